// SPDX-License-Identifier: GPL-3.0-or-later
#include "memory_bandwidth.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "parallel/threads.h"

namespace eigencrust::bench {
namespace {

constexpr std::size_t mebibyte = std::size_t{1} << 20;

/// Of one array: four times the last cache, as far as the system tells its size.
std::size_t array_bytes() {
  const long cache = std::max(sysconf(_SC_LEVEL3_CACHE_SIZE), sysconf(_SC_LEVEL2_CACHE_SIZE));
  return std::clamp(4 * static_cast<std::size_t>(std::max(0L, cache)), 64 * mebibyte, 512 * mebibyte);
}

} // namespace

double triad_bandwidth(unsigned threads) {
  const std::size_t n = array_bytes() / sizeof(double);
  const Threads team(threads);
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  // One long block per thread and no other order: the hardware's prefetching sees plain streams.
  const std::size_t block = (n + threads - 1) / threads;
  double best = 0;
  for (int round = 1; round <= 7; ++round) {
    const double s = round; // a new value: no round can be left out
    const auto start = std::chrono::steady_clock::now();
    for_blocks(team, n, block, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + s * c[i];
    });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::swap(a, b); // the result is used
    best = std::max(best, 3.0 * sizeof(double) * static_cast<double>(n) / seconds);
  }
  return b.front() > 0 ? best : 0;
}

} // namespace eigencrust::bench
