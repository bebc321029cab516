// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/range_grid.h"

#include <algorithm>
#include <cmath>

namespace eigencrust {
namespace {

// So many pixels apart samples are neighbours still: single pixels without a return leave no hole.
constexpr std::int32_t reach = 3;
// A step in range of more than so many pixels' widths is a jump. The quanta of a depth camera are up to 9 pixels wide,
// at 6 m; what a scanner sees between two neighbouring pixels at a flatter angle than 84° it hardly sees at all.
constexpr double widest_step = 10;

} // namespace

RangeGrid::RangeGrid(const PointCloud& cloud, std::span<const SampleIndex> sample_of_row, const Tetrahedralization& t,
                     std::span<const SightLine> lines)
    : t_(&t) {
  if (cloud.cell.empty()) return;
  pixel_.resize(t.sample_count);
  for (const SightLine& line : lines) {
    const Vec3 way = line.target - t.positions[line.sample];
    const double length = norm(way);
    if (length > 0) pixel_[line.sample.value].towards = (1 / length) * way;
  }
  for (std::size_t row = 0; row < sample_of_row.size(); ++row) {
    const SampleIndex s = sample_of_row[row];
    const std::uint32_t scan = cloud.scan_index.empty() ? 0 : cloud.scan_index[row];
    if (!s.valid() || cloud.cell[row] == no_index || pixel_[s.value].towards == Vec3{}) continue;
    const auto columns = cloud.grids[scan].columns;
    pixel_[s.value].scan = scan;
    pixel_[s.value].row = static_cast<std::int32_t>(cloud.cell[row] / columns);
    pixel_[s.value].column = static_cast<std::int32_t>(cloud.cell[row] % columns);
  }
}

Between RangeGrid::between(SampleIndex a, SampleIndex b) const {
  const Pixel &p = pixel_[a.value], &q = pixel_[b.value];
  if (p.scan == no_index || p.scan != q.scan) return Between::unknown;
  const std::int32_t rows = std::abs(p.row - q.row), columns = std::abs(p.column - q.column);
  if (rows > reach || columns > reach) return Between::unknown;
  const Vec3 way = t_->positions[b] - t_->positions[a];
  const double step = dot(way, p.towards), aside = norm(way - step * p.towards);
  const double pixel = aside / std::hypot(rows, columns);
  return std::fabs(step) > widest_step * pixel ? Between::jump : Between::surface;
}

Between RangeGrid::between(const std::array<SampleIndex, 3>& triangle) const {
  Between all = Between::surface;
  for (std::size_t k = 0; k < 3; ++k) {
    const Between one = between(triangle[k], triangle[(k + 1) % 3]);
    if (one == Between::jump) return one;
    if (one == Between::unknown) all = one;
  }
  return all;
}

} // namespace eigencrust
