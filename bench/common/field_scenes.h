// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Clouds of the kind that people bring: contours of an organ, a tunnel in rings, a noisy object beside clean
/// ones, filled volumes, a room seen from within, the ground with what stands on it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "bodies.h"
#include "parts.h"
#include "scene.h"

namespace eigencrust::bench {

/// The rows of a part as a cloud, every coordinate moved by a normal deviate of `noise` spacings.
Scene part_scene(Part part, double noise, std::uint64_t seed, unsigned threads);

/// A vessel of an organ: a disc that moves, turns into an ellipse of that ratio along y and changes its radius
/// as z rises.
struct Vessel {
  Vec3 from, to; ///< from.z < to.z
  double radius_from, radius_to;
  double ratio = 1;
};
/// Horizontal sections of the union of vessels. At most two of them may overlap at a place; where they do, both
/// must be round.
class Organ {
 public:
  explicit Organ(std::vector<Vessel> vessels) : vessels_(std::move(vessels)) {}

  [[nodiscard]] double section_area(double z) const;
  [[nodiscard]] bool inside(const Vec3& p) const;
  /// Outline of the section at z, samples about `step` apart.
  [[nodiscard]] std::vector<Vec3> contour(double z, double step) const;
  [[nodiscard]] double low() const;
  [[nodiscard]] double high() const;

  /// `slices` contours from end to end. The truth knows volume, components and genus (0).
  [[nodiscard]] Scene contours(unsigned slices, double step, unsigned threads) const;

 private:
  struct Section {
    Vec3 centre;
    double a, b; ///< half axes
  };
  [[nodiscard]] std::vector<Section> sections(double z) const;

  std::vector<Vessel> vessels_;
};

/// A tunnel driven along x: rings of points across it, `gap` apart, none on its ends.
/// The section is an ellipse of half axes a (along y) and b; its middle winds by `swing`.
Scene tunnel(double length, double gap, double a, double b, double swing, unsigned per_ring, unsigned threads);

/// A noisy ball, a clean ball a quarter as wide and a clean plate, in this order of rows: clean ball, plate,
/// noisy ball. `noise` is in spacings of the noisy ball, which has `count` samples.
Scene noisy_beside_clean(std::size_t count, double noise, std::uint64_t seed, unsigned threads);

/// A ball with round cavities, each given by its centre and radius; samples spread evenly, `spacing` apart.
struct Cavity {
  Vec3 centre;
  double radius;
};
Scene ball_with_cavities(double radius, std::span<const Cavity> cavities, double spacing, unsigned threads);

/// Points that fill an ellipsoid: at random, or (count 0) all points of the unit lattice in it.
Scene filled_ellipsoid(const Vec3& half_axes, std::size_t count, std::uint64_t seed, unsigned threads);

/// A room seen from within: 5 × 4 × 2.7 m, free space being the body; with a pillar and a table when `furnished`
/// (genus 1: the pillar). Every point knows the sensor that saw it.
Scene room(std::span<const Vec3> scanners, bool furnished, double noise, std::uint64_t seed, unsigned threads);

/// Hilly ground: a height for each square of `cell`, at coordinates as a survey has them.
Scene terrain(unsigned columns, unsigned rows, double cell, std::uint64_t seed, unsigned threads);

/// A ball that touches flat ground, samples of both where they can be seen from above.
Scene ball_on_ground(double ground, double radius, double spacing, std::uint64_t seed, unsigned threads);

} // namespace eigencrust::bench
