// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/view_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eigencrust {
namespace {

/// The cube of each vertex, numbered from 0 on along the grid.
std::vector<std::uint32_t> cubes(const TriangleMesh& mesh, const Vec3& corner, double edge, std::uint32_t& count) {
  using Cell = std::array<std::int64_t, 3>;
  std::vector<Cell> cell;
  cell.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    const Vec3 p = (1 / edge) * (v - corner);
    cell.push_back({static_cast<std::int64_t>(p.x), static_cast<std::int64_t>(p.y), static_cast<std::int64_t>(p.z)});
  }
  std::vector<std::uint32_t> order(cell.size()), cube(cell.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return cell[a] < cell[b]; });
  count = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && cell[order[k]] != cell[order[k - 1]]) ++count;
    cube[order[k]] = count;
  }
  count += order.empty() ? 0 : 1;
  return cube;
}

ViewMesh clustered(const TriangleMesh& mesh, const Vec3& corner, double edge) {
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> cube = cubes(mesh, corner, edge, count);
  ViewMesh view;
  std::vector<double> members(count, 0);
  view.mesh.vertices.resize(count);
  for (std::size_t v = 0; v < cube.size(); ++v) {
    view.mesh.vertices[cube[v]] = view.mesh.vertices[cube[v]] + (mesh.vertices[v] - corner);
    ++members[cube[v]];
  }
  for (std::uint32_t c = 0; c < count; ++c) view.mesh.vertices[c] = corner + (1 / members[c]) * view.mesh.vertices[c];
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    if (cube[a] == cube[b] || cube[b] == cube[c] || cube[c] == cube[a]) continue;
    view.mesh.triangles.push_back({cube[a], cube[b], cube[c]});
    view.triangle.push_back(i);
  }
  return view;
}

} // namespace

ViewMesh view_mesh(const TriangleMesh& mesh, std::size_t most) {
  ViewMesh view;
  if (mesh.triangles.size() <= most) {
    view.mesh.vertices = mesh.vertices;
    view.mesh.triangles = mesh.triangles;
    view.triangle.resize(mesh.triangles.size());
    std::iota(view.triangle.begin(), view.triangle.end(), 0u);
    return view;
  }
  Box3 box;
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area += norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a])) / 2;
    for (const std::uint32_t v : {a, b, c}) box.add(mesh.vertices[v]);
  }
  // Cubes that a flat surface meets have two triangles each; a step finer than needed is tried first.
  constexpr double step = 1.15;
  const double smallest = 1e-9 * box.diagonal();
  double edge = std::max(std::sqrt(2 * area / static_cast<double>(most)) / step, smallest);
  do {
    view = clustered(mesh, box.min, edge);
    edge *= step;
  } while (view.mesh.triangles.size() > most);
  return view;
}

} // namespace eigencrust
