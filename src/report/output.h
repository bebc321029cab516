// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What stands around the paper's page: checks of input and result, the report's entries, attributes.
#pragma once

#include <eigencrust/eigencrust.h>
#include <eigencrust/stages.h>

#include "report/run.h"

namespace eigencrust {

/// \throws Error{input} when an array of the cloud has the wrong length
void check_cloud(const PointCloud& cloud);
void describe_input(const PointCloud& cloud, const Samples& samples, Report& report);
void describe_noise(const std::vector<float>& grid_spacing, Run& run);
/// How far in front of each sample a tetrahedron must begin to count as crossed.
std::vector<float> crossing_depths(const std::vector<float>& grid_spacing, const Options& options, double spacing,
                                   std::size_t samples);
/// What the lines of sight say beyond what was `named`.
void describe_sight(const SightCrossings& crossings, const SightLabels& sight, const Labels& named, Run& run,
                    Report& report);
void describe_contradictions(std::uint64_t contradicting, Run& run, Report& report);
void describe_labels(const FinalLabels& labels, Run& run);
void describe_manifold(const ManifoldCounts& counts, const Labels& known, const Labels& labels, Run& run);
std::uint64_t edge_count(const SignedGraph& graph);
void describe_partition(const std::string& name, std::uint64_t edges, const Partition& partition, Run& run,
                        Report& report);
void describe_pole_labels(const PoleLabels& labels, Run& run);

/// \throws Error{no_surface}
void require_surface(const Surface& surface);
/// The lines of all samples, also of isolated ones.
std::vector<SightLine> rays_of(const PointCloud& cloud, const Tetrahedralization& tetrahedralization);
/// Notes how much of the surface is `unsupported`, and warns where much of it stays.
void describe_unsupported(const Surface& surface, std::span<const std::uint8_t> unsupported, Run& run, Report& report);
/// \throws Error{no_surface} when nothing is left of it
void require_trimmed(const Surface& surface);
/// What the options promise and the mesh is not.
std::vector<std::string> broken_guarantees(const MeshSummary& mesh, const Options& options);

/// Are the samples the input's rows moved without any rounding?
bool is_exact_translation(const Tetrahedralization& tetrahedralization, const PointCloud& cloud,
                          const Threads& threads);

/// The surface in input coordinates with the attributes of its points and source_index. Unless the
/// vertices were moved they are the input's rows bit for bit.
TriangleMesh finish_mesh(const Surface& surface, const Tetrahedralization& tetrahedralization, const PointCloud& cloud,
                         bool moved);

} // namespace eigencrust
