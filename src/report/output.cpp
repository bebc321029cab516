// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/output.h"

#include <algorithm>
#include <cmath>

#include <eigencrust/io.h>

#include "geometry/exact_difference.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

void check_sensors(const PointCloud& cloud) {
  if (!cloud.sensor_of.empty() && cloud.sensor_of.size() != cloud.points.size())
    throw Error(ErrorKind::input, "input",
                "the sensor index has " + std::to_string(cloud.sensor_of.size()) + " entries for " +
                    std::to_string(cloud.points.size()) + " points",
                "give one sensor number per point");
  for (const std::uint32_t sensor : cloud.sensor_of)
    if (sensor != PointCloud::no_sensor && sensor >= cloud.sensors.size())
      throw Error(ErrorKind::input, "input",
                  "a point names sensor " + std::to_string(sensor) + " of " + std::to_string(cloud.sensors.size()),
                  "number the sensors from 0, or say no_sensor");
  for (const Sensor& sensor : cloud.sensors) {
    if (!is_finite(sensor.place))
      throw Error(ErrorKind::input, "input", "the place of a sensor is not finite", "give finite coordinates");
    if (sensor.at_infinity && std::abs(norm(sensor.place) - 1) > 1e-6)
      throw Error(ErrorKind::input, "input", "the direction of a sensor at infinity is no unit vector",
                  "divide it by its length");
  }
}

} // namespace

void check_cloud(const PointCloud& cloud) {
  const std::size_t n = cloud.points.size();
  for (const Attribute& attribute : cloud.attributes)
    if (attribute.rows() != n)
      throw Error(ErrorKind::input, "input",
                  "attribute " + attribute.name + " has " + std::to_string(attribute.rows()) + " rows for " +
                      std::to_string(n) + " points",
                  "give one value per point");
  if (!cloud.scan_index.empty() && cloud.scan_index.size() != n)
    throw Error(ErrorKind::input, "input",
                "the scan index has " + std::to_string(cloud.scan_index.size()) + " entries for " + std::to_string(n) +
                    " points",
                "give one scan number per point");
  check_sensors(cloud);
}

void describe_input(const PointCloud& cloud, const Samples& samples, Report& report) {
  report.points = cloud.points.size();
  report.duplicates = samples.duplicates;
  report.nonfinite = samples.nonfinite;
  report.bounds = samples.bounds;
}

void describe_noise(const std::vector<float>& grid_spacing, Run& run) {
  if (grid_spacing.empty()) return;
  std::vector<float> sorted = grid_spacing;
  for (const auto& [name, share] : {std::pair{"grid_spacing_q10", 0.1}, std::pair{"grid_spacing_median", 0.5},
                                    std::pair{"grid_spacing_q90", 0.9}}) {
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    run.count("noise", name, static_cast<double>(*at));
  }
}

std::vector<float> crossing_depths(const std::vector<float>& grid_spacing, const Options& options, double spacing,
                                   std::size_t samples) {
  if (options.crossing_depth) return std::vector<float>(samples, static_cast<float>(*options.crossing_depth));
  std::vector<float> depth(samples, static_cast<float>(2 * spacing));
  constexpr float noise_in_grid_spacings = 3 / 1.2f; // 3 deviations; a grid spacing is 1.2 of them
  for (std::size_t i = 0; i < grid_spacing.size(); ++i)
    depth[i] = std::max(depth[i], noise_in_grid_spacings * grid_spacing[i]);
  return depth;
}

void describe_sight(const SightCrossings& crossings, const SightLabels& sight, const Labels& named, Run& run,
                    Report& report) {
  std::uint64_t outside = 0, inside = 0;
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (named.raw()[i] != Label::unlabelled) continue;
    outside += sight.labels.raw()[i] == Label::outside;
    inside += sight.labels.raw()[i] == Label::inside;
  }
  report.sight_lines = crossings.begin.size() - 1;
  run.count("lines", static_cast<double>(report.sight_lines));
  run.count("disbelieved", static_cast<double>(sight.disbelieved));
  run.count("outside", static_cast<double>(outside));
  run.count("inside", static_cast<double>(inside));
}

void describe_contradictions(std::uint64_t contradicting, Run& run, Report& report) {
  report.contradicting_rays = contradicting;
  const double share = static_cast<double>(contradicting) / static_cast<double>(report.sight_lines);
  constexpr double usual = 0.05;
  if (share > usual)
    run.warn(std::to_string(std::lround(100 * share)) +
             " % of the lines of sight cross what was found to be inside: check the sensors' places, or ignore them");
}

void describe_labels(const FinalLabels& labels, Run& run) {
  if (labels.supernodes_agree)
    run.warn("the second eigenvector puts inside and outside on the same side; use --second-stage harmonic");
}

void describe_manifold(const ManifoldCounts& counts, const Labels& known, const Labels& labels, Run& run) {
  run.count("edges_repaired", static_cast<double>(counts.edges));
  run.count("vertices_repaired", static_cast<double>(counts.vertices));
  run.count("tetrahedra_relabelled", static_cast<double>(counts.relabelled));
  std::uint64_t overruled = 0;
  for (std::size_t i = 0; i < known.size(); ++i)
    overruled += known.raw()[i] != Label::unlabelled && known.raw()[i] != labels.raw()[i];
  if (overruled > 0)
    run.warn(std::to_string(overruled) + " tetrahedra named inside or outside were overruled by the manifold repair");
}

std::uint64_t edge_count(const SignedGraph& graph) {
  std::uint64_t edges = graph.column.size() / 2;
  for (const SignedGraph::Supernode& super : graph.supernodes)
    for (const float w : super.weight) edges += w != 0;
  return edges;
}

void describe_partition(const std::string& name, std::uint64_t edges, const Partition& partition, Run& run,
                        Report& report) {
  PartitionReport entry;
  entry.stage = name;
  entry.nodes = partition.value.size();
  entry.edges = edges;
  entry.eigenvalue = partition.eigenvalue;
  entry.residual = partition.residual;
  entry.iterations = partition.iterations;
  entry.sign_changes = partition.sign_changes;
  entry.components = partition.components;
  entry.free_components = partition.free_components;
  entry.status = partition.status;
  report.partitions.push_back(entry);
  report.undecided_nodes += partition.undecided;
  if (partition.status == SolverStatus::not_converged)
    run.warn("the solver of the " + name + " stopped before the signs settled (residual " +
             std::to_string(partition.residual) + ")");
}

void describe_pole_labels(const PoleLabels& labels, Run& run) {
  run.count("vote", labels.vote);
  run.count("supernode_overruled", labels.reversed ? 1 : 0);
  run.count("contradicted", static_cast<double>(labels.contradicted));
  run.count("left_to_stage_two", static_cast<double>(labels.left_to_stage_two));
}

void require_surface(const Surface& surface) {
  if (surface.mesh.triangles.empty())
    throw Error(
        ErrorKind::no_surface, "surface", "every tetrahedron was labelled outside",
        "check that the points surround a volume, take a smaller --grid-spacing or off, or name an inside point");
}

std::vector<SightLine> rays_of(const PointCloud& cloud, const Tetrahedralization& t) {
  return sight_lines(cloud, t, std::vector<float>(t.sample_count, 0), {});
}

void describe_unsupported(const Surface& surface, std::span<const std::uint8_t> unsupported, Run& run, Report& report) {
  report.unsupported_area = share_of_area(surface, unsupported);
  run.count("unsupported", static_cast<double>(std::count(unsupported.begin(), unsupported.end(), 1)));
  constexpr double usual = 0.1;
  if (report.unsupported_area > usual && !report.options.trim)
    run.warn(std::to_string(std::lround(100 * report.unsupported_area)) +
             " % of the surface's area was invented: no samples bear it out" +
             (report.one_sided ? " (the sensors all lie on one side)" : "") + "; --trim leaves it out");
}

void require_trimmed(const Surface& surface) {
  if (surface.mesh.triangles.empty())
    throw Error(ErrorKind::no_surface, "trim", "no triangle is borne out by the samples",
                "leave out --trim, or check the places of the sensors");
}

std::vector<std::string> broken_guarantees(const MeshSummary& mesh, const Options& options) {
  std::vector<std::string> broken;
  if (!mesh.closed() && !options.facade && !options.trim) broken.emplace_back("closed");
  if (options.manifold && !mesh.manifold()) broken.emplace_back("manifold");
  if (options.manifold && !mesh.oriented()) broken.emplace_back("consistently oriented");
  return broken;
}

bool is_exact_translation(const Tetrahedralization& t, const PointCloud& cloud, const Threads& threads) {
  const auto rounded = sum_blocks<std::uint64_t>(threads, t.sample_count, [&](std::size_t begin, std::size_t end) {
    std::uint64_t count = 0;
    for (std::size_t s = begin; s < end; ++s) count += !is_exact_difference(cloud.points[t.source.raw()[s]], t.origin);
    return count;
  });
  return rounded == 0;
}

TriangleMesh finish_mesh(const Surface& surface, const Tetrahedralization& t, const PointCloud& cloud, bool moved) {
  TriangleMesh mesh;
  mesh.triangles = surface.mesh.triangles;
  std::vector<std::uint32_t> source;
  source.reserve(surface.sample_of.size());
  for (const SampleIndex s : surface.sample_of) source.push_back(t.source[s]);
  mesh.vertices.reserve(source.size());
  for (std::size_t v = 0; v < source.size(); ++v)
    mesh.vertices.push_back(moved ? surface.mesh.vertices[v] + t.origin : cloud.points[source[v]]);
  for (const Attribute& attribute : cloud.attributes) mesh.vertex_attributes.push_back(gather(attribute, source));
  mesh.vertex_attributes.push_back(make_attribute("source_index", source));
  if (!cloud.scan_index.empty()) {
    std::vector<std::uint32_t> scan;
    scan.reserve(source.size());
    for (const std::uint32_t row : source) scan.push_back(cloud.scan_index[row]);
    mesh.vertex_attributes.push_back(make_attribute("scan_index", scan));
  }
  mesh.triangle_attributes.push_back(make_attribute("support", surface.support));
  return mesh;
}

} // namespace eigencrust
