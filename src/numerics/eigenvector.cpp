// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/eigenvector.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "numerics/dense.h"

namespace eigencrust {
namespace {

// On coarse levels a step costs next to nothing; signs settle long before.
constexpr std::uint32_t coarse_steps = 12;
// A consistent graph has eigenvalue 0 up to the rounding of float weights.
constexpr double consistent_eigenvalue = 1e-10;

std::uint32_t count_sign_changes(const Vector& before, const Vector& after, const Threads& threads) {
  return sum_blocks<std::uint32_t>(threads, before.size(), [&](std::size_t begin, std::size_t end) {
    std::uint32_t changes = 0;
    for (std::size_t i = begin; i < end; ++i) changes += (before[i] > 0) != (after[i] > 0);
    return changes;
  });
}

bool signs_are_stable(const std::vector<std::uint32_t>& changes, double residual, std::size_t n,
                      const IterationControl& control) {
  if (!control.stop_on_stable_signs || residual > control.stable_residual ||
      changes.size() < std::max(2u, control.min_steps))
    return false;
  const double limit = control.stable_share * static_cast<double>(n);
  return changes.back() <= limit && changes[changes.size() - 2] <= limit;
}

/// A vector with its product with M, so that combinations need no new product.
struct Direction {
  Vector v, mv;
};

/// One level of the eigenproblem with the iterate and the previous direction.
class LobpcgLevel {
 public:
  LobpcgLevel(const SignedMultigrid& hierarchy, std::size_t level, Vector start, const Threads& threads)
      : hierarchy_(hierarchy),
        level_(level),
        matrix_(hierarchy.levels()[level].matrix),
        mass_(hierarchy.levels()[level].mass),
        threads_(threads) {
    x_.v = std::move(start);
    // Where every edge cancels on the way down, nothing comes back up: begin anywhere but at zero, which
    // would pass for a perfect eigenvector.
    if (!scale_to_unit(x_.v)) {
      for (std::size_t i = 0; i < x_.v.size(); ++i)
        x_.v[i] = mass_[i] > 0 ? std::remainder(static_cast<double>(i + 1) * 0.6180339887498949, 1.0) : 0.0;
    }
    multiply(matrix_, x_.v, x_.mv, threads_);
    normalize(x_);
    update_residual();
  }

  double eigenvalue() const { return eigenvalue_; }
  double residual_norm() const { return residual_norm_; }
  const Vector& vector() const { return x_.v; }
  Vector take() { return std::move(x_.v); }

  void step() {
    Direction w;
    hierarchy_.cycle(level_, residual_, w.v, threads_);
    orthogonalize(w.v, {&x_});
    if (!scale_to_unit(w.v)) return;
    multiply(matrix_, w.v, w.mv, threads_);
    std::vector<Direction*> basis{&x_, &w};
    if (!p_.v.empty()) {
      for (const Direction* q : basis) subtract_projection(p_, *q);
      if (normalize(p_)) basis.push_back(&p_);
    }
    rayleigh_ritz(basis);
    update_residual();
  }

 private:
  /// Smallest Ritz vector in the span of a D-orthonormal basis whose first member is the iterate.
  void rayleigh_ritz(const std::vector<Direction*>& basis) {
    const auto size = static_cast<Eigen::Index>(basis.size());
    Eigen::MatrixXd gram(size, size);
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index j = i; j < size; ++j)
        gram(i, j) = gram(j, i) =
            inner_product(basis[static_cast<std::size_t>(i)]->v, basis[static_cast<std::size_t>(j)]->mv, threads_);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
    Eigen::VectorXd c = solver.eigenvectors().col(0);
    if (c(0) < 0) c = -c;
    const double cx = c(0), cw = c(1), cp = size > 2 ? c(2) : 0.0;
    Direction& w = *basis[1];
    if (size <= 2) p_ = {Vector(x_.v.size(), 0), Vector(x_.v.size(), 0)};
    for_each_index(threads_, x_.v.size(), [&](std::size_t i) {
      p_.v[i] = cw * w.v[i] + cp * p_.v[i];
      p_.mv[i] = cw * w.mv[i] + cp * p_.mv[i];
      x_.v[i] = cx * x_.v[i] + p_.v[i];
      x_.mv[i] = cx * x_.mv[i] + p_.mv[i];
    });
    normalize(x_);
  }

  void update_residual() {
    eigenvalue_ = inner_product(x_.v, x_.mv, threads_);
    residual_.resize(x_.v.size());
    for_each_index(threads_, x_.v.size(),
                   [&](std::size_t i) { residual_[i] = x_.mv[i] - eigenvalue_ * mass_[i] * x_.v[i]; });
    const double square = sum_blocks<double>(threads_, residual_.size(), [&](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i)
        if (mass_[i] > 0) part += residual_[i] * residual_[i] / mass_[i];
      return part;
    });
    residual_norm_ = std::sqrt(square);
  }

  void orthogonalize(Vector& v, std::initializer_list<const Direction*> others) {
    for (int pass = 0; pass < 2; ++pass)
      for (const Direction* q : others) add_scaled(-weighted_product(v, mass_, q->v, threads_), q->v, v, threads_);
  }
  void subtract_projection(Direction& d, const Direction& q) {
    const double k = weighted_product(d.v, mass_, q.v, threads_);
    add_scaled(-k, q.v, d.v, threads_);
    add_scaled(-k, q.mv, d.mv, threads_);
  }
  bool scale_to_unit(Vector& v) {
    const double size = std::sqrt(weighted_product(v, mass_, v, threads_));
    if (!(size > std::numeric_limits<double>::min()) || !std::isfinite(size)) return false;
    for_each_index(threads_, v.size(), [&](std::size_t i) { v[i] /= size; });
    return true;
  }
  bool normalize(Direction& d) {
    const double size = std::sqrt(weighted_product(d.v, mass_, d.v, threads_));
    if (!(size > 1e-12) || !std::isfinite(size)) return false;
    for_each_index(threads_, d.v.size(), [&](std::size_t i) {
      d.v[i] /= size;
      d.mv[i] /= size;
    });
    return true;
  }

  const SignedMultigrid& hierarchy_;
  std::size_t level_;
  const BorderedMatrix& matrix_;
  const Vector& mass_;
  const Threads& threads_;
  Direction x_, p_;
  Vector residual_;
  double eigenvalue_ = 0, residual_norm_ = 0;
};

} // namespace

IterationResult smallest_eigenvector(const SignedMultigrid& hierarchy, const IterationControl& control,
                                     const Threads& threads) {
  IterationResult result;
  const std::size_t coarsest = hierarchy.levels().size() - 1;
  Vector x;
  result.eigenvalue =
      smallest_eigenvector_dense(hierarchy.levels()[coarsest].matrix, hierarchy.levels()[coarsest].mass, x);
  IterationControl coarse_control = control;
  coarse_control.stop_on_stable_signs = true;
  for (std::size_t level = coarsest; level-- > 0;) {
    Vector start;
    hierarchy.prolongate(level, x, start, threads);
    LobpcgLevel iteration(hierarchy, level, std::move(start), threads);
    const IterationControl& rule = level == 0 ? control : coarse_control;
    const std::uint32_t limit = level == 0 ? control.max_steps : coarse_steps;
    std::vector<std::uint32_t> changes;
    while (changes.size() < limit) {
      if (control.checkpoint) control.checkpoint(level == 0 ? static_cast<double>(changes.size()) / limit : 0.0);
      const Vector before = iteration.vector();
      iteration.step();
      changes.push_back(count_sign_changes(before, iteration.vector(), threads));
      if (iteration.residual_norm() <= control.tolerance ||
          signs_are_stable(changes, iteration.residual_norm(), before.size(), rule))
        break;
    }
    if (level == 0) {
      result.status = iteration.residual_norm() <= control.tolerance ? SolverStatus::converged
                      : signs_are_stable(changes, iteration.residual_norm(), iteration.vector().size(), control)
                          ? SolverStatus::signs_stable
                          : SolverStatus::not_converged;
      result.residual = iteration.residual_norm();
      result.eigenvalue = iteration.eigenvalue();
      result.steps = static_cast<std::uint32_t>(changes.size());
      result.sign_changes = std::move(changes);
    }
    x = iteration.take();
  }
  if (coarsest == 0) result.status = SolverStatus::converged;
  if (result.eigenvalue < consistent_eigenvalue && result.status != SolverStatus::not_converged)
    result.status = SolverStatus::consistent;
  result.x = std::move(x);
  return result;
}

IterationResult conjugate_gradients(const SignedMultigrid& hierarchy, const Vector& b, const IterationControl& control,
                                    const Threads& threads) {
  const BorderedMatrix& m = hierarchy.finest().matrix;
  IterationResult result;
  Vector r = b, z, p, mp;
  result.x.assign(b.size(), 0);
  const double size = std::sqrt(inner_product(b, b, threads));
  if (size == 0) {
    result.status = SolverStatus::converged;
    return result;
  }
  double rz = 0;
  for (;;) {
    result.residual = std::sqrt(inner_product(r, r, threads)) / size;
    if (result.residual <= control.tolerance)
      result.status = SolverStatus::converged;
    else if (signs_are_stable(result.sign_changes, result.residual, b.size(), control))
      result.status = SolverStatus::signs_stable;
    if (result.status != SolverStatus::not_converged || result.steps == control.max_steps) break;
    if (control.checkpoint) control.checkpoint(static_cast<double>(result.steps) / control.max_steps);
    hierarchy.cycle(0, r, z, threads);
    const double rz_new = inner_product(r, z, threads);
    if (result.steps == 0)
      p = z;
    else {
      const double beta = rz_new / rz;
      for_each_index(threads, p.size(), [&](std::size_t i) { p[i] = z[i] + beta * p[i]; });
    }
    rz = rz_new;
    multiply(m, p, mp, threads);
    const double alpha = rz / inner_product(p, mp, threads);
    if (!std::isfinite(alpha)) break;
    const Vector before = result.x;
    add_scaled(alpha, p, result.x, threads);
    add_scaled(-alpha, mp, r, threads);
    result.sign_changes.push_back(count_sign_changes(before, result.x, threads));
    ++result.steps;
  }
  return result;
}

} // namespace eigencrust
