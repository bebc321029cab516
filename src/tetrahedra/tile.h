// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A part of the Delaunay tetrahedra, made without the rest of the samples.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <eigencrust/stages.h>

#include "tetrahedra/sample_blocks.h"

namespace eigencrust {

/// How far all tiles together have come. Tiles tell it from several threads.
class TileProgress {
 public:
  /// \param insertions how many are expected
  TileProgress(const WatchGrowth& watch, std::uint64_t insertions) : watch_(watch), expected_(insertions) {}

  /// What has come since the last call. May throw to end the work.
  void add(std::uint64_t insertions, std::int64_t tetrahedra);
  /// Tiles are of no use for this cloud.
  void give_up() { given_up_ = true; }
  [[nodiscard]] bool given_up() const { return given_up_; }

 private:
  const WatchGrowth& watch_;
  std::uint64_t expected_;
  std::atomic<std::uint64_t> inserted_ = 0;
  std::atomic<std::int64_t> tetrahedra_ = 0;
  std::atomic<bool> given_up_ = false;
};

/// A face between tetrahedra of two tiles.
struct OpenFace {
  std::array<VertexIndex, 3> vertices; ///< by number
  TetrahedronIndex tetrahedron;        ///< on this side
  std::uint32_t corner = 0;            ///< of the tetrahedron, opposite to the face
  auto operator<=>(const OpenFace&) const = default;
};

/// The tetrahedra of the whole whose smallest vertex is in a range of samples: each is in the tile of one range.
struct Tile {
  /// The smallest vertex first, the second smallest second, positively oriented; sorted.
  std::vector<std::array<VertexIndex, 4>> tetrahedra;
  /// Opposite to each vertex, numbers in the tile; none beyond the cube and where a face is open.
  std::vector<std::array<TetrahedronIndex, 4>> neighbours;
  std::vector<OpenFace> open;
};

/// Brings samples that are elsewhere.
class SampleSupply {
 public:
  virtual ~SampleSupply() = default;
  /// Lets the tile's SampleBlocks learn blocks. All tiles call it the same number of times, and each waits for all.
  /// \param wanted numbers of blocks that are not known, ascending
  /// \return false where no tile wants any
  virtual bool fetch(const std::vector<std::uint32_t>& wanted) = 0;
};

/// Makes a tile from its own samples and those of the others that turn out to matter. A tetrahedron of some of the
/// samples is one of all exactly if no other sample lies in its circumsphere, so each is asked for the sample
/// deepest inside it; what is found is inserted, and asked for again what became of it. Among cospherical samples the
/// coordinates alone decide (Devillers and Teillaud 2011, in CGAL), so all tiles decide alike.
/// \param corners of the cube, eight
/// \param blocks of the samples; those of the range are known
/// \param supply of the others; none where all are known
/// \return none where progress was given up, by this tile when its tetrahedra have too many samples on or near
/// their circumspheres
std::optional<Tile> make_tile(std::span<const Vec3> corners, const SampleBlocks& blocks, const SampleRange& range,
                              TileProgress& progress, SampleSupply* supply = nullptr);

} // namespace eigencrust
