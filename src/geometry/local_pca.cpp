// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/local_pca.h"

#include <Eigen/Eigenvalues>

namespace eigencrust {

LocalPca local_pca(std::span<const Vec3> positions, std::span<const std::uint32_t> points, const Vec3& origin) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : points) {
    const Vec3 d = positions[i] - origin;
    const Eigen::Vector3d e(d.x, d.y, d.z);
    mean += e;
    moments += e * e.transpose();
  }
  const double n = static_cast<double>(points.size());
  mean /= n;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments / n - mean * mean.transpose());
  const Eigen::Vector3d variance = solver.eigenvalues().cwiseMax(0.0), normal = solver.eigenvectors().col(0);
  return {{mean[0], mean[1], mean[2]}, {variance[0], variance[1], variance[2]}, {normal[0], normal[1], normal[2]}};
}

} // namespace eigencrust
