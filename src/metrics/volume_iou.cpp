// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <string>

#include <eigencrust/error.h>
#include <eigencrust/metrics.h>

#include "geometry/mesh_topology.h"
#include "parallel/compressed_rows.h"

namespace eigencrust {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// A place in the plane that the columns stand on.
struct Place {
  double x, y;
};

/// Sign of the turn a -> b -> c, exact.
int turn(const Place& a, const Place& b, const Place& c) {
  return static_cast<int>(
      CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y), Kernel::Point_2(c.x, c.y)));
}

/// The same with c shifted by (e, e²) for an infinitely small e > 0: never 0 for a ≠ b. So a column
/// through an edge or a vertex of a closed surface crosses it as evenly as any other.
int turn_shifted(const Place& a, const Place& b, const Place& c) {
  const int sign = turn(a, b, c);
  if (sign != 0) return sign;
  if (a.y != b.y) return a.y < b.y ? -1 : 1;
  return a.x < b.x ? 1 : a.x > b.x ? -1 : 0;
}

/// The columns: `count` × `count` lines parallel to z in the middle of the cells of a grid.
struct Columns {
  double x0, y0, dx, dy;
  std::uint32_t count;

  [[nodiscard]] Place place(std::uint32_t i, std::uint32_t j) const {
    return {x0 + (i + 0.5) * dx, y0 + (j + 0.5) * dy};
  }

  /// Numbers of the columns that may lie in [lo, hi]; one too many at either end does no harm.
  static std::pair<std::uint32_t, std::uint32_t> range(double lo, double hi, double origin, double step,
                                                       std::uint32_t n) {
    const double last = n - 1.0;
    const double from = std::clamp(std::floor((lo - origin) / step - 0.5) - 1, 0.0, last);
    const double to = std::clamp(std::ceil((hi - origin) / step - 0.5) + 1, 0.0, last);
    return {static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to)};
  }
};

/// A surface crosses a column at height z; `step` is added to its winding number there.
struct Crossing {
  double z;
  std::int32_t step;
  std::uint32_t mesh; ///< 0 or 1
};

/// Crossings of one row of columns with one triangle go into `row`.
void cross_triangle(const std::array<Vec3, 3>& v, std::uint32_t mesh, const Columns& columns, std::uint32_t j,
                    std::vector<std::vector<Crossing>>& row) {
  const Place a{v[0].x, v[0].y}, b{v[1].x, v[1].y}, c{v[2].x, v[2].y};
  const int facing = turn(a, b, c);
  if (facing == 0) return; // seen edge-on
  const auto [from, to] =
      Columns::range(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), columns.x0, columns.dx, columns.count);
  const double lowest = std::min({v[0].z, v[1].z, v[2].z}), highest = std::max({v[0].z, v[1].z, v[2].z});
  for (std::uint32_t i = from; i <= to; ++i) {
    const Place p = columns.place(i, j);
    if (turn_shifted(a, b, p) != facing || turn_shifted(b, c, p) != facing || turn_shifted(c, a, p) != facing) continue;
    const auto area = [&](const Place& s, const Place& t) {
      return (s.x - p.x) * (t.y - p.y) - (s.y - p.y) * (t.x - p.x);
    };
    const double wa = area(b, c), wb = area(c, a), wc = area(a, b), sum = wa + wb + wc;
    const double z = sum != 0 ? (wa * v[0].z + wb * v[1].z + wc * v[2].z) / sum : lowest;
    row[i].push_back({std::clamp(z, lowest, highest), -facing, mesh}); // facing up: the way up leaves the body
  }
}

/// Lengths along one column inside both and inside either. \return false when the winding number does
/// not come back to 0.
bool integrate(std::vector<Crossing>& column, double& both, double& either) {
  std::sort(column.begin(), column.end(), [](const Crossing& a, const Crossing& b) { return a.z < b.z; });
  std::array<std::int64_t, 2> winding{0, 0};
  for (std::size_t k = 0; k < column.size(); ++k) {
    winding[column[k].mesh] += column[k].step;
    if (k + 1 == column.size()) break;
    const double length = column[k + 1].z - column[k].z;
    if (winding[0] != 0 && winding[1] != 0) both += length;
    if (winding[0] != 0 || winding[1] != 0) either += length;
  }
  return winding[0] == 0 && winding[1] == 0;
}

struct MeshTriangle {
  std::uint32_t triangle, mesh;
};

/// Triangles of both meshes by the rows of columns they may cross.
CompressedRows<MeshTriangle> rows_of(const std::array<const TriangleMesh*, 2>& meshes, const Columns& columns) {
  return build_rows<MeshTriangle>(columns.count, [&](auto&& visit) {
    for (std::uint32_t m = 0; m < 2; ++m)
      for (std::uint32_t t = 0; t < meshes[m]->triangles.size(); ++t) {
        Box3 box;
        for (const std::uint32_t v : meshes[m]->triangles[t]) box.add(meshes[m]->vertices[v]);
        const auto [from, to] = Columns::range(box.min.y, box.max.y, columns.y0, columns.dy, columns.count);
        for (std::uint32_t j = from; j <= to; ++j) visit(j, MeshTriangle{t, m});
      }
  });
}

/// Box of the vertices in use. \throws Error{input}
Box3 checked_bounds(const std::array<const TriangleMesh*, 2>& meshes) {
  Box3 box;
  for (const TriangleMesh* mesh : meshes) {
    require_valid_indices(*mesh, "volume overlap");
    if (mesh->triangles.empty())
      throw Error(ErrorKind::input, "volume overlap", "a mesh has no triangles", "give two closed meshes");
    for (const Triangle& t : mesh->triangles)
      for (const std::uint32_t v : t) {
        if (!is_finite(mesh->vertices[v]))
          throw Error(ErrorKind::input, "volume overlap", "vertex " + std::to_string(v) + " is not finite",
                      "repair the mesh");
        box.add(mesh->vertices[v]);
      }
  }
  return box;
}

} // namespace

double volume_iou(const TriangleMesh& a, const TriangleMesh& b, std::uint32_t columns, unsigned threads) {
  const std::array<const TriangleMesh*, 2> meshes{&a, &b};
  const Box3 box = checked_bounds(meshes);
  if (columns == 0 || columns > 65536)
    throw Error(ErrorKind::usage, "volume overlap", "the number of columns is not in 1 to 65536", "choose one that is");
  const Columns grid{box.min.x, box.min.y, (box.max.x - box.min.x) / columns, (box.max.y - box.min.y) / columns,
                     columns};
  if (!(grid.dx > 0) || !(grid.dy > 0)) return 0; // flat: nothing inside
  const auto rows = rows_of(meshes, grid);

  struct Sum {
    double both = 0, either = 0;
    std::uint64_t unbalanced = 0;
    Sum operator+(const Sum& o) const { return {both + o.both, either + o.either, unbalanced + o.unbalanced}; }
  };
  const Sum sum = sum_blocks<Sum>(
      Threads(threads), columns,
      [&](std::size_t begin, std::size_t end) {
        Sum part;
        std::vector<std::vector<Crossing>> row(columns);
        for (std::size_t j = begin; j < end; ++j) {
          for (auto& column : row) column.clear();
          for (const MeshTriangle& entry : rows[j]) {
            const TriangleMesh& mesh = *meshes[entry.mesh];
            const Triangle& t = mesh.triangles[entry.triangle];
            cross_triangle({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, entry.mesh, grid,
                           static_cast<std::uint32_t>(j), row);
          }
          for (auto& column : row)
            if (!integrate(column, part.both, part.either)) ++part.unbalanced;
        }
        return part;
      },
      4);
  if (sum.unbalanced > 0)
    throw Error(ErrorKind::input, "volume overlap",
                "a mesh is not closed and oriented: " + std::to_string(sum.unbalanced) +
                    " lines leave it fewer times "
                    "than they enter it or more often",
                "close the mesh");
  return sum.either > 0 ? sum.both / sum.either : 0;
}

} // namespace eigencrust
