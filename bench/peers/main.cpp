// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// eigencrust-peers METHOD CLOUD MESH: one reconstruction of CGAL, for eigencrust-quality.
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include <eigencrust/io.h>

#include "peers.h"

int main(int argc, char** argv) {
  using namespace eigencrust;
  using namespace eigencrust::bench;
  const std::map<std::string, std::function<TriangleMesh(const Points&)>> methods{
      {"poisson", cgal_poisson},
      {"advancing-front", cgal_advancing_front},
      {"scale-space", cgal_scale_space},
      {"alpha-wrap", cgal_alpha_wrap}};
  const auto method = argc == 4 ? methods.find(argv[1]) : methods.end();
  if (method == methods.end()) {
    std::cerr << "eigencrust-peers METHOD CLOUD MESH, METHOD one of";
    for (const auto& [name, unused] : methods) std::cerr << " " << name;
    std::cerr << "\n";
    return EXIT_FAILURE;
  }
  try {
    Points points;
    for (const Vec3& p : read_point_cloud(argv[2]).points) points.emplace_back(p.x, p.y, p.z);
    write_mesh(argv[3], method->second(points));
  } catch (const std::exception& error) {
    std::cerr << "eigencrust-peers: error: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
