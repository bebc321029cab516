// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetrahedra/incremental_delaunay.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <eigencrust/error.h>

#include "geometry/tetrahedron.h"
#include "parallel/prefetch.h"
#include "tetrahedra/sphere_side.h"

namespace eigencrust {
namespace {

constexpr std::size_t tetrahedra_per_point = 7;     // of points in space; of surfaces a little fewer
constexpr std::uint32_t most_tetrahedra = 1u << 30; // four corners of each have numbers, and one number means none

Error fault(const char* what) {
  return {ErrorKind::guarantee, "delaunay", what, "report this as a fault of the program"};
}

/// A side of a tetrahedron that looks for the other.
struct Side {
  std::array<std::uint32_t, 3> vertices; ///< by number
  std::uint32_t corner;                  ///< opposite to it
  auto operator<=>(const Side&) const = default;
};

Side side(const std::array<std::uint32_t, 4>& tetrahedron, std::uint32_t corner, std::uint32_t number) {
  Side result{{}, IncrementalDelaunay::corner(number, corner)};
  for (std::size_t j = 0; j < 3; ++j) result.vertices[j] = tetrahedron[face_opposite[corner][j]];
  std::sort(result.vertices.begin(), result.vertices.end());
  return result;
}

} // namespace

IncrementalDelaunay::IncrementalDelaunay(std::vector<Vec3> points) : points_(std::move(points)) {
  at_.resize(points_.size(), no_index);
  number_in_hole_.resize(points_.size(), 0);
  tetrahedra_.reserve(tetrahedra_per_point * points_.size());
  asked_.reserve(tetrahedra_per_point * points_.size());
  join_corners();
}

std::uint32_t IncrementalDelaunay::add(const Vec3& point) {
  points_.push_back(point);
  at_.push_back(no_index);
  number_in_hole_.push_back(0);
  return static_cast<std::uint32_t>(points_.size() - 1);
}

bool IncrementalDelaunay::exists(std::uint32_t tetrahedron) const {
  return tetrahedra_[tetrahedron].vertices[0] != no_index;
}

std::array<const Vec3*, 4> IncrementalDelaunay::corners_of(std::uint32_t tetrahedron) const {
  const auto& v = tetrahedra_[tetrahedron].vertices;
  return {&points_[v[0]], &points_[v[1]], &points_[v[2]], &points_[v[3]]};
}

bool IncrementalDelaunay::is_inside_sphere(std::uint32_t tetrahedron, const Vec3& point) const {
  return eigencrust::is_inside_sphere(corners_of(tetrahedron), point);
}

bool IncrementalDelaunay::is_delaunay(const std::array<std::uint32_t, 4>& v, std::uint32_t begin) const {
  const std::array<const Vec3*, 4> corners{&points_[v[0]], &points_[v[1]], &points_[v[2]], &points_[v[3]]};
  for (std::uint32_t i = begin; i < begin + cube_corners; ++i)
    if (std::find(v.begin(), v.end(), i) == v.end() && eigencrust::is_inside_sphere(corners, points_[i])) return false;
  return true;
}

/// Of all four corners those with none of the others in their circumsphere.
void IncrementalDelaunay::join_corners() {
  const auto begin = static_cast<std::uint32_t>(points_.size()) - cube_corners;
  for (std::uint32_t set = 0; set < 1u << cube_corners; ++set) {
    if (std::popcount(set) != 4) continue;
    std::array<std::uint32_t, 4> v{};
    for (std::uint32_t i = 0, k = 0; i < cube_corners; ++i)
      if ((set >> i & 1) != 0) v[k++] = begin + i;
    const int sign = orientation(points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]);
    if (sign < 0) std::swap(v[0], v[1]);
    if (sign != 0 && is_delaunay(v, begin)) tetrahedra_.push_back({v, {no_index, no_index, no_index, no_index}});
  }
  asked_.resize(tetrahedra_.size(), 0);
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < tetrahedra_.size(); ++t)
    for (std::uint32_t k = 0; k < 4; ++k) {
      sides.push_back(side(tetrahedra_[t].vertices, k, t));
      at_[tetrahedra_[t].vertices[k]] = t;
    }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i - 1].vertices == sides[i].vertices) {
      const std::uint32_t a = sides[i - 1].corner, b = sides[i].corner;
      tetrahedra_[tetrahedron_of(a)].across[place_of(a)] = b;
      tetrahedra_[tetrahedron_of(b)].across[place_of(b)] = a;
    }
}

std::uint32_t IncrementalDelaunay::insert(std::uint32_t vertex, std::uint32_t near) {
  ++insertion_;
  dig(vertex, locate(points_[vertex], near));
  return fill(vertex);
}

/// From tetrahedron to tetrahedron, always across a face that the point is beyond: in a Delaunay tetrahedralization
/// this comes to an end (Edelsbrunner 1990).
std::uint32_t IncrementalDelaunay::locate(const Vec3& p, std::uint32_t near) const {
  std::uint32_t t = near, entry = no_index;
  while (true) {
    const std::array<const Vec3*, 4> corners = corners_of(t);
    const SeenFrom<4> seen(p, corners);
    const double largest_product = seen.largest_product();
    const auto is_beyond = [&](std::uint32_t k) {
      const auto& [a, b, c] = face_opposite[k];
      const int sign = sign_in_double(seen, a, b, c, largest_product);
      return (sign != 0 ? sign : orientation(p, *corners[a], *corners[b], *corners[c])) < 0;
    };
    std::uint32_t k = 0;
    while (k < corners.size() && (k == entry || !is_beyond(k))) ++k;
    if (k == corners.size()) break;
    const std::uint32_t across = tetrahedra_[t].across[k];
    if (across == no_index) throw fault("a sample is outside of the cube");
    t = tetrahedron_of(across);
    entry = place_of(across);
  }
  for (const Vec3* corner : corners_of(t))
    if (*corner == p) throw fault("two samples are at the same place");
  return t;
}

/// Does a tetrahedron go for a new point? What goes is in the hole from then on.
bool IncrementalDelaunay::goes(std::uint32_t t, const Vec3& p) {
  const std::uint32_t stays = 2 * insertion_, goes = stays + 1;
  if (asked_[t] >= stays) return asked_[t] == goes;
  const bool inside = is_inside_sphere(t, p);
  asked_[t] = inside ? goes : stays;
  if (!inside) return false;
  hole_.push_back(t);
  for (const std::uint32_t next : tetrahedra_[t].across)
    if (next != no_index) {
      prefetch(tetrahedra_[tetrahedron_of(next)]);
      prefetch(asked_[tetrahedron_of(next)]);
    }
  return true;
}

/// Finds what goes, which hangs together, and its faces.
void IncrementalDelaunay::dig(std::uint32_t vertex, std::uint32_t first) {
  const Vec3 p = points_[vertex];
  faces_.clear();
  hole_.clear();
  if (!goes(first, p)) throw fault("a tetrahedron does not hold its own samples");
  for (std::size_t i = 0; i < hole_.size(); ++i) {
    const Tetrahedron t = tetrahedra_[hole_[i]];
    for (std::uint32_t k = 0; k < 4; ++k) {
      if (t.across[k] != no_index && goes(tetrahedron_of(t.across[k]), p)) continue;
      Face& face = faces_.emplace_back();
      face.joined.vertices = t.vertices;
      face.joined.vertices[k] = vertex;
      face.joined.across[k] = t.across[k];
      face.point = k;
    }
  }
}

/// \return one of the new tetrahedra
std::uint32_t IncrementalDelaunay::fill(std::uint32_t vertex) {
  take_numbers();
  if (faces_.size() / 2 + 2 <= most_in_table) // a sphere of F triangles has F / 2 + 2 vertices (Euler)
    join_faces();
  else
    join_many_faces();
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const auto& [joined, point] = faces_[i];
    tetrahedra_[numbers_[i]] = joined;
    const std::uint32_t beyond = joined.across[point];
    if (beyond != no_index) tetrahedra_[tetrahedron_of(beyond)].across[place_of(beyond)] = corner(numbers_[i], point);
  }
  at_[vertex] = numbers_.front();
  return numbers_.front();
}

/// For each face one: of those that went, today or before, and then new ones.
void IncrementalDelaunay::take_numbers() {
  numbers_.clear();
  for (const std::uint32_t t : hole_)
    if (numbers_.size() < faces_.size()) {
      numbers_.push_back(t);
    } else {
      tetrahedra_[t].vertices[0] = no_index;
      free_.push_back(t);
    }
  while (numbers_.size() < faces_.size() && !free_.empty()) {
    numbers_.push_back(free_.back());
    free_.pop_back();
  }
  while (numbers_.size() < faces_.size()) {
    numbers_.push_back(static_cast<std::uint32_t>(tetrahedra_.size()));
    tetrahedra_.emplace_back();
    asked_.push_back(0);
  }
  if (tetrahedra_.size() >= most_tetrahedra)
    throw Error(ErrorKind::memory, "delaunay", "more than a billion tetrahedra in one part",
                "use more threads (--threads), or split the cloud");
}

/// Of two faces at an edge, one has it in one direction and one in the other; what is joined to them are neighbours.
void IncrementalDelaunay::join_faces() {
  ends_.resize(faces_.size());
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const auto& [joined, point] = faces_[i];
    const auto& around = face_opposite[point];
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint32_t v = joined.vertices[around[j]];
      if (number_in_hole_[v] == 0) {
        of_hole_.push_back(v);
        number_in_hole_[v] = static_cast<std::uint8_t>(of_hole_.size());
        at_[v] = numbers_[i];
      }
      ends_[i][j] = number_in_hole_[v] - 1u;
    }
    for (std::size_t j = 0; j < 3; ++j)
      edges_[ends_[i][(j + 1) % 3]][ends_[i][(j + 2) % 3]] = corner(numbers_[i], static_cast<std::uint32_t>(around[j]));
  }
  for (std::size_t i = 0; i < faces_.size(); ++i)
    for (std::size_t j = 0; j < 3; ++j)
      faces_[i].joined.across[face_opposite[faces_[i].point][j]] = edges_[ends_[i][(j + 2) % 3]][ends_[i][(j + 1) % 3]];
  for (const std::uint32_t v : of_hole_) number_in_hole_[v] = 0;
  of_hole_.clear();
}

/// The same for holes with too many vertices for the table.
void IncrementalDelaunay::join_many_faces() {
  std::vector<Side> sides;
  for (std::uint32_t i = 0; i < faces_.size(); ++i) {
    const auto& [joined, point] = faces_[i];
    for (const std::size_t k : face_opposite[point]) {
      sides.push_back(side(joined.vertices, static_cast<std::uint32_t>(k), i));
      at_[joined.vertices[k]] = numbers_[i];
    }
  }
  std::sort(sides.begin(), sides.end());
  const auto meet = [&](std::uint32_t a, std::uint32_t b) {
    faces_[tetrahedron_of(a)].joined.across[place_of(a)] = corner(numbers_[tetrahedron_of(b)], place_of(b));
  };
  for (std::size_t i = 1; i < sides.size(); i += 2) {
    meet(sides[i - 1].corner, sides[i].corner);
    meet(sides[i].corner, sides[i - 1].corner);
  }
}

std::vector<std::uint32_t> IncrementalDelaunay::around(std::uint32_t vertex) {
  const std::uint32_t seen = 2 * ++insertion_;
  std::vector<std::uint32_t> result{at_[vertex]};
  asked_[at_[vertex]] = seen;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Tetrahedron& t = tetrahedra_[result[i]];
    for (std::size_t k = 0; k < 4; ++k) {
      if (t.vertices[k] == vertex || t.across[k] == no_index) continue;
      const std::uint32_t other = tetrahedron_of(t.across[k]);
      if (std::exchange(asked_[other], seen) != seen) result.push_back(other);
    }
  }
  return result;
}

} // namespace eigencrust
