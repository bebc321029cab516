// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numeric>
#include <random>

#include <eigencrust/error.h>
#include <eigencrust/metrics.h>

#include "geometry/mesh_topology.h"

namespace eigencrust {
namespace {

/// A number in [0, 1) from the top 53 bits. The distributions of the standard library differ from one
/// library to the next; the generator itself does not.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

} // namespace

std::vector<Vec3> sample_surface(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed,
                                 std::vector<std::uint32_t>* triangle_of) {
  require_valid_indices(mesh, "surface samples");
  std::vector<double> area_up_to(mesh.triangles.size());
  double total = 0;
  for (std::size_t t = 0; t < area_up_to.size(); ++t) {
    total += norm(area_vector(mesh, t));
    area_up_to[t] = total;
  }
  if (!(total > 0) || !std::isfinite(total))
    throw Error(ErrorKind::input, "surface samples", "the mesh has no area, or not a finite one", "repair the mesh");

  std::mt19937_64 random(seed);
  std::vector<Vec3> points;
  points.reserve(count);
  if (triangle_of != nullptr) triangle_of->clear();
  std::uint32_t t = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // One sample in each of `count` equal shares of the area: less scatter than independent draws.
    const double place = (static_cast<double>(i) + uniform(random)) / static_cast<double>(count) * total;
    while (t + 1 < area_up_to.size() && area_up_to[t] <= place) ++t;
    // Osada et al., "Shape Distributions" (2002), eq. 1: uniform over the triangle.
    const double root = std::sqrt(uniform(random)), v = uniform(random);
    const auto& [a, b, c] = mesh.triangles[t];
    points.push_back((1 - root) * mesh.vertices[a] + (root * (1 - v)) * mesh.vertices[b] +
                     (root * v) * mesh.vertices[c]);
    if (triangle_of != nullptr) triangle_of->push_back(t);
  }
  return points;
}

} // namespace eigencrust
