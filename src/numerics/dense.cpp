// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/dense.h"

#include <Eigen/Eigenvalues>

namespace eigencrust {

Eigen::MatrixXd to_dense(const BorderedMatrix& m) {
  const std::uint32_t n = m.interior_size();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(m.size(), m.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    dense(i, i) = m.diagonal[i];
    for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e)
      dense(i, m.column[e]) = static_cast<double>(m.value[e]);
    for (std::uint32_t s = 0; s < m.border_size(); ++s)
      dense(i, n + s) = dense(n + s, i) = static_cast<double>(m.border[s][i]);
  }
  for (std::uint32_t s = 0; s < m.border_size(); ++s)
    for (std::uint32_t t = 0; t < m.border_size(); ++t) dense(n + s, n + t) = m.corner[s][t];
  return dense;
}

double smallest_eigenvector_dense(const BorderedMatrix& matrix, const Vector& mass, Vector& x) {
  x.assign(matrix.size(), 0);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < matrix.size(); ++i)
    if (mass[i] > 0) kept.push_back(i);
  if (kept.empty()) return 0;
  Eigen::MatrixXd a = to_dense(matrix)(kept, kept);
  Eigen::VectorXd scale(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) scale(i) = 1 / std::sqrt(mass[kept[static_cast<std::size_t>(i)]]);
  a = (scale.asDiagonal() * a * scale.asDiagonal()).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (a + a.transpose()));
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    x[kept[static_cast<std::size_t>(i)]] = solver.eigenvectors()(i, 0) * scale(i);
  return solver.eigenvalues()(0);
}

} // namespace eigencrust
