// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <tuple>

#include <eigencrust/error.h>
#include <eigencrust/stages.h>

#include "geometry/exact_difference.h"
#include "geometry/nearest.h"
#include "geometry/spatial_order.h"
#include "geometry/tetrahedron.h"
#include "numerics/quantile.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

struct Keyed {
  std::uint64_t key;
  Vec3 position;
  std::uint32_t row;

  friend bool operator<(const Keyed& a, const Keyed& b) {
    return std::tie(a.key, a.position.x, a.position.y, a.position.z, a.row) <
           std::tie(b.key, b.position.x, b.position.y, b.position.z, b.row);
  }
};

/// Along the Hilbert curve; what falls into one of its cells, along the cell's own curve: a stray row far away makes
/// the cells as large as the object.
void sort_along_curve(std::span<Keyed> samples, const Box3& box, const Threads& threads) {
  for_each_index(threads, samples.size(),
                 [&](std::size_t i) { samples[i].key = hilbert_key(samples[i].position, box); });
  sort_blocks(threads, samples);
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    Box3 cell;
    for (end = begin; end < samples.size() && samples[end].key == samples[begin].key; ++end)
      cell.add(samples[end].position);
    if (cell.diagonal() > 0) sort_along_curve(samples.subspan(begin, end - begin), cell, threads);
  }
}

void check_extent(const Box3& box) {
  // Squares and cubes of lengths must stay within the range of double.
  constexpr double largest = 1e30;
  const double extent = box.diagonal();
  const double farthest = std::max({std::fabs(box.min.x), std::fabs(box.min.y), std::fabs(box.min.z),
                                    std::fabs(box.max.x), std::fabs(box.max.y), std::fabs(box.max.z)});
  if (!(extent < largest) || farthest > largest)
    throw Error(ErrorKind::input, "samples", "coordinates are larger than 1e30",
                "remove stray rows or change the unit of the input");
  if (extent < 1 / largest)
    throw Error(ErrorKind::input, "samples", "all finite points lie within 1e-30 of each other",
                "give at least 5 distinct points, or change the unit of the input");
}

/// An origin in or near the box from which all points are exact: the box's centre if it is one. Otherwise the centre
/// on axes on which the cloud is farther from 0 than it is wide (of two numbers within a factor of 2 the difference
/// is exact; Sterbenz 1974), and 0 on the others.
Vec3 exact_origin(std::span<const Vec3> points, const Box3& box, const Threads& threads) {
  const Vec3 centre = box.centre();
  const auto rounded = sum_blocks<std::uint64_t>(threads, points.size(), [&](std::size_t begin, std::size_t end) {
    std::uint64_t count = 0;
    for (std::size_t i = begin; i < end; ++i) count += is_finite(points[i]) && !is_exact_difference(points[i], centre);
    return count;
  });
  if (rounded == 0) return centre;
  const auto far = [&](double c) { return std::fabs(c) > box.diagonal() ? c : 0.0; };
  return {far(centre.x), far(centre.y), far(centre.z)};
}

} // namespace

Samples prepare_samples(std::span<const Vec3> points, const Threads& threads) {
  constexpr std::size_t most = no_index - cube_corners;
  if (points.size() > most)
    throw Error(ErrorKind::input, "samples", "more than " + std::to_string(most) + " points", "split the cloud");
  Samples samples;
  for (const Vec3& p : points) {
    if (is_finite(p))
      samples.bounds.add(p);
    else
      ++samples.nonfinite;
  }
  const std::size_t finite = points.size() - samples.nonfinite;
  if (finite == 0) throw Error(ErrorKind::input, "samples", "no finite point", "give at least 5 distinct points");
  check_extent(samples.bounds);
  samples.origin = exact_origin(points, samples.bounds, threads);
  const Box3 box{samples.bounds.min - samples.origin, samples.bounds.max - samples.origin};

  std::vector<Keyed> keyed;
  keyed.reserve(finite);
  for (std::uint32_t row = 0; row < points.size(); ++row)
    if (is_finite(points[row])) keyed.push_back({0, points[row] - samples.origin, row});
  sort_along_curve(keyed, box, threads);

  // Rows with equal coordinates follow one another; the first has the smallest row.
  samples.positions.raw().reserve(finite + cube_corners);
  samples.source.raw().reserve(finite);
  samples.of_row.resize(points.size());
  for (const Keyed& k : keyed) {
    if (!samples.positions.empty() && samples.positions.raw().back() == k.position) {
      ++samples.duplicates;
    } else {
      samples.positions.raw().push_back(k.position);
      samples.source.raw().push_back(k.row);
    }
    samples.of_row[k.row] = SampleIndex{samples.positions.size() - 1};
  }
  if (samples.positions.size() < 5)
    throw Error(ErrorKind::input, "samples",
                "only " + std::to_string(samples.positions.size()) + " distinct finite points",
                "give at least 5 that are not in one plane");
  return samples;
}

double median_spacing(const Samples& samples, std::span<const Vec3> points, std::span<const std::uint32_t> scan_index,
                      const Threads& threads) {
  std::vector<double> nearest;
  if (scan_index.empty()) {
    nearest = nearest_other(samples.positions.raw(), threads);
  } else {
    // Scan numbers are names: however large, they ask for no memory.
    std::vector<std::uint32_t> scans(scan_index.begin(), scan_index.end());
    std::sort(scans.begin(), scans.end());
    scans.erase(std::unique(scans.begin(), scans.end()), scans.end());
    std::vector<std::vector<Vec3>> of_scan(scans.size());
    for (std::size_t row = 0; row < points.size(); ++row) {
      if (!is_finite(points[row])) continue;
      const auto scan = std::lower_bound(scans.begin(), scans.end(), scan_index[row]) - scans.begin();
      of_scan[static_cast<std::size_t>(scan)].push_back(points[row] - samples.origin);
    }
    for (std::vector<Vec3>& scan : of_scan) {
      std::sort(scan.begin(), scan.end());
      scan.erase(std::unique(scan.begin(), scan.end()), scan.end());
      const std::vector<double> distances = nearest_other(scan, threads);
      nearest.insert(nearest.end(), distances.begin(), distances.end());
    }
  }
  if (nearest.empty()) return 0;
  return median(nearest);
}

double resolve_grid_spacing(const LengthChoice& option, const Samples& samples, std::span<const Vec3> points,
                            std::span<const std::uint32_t> scan_index, const Threads& threads) {
  if (const auto given = option.given(samples.bounds.diagonal())) return *given;
  // Merged scans disagree by their registration; a single scan gives no such sign.
  const bool several =
      std::any_of(scan_index.begin(), scan_index.end(), [&](std::uint32_t scan) { return scan != scan_index.front(); });
  return several ? std::sqrt(2.0) * median_spacing(samples, points, scan_index, threads) : 0;
}

} // namespace eigencrust
