// SPDX-License-Identifier: GPL-3.0-or-later
#include "contest_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>
#include <eigencrust/validate.h>

#include "data_folder.h"
#include "fit_scenes.h"
#include "geometry/nearest.h"
#include "parallel/threads.h"
#include "sampling.h"

namespace eigencrust::bench {
namespace {

namespace fs = std::filesystem;

WriteOptions exactly() {
  WriteOptions options;
  options.coordinates = CoordinateType::float64;
  return options;
}

bool comes_before(const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

Scene scene_of(const ContestCase& item, Sources& sources) {
  if (item.make) return item.make(sources);
  Truth truth;
  if (item.files.size() > 1) truth = sources.truth(item.files[1]);
  Scene scene = clean_scene(sources.points(item.as_it_is), std::move(truth), sources.threads());
  scene.true_samples = 0;
  return scene;
}

using Corners = std::array<std::uint32_t, 3>;

/// The corners of all triangles, increasing, and they in order.
std::vector<Corners> sorted_triangles(const TriangleMesh& mesh, const std::vector<Vec3>& places) {
  std::vector<std::uint32_t> number;
  for (const Vec3& v : mesh.vertices)
    number.push_back(
        static_cast<std::uint32_t>(std::lower_bound(places.begin(), places.end(), v, comes_before) - places.begin()));
  std::vector<Corners> all;
  for (const auto& t : mesh.triangles) {
    Corners& corners = all.emplace_back(Corners{number[t[0]], number[t[1]], number[t[2]]});
    std::sort(corners.begin(), corners.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// The four corners of every two triangles with a common edge, increasing, and the two.
using Pair = std::pair<std::array<std::uint32_t, 4>, std::array<std::size_t, 2>>;
std::vector<Pair> pairs_of(const std::vector<Corners>& triangles) {
  std::map<std::array<std::uint32_t, 2>, std::vector<std::size_t>> at_edge;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto [a, b, c] = triangles[i];
    for (const auto& edge : {std::array{a, b}, std::array{a, c}, std::array{b, c}}) at_edge[edge].push_back(i);
  }
  std::vector<Pair> pairs;
  for (const auto& [edge, at] : at_edge) {
    if (at.size() != 2) continue;
    std::array corners{edge[0], edge[1], 0u, 0u};
    for (std::size_t k = 0; k < 2; ++k)
      for (const std::uint32_t c : triangles[at[k]])
        if (c != edge[0] && c != edge[1]) corners[2 + k] = c;
    std::sort(corners.begin(), corners.end());
    pairs.push_back({corners, {at[0], at[1]}});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// How many of these triangles lie two and two over the same four corners as two of the others, their edge turned.
std::size_t count_turned(const std::vector<Corners>& triangles, const std::vector<Corners>& others) {
  const std::vector<Pair> pairs = pairs_of(others);
  std::vector<std::uint8_t> turned(triangles.size(), 0);
  for (const auto& [corners, two] : pairs_of(triangles)) {
    const auto found = std::lower_bound(pairs.begin(), pairs.end(), Pair{corners, {0, 0}});
    if (found != pairs.end() && found->first == corners) turned[two[0]] = turned[two[1]] = 1;
  }
  return static_cast<std::size_t>(std::count(turned.begin(), turned.end(), 1));
}

void measure_mesh(const TriangleMesh& mesh, unsigned threads, ContestFigures& figures) {
  constexpr std::size_t many = 3'000'000; // triangles: crossings of more take longer than the methods
  const MeshSummary summary = validate(mesh, {.self_intersections = mesh.triangles.size() <= many, .threads = threads});
  figures.triangles = static_cast<double>(summary.triangles);
  figures.pieces = static_cast<double>(summary.components);
  figures.genus = static_cast<double>(summary.genus);
  figures.boundary = static_cast<double>(summary.boundary_edges);
  figures.nonmanifold = static_cast<double>(summary.nonmanifold_edges + summary.nonmanifold_vertices);
  figures.crossings = static_cast<double>(summary.self_intersections);
  if (summary.closed()) figures.volume = std::abs(summary.volume);
}

/// Share of the points farther from the surface than 2 % of the diagonal of their box.
double missed_share(const std::vector<Vec3>& samples, const TriangleMesh& mesh, unsigned threads) {
  constexpr std::size_t asked = 100'000; // points at most
  constexpr double reach = 0.02;
  if (samples.empty()) return -1;
  Box3 box;
  for (const Vec3& p : samples) box.add(p);
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < samples.size(); i += 1 + samples.size() / asked) some.push_back(samples[i]);
  const std::vector<double> gaps = distances_to_surface(some, mesh, threads);
  const double limit = reach * box.diagonal();
  const auto far = std::count_if(gaps.begin(), gaps.end(), [&](double gap) { return gap > limit; });
  return static_cast<double>(far) / static_cast<double>(gaps.size());
}

/// Outliers that the surface goes through, and samples that it does not.
void measure_rows(const fs::path& folder, const ContestScene& scene, const TriangleMesh& mesh, unsigned threads,
                  ContestFigures& figures) {
  const std::vector<Vec3> points = read_point_cloud(scene.cloud).points;
  const std::vector<std::uint32_t> rows = outlier_rows(points, scene.true_samples, threads);
  std::vector<Vec3> outliers, samples;
  for (std::size_t i = 0, next = 0; i < points.size(); ++i) {
    const bool outlier = next < rows.size() && rows[next] == i;
    next += outlier;
    (outlier ? outliers : samples).push_back(points[i]);
  }
  figures.missed = missed_share(samples, mesh, threads);
  const auto gaps = distances_to_surface(outliers, mesh, threads);
  std::vector<double> depths(outliers.size(), 2 * scene.spacing);
  if (fs::exists(folder / "truth.ply") && !outliers.empty())
    depths = distances_to_surface(outliers, read_mesh(folder / "truth.ply"), threads);
  figures.outliers = 0;
  for (std::size_t i = 0; i < outliers.size();
       ++i) // one beside the true surface may well be near the one that was found
    figures.outliers += gaps[i] < scene.spacing && depths[i] >= 2 * scene.spacing;
}

void measure_truth(const fs::path& folder, const ContestScene& scene, const TriangleMesh& mesh, unsigned threads,
                   ContestFigures& figures) {
  if (fs::exists(folder / "truth.ply")) {
    CompareOptions options;
    options.threads = threads;
    options.threshold = 2 * scene.spacing;
    const Comparison c = compare(mesh, read_mesh(folder / "truth.ply"), options);
    figures.to_truth = c.to_reference.mean / scene.spacing;
    figures.from_truth = c.from_reference.mean / scene.spacing;
    figures.missing = 1 - c.recall;
  }
  if (!fs::exists(folder / "edges.ply")) return;
  const auto gaps = distances_to_surface(read_point_cloud(folder / "edges.ply").points, mesh, threads);
  figures.edges = summarize(gaps).mean / scene.spacing;
}

} // namespace

void write_contest_scene(const ContestCase& item, Sources& sources, const fs::path& folder) {
  const Scene scene = scene_of(item, sources);
  fs::create_directories(folder);
  for (const char* old : {"truth.ply", "edges.ply"}) fs::remove(folder / old);
  const fs::path cloud = item.make ? folder / "cloud.ply" : sources.path(item.as_it_is.string());
  if (item.make) write_point_cloud(cloud, scene.cloud, exactly());
  if (scene.truth.mesh) {
    write_mesh(folder / "truth.ply", *scene.truth.mesh, exactly());
    PointCloud edges;
    edges.points = points_on_sharp_edges(*scene.truth.mesh, 0.2 * scene.spacing);
    // On a scanned shape few and short ones are chance.
    if (item.group == "fig7") write_point_cloud(folder / "edges.ply", edges, exactly());
  }
  const std::int64_t genus = item.genus ? *item.genus : item.make ? scene.truth.genus : -1;
  const nlohmann::json json{{"cloud", fs::absolute(cloud).string()}, {"points", scene.cloud.points.size()},
                            {"true_samples", scene.true_samples},    {"spacing", scene.spacing},
                            {"volume", scene.truth.volume},          {"genus", genus},
                            {"components", scene.truth.components}};
  write_text((folder / "scene.json").string(), json.dump(2) + "\n");
}

ContestScene read_contest_scene(const fs::path& folder) {
  std::ifstream stream(folder / "scene.json");
  if (!stream) throw Error(ErrorKind::input, folder.string(), "there is no scene.json", "make the case first");
  const auto json = nlohmann::json::parse(stream);
  return {json.at("cloud").get<std::string>(),
          json.at("points"),
          json.at("true_samples"),
          json.at("spacing"),
          json.at("volume"),
          json.at("genus"),
          json.at("components")};
}

std::vector<std::uint32_t> outlier_rows(const std::vector<Vec3>& points, std::size_t true_samples, unsigned threads) {
  std::vector<std::uint32_t> rows;
  if (true_samples > 0) {
    for (std::size_t i = true_samples; i < points.size(); ++i) rows.push_back(static_cast<std::uint32_t>(i));
    return rows;
  }
  constexpr std::size_t neighbours = 9; // itself and 8: scans lie on each other
  constexpr double apart = 10;          // medians
  const PointTree tree(points);
  std::vector<double> reach(points.size(), 0);
  const auto measure = [&](std::size_t i) {
    std::array<std::uint32_t, neighbours> index{};
    std::array<double, neighbours> squared{};
    const std::size_t found = tree.nearest(points[i], neighbours, index.data(), squared.data());
    if (found > 0) reach[i] = std::sqrt(squared[found - 1]);
  };
  for_each_index(Threads(threads), points.size(), measure, costly_block);
  const double limit = apart * summarize(reach).median;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (reach[i] > limit) rows.push_back(static_cast<std::uint32_t>(i));
  return rows;
}

Agreement triangle_agreement(const TriangleMesh& a, const TriangleMesh& b) {
  std::vector<Vec3> places = a.vertices;
  places.insert(places.end(), b.vertices.begin(), b.vertices.end());
  std::sort(places.begin(), places.end(), comes_before);
  const std::vector<Corners> of_a = sorted_triangles(a, places), of_b = sorted_triangles(b, places);
  std::vector<Corners> only_a, only_b;
  std::set_difference(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(only_a));
  std::set_difference(of_b.begin(), of_b.end(), of_a.begin(), of_a.end(), std::back_inserter(only_b));
  if (of_a.empty() && of_b.empty()) return {};
  const auto most = static_cast<double>(std::max(of_a.size(), of_b.size()));
  const std::size_t common = of_a.size() - only_a.size();
  // Where nothing is the same the vertices are others, of millions of triangles at times.
  const std::size_t turned = common == 0 ? 0 : std::min(count_turned(only_a, only_b), count_turned(only_b, only_a));
  return {static_cast<double>(common) / most, static_cast<double>(common + turned) / most};
}

ContestFigures contest_figures(const fs::path& folder, const fs::path& mesh_file, const fs::path& other,
                               unsigned threads) {
  const ContestScene scene = read_contest_scene(folder);
  const TriangleMesh mesh = read_mesh(mesh_file);
  ContestFigures figures;
  if (mesh.triangles.empty())
    throw Error(ErrorKind::input, mesh_file.string(), "there is no triangle in it", "look at what made it");
  measure_mesh(mesh, threads, figures);
  measure_rows(folder, scene, mesh, threads, figures);
  measure_truth(folder, scene, mesh, threads, figures);
  if (!other.empty()) {
    const Agreement agreement = triangle_agreement(mesh, read_mesh(other));
    figures.agree = agreement.same;
    figures.agree_but_turned = agreement.but_for_turned;
  }
  return figures;
}

} // namespace eigencrust::bench
