// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a run did, in numbers. docs/report.md describes the JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <eigencrust/options.h>
#include <eigencrust/types.h>
#include <eigencrust/validate.h>

namespace eigencrust {

/// A file that was read.
struct InputFile {
  std::string path, sha256;             ///< its name, and the digest of its bytes
  std::uint64_t points = 0;             ///< rows of it
  std::vector<Sensor> sensors{};        ///< those that saw a point of it, in the order of the cloud's sensors
  std::uint64_t points_with_sensor = 0; ///< of its points
};

/// What a stage of the work took and counted.
struct StageReport {
  std::string name;                                   ///< as in docs/report.md
  double seconds = 0;                                 ///< of wall time
  std::uint64_t peak_memory_bytes = 0;                ///< of the process up to the end of the stage
  std::vector<std::pair<std::string, double>> counts; ///< what it counted, by name
};

/// How a graph was parted in two; the figures are those of Partition.
struct PartitionReport {
  std::string stage;                                 ///< "poles" or "tetrahedra"
  std::uint64_t nodes = 0, edges = 0;                ///< of the graph
  double eigenvalue = 0, residual = 0;               ///< see Partition
  std::uint32_t iterations = 0;                      ///< on the finest level
  std::vector<std::uint32_t> sign_changes;           ///< per iteration
  std::uint32_t components = 0, free_components = 0; ///< of the graph, and those without a supernode
  SolverStatus status = SolverStatus::trivial;       ///< why it ended
};

/// How far the vertices of the mesh are from their input points.
struct MovedReport {
  std::uint64_t vertices = 0;          ///< that are elsewhere, but for strays
  double median = 0, q99 = 0, max = 0; ///< of the distances of these, in the unit of the input
  std::uint64_t strays = 0;            ///< points that stand alone and moved to the middle of a bridge, however far
  std::uint64_t crossing = 0;          ///< pairs of triangles that cross all the same
};

/// Where the surface goes over what no samples bear out: holes in the data, mouths of what was not seen inside.
struct BridgedReport {
  std::uint64_t places = 0; ///< that are 10 spacings wide or more
  double widest = 0;        ///< diameter of the disc as large as the largest of them, in the unit of the input
  Vec3 at;                  ///< its middle
};

/// Sheets of samples that the labels left out at first.
struct PassedSheetsReport {
  std::uint64_t sheets = 0, samples = 0; ///< how many, and of how many samples
  Vec3 at;                               ///< middle of the largest, in the unit of the input
};

/// Distances from points of one surface to another.
struct DistanceReport {
  double mean = 0, max = 0; ///< in the unit of the input
};
/// Of a simplified or remeshed mesh and the one before.
struct DeviationReport {
  DistanceReport to_full;   ///< from points spread evenly over the new mesh, and its vertices
  DistanceReport from_full; ///< from the vertices of the one before, each for the area around it
  /// The largest distance either way.
  [[nodiscard]] double max() const { return to_full.max > from_full.max ? to_full.max : from_full.max; }
};

/// How regular triangles are.
struct ShapeReport {
  double least_angle = 0;           ///< of any triangle, degrees
  double low_angle = 0;             ///< 99 % of the triangles have no smaller angle, degrees
  std::vector<std::uint64_t> edges; ///< how many are that long, in quarters of the length asked for; the last: or more
};

/// Triangles that were made fewer (Options::triangles, Options::max_error) or regular (Options::edge).
struct SimplifiedReport {
  std::uint64_t vertices_before = 0, triangles_before = 0, vertices = 0,
                triangles = 0;      ///< of the mesh before and after
  double max_error = 0;             ///< the one asked for as a length; 0: none
  double edge = 0;                  ///< the same
  DeviationReport deviation;        ///< how far the new surface is from the one before
  std::uint64_t held = 0;           ///< vertices before that stay, for triangles would cross or be too far off there
  std::uint64_t crossing = 0;       ///< pairs of triangles that cross or are degenerate all the same
  std::optional<ShapeReport> shape; ///< with Options::edge
};

/// What was done and found: docs/report.md.
struct Report {
  std::vector<std::string> command; ///< the words of the command line; empty where the library was called
  std::vector<InputFile> files;     ///< that were read
  std::uint64_t points = 0, duplicates = 0,
                nonfinite = 0;             ///< rows, and how many of them repeat others or are not finite
  double spacing = 0;                      ///< median side of the square that a sample stands for
  Box3 bounds;                             ///< of the finite points
  Options options;                         ///< as they were used
  std::vector<StageReport> stages;         ///< in their order
  std::vector<PartitionReport> partitions; ///< of poles, then of tetrahedra
  MeshSummary mesh;                        ///< what validate() says of the result
  double grid_spacing = 0; ///< the ℓ of the scans or the one given, used with the paper's weights; 0: off
  std::vector<DroppedComponent> dropped_components; ///< pieces that were not kept
  std::uint64_t undecided_nodes = 0;                ///< of the graphs, left without a sign
  std::uint64_t sight_lines = 0;                    ///< from samples to their sensors; 0: no sensor is known
  std::uint64_t contradicting_rays = 0;             ///< those that cross what was found to be inside
  std::optional<OneSided> one_sided;                ///< the sensors all lie on one side
  Surroundings surroundings;                        ///< what was scanned
  std::optional<Base> base;                         ///< where Options::base was asked for
  double unsupported_area = 0;                ///< share of the surface's area that no samples bear out, before trimming
  BridgedReport bridged;                      ///< before trimming
  PassedSheetsReport passed_sheets;           ///< where walls may be torn
  std::optional<MovedReport> moved;           ///< none: every vertex is an input point
  std::optional<SimplifiedReport> simplified; ///< none: triangles are those of the surface
  double seconds = 0;                         ///< of the whole run
  std::uint64_t peak_memory_bytes = 0;        ///< of the process
  std::uint64_t peak_disk_bytes = 0;          ///< of arrays that lay on the disk, out of core
  std::vector<std::string> warnings;          ///< what there is to know before use, with what to do
  /// What the mesh was promised to be and is not (closed, manifold, oriented, free of crossings): a fault of the
  /// program.
  std::vector<std::string> broken_guarantees;
};

/// JSON, schema 1, indented by two blanks.
std::string to_json(const Report& report);
/// The object under "mesh" of the report.
std::string to_json(const MeshSummary& mesh);

/// Largest resident set of this process so far, in bytes.
std::uint64_t peak_memory_bytes();

} // namespace eigencrust
