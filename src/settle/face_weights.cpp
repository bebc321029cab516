// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/face_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/tetrahedron.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust {
namespace {

// Two bytes a face: the measure need not be known better.
constexpr double steps_of_cost = std::numeric_limits<std::int16_t>::max() / (1 + FaceWeights::cost_of_isolated);

// Thinner in its longest edges is a tetrahedron of samples that lie in a plane and on a circle: where its centre is on
// the way between those of its neighbours rounding decides (32 bits some hundred edges from zero). It has no say.
constexpr double flat = 1e-5;

/// Of each face the vector across it, twice as long as its area.
std::array<Vec3, 4> across_faces(const std::array<Vec3, 4>& p) {
  std::array<Vec3, 4> result;
  for (std::size_t k = 0; k < 4; ++k)
    result[k] = cross(p[(k + 2) % 4] - p[(k + 1) % 4], p[(k + 3) % 4] - p[(k + 1) % 4]);
  return result;
}

bool is_flat(const std::array<Vec3, 4>& p, double largest_face) {
  double longest = 0;
  for (std::size_t k = 0; k < 4; ++k)
    longest = std::max({longest, squared_norm(p[k] - p[(k + 1) % 4]), squared_norm(p[k] - p[(k + 2) % 4])});
  const double volume = std::fabs(dot(p[0] - p[3], cross(p[1] - p[3], p[2] - p[3])));
  return volume < flat * std::sqrt(longest) * largest_face;
}

/// \param isolated which of the vertices are
std::array<std::int16_t, 4> cosines(const std::array<Vec3, 4>& p, const std::array<bool, 4>& isolated) {
  const std::array<Vec3, 4> across = across_faces(p);
  std::array<double, 4> size{};
  for (std::size_t k = 0; k < 4; ++k) size[k] = norm(across[k]);
  const bool has_no_say = is_flat(p, *std::max_element(size.begin(), size.end()));
  const Vec3 centre = std::apply(circumcentre, p);
  const double radius = distance(centre, p[0]);
  std::array<std::int16_t, 4> result{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& on_face = p[(k + 1) % 4];
    const double side = dot(across[k], p[k] - on_face) >= 0 ? 1 : -1;
    const double cosine = has_no_say ? 1 : side * dot(across[k], centre - on_face) / (size[k] * radius);
    const bool costs_more = isolated[(k + 1) % 4] || isolated[(k + 2) % 4] || isolated[(k + 3) % 4];
    result[k] =
        static_cast<std::int16_t>(std::lround(steps_of_cost * (cosine >= -1 ? std::min(cosine, 1.0) : -1.0) -
                                              (costs_more ? steps_of_cost * FaceWeights::cost_of_isolated : 0)));
  }
  return result;
}

} // namespace

FaceWeights::FaceWeights(const Tetrahedralization& t, SampleLengthsView isolated, const Threads& threads)
    : cosine_(t.tetrahedra.size()) {
  const auto is_isolated = [&](VertexIndex v) {
    return !isolated.empty() && !t.is_corner(v) && isolated[t.sample(v)] > 0;
  };
  for_each_index(threads, t.tetrahedra.size(), [&](std::size_t at) {
    const TetrahedronIndex i{static_cast<std::uint32_t>(at)};
    std::array<bool, 4> of{};
    for (std::size_t k = 0; k < 4; ++k) of[k] = is_isolated(t.tetrahedra[i][k]);
    cosine_[i] = cosines(corners_of(t, i), of);
  });
  for_each_index(threads, t.tetrahedra.size(), [&](std::size_t at) { // each face once, both its sides
    const TetrahedronIndex i{static_cast<std::uint32_t>(at)};
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours[i][k];
      if (!n.valid() || n > i) continue;
      const auto& back = t.neighbours[n];
      const auto j = static_cast<std::size_t>(std::find(back.begin(), back.end(), i) - back.begin());
      cosine_[i][k] = cosine_[n][j] = std::min(cosine_[i][k], cosine_[n][j]);
    }
  });
}

float FaceWeights::operator()(TetrahedronIndex i, std::size_t k) const {
  return least + 1 - static_cast<float>(cosine_[i][k]) / static_cast<float>(steps_of_cost);
}

} // namespace eigencrust
