// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/local_frame.h"

#include <Eigen/Eigenvalues>

namespace eigencrust {

LocalFrame local_frame(std::span<const Vec3> points, std::span<const std::uint32_t> index, const Vec3& near,
                       std::span<const double> weight) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double total = 0;
  for (std::size_t k = 0; k < index.size(); ++k) {
    const Vec3 d = points[index[k]] - near;
    const double w = weight.empty() ? 1 : weight[k];
    const Eigen::Vector3d e(d.x, d.y, d.z);
    sum += w * e;
    moments += w * e * e.transpose();
    total += w;
  }
  const Eigen::Vector3d mean = sum / total;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments / total - mean * mean.transpose());
  LocalFrame frame;
  frame.mean = near + Vec3{mean[0], mean[1], mean[2]};
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = solver.eigenvectors().col(k);
    frame.axis[static_cast<std::size_t>(k)] = {axis[0], axis[1], axis[2]};
    frame.variance[static_cast<std::size_t>(k)] = std::max(0.0, solver.eigenvalues()[k]);
  }
  return frame;
}

} // namespace eigencrust
