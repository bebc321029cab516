// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Scenes that do not close by themselves: rooms seen from within, buildings from both sides, ground with what stands
/// on it, streets.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parts.h"
#include "scene.h"

namespace eigencrust::bench {

/// What scanners see of boxes added and cut out in turn, from within the free space or from outside. Six views of
/// `rays` × `rays` from each place; every point knows its sensor.
struct BlockScan {
  std::vector<Block> blocks;
  std::vector<Vec3> scanners;
  std::uint32_t rays = 60;
  std::vector<Box3> blind{}; ///< nothing returns from there: windows, open doors
  double noise = 0;          ///< of the range
};
/// The truth is what the blocks make: the free space of rooms, or the walls of a building.
Scene block_scan(const BlockScan& scan, std::uint64_t seed, unsigned threads);

/// A height for each place of a jittered lattice over [-half, half]².
struct HeightScan {
  double half, spacing;
  double noise = 0; ///< of the height
  std::function<double(double x, double y)> height;
  std::function<bool(double x, double y)> seen{}; ///< empty: everywhere
};
Scene height_scan(const HeightScan& scan, std::uint64_t seed, unsigned threads);

/// A cone of that radius and height on the ground around it.
double cone_height(double radius, double height, double x, double y);

/// Houses with pitched roofs on flat ground, as from the air: samples on few of their walls.
Scene houses_from_the_air(double spacing, double noise, std::uint64_t seed, unsigned threads);

/// A street before a façade with windows set back; z is up, x along the street.
Scene street(double spacing, double noise, std::uint64_t seed, unsigned threads);

} // namespace eigencrust::bench
