// SPDX-License-Identifier: GPL-3.0-or-later
#include "pause_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

namespace eigencrust::cli {
namespace {

/// Counts until it goes.
class Worker {
 public:
  Worker()
      : thread_([this] {
          while (!stop_) ++count_;
        }) {
    wait_for_more_than(0);
  }
  ~Worker() {
    stop_ = true;
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  [[nodiscard]] std::uint64_t count() const { return count_; }
  void wait_for_more_than(std::uint64_t count) const {
    while (count_ <= count) std::this_thread::yield();
  }

 private:
  std::atomic<std::uint64_t> count_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

TEST(OtherThreadsPaused, StandStillUntilItGoes) {
  const Worker one, other;
  for (int round = 0; round < 3; ++round) {
    std::uint64_t of_one = 0, of_other = 0;
    {
      const OtherThreadsPaused paused;
      for (int look = 0; look < 100 && (one.count() != of_one || other.count() != of_other); ++look) {
        of_one = one.count(); // they may be slow to stop
        of_other = other.count();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
      EXPECT_EQ(one.count(), of_one);
      EXPECT_EQ(other.count(), of_other);
    }
    one.wait_for_more_than(of_one);
    other.wait_for_more_than(of_other);
  }
}

} // namespace
} // namespace eigencrust::cli
