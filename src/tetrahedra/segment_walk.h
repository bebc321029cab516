// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Straight through the tetrahedra, by exact signs.
#pragma once

#include <array>
#include <optional>

#include <eigencrust/types.h>

namespace eigencrust {

/// Visits, in order, the tetrahedra whose interior is met by the open segment from a sample to a point; they
/// are found without tolerance. Where the segment runs through vertices or edges or within faces it is led
/// aside by an infinitesimal turn of its far end, (ε, ε², ε³), the same for all; tetrahedra that it then meets
/// but that the true segment only touches are passed over. It ends at the point or where it leaves the cube.
class SegmentWalk {
 public:
  /// \param target relative to the origin of `tetrahedralization`; there is nothing to visit when it is the sample's
  ///        own place
  SegmentWalk(const Tetrahedralization& tetrahedralization, const VertexStars& stars, VertexIndex from,
              const Vec3& target);

  /// Goes on to the next tetrahedron, at first to the one at the sample. \return false: there is none
  bool next();
  [[nodiscard]] TetrahedronIndex tetrahedron() const { return current_; }
  /// Distance from the sample to where the segment enters the tetrahedron, rounded; it never decreases by more
  /// than rounding.
  [[nodiscard]] double depth() const { return entry_ / length_; }
  /// The same for where it leaves it, or would if it did not end.
  [[nodiscard]] double exit_depth() const { return exit_ / length_; }

 private:
  struct Corner {
    VertexIndex vertex;
    Vec3 offset;         ///< from the first sample
    double size = 0;     ///< largest coordinate of the offset
    double along = 0;    ///< dot(offset, direction)
    bool before = false; ///< certainly nearer than the target, measured along the direction
  };
  /// det(p - s, q - s, target - s): its rounded value and its exact sign.
  struct Turn {
    double value = 0;
    int sign = 0;
  };

  [[nodiscard]] Corner corner(VertexIndex vertex) const;
  void project(Corner& corner) const;
  [[nodiscard]] Turn turn(const Corner& p, const Corner& q) const;
  /// The sign after the infinitesimal turn; 0 only if the sample, p and q are collinear.
  [[nodiscard]] int perturbed(const Turn& turn, const Corner& p, const Corner& q) const;
  std::optional<std::size_t> side_out_of_cone(TetrahedronIndex tetrahedron, std::size_t at);
  bool begin();
  bool step();
  [[nodiscard]] bool ends_before_face() const;
  [[nodiscard]] bool meets_interior(const std::array<int, 3>& apex_signs) const;
  [[nodiscard]] double along_at_face() const;

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  VertexIndex from_;
  Vec3 start_, target_, direction_;
  double length_ = 0, size_ = 0, entry_ = 0, exit_ = 0;
  TetrahedronIndex current_, beyond_; ///< beyond_: across the face through which the segment leaves current_
  std::array<Corner, 3> face_;        ///< that face; counter-clockwise seen from beyond
  std::array<Turn, 3> edge_;          ///< of corners i + 1 and i + 2; >= 0
  std::uint32_t steps_ = 0;
  bool begun_ = false, interior_ = false;
};

} // namespace eigencrust
