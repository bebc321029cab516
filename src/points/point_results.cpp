// SPDX-License-Identifier: GPL-3.0-or-later
#include "points/point_results.h"

#include <limits>

#include "parallel/threads.h"
#include "samples/rows.h"

namespace eigencrust {

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
