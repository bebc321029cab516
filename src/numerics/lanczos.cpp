// SPDX-License-Identifier: GPL-3.0-or-later
#include <Spectra/SymEigsSolver.h>

#include <algorithm>
#include <cmath>

#include "numerics/eigenvector.h"

namespace eigencrust {
namespace {

/// y = (2I - D^-1/2 M D^-1/2) x, as Spectra asks for it.
class ShiftedOperator {
 public:
  using Scalar = double;

  ShiftedOperator(const BorderedMatrix& matrix, const Vector& mass, const IterationControl& control,
                  const Threads& threads)
      : matrix_(matrix), control_(control), threads_(threads), inverse_root_(mass.size()), in_(mass.size()) {
    for (std::size_t i = 0; i < mass.size(); ++i) inverse_root_[i] = mass[i] > 0 ? 1 / std::sqrt(mass[i]) : 0;
  }
  Eigen::Index rows() const { return static_cast<Eigen::Index>(inverse_root_.size()); }
  Eigen::Index cols() const { return rows(); }

  void perform_op(const double* x, double* y) const {
    if (control_.checkpoint && products_++ % 32 == 0) control_.checkpoint(0.0);
    const std::size_t n = inverse_root_.size();
    for (std::size_t i = 0; i < n; ++i) in_[i] = inverse_root_[i] * x[i];
    multiply(matrix_, in_, out_, threads_);
    // Rows without mass are given the eigenvalue 0 of this operator, the far end of the spectrum.
    for (std::size_t i = 0; i < n; ++i) y[i] = inverse_root_[i] > 0 ? 2 * x[i] - inverse_root_[i] * out_[i] : 0;
  }
  const Vector& inverse_root() const { return inverse_root_; }

 private:
  const BorderedMatrix& matrix_;
  const IterationControl& control_;
  const Threads& threads_;
  Vector inverse_root_;
  mutable Vector in_, out_;
  mutable std::size_t products_ = 0;
};

double residual_norm(const BorderedMatrix& matrix, const Vector& mass, const Vector& x, double eigenvalue,
                     const Threads& threads) {
  Vector mx;
  multiply(matrix, x, mx, threads);
  double square = 0, size = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(mass[i] > 0)) continue;
    const double r = mx[i] - eigenvalue * mass[i] * x[i];
    square += r * r / mass[i];
    size += mass[i] * x[i] * x[i];
  }
  return std::sqrt(square / size);
}

} // namespace

IterationResult smallest_eigenvector_lanczos(const BorderedMatrix& matrix, const Vector& mass,
                                             const IterationControl& control, const Threads& threads) {
  IterationResult result;
  const auto n = static_cast<Eigen::Index>(matrix.size());
  ShiftedOperator op(matrix, mass, control, threads);
  Spectra::SymEigsSolver<ShiftedOperator> solver(op, 1, std::min<Eigen::Index>(n, 60));
  solver.init();
  // Spectra tests its residual estimate against tolerance × |eigenvalue|, here close to 2.
  const Eigen::Index converged = solver.compute(Spectra::SortRule::LargestAlge,
                                                static_cast<Eigen::Index>(control.max_steps), control.tolerance / 2);
  result.steps = static_cast<std::uint32_t>(solver.num_operations());
  if (converged < 1) return result;
  const Eigen::VectorXd y = solver.eigenvectors(1).col(0);
  result.x.resize(matrix.size());
  for (std::size_t i = 0; i < result.x.size(); ++i)
    result.x[i] = op.inverse_root()[i] * y(static_cast<Eigen::Index>(i));
  result.eigenvalue = 2 - solver.eigenvalues()(0);
  result.residual = residual_norm(matrix, mass, result.x, result.eigenvalue, threads);
  result.status = result.residual <= control.tolerance * 10 ? SolverStatus::converged : SolverStatus::not_converged;
  return result;
}

} // namespace eigencrust
