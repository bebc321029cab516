// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that knows which code computes regular triangulations.
#include "crusts/power_diagram.h"

#include "tetrahedra/insertion_rounds.h"

#include <CGAL/Cartesian_converter.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace eigencrust {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel,
                                                               CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Regular = CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

/// Balls that no cell is left for, hidden by others, are no vertices.
Regular triangulation_of(std::span<const Sphere> balls) {
  Regular regular;
  Regular::Cell_handle hint;
  for (const std::uint32_t i : in_rounds(static_cast<std::uint32_t>(balls.size()))) {
    const auto& [centre, radius] = balls[i];
    const Regular::Vertex_handle v =
        regular.insert(Regular::Weighted_point({centre.x, centre.y, centre.z}, radius * radius), hint);
    if (v == Regular::Vertex_handle()) continue;
    v->info() = i;
    hint = v->cell();
  }
  return regular;
}

// Below this share of its longest edge's cube the six-fold volume of a tetrahedron of doubles says little: with poles
// of nearly cospherical samples such flat ones are many.
constexpr double flat_share = 1e-6;

/// The point of equal power distance from the four balls of a cell. Cells are not flat by exact arithmetic, which flat
/// looking ones get here, too.
Vec3 dual_of(const Regular& regular, Regular::Cell_handle cell) {
  const auto at = [&](int k) { return cell->vertex(k)->point().point(); };
  double longest = 0;
  for (int i = 0; i < 4; ++i)
    for (int k = i + 1; k < 4; ++k) longest = std::max(longest, CGAL::squared_distance(at(i), at(k)));
  const double volume = std::abs(CGAL::determinant(at(1) - at(0), at(2) - at(0), at(3) - at(0)));
  if (volume > flat_share * longest * std::sqrt(longest)) {
    const auto centre = regular.dual(cell);
    return {centre.x(), centre.y(), centre.z()};
  }
  using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
  const CGAL::Cartesian_converter<Kernel, Exact> exact;
  const auto ball = [&](int k) { return exact(cell->vertex(k)->point()); };
  const auto centre = Exact().construct_weighted_circumcenter_3_object()(ball(0), ball(1), ball(2), ball(3));
  return {CGAL::to_double(centre.x()), CGAL::to_double(centre.y()), CGAL::to_double(centre.z())};
}

/// The cells around an edge from ball a to ball b; nothing where one of them is infinite.
std::vector<std::uint32_t> polygon_around(const Regular& regular, const Regular::Edge& edge) {
  std::vector<std::uint32_t> polygon;
  auto cell = regular.incident_cells(edge);
  const auto first = cell;
  do {
    if (regular.is_infinite(cell)) return {};
    polygon.push_back(cell->info());
  } while (++cell != first);
  // The circulator turns counter-clockwise seen against the edge, from its second end.
  return polygon;
}

} // namespace

PowerDiagram power_diagram(std::span<const Sphere> balls) {
  Regular regular = triangulation_of(balls);
  PowerDiagram diagram;
  diagram.begin.push_back(0);
  for (const auto c : regular.finite_cell_handles()) {
    c->info() = static_cast<std::uint32_t>(diagram.vertices.size());
    diagram.vertices.push_back(dual_of(regular, c));
  }
  if (regular.dimension() < 3) return diagram;
  // The engine names an edge by whichever of its cells lies first in memory: so each gets a form of its own here.
  std::vector<std::pair<std::array<std::uint32_t, 2>, Regular::Edge>> edges;
  for (const Regular::Edge& edge : regular.finite_edges()) {
    const auto& [cell, i, k] = edge;
    const std::uint32_t a = cell->vertex(i)->info(), b = cell->vertex(k)->info();
    edges.push_back(a < b ? std::pair{std::array{a, b}, edge} : std::pair{std::array{b, a}, Regular::Edge{cell, k, i}});
  }
  std::sort(edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [balls_of_edge, edge] : edges) {
    diagram.facets.push_back(balls_of_edge);
    auto polygon = polygon_around(regular, edge);
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
    diagram.corners.insert(diagram.corners.end(), polygon.begin(), polygon.end());
    diagram.begin.push_back(diagram.corners.size());
  }
  return diagram;
}

} // namespace eigencrust
