// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/eigenvector.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "numerics/dense.h"

namespace eigencrust {
namespace {

// On coarse levels a step costs next to nothing; signs settle long before.
constexpr std::uint32_t coarse_steps = 12;
constexpr double coarse_stable_share = 1e-3;
// A value that would be 0 after this many more steps like the last is not settled (docs/decisions/0019).
constexpr double steps_ahead = 4;
// More of such values, and the iteration goes on.
constexpr double most_unsettled = 1e-3;
// A consistent graph has eigenvalue 0 up to the rounding of float weights.
constexpr double consistent_eigenvalue = 1e-10;

bool signs_are_stable(const std::vector<std::uint32_t>& changes, double residual, std::size_t n,
                      const IterationControl& control) {
  if (!control.stop_on_stable_signs || residual > control.stable_residual ||
      changes.size() < std::max(2u, control.min_steps))
    return false;
  const double limit = control.stable_share * static_cast<double>(n);
  return changes.back() <= limit && changes[changes.size() - 2] <= limit;
}

/// What one pass over the vectors of a step tells.
struct Progress {
  double square = 0; ///< of the residual's norm
  std::uint32_t changes = 0;
  Progress operator+(const Progress& other) const { return {square + other.square, changes + other.changes}; }
};

/// Inner products of x, w and p with each other, D in between (upper triangle), and with their products with M.
struct GramSums {
  std::array<double, 6> mass{}, matrix{};
  GramSums& operator+=(const GramSums& other) {
    for (std::size_t k = 0; k < 6; ++k) {
      mass[k] += other.mass[k];
      matrix[k] += other.matrix[k];
    }
    return *this;
  }
  friend GramSums operator+(GramSums a, const GramSums& b) { return a += b; }
};

/// Coefficients of the smallest Ritz vector in the span of x, w and p, of D-norm 1, and its value.
struct Ritz {
  double x = 1, w = 0, p = 0, value = 0;
};

std::optional<Ritz> smallest_ritz(const GramSums& sums, int size) {
  Eigen::MatrixXd mass(size, size), matrix(size, size);
  constexpr int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  Eigen::VectorXd scale(size);
  for (int i = 0; i < size; ++i) {
    const double square = sums.mass[static_cast<std::size_t>(at[i][i])];
    if (!(square > std::numeric_limits<double>::min()) || !std::isfinite(square)) return std::nullopt;
    scale(i) = 1 / std::sqrt(square);
  }
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      mass(i, j) = sums.mass[static_cast<std::size_t>(at[i][j])] * scale(i) * scale(j);
      matrix(i, j) = sums.matrix[static_cast<std::size_t>(at[i][j])] * scale(i) * scale(j);
    }
  // Nearly dependent directions: one fewer will do.
  if (const Eigen::LLT<Eigen::MatrixXd> factors(mass);
      factors.info() != Eigen::Success || factors.matrixLLT().diagonal().minCoeff() < 1e-6)
    return std::nullopt;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, mass);
  if (solver.info() != Eigen::Success || !solver.eigenvectors().allFinite()) return std::nullopt;
  Eigen::VectorXd c = solver.eigenvectors().col(0).cwiseProduct(scale);
  if (c(0) < 0) c = -c;
  return Ritz{c(0), c(1), size > 2 ? c(2) : 0.0, solver.eigenvalues()(0)};
}

double inner_product(const Vector& a, const FloatVector& b, const Threads& threads) {
  return sum_blocks<double>(threads, a.size(), [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) part += a[i] * static_cast<double>(b[i]);
    return part;
  });
}

/// One level of the eigenproblem: the iterate x, the last step p, and the preconditioned residual w.
class LobpcgLevel {
 public:
  LobpcgLevel(const SignedMultigrid& hierarchy, std::size_t level, Vector start, SignedMultigrid::Workspace& workspace,
              const Threads& threads)
      : hierarchy_(hierarchy),
        level_(level),
        matrix_(hierarchy.levels()[level].matrix),
        mass_(hierarchy.levels()[level].mass),
        workspace_(workspace),
        threads_(threads),
        x_(std::move(start)),
        p_(x_.size(), 0),
        mp_(x_.size(), 0),
        residual_(x_.size()) {
    // Where every edge cancels on the way down, nothing comes back up: begin anywhere but at zero, which
    // would pass for a perfect eigenvector.
    if (!scale_to_unit(x_)) {
      for (std::size_t i = 0; i < x_.size(); ++i)
        x_[i] = mass_[i] > 0 ? std::remainder(static_cast<double>(i + 1) * 0.6180339887498949, 1.0) : 0.0;
      scale_to_unit(x_);
    }
    multiply(matrix_, x_, mx_, threads_);
    advance({1, 0, 0, inner_product(x_, mx_, threads_)});
  }

  double eigenvalue() const { return eigenvalue_; }
  double residual_norm() const { return residual_norm_; }
  std::size_t size() const { return x_.size(); }
  Vector take() { return std::move(x_); }

  /// \returns how many signs changed
  std::uint32_t step() {
    hierarchy_.cycle(level_, residual_, z_, workspace_, threads_);
    const double along = sum_blocks<double>(threads_, x_.size(), [&](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i) part += x_[i] * mass_[i] * static_cast<double>(z_[i]);
      return part;
    });
    w_.resize(x_.size());
    for_each_index(threads_, x_.size(), [&](std::size_t i) { w_[i] = static_cast<double>(z_[i]) - along * x_[i]; });
    multiply(matrix_, w_, mw_, threads_);
    const GramSums sums = gram();
    std::optional<Ritz> ritz = has_p_ ? smallest_ritz(sums, 3) : std::nullopt;
    if (!ritz) ritz = smallest_ritz(sums, 2);
    if (!ritz) return 0;
    has_p_ = true;
    return advance(*ritz);
  }

  /// Nodes that changed sign in the last step, or would within `steps` more steps like it.
  std::vector<std::uint8_t> unsettled(double steps) const {
    std::vector<std::uint8_t> result(matrix_.interior_size());
    for_each_index(threads_, result.size(), [&](std::size_t i) {
      const double before = (x_[i] - p_[i]) / last_x_, step = x_[i] - before;
      result[i] = before * x_[i] <= 0 || (x_[i] + steps * step) * x_[i] <= 0;
    });
    return result;
  }

 private:
  GramSums gram() const {
    return sum_blocks<GramSums>(threads_, x_.size(), [&](std::size_t begin, std::size_t end) {
      GramSums s;
      for (std::size_t i = begin; i < end; ++i) {
        const double x = x_[i], w = w_[i], p = p_[i], dx = mass_[i] * x, dw = mass_[i] * w, dp = mass_[i] * p;
        const std::array<double, 6> d{x * dx, x * dw, x * dp, w * dw, w * dp, p * dp};
        const std::array<double, 6> m{x * mx_[i], x * mw_[i], x * mp_[i], w * mw_[i], w * mp_[i], p * mp_[i]};
        for (std::size_t k = 0; k < 6; ++k) {
          s.mass[k] += d[k];
          s.matrix[k] += m[k];
        }
      }
      return s;
    });
  }

  /// x <- c_x x + p, p <- c_w w + c_p p, and all that follows from them, in one pass.
  std::uint32_t advance(const Ritz& c) {
    const bool has_w = !w_.empty();
    const Progress sums = sum_blocks<Progress>(threads_, x_.size(), [&](std::size_t begin, std::size_t end) {
      Progress s;
      for (std::size_t i = begin; i < end; ++i) {
        const double before = x_[i];
        if (has_w) {
          p_[i] = c.w * w_[i] + c.p * p_[i];
          mp_[i] = c.w * mw_[i] + c.p * mp_[i];
          x_[i] = c.x * before + p_[i];
          mx_[i] = c.x * mx_[i] + mp_[i];
        }
        const double r = mx_[i] - c.value * mass_[i] * x_[i];
        residual_[i] = static_cast<float>(r);
        if (mass_[i] > 0) s.square += r * r / mass_[i];
        s.changes += (before > 0) != (x_[i] > 0);
      }
      return s;
    });
    eigenvalue_ = c.value;
    residual_norm_ = std::sqrt(sums.square);
    last_x_ = c.x;
    return sums.changes;
  }

  bool scale_to_unit(Vector& v) {
    const double size = std::sqrt(weighted_product(v, mass_, v, threads_));
    if (!(size > std::numeric_limits<double>::min()) || !std::isfinite(size)) return false;
    for_each_index(threads_, v.size(), [&](std::size_t i) { v[i] /= size; });
    return true;
  }

  const SignedMultigrid& hierarchy_;
  std::size_t level_;
  const BorderedMatrix& matrix_;
  const Vector& mass_;
  SignedMultigrid::Workspace& workspace_;
  const Threads& threads_;
  Vector x_, mx_, p_, mp_, w_, mw_;
  FloatVector residual_, z_;
  bool has_p_ = false;
  double eigenvalue_ = 0, residual_norm_ = 0, last_x_ = 1;
};

} // namespace

IterationResult smallest_eigenvector(const SignedMultigrid& hierarchy, const IterationControl& control,
                                     const Threads& threads) {
  IterationResult result;
  const std::size_t coarsest = hierarchy.levels().size() - 1;
  SignedMultigrid::Workspace workspace = hierarchy.workspace();
  Vector x;
  result.eigenvalue =
      smallest_eigenvector_dense(hierarchy.levels()[coarsest].matrix, hierarchy.levels()[coarsest].mass, x);
  IterationControl coarse_control = control;
  coarse_control.stop_on_stable_signs = true;
  coarse_control.stable_share = std::max(control.stable_share, coarse_stable_share);
  for (std::size_t level = coarsest; level-- > 0;) {
    Vector start;
    hierarchy.prolongate(level, x, start, threads);
    LobpcgLevel iteration(hierarchy, level, std::move(start), workspace, threads);
    const IterationControl& rule = level == 0 ? control : coarse_control;
    const std::uint32_t limit = level == 0 ? control.max_steps : coarse_steps;
    std::vector<std::uint32_t> changes;
    bool settled = false;
    while (changes.size() < limit) {
      if (control.checkpoint) control.checkpoint(level == 0 ? static_cast<double>(changes.size()) / limit : 0.0);
      changes.push_back(iteration.step());
      if (iteration.residual_norm() <= control.tolerance) break;
      if (!signs_are_stable(changes, iteration.residual_norm(), iteration.size(), rule)) continue;
      if (level > 0) break;
      // A whole part of the object may be about to change sides without a single sign changing now.
      const std::vector<std::uint8_t> open = iteration.unsettled(steps_ahead);
      settled = static_cast<double>(std::count(open.begin(), open.end(), 1)) <=
                most_unsettled * static_cast<double>(iteration.size());
      if (settled) break;
    }
    if (level == 0) {
      result.status = iteration.residual_norm() <= control.tolerance ? SolverStatus::converged
                      : settled                                      ? SolverStatus::signs_stable
                                                                     : SolverStatus::not_converged;
      result.residual = iteration.residual_norm();
      result.eigenvalue = iteration.eigenvalue();
      result.steps = static_cast<std::uint32_t>(changes.size());
      result.sign_changes = std::move(changes);
      if (control.stop_on_stable_signs && result.status != SolverStatus::converged)
        result.unsettled = iteration.unsettled(steps_ahead);
    }
    x = iteration.take();
  }
  if (coarsest == 0) result.status = SolverStatus::converged;
  if (result.eigenvalue < consistent_eigenvalue && result.status != SolverStatus::not_converged)
    result.status = SolverStatus::consistent;
  result.x = std::move(x);
  return result;
}

IterationResult conjugate_gradients(const SignedMultigrid& hierarchy, Vector b, const IterationControl& control,
                                    const Threads& threads) {
  const BorderedMatrix& m = hierarchy.finest().matrix;
  SignedMultigrid::Workspace workspace = hierarchy.workspace();
  IterationResult result;
  const double size = std::sqrt(inner_product(b, b, threads));
  const std::size_t n = b.size();
  // Directions are single, too: x and r follow the direction as it is, so rounding it costs no accuracy.
  Vector r = std::move(b), mp;
  FloatVector p(n, 0), z;
  result.x.assign(n, 0);
  if (size == 0) {
    result.status = SolverStatus::converged;
    return result;
  }
  double rz = 0, square = size * size;
  for (;;) {
    result.residual = std::sqrt(square) / size;
    if (result.residual <= control.tolerance)
      result.status = SolverStatus::converged;
    else if (signs_are_stable(result.sign_changes, result.residual, n, control))
      result.status = SolverStatus::signs_stable;
    if (result.status != SolverStatus::not_converged || result.steps == control.max_steps) break;
    if (control.checkpoint) control.checkpoint(static_cast<double>(result.steps) / control.max_steps);
    hierarchy.cycle(0, r, z, workspace, threads);
    // The cycle is linear to single precision only: the difference form (Polak-Ribiere) would forgive more,
    // but a few dozen steps do not need it.
    const double rz_new = inner_product(r, z, threads);
    const double beta = result.steps == 0 ? 0 : rz_new / rz;
    for_each_index(threads, p.size(), [&](std::size_t i) {
      p[i] = static_cast<float>(static_cast<double>(z[i]) + beta * static_cast<double>(p[i]));
    });
    rz = rz_new;
    multiply(m, p, mp, threads);
    const double alpha = rz / inner_product(mp, p, threads);
    if (!std::isfinite(alpha)) break;
    const Progress step = sum_blocks<Progress>(threads, p.size(), [&](std::size_t begin, std::size_t end) {
      Progress part;
      for (std::size_t i = begin; i < end; ++i) {
        const double before = result.x[i];
        result.x[i] += alpha * static_cast<double>(p[i]);
        r[i] -= alpha * mp[i];
        part.square += r[i] * r[i];
        part.changes += (before > 0) != (result.x[i] > 0);
      }
      return part;
    });
    square = step.square;
    result.sign_changes.push_back(step.changes);
    ++result.steps;
  }
  return result;
}

} // namespace eigencrust
