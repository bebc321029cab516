// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/remesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <eigencrust/error.h>

#include "geometry/float_places.h"
#include "geometry/mesh_topology.h"
#include "numerics/quantile.h"
#include "simplify/crossings.h"
#include "simplify/turned.h"

namespace eigencrust {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using HalfedgeMesh = CGAL::Surface_mesh<Point>;

// Degrees between the normals of two triangles: more is a crease. Noise that was fitted makes 10, machined parts have
// 90.
constexpr double crease = 60;
// Of splitting, collapsing, flipping and moving; more change little.
constexpr unsigned iterations = 5;
// Rounds in which ever wider surroundings of crossings stay as they were.
constexpr int most_rounds = 8;
// A much finer mesh is simplified before, to so many times the triangles that there will be: they are as good to work
// on, and where they stay they are not much smaller.
constexpr double finer = 4;
// A mesh of these takes some gigabytes.
constexpr double most_triangles = 2e7;
// Bins of the histogram, in quarters of the length asked for.
constexpr std::size_t bins = 9;
constexpr double bins_of_length = 4;

/// With edges of that length.
double expected_triangles(const TriangleMesh& mesh, double edge) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += norm(area_vector(mesh, t)) / 2;
  return area / (std::sqrt(3.0) / 4 * edge * edge);
}

void require_reasonable(double triangles, double edge) {
  if (triangles <= most_triangles) return;
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", edge * std::sqrt(triangles / most_triangles));
  throw Error(ErrorKind::usage, "remesh", "edges so short make more than 20 million triangles",
              std::string("give --edge at least ") + text);
}

class Remeshing {
 public:
  Remeshing(const TriangleMesh& full, const FullSurface& surface, double edge, double spacing, const Threads& threads)
      : full_(full),
        surface_(surface),
        edge_(edge),
        spacing_(spacing),
        threads_(threads),
        sides_(full, threads),
        kept_(full.triangles.size(), 0) {
    Box3 box;
    for (const Vec3& p : full.vertices) box.add(p);
    centre_ = box.empty() ? Vec3{} : box.centre();
  }

  OtherTriangles run() {
    OtherTriangles result{full_, {}, 0, 0};
    for (int round = 0; round <= most_rounds; ++round) {
      std::optional<TriangleMesh> mesh;
      if (round < most_rounds) mesh = remeshed_if_possible();
      if (!mesh) break; // as it was
      CrossingVertices crossing = crossing_vertices(*mesh, threads_);
      if (crossing.count == 0) crossing.at = sides_.turned(*mesh, vertices_before(*mesh), threads_);
      if (crossing.count == 0 && crossing.at.empty()) {
        result.mesh = std::move(*mesh);
        break;
      }
      keep_around(*mesh, crossing.at, round);
    }
    result.mesh.vertex_attributes.clear();
    result.mesh.triangle_attributes.clear();
    result.deviation = surface_.measure(result.mesh, threads_);
    result.crossing = crossing_vertices(result.mesh, threads_).count;
    std::vector<std::uint8_t> held(full_.vertices.size(), 0);
    for (std::size_t t = 0; t < kept_.size(); ++t)
      if (kept_[t])
        for (const std::uint32_t v : full_.triangles[t]) held[v] = 1;
    result.held = static_cast<std::uint64_t>(std::count(held.begin(), held.end(), 1));
    return result;
  }

 private:
  /// CGAL 5.5 asserts, where assertions are on, that creases between its patches close, and they need not.
  [[nodiscard]] std::optional<TriangleMesh> remeshed_if_possible() const {
    try {
      return remeshed();
    } catch (const CGAL::Assertion_exception&) {
      return std::nullopt;
    }
  }

  /// None: the mesh is no manifold.
  [[nodiscard]] std::optional<TriangleMesh> remeshed() const {
    namespace pmp = CGAL::Polygon_mesh_processing;
    HalfedgeMesh mesh;
    const auto number = mesh.add_property_map<HalfedgeMesh::Vertex_index, std::uint32_t>("v:before", no_index).first;
    for (std::uint32_t v = 0; v < full_.vertices.size(); ++v) {
      const Vec3 p = full_.vertices[v] - centre_;
      number[mesh.add_vertex(Point(p.x, p.y, p.z))] = v;
    }
    const auto kept = mesh.add_property_map<HalfedgeMesh::Face_index, bool>("f:kept", false).first;
    for (std::size_t t = 0; t < full_.triangles.size(); ++t) {
      const auto& [a, b, c] = full_.triangles[t];
      const auto face =
          mesh.add_face(HalfedgeMesh::Vertex_index(a), HalfedgeMesh::Vertex_index(b), HalfedgeMesh::Vertex_index(c));
      if (face == HalfedgeMesh::null_face()) return std::nullopt;
      kept[face] = kept_[t] != 0;
    }
    const auto creases = mesh.add_property_map<HalfedgeMesh::Edge_index, bool>("e:crease", false).first;
    for (unsigned i = 0; i < iterations; ++i) {
      // CGAL forgets creases that it collapses.
      for (const HalfedgeMesh::Edge_index e : mesh.edges()) creases[e] = is_crease(mesh, e);
      std::vector<HalfedgeMesh::Face_index> free;
      for (const HalfedgeMesh::Face_index f : mesh.faces())
        if (!kept[f]) free.push_back(f);
      // CGAL 5.5 moves vertices itself, but reads past the end where all triangles around one have no area.
      pmp::isotropic_remeshing(free, edge_, mesh,
                               pmp::parameters::number_of_iterations(1)
                                   .number_of_relaxation_steps(0)
                                   .do_project(false)
                                   .edge_is_constrained_map(creases));
      move_along_surface(mesh, kept, creases);
    }
    return placed(mesh, number);
  }

  /// Each vertex, but those at rims, creases and what is kept, to the middle of its neighbours, along its tangent plane
  /// and then to the surface, where that turns none of its triangles over.
  template <class Kept, class Creases>
  void move_along_surface(HalfedgeMesh& mesh, const Kept& kept, const Creases& creases) const {
    std::vector<HalfedgeMesh::Vertex_index> movable;
    for (const HalfedgeMesh::Vertex_index v : mesh.vertices()) {
      bool may_move = !mesh.is_isolated(v);
      if (may_move)
        for (const HalfedgeMesh::Halfedge_index h : mesh.halfedges_around_target(mesh.halfedge(v)))
          may_move = may_move && !mesh.is_border(mesh.edge(h)) && !creases[mesh.edge(h)] && !kept[mesh.face(h)];
      if (may_move) movable.push_back(v);
    }
    std::vector<Vec3> places(movable.size());
    for_each_index(
        threads_, movable.size(), [&](std::size_t i) { places[i] = better_place(mesh, movable[i]); }, costly_block);
    for (std::size_t i = 0; i < movable.size(); ++i) {
      const Point before = mesh.point(movable[i]), after(places[i].x, places[i].y, places[i].z);
      const std::vector<Vec3> areas = areas_around(mesh, movable[i]);
      mesh.point(movable[i]) = after;
      const std::vector<Vec3> moved = areas_around(mesh, movable[i]);
      for (std::size_t k = 0; k < areas.size(); ++k)
        if (!(dot(areas[k], moved[k]) > 0) && squared_norm(areas[k]) > 0) mesh.point(movable[i]) = before;
    }
  }

  static Vec3 place(const HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index v) {
    const Point& p = mesh.point(v);
    return {p.x(), p.y(), p.z()};
  }
  /// Twice the area of the triangle at the halfedge, along its normal.
  static Vec3 area(const HalfedgeMesh& mesh, HalfedgeMesh::Halfedge_index h) {
    const Vec3 from = place(mesh, mesh.source(h));
    return cross(place(mesh, mesh.target(h)) - from, place(mesh, mesh.target(mesh.next(h))) - from);
  }
  static std::vector<Vec3> areas_around(const HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index v) {
    std::vector<Vec3> areas;
    for (const HalfedgeMesh::Halfedge_index h : mesh.halfedges_around_target(mesh.halfedge(v)))
      areas.push_back(area(mesh, h));
    return areas;
  }
  [[nodiscard]] Vec3 better_place(const HalfedgeMesh& mesh, HalfedgeMesh::Vertex_index v) const {
    const Vec3 here = place(mesh, v);
    Vec3 sum, normal;
    double count = 0;
    for (const HalfedgeMesh::Halfedge_index h : mesh.halfedges_around_target(mesh.halfedge(v))) {
      sum = sum + (place(mesh, mesh.source(h)) - here);
      count += 1;
    }
    for (const Vec3& area : areas_around(mesh, v)) normal = normal + area;
    Vec3 way = (1 / count) * sum;
    if (const double square = squared_norm(normal); square > 0) way = way - (dot(way, normal) / square) * normal;
    return surface_.tree().nearest(here + way + centre_).point - centre_;
  }

  static bool is_crease(const HalfedgeMesh& mesh, HalfedgeMesh::Edge_index e) {
    if (mesh.is_border(e)) return false; // stays anyway
    const Vec3 m = area(mesh, mesh.halfedge(e, 0)), n = area(mesh, mesh.halfedge(e, 1));
    return dot(m, n) < std::cos(crease * std::numbers::pi / 180) * norm(m) * norm(n);
  }

  /// In the coordinates of the full mesh; what did not move is where it was bit for bit.
  template <class Numbers>
  [[nodiscard]] TriangleMesh placed(const HalfedgeMesh& mesh, const Numbers& number) const {
    TriangleMesh result;
    std::vector<std::uint32_t> place(mesh.num_vertices(), no_index);
    for (const HalfedgeMesh::Vertex_index v : mesh.vertices()) {
      if (mesh.is_isolated(v)) continue;
      place[v] = static_cast<std::uint32_t>(result.vertices.size());
      const Vec3 p{mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()};
      const std::uint32_t before = number[v];
      result.vertices.push_back(before != no_index && full_.vertices[before] - centre_ == p
                                    ? full_.vertices[before]
                                    : as_floats(p + centre_, spacing_));
    }
    for (const auto f : mesh.faces()) {
      const auto h = mesh.halfedge(f);
      result.triangles.push_back({place[mesh.target(h)], place[mesh.target(mesh.next(h))], place[mesh.source(h)]});
    }
    return result;
  }

  [[nodiscard]] std::vector<std::uint32_t> vertices_before(const TriangleMesh& mesh) const {
    std::vector<std::uint32_t> before(mesh.vertices.size());
    for_each_index(
        threads_, before.size(),
        [&](std::size_t v) { before[v] = full_.triangles[surface_.tree().nearest(mesh.vertices[v]).triangle][0]; },
        costly_block);
    return before;
  }

  void keep_around(const TriangleMesh& mesh, const std::vector<std::uint8_t>& bad, int round) {
    std::vector<std::uint8_t> near(full_.vertices.size(), 0);
    for (std::size_t v = 0; v < bad.size(); ++v)
      if (bad[v])
        for (const std::uint32_t u : full_.triangles[surface_.tree().nearest(mesh.vertices[v]).triangle]) near[u] = 1;
    widen(full_, 1 << round, near);
    for (std::size_t t = 0; t < kept_.size(); ++t)
      for (const std::uint32_t v : full_.triangles[t]) kept_[t] |= near[v];
  }

  const TriangleMesh& full_;
  const FullSurface& surface_;
  double edge_, spacing_;
  const Threads& threads_;
  PieceSides sides_;
  std::vector<std::uint8_t> kept_; ///< of each triangle before
  Vec3 centre_;
};

} // namespace

OtherTriangles remesh(const TriangleMesh& full, const FullSurface& surface, double edge, double spacing,
                      const Threads& threads) {
  const double expected = expected_triangles(full, edge);
  require_reasonable(expected, edge);
  const auto enough = static_cast<std::size_t>(finer * expected);
  if (full.triangles.size() <= 2 * enough) return Remeshing(full, surface, edge, spacing, threads).run();
  const OtherTriangles fewer =
      simplify(full, surface, {enough, std::numeric_limits<double>::infinity()}, spacing, threads);
  OtherTriangles result = Remeshing(fewer.mesh, {fewer.mesh, threads}, edge, spacing, threads).run();
  result.deviation = surface.measure(result.mesh, threads);
  return result;
}

ShapeReport shape_of(const TriangleMesh& mesh, double edge, const Threads& threads) {
  ShapeReport shape;
  shape.edges.assign(bins, 0);
  for_each_edge(sorted_sides(mesh.triangles, mesh.vertices.size(), threads), [&](std::span<const Side> sides) {
    const double length = distance(mesh.vertices[sides[0].low], mesh.vertices[sides[0].high]);
    ++shape.edges[static_cast<std::size_t>(std::min(bins_of_length * length / edge, bins - 1.0))];
  });
  std::vector<double> angles(mesh.triangles.size());
  for_each_index(threads, angles.size(), [&](std::size_t t) {
    double least = 180;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.vertices[mesh.triangles[t][k]];
      const Vec3 a = mesh.vertices[mesh.triangles[t][(k + 1) % 3]] - p;
      const Vec3 b = mesh.vertices[mesh.triangles[t][(k + 2) % 3]] - p;
      least = std::min(least, std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi);
    }
    angles[t] = least;
  });
  if (angles.empty()) return shape;
  shape.low_angle = quantile(angles, 0.01);
  shape.least_angle = *std::min_element(angles.begin(), angles.end());
  return shape;
}

} // namespace eigencrust
