// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds whose tetrahedra are many more than usual, and runs that are to end while they grow.
#include <eigencrust/eigencrust.h>
#include <eigencrust/memory_forecast.h>
#include <gmock/gmock.h>

#include <atomic>

#include "clouds.h"
#include "support.h"

namespace eigencrust {
namespace {

using testing::HasSubstr;

/// Each point of the moment curve is a neighbour of each other.
PointCloud moment_curve(std::uint32_t n) {
  PointCloud cloud;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / n;
    cloud.points.push_back({t, t * t, t * t * t});
  }
  return cloud;
}

TEST(Growth, TheLimitHoldsWhileTheTetrahedraGrow) {
  const PointCloud cloud = moment_curve(1500); // more than a million tetrahedra
  Options options;
  options.max_memory = 20'000'000;
  ASSERT_LT(forecast(cloud).memory_bytes, options.max_memory);
  for (const unsigned threads : {1u, 2u}) {
    options.threads = threads;
    try {
      reconstruct(cloud, options);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::memory);
      EXPECT_THAT(error.what(), HasSubstr("tetrahedra"));
    }
  }
}

TEST(Growth, OrdinaryCloudsStayBelowTheirForecast) {
  Options options;
  options.threads = 1;
  for (const auto& points : {clouds::sphere(2000), clouds::random_box(2000, 3), clouds::torus(3, 1, 60, 30)}) {
    PointCloud cloud;
    cloud.points = points;
    options.max_memory = forecast(cloud).memory_bytes;
    options.components.kind = KeepComponents::Kind::all;
    try {
      reconstruct(cloud, options);
    } catch (const Error& error) {
      EXPECT_NE(error.kind(), ErrorKind::memory) << error.what();
    }
  }
}

TEST(Growth, TheTriangulationIsCancelled) {
  class AtDelaunay : public Observer {
   public:
    void stage_begins(std::string_view stage) override { begun = stage == "delaunay"; }
    bool cancelled() override { return begun && ++asked > 3; }
    std::atomic<bool> begun{false};
    std::atomic<int> asked{0};
  };
  PointCloud cloud;
  cloud.points = clouds::sphere(20000);
  for (const unsigned threads : {1u, 2u}) {
    Options options;
    options.threads = threads;
    AtDelaunay observer;
    try {
      reconstruct(cloud, options, observer);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::cancelled);
      EXPECT_EQ(error.place(), "delaunay");
    }
    EXPECT_LT(observer.asked, 10);
  }
}

TEST(Growth, ManyTetrahedraAreTold) {
  Options options;
  options.components.kind = KeepComponents::Kind::all;
  options.threads = 1;
  PointCloud cloud;
  cloud.points = clouds::sphere(300);
  constexpr int many = 150; // on each of two skew lines: every step of one with every step of the other
  for (int i = 0; i < many; ++i) {
    const double t = static_cast<double>(i) / many;
    cloud.points.push_back({5 + t, 0, 0});
    cloud.points.push_back({5, t, 1});
  }
  const Result result = reconstruct(cloud, options);
  EXPECT_THAT(result.report.warnings, testing::Contains(HasSubstr("tetrahedra per sample")));
  cloud.points.resize(300);
  EXPECT_THAT(reconstruct(cloud, options).report.warnings, testing::IsEmpty());
}

} // namespace
} // namespace eigencrust
