// SPDX-License-Identifier: GPL-3.0-or-later
// How reconstruct() refuses, reports and lets itself be watched and stopped.
#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <gmock/gmock.h>

#include <atomic>
#include <limits>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Points;

ErrorKind kind_of(const PointCloud& cloud, const Options& options = {}) {
  try {
    reconstruct(cloud, options);
  } catch (const Error& error) {
    EXPECT_FALSE(error.place().empty());
    EXPECT_FALSE(error.cause().empty());
    EXPECT_FALSE(error.remedy().empty());
    return error.kind();
  }
  return ErrorKind{};
}
ErrorKind kind_of(Points points) { return kind_of(clouds::cloud_of(std::move(points))); }

TEST(Refusals, CloudsThatBoundNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(kind_of(Points{}), ErrorKind::input);
  EXPECT_EQ(kind_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), ErrorKind::input);
  EXPECT_EQ(kind_of(Points(1000, Vec3{1, 2, 3})), ErrorKind::input);
  EXPECT_EQ(kind_of(Points(1000, Vec3{nan, nan, nan})), ErrorKind::input);
  EXPECT_EQ(kind_of(clouds::lattice(10, 10, 1)), ErrorKind::input); // coplanar
  EXPECT_EQ(kind_of(clouds::moved(clouds::lattice(10, 10, 1), {1e6, 2e6, 3e6})), ErrorKind::input);
  EXPECT_EQ(kind_of(clouds::lattice(100, 1, 1)), ErrorKind::input); // collinear
  EXPECT_EQ(kind_of(clouds::joined(clouds::sphere(100), {{1e200, 0, 0}})), ErrorKind::input);
}

TEST(Refusals, ArraysThatDoNotFit) {
  PointCloud cloud = clouds::cloud_of(clouds::sphere(100));
  cloud.scan_index.assign(99, 0);
  EXPECT_EQ(kind_of(cloud), ErrorKind::input);
  cloud.scan_index.clear();
  cloud.attributes = {make_attribute("short", ScalarType::float64, std::vector<double>(99, 0.0))};
  EXPECT_EQ(kind_of(cloud), ErrorKind::input);
}

TEST(Refusals, OptionsThatMakeNoSense) {
  const PointCloud cloud = clouds::cloud_of(clouds::sphere(200));
  Options options;
  options.solver.max_steps = 0;
  EXPECT_EQ(kind_of(cloud, options), ErrorKind::usage);
  options = {};
  options.inside_points = {{50, 0, 0}};
  EXPECT_EQ(kind_of(cloud, options), ErrorKind::usage);
  options = {};
  options.outside_points = options.inside_points = {{0.01, 0.02, 0.03}};
  EXPECT_EQ(kind_of(cloud, options), ErrorKind::usage);
}

TEST(Refusals, AnEmptySurfaceIsAnErrorOfItsOwn) {
  // A grid spacing so large that every tetrahedron is questionable: nothing is inside.
  Options options;
  options.grid_spacing = {LengthChoice::Kind::length, 1e3};
  EXPECT_EQ(kind_of(clouds::cloud_of(clouds::sphere(200)), options), ErrorKind::no_surface);
}

TEST(Refusals, ScanNumbersMayBeAnyNumbers) {
  PointCloud cloud = clouds::cloud_of(clouds::sphere(500));
  cloud.scan_index.assign(500, 0);
  for (std::size_t i = 0; i < 250; ++i) cloud.scan_index[2 * i] = 4294967295u;
  cloud.scan_index[17] = 4000000000u;
  EXPECT_EQ(kind_of(cloud), ErrorKind{});
}

/// Writes down what it sees; asks to stop at the `stop_at`-th question, or from a named stage on.
class Recorder : public Observer {
 public:
  std::vector<std::string> begun, ended;
  std::vector<std::string> faults;
  std::atomic<std::size_t> questions = 0; // worker threads ask too
  std::size_t stop_at = std::numeric_limits<std::size_t>::max();
  std::string stop_from;

  void stage_begins(std::string_view stage) override {
    if (begun.size() != ended.size()) faults.push_back("begins before the last one ended: " + std::string(stage));
    begun.emplace_back(stage);
    fraction_ = 0;
  }
  void progress(double fraction) override {
    if (begun.size() != ended.size() + 1) faults.push_back("progress outside a stage");
    if (!(fraction >= 0 && fraction <= 1)) faults.push_back("fraction " + std::to_string(fraction));
    if (fraction < fraction_) faults.push_back("progress goes back in " + begun.back());
    fraction_ = fraction;
  }
  void stage_ends(std::string_view stage, double seconds) override {
    ended.emplace_back(stage);
    if (ended.size() != begun.size() || ended.back() != begun.back()) faults.push_back("ends: " + ended.back());
    if (seconds < 0) faults.push_back("negative time");
  }
  bool cancelled() override {
    return questions++ >= stop_at || (!stop_from.empty() && !begun.empty() && begun.back() == stop_from);
  }

 private:
  double fraction_ = 0;
};

Points noisy_cloud() {
  return clouds::joined(clouds::jittered(clouds::sphere(1500), 0.05, 1), clouds::random_box(60, 2, 2));
}

TEST(Observers, SeeEveryStageBeginAndEndAndProgressGoForward) {
  for (const Preset preset : {Preset::robust, Preset::paper}) {
    Recorder recorder;
    Options options = Options::of(preset);
    options.smooth = 1;
    const Result result = reconstruct(clouds::cloud_of(noisy_cloud()), options, recorder);
    EXPECT_THAT(recorder.faults, testing::IsEmpty());
    EXPECT_EQ(recorder.begun, recorder.ended);
    std::vector<std::string> reported;
    for (const StageReport& stage : result.report.stages) reported.push_back(stage.name);
    EXPECT_EQ(recorder.begun, reported);
  }
}

TEST(Observers, MayStopAtEveryQuestion) {
  const PointCloud cloud = clouds::cloud_of(clouds::jittered(clouds::sphere(400), 0.05, 3));
  Options options;
  options.smooth = 1;
  for (const unsigned threads : {1u, 4u}) {
    options.threads = threads;
    Recorder whole;
    reconstruct(cloud, options, whole);
    ASSERT_GT(whole.questions, 100u); // every loop asks
    const std::size_t step = threads == 1 ? 1 : 7;
    for (std::size_t k = 0; k < whole.questions; k += step) {
      Recorder recorder;
      recorder.stop_at = k;
      try {
        reconstruct(cloud, options, recorder);
        ADD_FAILURE() << "went on after question " << k;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled);
        EXPECT_LE(recorder.questions, k + threads);
        EXPECT_EQ(recorder.begun, recorder.ended); // a stage that is broken off ends all the same
      }
    }
  }
}

TEST(Observers, MayStopInEveryStageButTheLast) {
  const PointCloud cloud = clouds::cloud_of(clouds::jittered(clouds::sphere(400), 0.05, 4));
  Recorder whole;
  reconstruct(cloud, {}, whole);
  for (std::size_t i = 0; i + 1 < whole.begun.size(); ++i) {
    Recorder recorder;
    recorder.stop_from = whole.begun[i];
    try {
      reconstruct(cloud, {}, recorder);
      ADD_FAILURE() << "went on after " << whole.begun[i];
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
  }
}

TEST(Reports, SayWhatWasDone) {
  PointCloud cloud = clouds::cloud_of(clouds::sphere(1000));
  const Result result = reconstruct(cloud);
  const Report& report = result.report;
  EXPECT_EQ(report.points, 1000u);
  EXPECT_NEAR(report.spacing, 3.5 / std::sqrt(1000.0), 0.03);
  EXPECT_EQ(report.grid_spacing, 0);       // a single scan
  ASSERT_EQ(report.partitions.size(), 1u); // the tetrahedra get a cut
  EXPECT_EQ(report.partitions[0].stage, "poles");
  EXPECT_GT(report.seconds, 0);
  EXPECT_GT(report.peak_memory_bytes, 0u);
  EXPECT_EQ(result.labels.size(), result.tetrahedralization.tetrahedra.size());
  EXPECT_THAT(result.labels.raw(), testing::Each(testing::Ne(Label::unlabelled)));
  double stages = 0;
  for (const StageReport& stage : report.stages) stages += stage.seconds;
  EXPECT_LE(stages, report.seconds * 1.001);
}

TEST(Reports, ListWhatWasDropped) {
  const Points points = clouds::joined(clouds::sphere(1500), clouds::sphere(600, 0.5, {10, 0, 0}));
  Options options;
  options.components.kind = KeepComponents::Kind::largest;
  const Result result = reconstruct(clouds::cloud_of(points), options);
  EXPECT_EQ(result.report.mesh.components, 1u);
  ASSERT_EQ(result.report.dropped_components.size(), 1u);
  EXPECT_NEAR(distance(result.report.dropped_components[0].centre, {10, 0, 0}), 0, 0.05); // input coordinates
}

} // namespace
} // namespace eigencrust
