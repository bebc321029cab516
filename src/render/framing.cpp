// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/framing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/nearest.h"

namespace eigencrust {
namespace {

constexpr std::size_t most_looked_at = 20000; ///< of many points a part tells as much
constexpr std::size_t neighbours = 8;
// A surface that is sampled a hundred times as densely in one place as in another has spacings of one to ten.
constexpr double apart = 10;   ///< in median distances to the last of the neighbours
constexpr double hardly = 0.9; ///< of the whole box: what is left out would not make the rest larger

/// For each point the distance to the last of its neighbours.
std::vector<double> reaches(const std::vector<Vec3>& points) {
  const PointTree tree(points);
  std::array<std::uint32_t, neighbours + 1> index{};
  std::array<double, neighbours + 1> squared{};
  std::vector<double> result;
  result.reserve(points.size());
  for (const Vec3& p : points) {
    const std::size_t found = tree.nearest(p, neighbours + 1, index.data(), squared.data());
    result.push_back(std::sqrt(squared[found - 1]));
  }
  return result;
}

/// Does every side of the whole box have nearly its length without what lies apart?
bool hardly_shrinks(const Box3& all, const Box3& bulk) {
  const Vec3 whole = all.max - all.min, rest = bulk.max - bulk.min;
  return rest.x >= hardly * whole.x && rest.y >= hardly * whole.y && rest.z >= hardly * whole.z;
}

} // namespace

std::vector<Vec3> bulk_of(std::vector<Vec3> points) {
  if (points.size() <= 2 * neighbours) return points;
  std::vector<Vec3> some;
  const std::size_t step = (points.size() + most_looked_at - 1) / most_looked_at;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  std::vector<double> reach = reaches(some), sorted = reach;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  Box3 all, bulk;
  for (const Vec3& p : points) all.add(p);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    if (!(reach[i] <= apart * *middle)) continue;
    bulk.add(some[i]);
    ++kept;
  }
  // Half of the points are no bulk where the median itself is of points that coincide.
  if (2 * kept < some.size() || hardly_shrinks(all, bulk)) return points;
  // What lies between the points that were looked at belongs to them.
  const double margin = *middle;
  bulk = {bulk.min - Vec3{margin, margin, margin}, bulk.max + Vec3{margin, margin, margin}};
  std::erase_if(points, [&](const Vec3& p) {
    return p.x < bulk.min.x || p.x > bulk.max.x || p.y < bulk.min.y || p.y > bulk.max.y || p.z < bulk.min.z ||
           p.z > bulk.max.z;
  });
  return points;
}

} // namespace eigencrust
