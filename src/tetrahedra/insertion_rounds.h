// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// In which order points go into a triangulation.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace eigencrust {

/// Numbers below `count`, which should follow a curve through space, in random rounds, each four times as large as the
/// one before and in the order of the curve (BRIO; Amenta, Choi, Rote 2003). The same in every call.
inline std::vector<std::uint32_t> in_rounds(std::uint32_t count) {
  std::mt19937_64 random;
  std::vector<std::vector<std::uint32_t>> rounds(1 + std::numeric_limits<std::uint64_t>::digits);
  for (std::uint32_t i = 0; i < count; ++i)
    rounds[static_cast<std::size_t>(std::countr_zero(random())) / 2].push_back(i);
  std::vector<std::uint32_t> order;
  order.reserve(count);
  for (auto round = rounds.rbegin(); round != rounds.rend(); ++round)
    order.insert(order.end(), round->begin(), round->end());
  return order;
}

} // namespace eigencrust
