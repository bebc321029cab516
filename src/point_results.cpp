// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_results.h"

#include <algorithm>
#include <limits>

#include "parallel/threads.h"

namespace eigencrust {
namespace {

/// The sample of each row; invalid for rows that are not finite.
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

} // namespace

void add_point_results(const PointCloud& cloud, const Tetrahedralization& t, const Surface& surface,
                       std::span<const float> grid_spacing, const Threads& threads, Result& result) {
  const Classification classes = classify_samples(t, surface, grid_spacing, threads);
  const IndexedArray<SampleIndex, Vec3> normals = orient_samples(t, surface, classes, grid_spacing, threads);
  const std::vector<SampleIndex> sample = samples_of_rows(cloud, t);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  result.inlier.assign(sample.size(), 0);
  result.confidence.assign(sample.size(), 0);
  result.normals.assign(sample.size(), {nan, nan, nan});
  for_each_index(threads, sample.size(), [&](std::size_t row) {
    if (!sample[row].valid()) return;
    result.inlier[row] = classes.inlier[sample[row]];
    result.confidence[row] = classes.confidence[sample[row]];
    result.normals[row] = normals[sample[row]];
  });
}

} // namespace eigencrust
