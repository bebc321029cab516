// SPDX-License-Identifier: GPL-3.0-or-later
#include "measures.h"

#include <algorithm>
#include <cmath>

#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>

#include "geometry/nearest.h"
#include "parallel/threads.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust::bench {
namespace {

constexpr std::size_t surface_samples = 100'000;
constexpr double far_vertex = 2, deep = 3; // spacings

bool contains(const Box3& box, const Vec3& p) {
  return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y && box.min.z <= p.z &&
         p.z <= box.max.z;
}

/// Which points are farther than a radius from a surface. Circumcentres crowd where all of a surface is about
/// equally far (the middle of a sphere), which is the worst place to ask a tree of triangles for the nearest:
/// it is asked only about points near some vertex.
class FarFrom {
 public:
  FarFrom(const TriangleMesh& mesh, double radius)
      : radius_(radius), vertices_(mesh.vertices), triangles_(mesh), widest_(radius + widest_gap(mesh)) {}

  [[nodiscard]] bool operator()(const Vec3& p) const {
    return vertices_.within(p, widest_).empty() || triangles_.nearest(p).distance > radius_;
  }

 private:
  /// No point of a triangle is farther from its nearest corner than the longest edge / √3.
  static double widest_gap(const TriangleMesh& mesh) {
    double longest = 0;
    for (const auto& t : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        longest = std::max(longest, distance(mesh.vertices[t[k]], mesh.vertices[t[(k + 1) % 3]]));
    return longest / std::sqrt(3.0);
  }

  double radius_;
  PointTree vertices_;
  TriangleTree triangles_;
  double widest_;
};

/// The column of input rows. \throws Error{guarantee} without it
const Attribute& source_of(const TriangleMesh& mesh) {
  const Attribute* source = find_attribute(mesh.vertex_attributes, "source_index");
  if (source == nullptr)
    throw Error(ErrorKind::guarantee, "robustness", "the mesh lacks source_index", "mend reconstruct()");
  return *source;
}

} // namespace

void measure_topology(const Scene& scene, const Result& result, Figures& figures) {
  const MeshSummary& mesh = result.report.mesh;
  std::int64_t genus = 0;
  const std::size_t bodies = std::min<std::size_t>(scene.truth.components, mesh.component_list.size());
  for (std::size_t i = 0; i < bodies; ++i) genus += mesh.component_list[i].genus;
  figures.set("components", static_cast<double>(mesh.components));
  figures.set("genus", static_cast<double>(genus));
  figures.set("genus_total", static_cast<double>(mesh.genus));
  figures.set("vertices", static_cast<double>(mesh.vertices));
  figures.set("volume", mesh.volume);
}

void measure_kept(const Scene& scene, const Result& result, Figures& figures) {
  if (scene.true_samples == 0) return;
  const auto is_true = [&](double row) { return row < static_cast<double>(scene.true_samples); };
  const Attribute& source = source_of(result.mesh);
  double kept = 0, distinct = 0;
  for (std::size_t v = 0; v < source.rows(); ++v) kept += is_true(attribute_value(source, v));
  for (const std::uint32_t row : result.tetrahedralization.source) distinct += is_true(row);
  figures.set("true_samples_kept", kept / distinct);
  figures.set("outliers_kept", 1 - kept / static_cast<double>(source.rows()));
}

void measure_distances(const Scene& scene, const Result& result, unsigned threads, Figures& figures) {
  if (scene.truth.mesh == nullptr || !(scene.spacing > 0)) return;
  const TriangleMesh& truth = *scene.truth.mesh;
  const DistanceStatistics to =
      summarize(distances_to_surface(sample_surface(result.mesh, surface_samples, 1), truth, threads));
  const DistanceStatistics from =
      summarize(distances_to_surface(sample_surface(truth, surface_samples, 2), result.mesh, threads));
  const std::vector<double> of_vertices = distances_to_surface(result.mesh.vertices, truth, threads);
  const double worst = *std::max_element(of_vertices.begin(), of_vertices.end());
  const auto far = std::count_if(of_vertices.begin(), of_vertices.end(),
                                 [&](double d) { return !(d <= far_vertex * scene.spacing); });
  figures.set("to_truth_mean", to.mean / scene.spacing);
  figures.set("to_truth_q95", to.q95 / scene.spacing);
  figures.set("to_truth_max", std::max(to.max, worst) / scene.spacing);
  figures.set("from_truth_mean", from.mean / scene.spacing);
  figures.set("from_truth_q95", from.q95 / scene.spacing);
  figures.set("from_truth_max", from.max / scene.spacing);
  figures.set("hausdorff", std::max({to.max, worst, from.max}) / scene.spacing);
  figures.set("far_vertices", static_cast<double>(far) / static_cast<double>(of_vertices.size()));
}

void measure_volume(const Scene& scene, const Result& result, Figures& figures) {
  if (!(scene.truth.volume > 0)) return;
  // The free space of rooms is the truth's body; their surface looks into it.
  const bool rooms = result.report.surroundings.kind == SceneKind::interior;
  const double volume = rooms ? -result.report.mesh.volume : result.report.mesh.volume;
  figures.set("volume_error", std::fabs(volume / scene.truth.volume - 1));
}

void measure_area(const Scene& scene, const Result& result, Figures& figures) {
  figures.set("area", result.report.mesh.area);
  if (scene.truth.area > 0) figures.set("area_error", std::fabs(result.report.mesh.area / scene.truth.area - 1));
}

void measure_sharp_edges(const Scene& scene, const Result& result, Figures& figures) {
  if (scene.sharp_edges.empty()) return;
  const Attribute& source = source_of(result.mesh);
  const auto row = [&](std::uint32_t v) { return static_cast<std::uint32_t>(attribute_value(source, v)); };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : result.mesh.triangles)
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax({row(t[k]), row(t[(k + 1) % 3])}));
  std::sort(edges.begin(), edges.end());
  double there = 0, all = 0;
  for (const auto& [a, b] : scene.sharp_edges) {
    const double length = distance(scene.cloud.points[a], scene.cloud.points[b]);
    all += length;
    if (std::binary_search(edges.begin(), edges.end(), std::pair(std::minmax({a, b})))) there += length;
  }
  figures.set("sharp_edges_kept", there / all);
}

void measure_clean_rows(const Scene& scene, const Result& result, Figures& figures) {
  if (scene.clean_rows.empty()) return;
  const Attribute& source = source_of(result.mesh);
  double least = 1;
  for (const auto& [begin, end] : scene.clean_rows) {
    double kept = 0, distinct = 0;
    const auto is_in = [b = begin, e = end](double row) {
      return static_cast<double>(b) <= row && row < static_cast<double>(e);
    };
    for (std::size_t v = 0; v < source.rows(); ++v) kept += is_in(attribute_value(source, v));
    for (const std::uint32_t row : result.tetrahedralization.source) distinct += is_in(row);
    least = std::min(least, kept / distinct);
  }
  figures.set("clean_rows_kept", least);
}

void measure_deep_tetrahedra(const Scene& scene, const Result& result, unsigned threads, Figures& figures) {
  if (scene.truth.inside == nullptr || scene.truth.mesh == nullptr) return;
  if (result.report.surroundings.kind == SceneKind::interior) return; // inside is what is solid, not the body
  const Tetrahedralization& t = result.tetrahedralization;
  const FarFrom is_deep(*scene.truth.mesh, deep * scene.spacing);
  enum : std::uint8_t { shallow, right, wrong };
  std::vector<std::uint8_t> verdict(t.tetrahedra.size(), shallow);
  const auto judge = [&](std::size_t i) {
    const TetrahedronIndex index{static_cast<std::uint32_t>(i)};
    const auto& [a, b, c, d] = t.tetrahedra[index];
    const Vec3 centre = t.origin + circumcentre(t.positions[a], t.positions[b], t.positions[c], t.positions[d]);
    if (!contains(result.report.bounds, centre) || !is_deep(centre)) return;
    const Label truth = scene.truth.inside(centre) ? Label::inside : Label::outside;
    verdict[i] = result.labels[index] == truth ? right : wrong;
  };
  for_each_index(Threads(threads), verdict.size(), judge, 4096);
  const auto wrong_ones = static_cast<double>(std::count(verdict.begin(), verdict.end(), wrong));
  const auto all = wrong_ones + static_cast<double>(std::count(verdict.begin(), verdict.end(), right));
  figures.set("deep_tetrahedra", all);
  figures.set("wrong_deep_tetrahedra", wrong_ones);
  figures.set("wrong_deep_share", all > 0 ? wrong_ones / all : 0);
}

void measure(const Scene& scene, const Result& result, unsigned threads, Figures& figures) {
  measure_topology(scene, result, figures);
  measure_kept(scene, result, figures);
  measure_distances(scene, result, threads, figures);
  measure_volume(scene, result, figures);
  measure_area(scene, result, figures);
  measure_sharp_edges(scene, result, figures);
  measure_clean_rows(scene, result, figures);
  measure_deep_tetrahedra(scene, result, threads, figures);
}

} // namespace eigencrust::bench
