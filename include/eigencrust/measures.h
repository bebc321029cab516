// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Angles, edges and walls of a mesh, and what it is good for in words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <eigencrust/types.h>
#include <eigencrust/validate.h>

namespace eigencrust {

/// How a mesh is measured.
struct MeasureOptions {
  /// Rays that look for the thinnest wall. Of larger meshes every second, third ... triangle sends one, so that a thin
  /// place of few triangles may be missed. 0: none.
  std::uint64_t most_rays = 4'000'000;
  unsigned threads = 0; ///< 0: all cores
};

/// How regular the triangles are, and how thick the body is. Lengths in the unit of the coordinates. Triangles without
/// area have sides, but neither angles nor an aspect.
struct MeshMeasures {
  double smallest_angle = 0, largest_angle = 0; ///< of a triangle, degrees
  /// Longest side over the diameter of the inscribed circle, over what that is for equal sides: 1 is best (the aspect
  /// ratio of Stimpson and others, "The Verdict Geometric Quality Library", 2007).
  double worst_aspect = 0;
  double shortest_edge = 0, median_edge = 0, longest_edge = 0; ///< of the sides of all triangles
  /// The body is as thick behind a triangle as it is far from its middle along the inward normal to the opposite side,
  /// if that is within 45° of parallel. A wall is a patch of such triangles with the area of 20 usual ones, or 1 % of
  /// the surface where that is less, so that single folded triangles are none; this is the thickness that no triangle
  /// of the thinnest wall exceeds. None where the mesh is not closed and oriented, or no sides face one another.
  std::optional<double> thinnest_wall;
  Vec3 thinnest_place;         ///< the middle of a triangle of that wall
  std::uint64_t wall_rays = 0; ///< how many were sent
};

/// \param summary what validate() said of the mesh. \throws Error{input} as validate
MeshMeasures measure(const TriangleMesh& mesh, const MeshSummary& summary, const MeasureOptions& options = {});

/// to_json(summary) with the measures, and with what printability() says. \param metres length of the unit; 0: not
/// known
std::string to_json(const MeshSummary& mesh, const MeshMeasures& measures, double metres);

/// "0.4 mm", "1.2 m"; without a unit where none is known. \param metres length of the unit of `length`; 0: not known
std::string length_in_words(double length, double metres);
/// Can the body be printed? "printable: closed, manifold, no crossings, thinnest wall 0.4 mm", or "not printable: 12
/// boundary edges". \param metres length of the mesh's unit; 0: not known
std::string printability(const MeshSummary& mesh, const MeshMeasures& measures, double metres);

} // namespace eigencrust
