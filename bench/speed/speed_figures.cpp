// SPDX-License-Identifier: GPL-3.0-or-later
#include "speed_figures.h"

#include <algorithm>
#include <limits>

namespace eigencrust::bench {
namespace {

constexpr std::uint64_t growth_begins = 100'000; // smaller clouds fit into caches

struct PerPoint {
  double cgal, delaunay, rest;
};

PerPoint per_point(const SpeedOutcome& outcome, const WholeTimes& whole) {
  const double delaunay = whole.stage_seconds("delaunay");
  return {outcome.per_point(median(outcome.cgal.seconds)), outcome.per_point(delaunay),
          outcome.per_point(median(whole.seconds) - delaunay)};
}

} // namespace

double median(std::span<const double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

double WholeTimes::stage_seconds(const std::string& name) const {
  for (const auto& [stage, times] : stages)
    if (stage == name) return median(times);
  return 0;
}

double WholeTimes::seconds_after_delaunay() const {
  std::vector<double> sums(seconds.size(), 0.0);
  bool after = false;
  for (const auto& [name, times] : stages) {
    for (std::size_t run = 0; after && name != "other" && run < sums.size(); ++run) sums[run] += times[run];
    after = after || name == "delaunay";
  }
  return median(sums);
}

std::vector<Growth> growth_of(const std::vector<SpeedOutcome>& outcomes) {
  std::vector<const SpeedOutcome*> generated;
  for (const SpeedOutcome& outcome : outcomes)
    if (outcome.item.file.empty() && outcome.measured()) generated.push_back(&outcome);
  std::sort(generated.begin(), generated.end(),
            [](const SpeedOutcome* a, const SpeedOutcome* b) { return a->points < b->points; });
  const auto large = std::find_if(generated.begin(), generated.end(),
                                  [](const SpeedOutcome* o) { return o->points >= growth_begins; });
  if (large != generated.end()) generated.erase(generated.begin(), large);

  std::vector<Growth> growth;
  for (const SpeedOutcome* outcome : generated)
    for (std::size_t i = 0; i < outcome->whole.size(); ++i) {
      const WholeTimes& whole = outcome->whole[i];
      const PerPoint first = per_point(*generated.front(), generated.front()->whole[i]),
                     now = per_point(*outcome, whole);
      growth.push_back({outcome->item.name, outcome->points, whole.threads, now.cgal / first.cgal,
                        now.delaunay / first.delaunay, now.rest / first.rest});
    }
  return growth;
}

} // namespace eigencrust::bench
