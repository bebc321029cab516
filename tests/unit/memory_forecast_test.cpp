// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/memory_forecast.h>
#include <gmock/gmock.h>

#include <cmath>

#include "support.h"

namespace eigencrust {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// All of them different.
PointCloud cloud_of(std::size_t points) {
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i) cloud.points.push_back({static_cast<double>(i), 0.5, -1});
  return cloud;
}

TEST(MemorySize, Parses) {
  EXPECT_EQ(parse_memory_size("4000000000"), 4'000'000'000u);
  EXPECT_EQ(parse_memory_size("1"), 1u);
  EXPECT_EQ(parse_memory_size("4G"), 4'000'000'000u);
  EXPECT_EQ(parse_memory_size("500M"), 500'000'000u);
  EXPECT_EQ(parse_memory_size("1.5k"), 1500u);
  EXPECT_EQ(parse_memory_size("2TB"), 2'000'000'000'000u);
  EXPECT_EQ(parse_memory_size("4Gi"), std::uint64_t{4} << 30);
  EXPECT_EQ(parse_memory_size("0.5MiB"), std::uint64_t{1} << 19);
  EXPECT_EQ(parse_memory_size("12B"), 12u);
}

TEST(MemorySize, RefusesWhatIsNone) {
  for (const char* text : {"", "G", "none", "-1", "0", "0.1", "1e9", "nan", "inf", "4X", "4GG", "4 G", "4Gii", "4iB",
                           "4Bi", "0x10", "9999999999T", "1,5G"})
    EXPECT_THAT(error_of([&] { parse_memory_size(text); }), HasSubstr("no size of memory")) << text;
}

TEST(MemorySize, IsDescribedForPeople) {
  EXPECT_EQ(describe_bytes(0), "0 bytes");
  EXPECT_EQ(describe_bytes(999), "999 bytes");
  EXPECT_EQ(describe_bytes(1000), "1.0 kB");
  EXPECT_EQ(describe_bytes(3'300'000'000), "3.3 GB");
  EXPECT_EQ(describe_bytes(23'400'000), "23 MB");
  EXPECT_EQ(describe_bytes(999'999), "1.0 MB"); // not "1000 kB"
  EXPECT_EQ(describe_bytes(9'960'000'000), "10 GB");
}

TEST(Forecast, GrowsWithPointsAndColumns) {
  Forecast last = forecast(std::uint64_t{0});
  for (std::uint64_t points = 1; points < std::uint64_t{1} << 40; points *= 3) {
    const Forecast next = forecast(points);
    EXPECT_GT(next.memory_bytes, last.memory_bytes);
    EXPECT_GT(next.seconds, last.seconds);
    EXPECT_GT(forecast(points, 100).memory_bytes, next.memory_bytes);
    last = next;
  }
  // What no machine has must not wrap around to something small.
  EXPECT_GT(forecast(~std::uint64_t{0}).memory_bytes, last.memory_bytes);
}

TEST(Forecast, CountsEveryColumnOfACloud) {
  PointCloud cloud = cloud_of(1000);
  EXPECT_EQ(further_bytes(cloud), 0u);
  cloud.attributes.push_back(make_attribute("a", std::vector<float>(1000)));
  EXPECT_EQ(further_bytes(cloud), 4000u);
  cloud.scan_index.resize(1000);
  EXPECT_EQ(further_bytes(cloud), 8000u);
  cloud.sensors.resize(2);
  cloud.sensor_of.resize(1000);
  EXPECT_EQ(further_bytes(cloud), 12'000u + 2 * sizeof(Sensor));
  EXPECT_EQ(forecast(cloud).memory_bytes, forecast(1000, further_bytes(cloud)).memory_bytes);
}

TEST(Forecast, RowsThatAreNoSamplesCountLittle) {
  const PointCloud once = cloud_of(200'000);
  PointCloud twice = once, broken = once;
  twice.points.insert(twice.points.end(), once.points.begin(), once.points.end());
  broken.points.resize(400'000, {std::nan(""), 0, 0});
  const auto bytes = [](const PointCloud& cloud) { return static_cast<double>(forecast(cloud).memory_bytes); };
  EXPECT_NEAR(bytes(twice) / bytes(once), 1.05, 0.02);
  EXPECT_DOUBLE_EQ(bytes(broken), bytes(twice));
  EXPECT_NEAR(forecast(twice).seconds / forecast(once).seconds, 1, 1e-9);
}

TEST(CheckMemory, RefusesAboveTheLimitAlone) {
  const PointCloud cloud = cloud_of(10'000);
  const std::uint64_t needed = forecast(cloud).memory_bytes;
  EXPECT_NO_THROW(check_memory(cloud, 0)); // no limit
  EXPECT_NO_THROW(check_memory(cloud, needed));
  EXPECT_THROW(check_memory(cloud, needed - 1), Error);
  EXPECT_THROW(check_memory(cloud, 1), Error);
}

TEST(CheckMemory, TellsForecastLimitAndHowManyPointsFit) {
  const PointCloud cloud = cloud_of(1'000'000);
  const std::uint64_t half = forecast(std::uint64_t{500'000}).memory_bytes;
  const std::string text = error_of([&] { check_memory(cloud, half); });
  EXPECT_THAT(text, HasSubstr("1000000 points"));
  EXPECT_THAT(text, HasSubstr(describe_bytes(forecast(cloud).memory_bytes)));
  EXPECT_THAT(text, HasSubstr("the limit of " + describe_bytes(half)));
  EXPECT_THAT(text, HasSubstr("about 500000 fit"));
  EXPECT_THAT(text, HasSubstr("--max-memory"));
}

TEST(CheckMemory, ReconstructHonoursTheOptionBeforeAnyStage) {
  class Watch : public Observer {
   public:
    void stage_begins(std::string_view) override { ++stages; }
    int stages = 0;
  } watch;
  Options options;
  options.max_memory = 1000;
  try {
    reconstruct(cloud_of(100), options, watch);
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::memory);
  }
  EXPECT_EQ(watch.stages, 0);
}

/// A root folder with what the system tells in files.
class AvailableMemory : public testing::Test {
 protected:
  void tell(const std::string& file, const std::string& text) {
    std::filesystem::create_directories((root / file).parent_path());
    write_bytes(root / file, text);
  }
  [[nodiscard]] std::uint64_t available() const { return available_memory_bytes(root.path()); }
  TempDir root;
};

TEST_F(AvailableMemory, IsNotKnownWithoutFiles) { EXPECT_EQ(available(), 0u); }

TEST_F(AvailableMemory, IsWhatIsSparePlusWhatTheProcessHolds) {
  tell("proc/meminfo", "MemTotal:       64000 kB\nMemFree:          100 kB\nMemAvailable:    2000 kB\n");
  EXPECT_EQ(available(), 2000u * 1024);
  tell("proc/self/status", "Name:\tx\nVmHWM:\t     900 kB\nVmRSS:\t     500 kB\n");
  EXPECT_EQ(available(), 2500u * 1024);
}

TEST_F(AvailableMemory, IsBoundByTheControlGroup) {
  tell("proc/meminfo", "MemAvailable:    2000 kB\n");
  tell("sys/fs/cgroup/memory.max", "max\n");
  EXPECT_EQ(available(), 2000u * 1024);
  tell("sys/fs/cgroup/memory.max", "1000000\n");
  EXPECT_EQ(available(), 1'000'000u);
  // Version 2: any group that the process's own lies in.
  tell("proc/self/cgroup", "0::/a/b\n");
  tell("sys/fs/cgroup/a/memory.max", "400000\n");
  tell("sys/fs/cgroup/a/b/memory.max", "max\n");
  EXPECT_EQ(available(), 400'000u);
  // A path of the world outside the container: its own folder is the topmost.
  tell("proc/self/cgroup", "0::/not/here\n");
  EXPECT_EQ(available(), 1'000'000u);
}

TEST_F(AvailableMemory, KnowsControlGroupsOfVersionOne) {
  tell("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n"); // none
  tell("proc/meminfo", "MemAvailable:    2000 kB\n");
  EXPECT_EQ(available(), 2000u * 1024);
  tell("proc/self/cgroup", "5:devices:/\n4:cpu,memory:/x\n");
  tell("sys/fs/cgroup/memory/x/memory.limit_in_bytes", "300000\n");
  EXPECT_EQ(available(), 300'000u);
}

TEST(AvailableMemoryHere, IsKnown) {
  if (!std::filesystem::exists("/proc/meminfo")) GTEST_SKIP() << "no /proc";
  EXPECT_GT(available_memory_bytes(), 1'000'000u);
}

TEST(MemoryWarning, OnlyWhenTheForecastExceedsWhatIsKnown) {
  EXPECT_THAT(memory_warning({5000, 1}, 0), IsEmpty());
  EXPECT_THAT(memory_warning({5000, 1}, 5000), IsEmpty());
  EXPECT_THAT(memory_warning({5'000'000, 1}, 4'000'000), HasSubstr("5.0 MB, exceeds the 4.0 MB"));
}

} // namespace
} // namespace eigencrust
