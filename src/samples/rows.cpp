// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/rows.h"

#include <algorithm>

namespace eigencrust {

std::vector<SampleIndex> samples_of_rows(const PointCloud& cloud, const Tetrahedralization& t) {
  std::vector<SampleIndex> sample(cloud.points.size());
  for (std::uint32_t i = 0; i < t.sample_count; ++i) sample[t.source.raw()[i]] = SampleIndex{i};
  std::vector<std::uint32_t> duplicates;
  for (std::uint32_t row = 0; row < sample.size(); ++row)
    if (!sample[row].valid() && is_finite(cloud.points[row])) duplicates.push_back(row);
  if (duplicates.empty()) return sample;
  std::vector<SampleIndex> sorted(t.sample_count);
  for (std::uint32_t i = 0; i < t.sample_count; ++i) sorted[i] = SampleIndex{i};
  const auto at = [&](SampleIndex s) -> const Vec3& { return t.positions[s]; };
  std::sort(sorted.begin(), sorted.end(), [&](SampleIndex a, SampleIndex b) { return at(a) < at(b); });
  for (const std::uint32_t row : duplicates) {
    const Vec3 position = cloud.points[row] - t.origin; // as prepare_samples() saw it
    sample[row] = *std::lower_bound(sorted.begin(), sorted.end(), position,
                                    [&](SampleIndex s, const Vec3& p) { return at(s) < p; });
  }
  return sample;
}

} // namespace eigencrust
