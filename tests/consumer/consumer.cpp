// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <iostream>
#include <numbers>

#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>
#include <eigencrust/render.h>
#include <eigencrust/stages.h>
#include <eigencrust/validate.h>

namespace {

/// Points on the unit sphere along a spiral with the golden angle.
eigencrust::PointCloud sphere(int n) {
  eigencrust::PointCloud cloud;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - z * z), a = i * std::numbers::pi * (3 - std::sqrt(5.0));
    cloud.points.push_back({r * std::cos(a), r * std::sin(a), z});
  }
  return cloud;
}

int complain(const char* what) {
  std::cerr << "consumer: " << what << "\n";
  return 1;
}

} // namespace

int main(int argc, char** argv) {
  using namespace eigencrust;
  if (argc < 3) return complain("give the names of a mesh and of a picture to write");
  const Result result = reconstruct(sphere(1000));
  const MeshSummary& mesh = result.report.mesh;
  if (!mesh.closed() || !mesh.manifold() || mesh.genus != 0) return complain("the sphere is no closed sphere");
  if (std::abs(mesh.volume / (4 * std::numbers::pi / 3) - 1) > 0.02) return complain("the volume is wrong");

  // Each of the other private dependencies is called once, so that one missing at link time is noticed.
  write_mesh(argv[1], result.mesh);
  if (sha256_of_file(argv[1]).size() != 64) return complain("no hash");
  if (read_mesh(argv[1]).triangles.size() != result.mesh.triangles.size()) return complain("the file differs");
  write_png(argv[2], render(result.mesh, {}));
  try {
    reconstruct(PointCloud{});
    return complain("no points, no complaint");
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) return complain("wrong kind of error");
  }
  std::cout << "consumer: eigencrust " << version() << " works, " << mesh.triangles << " triangles\n";
  return 0;
}
