// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/threads.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>

#include "clouds.h"

namespace eigencrust {
namespace {

TEST(Threads, SizeIsAsToldOrOnePerCore) {
  EXPECT_EQ(Threads(1).size(), 1u);
  EXPECT_EQ(Threads(4).size(), 4u);
  EXPECT_GE(Threads(0).size(), 1u);
}

TEST(Threads, EveryBlockRunsOnce) {
  for (const unsigned count : {1u, 2u, 4u}) {
    const Threads threads(count);
    for (const std::size_t blocks : {0u, 1u, 2u, 1000u}) {
      std::vector<std::atomic<int>> runs(blocks);
      threads.run(blocks, [&](std::size_t b) { ++runs[b]; });
      for (const auto& n : runs) EXPECT_EQ(n, 1);
    }
  }
}

TEST(Threads, TheSmallestBlocksExceptionIsRethrownAndTheTeamGoesOn) {
  for (const unsigned count : {1u, 2u, 4u}) {
    const Threads threads(count);
    for (int round = 0; round < 50; ++round) {
      std::string what;
      try {
        threads.run(100, [](std::size_t b) {
          if (b % 30 == 7) throw std::runtime_error(std::to_string(b));
        });
      } catch (const std::runtime_error& error) {
        what = error.what();
      }
      ASSERT_EQ(what, "7");
      std::atomic<int> runs{0};
      threads.run(10, [&](std::size_t) { ++runs; });
      ASSERT_EQ(runs, 10);
    }
  }
}

TEST(Threads, TheCheckComesBeforeEachBlockAndMayEndTheWork) {
  for (const unsigned count : {1u, 2u, 4u}) {
    std::atomic<int> asked{0}, most{1000};
    const Threads threads(count, [&] {
      if (++asked > most) throw std::runtime_error("enough");
    });
    std::atomic<int> runs{0};
    threads.run(100, [&](std::size_t) { ++runs; });
    EXPECT_EQ(asked, 100);
    EXPECT_EQ(runs, 100);
    asked = runs = 0;
    most = 5;
    EXPECT_THROW(threads.run(10000, [&](std::size_t) { ++runs; }), std::runtime_error);
    EXPECT_EQ(runs, 5);
    EXPECT_LE(asked, 5 + static_cast<int>(count)) << "asked on after the work was over";
    asked = runs = 0;
    const auto inner = [&](std::size_t) { threads.run(10, [&](std::size_t) { ++runs; }); };
    EXPECT_THROW(threads.run(10, inner), std::runtime_error);
    EXPECT_LE(runs, 5);
  }
}

TEST(Threads, BlocksMayRunBlocksOfTheirOwn) {
  for (const unsigned count : {1u, 2u, 4u}) {
    const Threads threads(count);
    std::vector<std::atomic<int>> runs(20 * 50);
    threads.run(20,
                [&](std::size_t outer) { threads.run(50, [&](std::size_t inner) { ++runs[50 * outer + inner]; }); });
    for (const auto& n : runs) EXPECT_EQ(n, 1);
    EXPECT_THROW(
        threads.run(3, [&](std::size_t) { threads.run(3, [](std::size_t) { throw std::runtime_error("!"); }); }),
        std::runtime_error);
  }
}

TEST(Threads, BlocksCoverTheRangeWithoutOverlap) {
  const Threads threads(3);
  for (const std::size_t n : {0u, 1u, 9u, 10u, 11u, 95u}) {
    std::vector<int> touched(n, 0);
    std::vector<std::size_t> first((n + 9) / 10, 999);
    for_blocks(threads, n, 10, [&](std::size_t begin, std::size_t end, std::size_t b) {
      first[b] = begin;
      for (std::size_t i = begin; i < end; ++i) ++touched[i];
    });
    EXPECT_THAT(touched, testing::Each(1));
    for (std::size_t b = 0; b < first.size(); ++b) EXPECT_EQ(first[b], 10 * b);
  }
}

TEST(Threads, SumsAreTheSameBitsForAnyNumberOfThreads) {
  clouds::Random random(1);
  std::vector<double> values(200000);
  for (double& v : values) v = std::exp(random.uniform(-30, 30)) * (random.uniform() < 0.5 ? -1 : 1);
  const auto sum = [&](unsigned count) {
    return sum_blocks<double>(
        Threads(count), values.size(),
        [&](std::size_t begin, std::size_t end) {
          double part = 0;
          for (std::size_t i = begin; i < end; ++i) part += values[i];
          return part;
        },
        1000);
  };
  const double one = sum(1);
  EXPECT_NE(one, 0);
  for (const unsigned count : {2u, 3u, 4u}) EXPECT_EQ(sum(count), one);
}

TEST(Threads, SumOverNothingIsZero) {
  EXPECT_EQ(sum_blocks<int>(Threads(2), 0, [](std::size_t, std::size_t) { return 1; }), 0);
}

TEST(Threads, SortsLikeTheStandardLibrary) {
  clouds::Random random(2);
  for (const std::size_t n : {0u, 1u, 15u, 4095u, 4096u, 50001u}) {
    std::vector<std::uint32_t> items(n);
    for (auto& v : items) v = random.below(1000);
    std::vector<std::uint32_t> expected = items;
    std::sort(expected.begin(), expected.end());
    sort_blocks(Threads(3), items);
    EXPECT_EQ(items, expected);
  }
}

} // namespace
} // namespace eigencrust
