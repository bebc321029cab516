// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The cloud of a case in files, for programs that know nothing else, and what a surface of it is measured by. Both are
/// called in processes of their own, so that the one that measures memory stays small (see run_child).
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "contest_cases.h"

namespace eigencrust::bench {

/// What is known of a cloud. Lengths are in its unit.
struct ContestScene {
  std::filesystem::path cloud;
  std::size_t points = 0;
  std::size_t true_samples = 0; ///< the first rows; 0: not known which are
  double spacing = 0;           ///< median distance to the nearest other point, of samples without noise if known
  double volume = 0;            ///< 0: not known
  std::int64_t genus = -1;      ///< -1: not known
  std::uint32_t components = 1;
};

/// Makes cloud.ply (unless the case has a file), truth.ply and edges.ply, points on its sharp edges, where there are
/// any, and scene.json. \throws Error
void write_contest_scene(const ContestCase& item, Sources& sources, const std::filesystem::path& folder);

/// \throws Error{input} when it was not written
ContestScene read_contest_scene(const std::filesystem::path& folder);

/// Of a surface; -1: not known.
struct ContestFigures {
  double triangles = -1, pieces = -1, genus = -1;
  double boundary = -1;    ///< edges
  double nonmanifold = -1; ///< edges and vertices, equal vertices made one
  double crossings = -1;   ///< pairs of triangles; not counted in meshes of more than three million
  double outliers = -1; ///< of the rows that are none of the surface, those within a spacing of it: see outlier_rows()
  double missed =
      -1; ///< share of the samples farther than 2 % of their box's diagonal: a scrap has no outliers, either
  double to_truth = -1, from_truth = -1; ///< mean distances in spacings
  double missing = -1;                   ///< share of the truth farther than two spacings
  double edges = -1;                     ///< mean distance of points on the true sharp edges, in spacings
  double volume = 0;                     ///< whichever way the triangles look; 0: not closed
  double agree = -1;                     ///< triangle_agreement() with the other mesh
  double agree_but_turned = -1;          ///< the same but for turned edges
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(ContestFigures, triangles, pieces, genus, boundary, nonmanifold,
                                                crossings, outliers, missed, to_truth, from_truth, missing, edges,
                                                volume, agree, agree_but_turned)

/// \param other its triangles are compared; empty: none
ContestFigures contest_figures(const std::filesystem::path& folder, const std::filesystem::path& mesh,
                               const std::filesystem::path& other, unsigned threads);

/// Rows that are not samples of the surface. Where it is not known which are: those whose 8th neighbour is more than
/// 10 times as far as the median of all.
std::vector<std::uint32_t> outlier_rows(const std::vector<Vec3>& points, std::size_t true_samples, unsigned threads);

/// Shares of the triangles of the mesh that has more.
struct Agreement {
  double same = 0; ///< both have them
  /// Those, and two and two over the same four corners as two of the other: an edge is turned. A flat tetrahedron is
  /// inside of one surface and outside of the other.
  double but_for_turned = 0;
};

/// Corners are told by their coordinates.
Agreement triangle_agreement(const TriangleMesh& a, const TriangleMesh& b);

} // namespace eigencrust::bench
