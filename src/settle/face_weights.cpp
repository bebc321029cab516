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
constexpr double steps = std::numeric_limits<std::int16_t>::max();

std::array<std::int16_t, 4> cosines(const std::array<Vec3, 4>& p) {
  const Vec3 centre = std::apply(circumcentre, p);
  const double radius = distance(centre, p[0]);
  std::array<std::int16_t, 4> result{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 &a = p[(k + 1) % 4], &b = p[(k + 2) % 4], &c = p[(k + 3) % 4];
    const Vec3 normal = cross(b - a, c - a);
    const double side = dot(normal, p[k] - a) >= 0 ? 1 : -1;
    const double cosine = side * dot(normal, centre - a) / (norm(normal) * radius);
    result[k] = static_cast<std::int16_t>(std::lround(steps * (cosine >= -1 ? std::min(cosine, 1.0) : -1.0)));
  }
  return result;
}

} // namespace

FaceWeights::FaceWeights(const Tetrahedralization& t, const Threads& threads) : t_(&t), cosine_(t.tetrahedra.size()) {
  for_each_index(threads, t.tetrahedra.size(), [&](std::size_t i) {
    cosine_.raw()[i] = cosines(corners_of(t, TetrahedronIndex{static_cast<std::uint32_t>(i)}));
  });
}

float FaceWeights::operator()(TetrahedronIndex i, std::size_t k) const {
  std::int16_t smaller = cosine_[i][k];
  const TetrahedronIndex n = t_->neighbours[i][k];
  if (n.valid())
    for (std::size_t j = 0; j < 4; ++j)
      if (t_->neighbours[n][j] == i) smaller = std::min(smaller, cosine_[n][j]);
  return least + 1 - static_cast<float>(smaller) / static_cast<float>(steps);
}

} // namespace eigencrust
