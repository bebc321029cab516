// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Parts as they are made and measured: with flat faces, sharp edges, thin walls and holes, sampled on all their
/// faces and edges. Every truth is a closed mesh whose volume and area are those of the formula.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "bodies.h"

namespace eigencrust::bench {

struct Part {
  std::vector<Vec3> samples;
  std::vector<std::array<std::uint32_t, 2>> sharp_edges; ///< samples that follow each other along one
  Truth truth;
};

/// An axis-aligned box that is added to a body or cut out of it.
struct Block {
  Vec3 low, high;
  bool solid = true;
};
/// Boxes added and cut out in turn, sampled on a lattice whose steps are about `spacing`: at least one step
/// between any two faces. The body must be a manifold.
Part block_part(std::span<const Block> blocks, double spacing);

/// A box open at the top, its walls and bottom `wall` thick.
Part open_bin(const Vec3& size, double wall, double spacing);

/// Distance from the z axis, and height.
struct ProfilePoint {
  double radius, height;
};
/// What the profile sweeps around the z axis. It goes from axis to axis, or is closed where its first point is
/// not on the axis, with the body to its left (up along the outer wall). Rings of samples about `spacing` apart,
/// every second one turned by half a step. Where the profile turns by more than 20° is a sharp edge.
Part turned_part(std::span<const ProfilePoint> profile, double spacing);

/// A beaker: its wall and bottom `wall` thick.
Part cup(double radius, double height, double wall, double spacing);

/// A quarter of a ring of pipe, open at both ends: genus 1.
/// \param bend distance of the pipe's axis from the centre of the bend
Part pipe_bend(double bend, double outer, double inner, double spacing);

/// A sheet [0, size.x] × [0, size.y] × [0, size.z] with a round hole through its middle: genus 1.
/// \param rims also samples on the rims and along their edges; without: two sheets of samples
Part holed_plate(const Vec3& size, double hole, double spacing, bool rims);

/// Rings of points: a tube of that radius around a closed curve, which must not come nearer to itself than two
/// radii nor bend more sharply than the radius: genus 1.
/// \param curve position for 0 <= t < 2π, smooth and never straight
Part closed_tube(const std::function<Vec3(double)>& curve, double radius, double spacing);

/// The vertices of a closed mesh with few of them.
Part mesh_part(TriangleMesh mesh);

/// The part with samples at random places, none too close, and none on its edges.
Part darted(Part part, std::size_t count, std::uint64_t seed);

/// Turned about its own origin by a rotation that the seed chooses.
Part rotated(Part part, std::uint64_t seed);

/// The parts as one; they must not touch.
Part beside(Part a, const Part& b);

/// Bodies that go through each other, each sampled all over as if the other was not there. Of the truth what is known
/// is the volume; one piece, genus 0. \param in_common the volume that is of both
Part through_each_other(Part a, const Part& b, double in_common);

/// x for y, y for z and z for x: what stood along z lies along x.
Part laid_down(Part part);

/// Every coordinate of a sample and of the truth.
Part moved(Part part, const Vec3& shift);

} // namespace eigencrust::bench
