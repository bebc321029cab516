// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/segment_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/predicates.h"
#include "geometry/tetrahedron.h"

namespace eigencrust {
namespace {

double largest(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

} // namespace

SegmentWalk::SegmentWalk(const Tetrahedralization& t, const VertexStars& stars, SampleIndex from, const Vec3& target)
    : t_(t),
      stars_(stars),
      from_(from),
      start_(t.positions[from]),
      target_(target),
      direction_(target - start_),
      length_(norm(direction_)),
      size_(largest(direction_)) {}

SegmentWalk::Corner SegmentWalk::corner(SampleIndex sample) const {
  const Vec3 offset = t_.positions[sample] - start_;
  return {sample, offset, largest(offset), 0, false};
}

/// What only corners of faces that the segment leaves through need.
void SegmentWalk::project(Corner& corner) const {
  corner.along = dot(corner.offset, direction_);
  const double square = length_ * length_, error = half_the_digits * (corner.size * size_ + square);
  corner.before = corner.along + error < square;
}

SegmentWalk::Turn SegmentWalk::turn(const Corner& p, const Corner& q) const {
  const double value = dot(cross(p.offset, q.offset), direction_);
  // Rounding is a few units in the last place of that product.
  const double bound = half_the_digits * p.size * q.size * size_;
  // Where products underflow the bound says nothing.
  if (bound > std::sqrt(std::numeric_limits<double>::min()) && std::fabs(value) > bound)
    return {value, value > 0 ? 1 : -1};
  return {value, orientation(start_, t_.positions[p.sample], t_.positions[q.sample], target_)};
}

int SegmentWalk::perturbed(const Turn& turn, const Corner& p, const Corner& q) const {
  // The determinant is linear in the target; its derivatives are the components of the normal.
  return turn.sign != 0 ? turn.sign : normal_sign(start_, t_.positions[p.sample], t_.positions[q.sample]);
}

bool SegmentWalk::next() {
  do {
    if (begun_ ? !step() : !begin()) return false;
  } while (!interior_);
  return true;
}

/// Is the direction within the cone of the tetrahedron at the sample? Sets face_ and edge_ on the way.
/// \return the side through whose plane it leaves the cone
std::optional<std::size_t> SegmentWalk::side_out_of_cone(TetrahedronIndex tetrahedron, std::size_t at) {
  const auto& v = t_.tetrahedra[tetrahedron];
  const auto& others = face_opposite[at];
  for (std::size_t i = 0; i < 3; ++i) face_[i] = corner(v[others[i]]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner &p = face_[(i + 1) % 3], &q = face_[(i + 2) % 3];
    edge_[i] = turn(p, q);
    if (perturbed(edge_[i], p, q) <= 0) return others[i];
  }
  return std::nullopt;
}

/// The tetrahedron of the star whose cone holds the direction: from one of them across the sides that it lies beyond,
/// which in a Delaunay tetrahedralization comes to no tetrahedron twice; among cospherical samples it might.
bool SegmentWalk::begin() {
  begun_ = true;
  if (!(size_ > 0)) return false;
  const std::span<const TetrahedronIndex> star = stars_[from_];
  const auto place_in = [&](TetrahedronIndex i) {
    const auto& v = t_.tetrahedra[i];
    return static_cast<std::size_t>(std::find(v.begin(), v.end(), from_) - v.begin());
  };
  std::optional<std::size_t> out = 0;
  current_ = star.front();
  for (std::size_t steps = 0; steps < star.size() && current_.valid(); ++steps) {
    out = side_out_of_cone(current_, place_in(current_));
    if (!out) break;
    current_ = t_.neighbours[current_][*out];
  }
  for (std::size_t i = 0; i < star.size() && out; ++i) out = side_out_of_cone(current_ = star[i], place_in(star[i]));
  if (out) return false;
  beyond_ = t_.neighbours[current_][place_in(current_)];
  for (Corner& c : face_) project(c);
  entry_ = 0;
  exit_ = along_at_face();
  interior_ = edge_[0].sign > 0 && edge_[1].sign > 0 && edge_[2].sign > 0;
  return true;
}

bool SegmentWalk::ends_before_face() const {
  if (face_[0].before && face_[1].before && face_[2].before) return false;
  return orientation(t_.positions[face_[0].sample], t_.positions[face_[1].sample], t_.positions[face_[2].sample],
                     target_) <= 0;
}

/// Where the segment meets the face: its corners weighed by the areas opposite them.
double SegmentWalk::along_at_face() const {
  double sum = 0, along = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double weight = std::max(edge_[i].value, 0.0);
    sum += weight;
    along += weight * face_[i].along;
  }
  return sum > 0 ? along / sum : std::max({face_[0].along, face_[1].along, face_[2].along});
}

/// Is the line within the interior of the tetrahedron of face_ and an apex? Seen along the line it is a point, and
/// must not lie on the hull of the four corners: no line through the point and a corner may have the others on one
/// side. \param apex_signs turns of the apex and each corner of face_
bool SegmentWalk::meets_interior(const std::array<int, 3>& apex) const {
  if (edge_[0].sign > 0 && edge_[1].sign > 0 && edge_[2].sign > 0) return true;
  const auto splits = [](int a, int b, int c) {
    return (a == 0 && b == 0 && c == 0) || (std::max({a, b, c}) > 0 && std::min({a, b, c}) < 0);
  };
  for (std::size_t i = 0; i < 3; ++i)
    if (!splits(edge_[(i + 2) % 3].sign, -edge_[(i + 1) % 3].sign, -apex[i])) return false;
  return splits(apex[0], apex[1], apex[2]);
}

bool SegmentWalk::step() {
  if (!beyond_.valid() || ends_before_face() || ++steps_ > t_.tetrahedra.size()) return false;
  entry_ = exit_;
  current_ = beyond_;
  const auto& v = t_.tetrahedra[current_];
  std::size_t k = 0;
  while (v[k] == face_[0].sample || v[k] == face_[1].sample || v[k] == face_[2].sample) ++k;
  Corner apex = corner(v[k]);
  project(apex);
  std::array<Turn, 3> turns;
  for (std::size_t i = 0; i < 3; ++i) turns[i] = turn(apex, face_[i]);
  interior_ = meets_interior({turns[0].sign, turns[1].sign, turns[2].sign});

  // Corner 0 left of the apex or right of it, then the corner after it on that side: the edge i, i + 1 whose
  // ends lie on both sides leads to the face with the apex. A corner in line with sample and apex is hidden.
  const int side = perturbed(turns[0], apex, face_[0]);
  std::size_t first = 1;
  if (side > 0 && perturbed(turns[1], apex, face_[1]) < 0) first = 0;
  if (side < 0 && perturbed(turns[2], apex, face_[2]) > 0) first = 2;
  const std::size_t second = (first + 1) % 3, left_out = (first + 2) % 3;
  const auto place = static_cast<std::size_t>(std::find(v.begin(), v.end(), face_[left_out].sample) - v.begin());
  beyond_ = t_.neighbours[current_][place];
  face_ = {face_[first], face_[second], apex};
  const Turn base = edge_[left_out]; // of first and second
  edge_ = {Turn{-turns[second].value, -turns[second].sign}, turns[first], base};
  exit_ = along_at_face();
  return true;
}

} // namespace eigencrust
