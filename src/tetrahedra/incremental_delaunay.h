// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The Delaunay tetrahedralization of points that come one after another.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// What holds a new point in its circumsphere goes, and the faces around the hole are joined to the point (Bowyer 1981,
/// Watson 1981). All signs are exact. Among cospherical points the coordinates alone decide, so that the tetrahedra do
/// not depend on the order of the points.
class IncrementalDelaunay {
 public:
  /// \name A corner of a tetrahedron, by one number
  /// @{
  static constexpr std::uint32_t corner(std::uint32_t tetrahedron, std::uint32_t k) { return 4 * tetrahedron + k; }
  static constexpr std::uint32_t tetrahedron_of(std::uint32_t corner) { return corner / 4; }
  static constexpr std::uint32_t place_of(std::uint32_t corner) { return corner % 4; }
  /// @}

  struct alignas(32) Tetrahedron {           // two to a line of the processor's cache
    std::array<std::uint32_t, 4> vertices{}; ///< positively oriented; no_index where there is none any more
    /// Opposite to each vertex: the corner of the neighbour that is opposite to the face between. No_index beyond the
    /// cube.
    std::array<std::uint32_t, 4> across{};
  };

  /// \param points the last eight are the corners of a cube that holds all others, none of them on its sides. They are
  /// tetrahedralized, the others wait for insert()
  explicit IncrementalDelaunay(std::vector<Vec3> points);

  /// \return its number; it waits for insert()
  std::uint32_t add(const Vec3& point);

  /// \param vertex that was not inserted yet
  /// \param near a tetrahedron, where the search begins
  /// \return one of those at the new vertex
  /// \throws Error (guarantee) where another vertex is at the same place; (memory) beyond a billion tetrahedra
  std::uint32_t insert(std::uint32_t vertex, std::uint32_t near);

  /// Numbers of those that went are used again.
  [[nodiscard]] const std::vector<Tetrahedron>& tetrahedra() const { return tetrahedra_; }
  [[nodiscard]] bool exists(std::uint32_t tetrahedron) const;
  [[nodiscard]] std::size_t count() const { return tetrahedra_.size() - free_.size(); }
  [[nodiscard]] const Vec3& position(std::uint32_t vertex) const { return points_[vertex]; }
  /// One of those at a vertex.
  [[nodiscard]] std::uint32_t at(std::uint32_t vertex) const { return at_[vertex]; }
  /// \return the tetrahedra at a vertex
  [[nodiscard]] std::vector<std::uint32_t> around(std::uint32_t vertex);
  /// Is a point that is no vertex inside the circumsphere?
  [[nodiscard]] bool is_inside_sphere(std::uint32_t tetrahedron, const Vec3& point) const;

 private:
  /// Of the hole that a new point makes.
  struct Face {
    Tetrahedron joined;  ///< to the point; of its neighbours it knows the one beyond the hole
    std::uint32_t point; ///< which of its vertices that is
  };

  void join_corners();
  [[nodiscard]] bool is_delaunay(const std::array<std::uint32_t, 4>& corners, std::uint32_t begin) const;
  [[nodiscard]] std::array<const Vec3*, 4> corners_of(std::uint32_t tetrahedron) const;
  [[nodiscard]] std::uint32_t locate(const Vec3& p, std::uint32_t near) const;
  [[nodiscard]] bool goes(std::uint32_t t, const Vec3& p);
  void dig(std::uint32_t vertex, std::uint32_t first);
  std::uint32_t fill(std::uint32_t vertex);
  void take_numbers();
  void join_faces();
  void join_many_faces();

  std::vector<Vec3> points_;
  std::vector<Tetrahedron> tetrahedra_;
  std::vector<std::uint32_t> at_;   ///< by vertex
  std::vector<std::uint32_t> free_; ///< numbers of tetrahedra that went

  /// \name Of the insertion or search at hand
  /// @{
  /// By tetrahedron: twice the number of the insertion in which it was asked, one more where it goes.
  std::vector<std::uint32_t> asked_;
  std::uint32_t insertion_ = 0;
  std::vector<std::uint32_t> hole_; ///< tetrahedra that go
  std::vector<Face> faces_;
  std::vector<std::uint32_t> numbers_; ///< of what is joined, by face

  static constexpr std::uint32_t most_in_table = 64; ///< vertices of a hole; few have more than thirty
  std::vector<std::uint8_t> number_in_hole_;         ///< by vertex; 0 where it has none
  std::vector<std::uint32_t> of_hole_;               ///< the vertices that have one
  std::vector<std::array<std::uint32_t, 3>> ends_;   ///< by face: the numbers of its vertices
  /// By the numbers of the ends of an edge: the corner opposite to it. Only what was written is read.
  std::array<std::array<std::uint32_t, most_in_table>, most_in_table> edges_;
  /// @}
};

} // namespace eigencrust
