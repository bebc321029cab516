// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parts of the outside that are not connected but by narrow ways.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "evidence/evidence.h"

namespace eigencrust {

/// How large a ball passes through a face, at least: the radius of its circumcircle. In spacings of its samples; where
/// these are noisy, in deviations of the noise.
double clearance(const Scene& scene, TetrahedronIndex i, std::size_t face);

/// In the unit of clearance(): ways that a ball of this radius does not pass may be gaps between samples.
constexpr double passing_ball = 2;

/// A part of the outside in which nothing is known beforehand to be outside.
struct UnknownRegion {
  std::uint32_t number = no_index;
  std::vector<TetrahedronIndex> tetrahedra;
  std::vector<SampleIndex> samples; ///< their corners, in order
  double widest = 0;                ///< the largest ball that is known to get through one of its faces
};

/// Tetrahedra outside that balls go through, in regions: from one to the other no ball gets.
class OutsideRegions {
 public:
  static constexpr std::uint32_t none = no_index;

  /// \param known labels that are no question
  OutsideRegions(const Scene& scene, const Labels& labels, const Labels& known, const Threads& threads);

  [[nodiscard]] const std::vector<UnknownRegion>& unknown() const { return unknown_; }
  /// Of a tetrahedron; none: no ball gets there, or only within a gap between samples.
  [[nodiscard]] std::uint32_t operator[](TetrahedronIndex i) const { return region_[i]; }
  /// Gives those of these tetrahedra that are outside and of no region to the one from which the largest ball gets
  /// nearest. \param tetrahedra in order
  void divide(std::span<const TetrahedronIndex> tetrahedra);

 private:
  using PassedFaces = IndexedArray<TetrahedronIndex, std::uint8_t>;
  [[nodiscard]] PassedFaces passed_faces(const Threads& threads) const;
  /// visit(tetrahedron, neighbour, face)
  template <class Visit>
  void for_each(const PassedFaces& passes, Visit&& visit) const;
  /// \param tetrahedra how many, by region; none where it is known
  void list_unknown(const PassedFaces& passes, const std::vector<std::uint32_t>& tetrahedra);

  const Scene& scene_;
  const Labels& labels_;
  IndexedArray<TetrahedronIndex, std::uint32_t> region_;
  std::vector<UnknownRegion> unknown_;
};

} // namespace eigencrust
