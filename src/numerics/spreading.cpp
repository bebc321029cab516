// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/spreading.h"

#include <algorithm>
#include <cmath>

namespace eigencrust {
namespace {

// A node whose value changes by less than this share of itself tells its neighbours nothing new.
constexpr double noticeable = 0.01;
constexpr double negligible = 1e-4; // of the largest value, 1
// Each node is looked at so often on average, at most.
constexpr std::uint64_t most_visits = 20;

} // namespace

void Spreading::hold(std::uint32_t node, float value) {
  partition_.value[node] = value;
  held_[node] = 1;
  wake_neighbours(node);
}

void Spreading::wake(std::uint32_t node) {
  if (waiting_[node] || held_[node]) return;
  waiting_[node] = 1;
  queue_.push_back(node);
}

void Spreading::run() {
  std::uint64_t visits = most_visits * graph_.node_count();
  while (!queue_.empty() && visits-- > 0) {
    const std::uint32_t node = queue_.front();
    queue_.pop_front();
    waiting_[node] = 0;
    const double before = static_cast<double>(partition_.value[node]), after = mean_at(node);
    partition_.value[node] = static_cast<float>(after);
    if (std::fabs(after - before) > noticeable * std::max(std::fabs(before), negligible)) wake_neighbours(node);
  }
}

void Spreading::wake_neighbours(std::uint32_t node) {
  for (std::uint64_t e = graph_.row_begin[node]; e < graph_.row_begin[node + 1]; ++e) wake(graph_.column[e]);
}

double Spreading::mean_at(std::uint32_t node) const {
  double sum = 0, size = 0;
  const auto add = [&](double w, double x) {
    sum += w * x;
    size += std::fabs(w);
  };
  for (std::uint64_t e = graph_.row_begin[node]; e < graph_.row_begin[node + 1]; ++e)
    add(static_cast<double>(graph_.weight[e]), static_cast<double>(partition_.value[graph_.column[e]]));
  for (std::size_t s = 0; s < graph_.supernodes.size(); ++s)
    add(static_cast<double>(graph_.supernodes[s].weight[node]), partition_.supernode_value[s]);
  return size > 0 ? sum / (size * (1 - partition_.eigenvalue)) : 0;
}

} // namespace eigencrust
