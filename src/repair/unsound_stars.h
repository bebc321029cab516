// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stars that are no disc, and ways through them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "parallel/threads.h"
#include "tetrahedra/star.h"

namespace eigencrust {

/// Is what the surface cuts out of a sphere around the sample one closed curve, or nothing?
class LinkCheck {
 public:
  LinkCheck(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Labels& labels)
      : t_(tetrahedralization), stars_(stars), labels_(labels) {}

  bool is_disc(VertexIndex s);

 private:
  [[nodiscard]] std::size_t steps_around() const;

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Labels& labels_;
  std::vector<std::array<std::uint32_t, 2>> arcs_; ///< both ways, sorted
};

/// Samples at which the surface is no disc, increasing.
std::vector<std::uint32_t> unsound_stars(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                                         const Labels& labels, const Threads& threads);

/// Price of a tetrahedron that must not turn where anything else will do, in units of the energy: far more than any
/// star.
constexpr double last_resort = 1e6;

/// How many labels are not what is known. Not counted are those at the cube, which nobody named.
std::uint64_t overruled(const Tetrahedralization& t, const Labels& known, const Labels& labels);

/// The first neighbour of the star's sample at whose edge more than two surface triangles meet; several strands of
/// inside tetrahedra lie around that edge. Invalid if there is none.
VertexIndex edge_with_several_strands(const Star& star, const Labels& labels);

/// Shortest face-connected path through the star from set 0 to another, without the sets.
/// \param component the set of each tetrahedron, or Star::none
/// \param length    of a tetrahedron in no set, >= 0; infinite: no way through it
std::vector<std::uint32_t> shortest_path(const Star& star, const std::vector<std::uint32_t>& component,
                                         const std::function<double(std::uint32_t)>& length);

} // namespace eigencrust
