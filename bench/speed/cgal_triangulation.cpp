// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal_triangulation.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <vector>

#include <eigencrust/io.h>

namespace eigencrust::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel>;

std::vector<Kernel::Point_3> points_of(const std::filesystem::path& path) {
  const PointCloud cloud = read_point_cloud(path);
  std::vector<Kernel::Point_3> points;
  points.reserve(cloud.points.size());
  for (const Vec3& p : cloud.points)
    if (is_finite(p)) points.emplace_back(p.x, p.y, p.z);
  return points;
}

} // namespace

std::string time_cgal(const std::filesystem::path& path) {
  const std::vector<Kernel::Point_3> points = points_of(path);
  const auto start = std::chrono::steady_clock::now();
  Triangulation triangulation;
  triangulation.insert(points.begin(), points.end());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return nlohmann::ordered_json{{"points", points.size()},
                                {"vertices", triangulation.number_of_vertices()},
                                {"tetrahedra", triangulation.number_of_finite_cells()},
                                {"seconds", seconds}}
      .dump();
}

} // namespace eigencrust::bench
