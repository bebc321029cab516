// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The eigenvector of the smallest eigenvalue of M x = λ D x, and the harmonic extension.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <eigencrust/types.h>

#include "numerics/signed_multigrid.h"

namespace eigencrust {

struct IterationControl {
  /// Stop when at most `stable_share` of all signs change in two steps running; otherwise only the
  /// residual stops the iteration.
  bool stop_on_stable_signs = true;
  double stable_share = 1e-4;
  /// Signs that stand still before the far side was heard of are not settled: the residual must be below
  /// this as well.
  double stable_residual = 1e-2;
  double tolerance = 1e-8;       ///< of the residual
  std::uint32_t max_steps = 100; ///< on the finest level
  std::uint32_t min_steps = 2;
  /// Called before each step with the share of max_steps done; may throw to cancel.
  std::function<void(double)> checkpoint;
};

struct IterationResult {
  Vector x; ///< interior, then border
  double eigenvalue = 0, residual = 0;
  std::uint32_t steps = 0;
  std::vector<std::uint32_t> sign_changes;
  /// Of an eigenvector that was stopped at stable signs: 1 for interior nodes whose value is not larger than
  /// what may still change. Empty otherwise.
  std::vector<std::uint8_t> unsettled;
  SolverStatus status = SolverStatus::not_converged;
};

/// Dense at the coarsest level, then level by level upwards with a few preconditioned steps each
/// (LOBPCG, Knyazev 2001, block size one; the preconditioner is one multigrid cycle).
IterationResult smallest_eigenvector(const SignedMultigrid& hierarchy, const IterationControl& control,
                                     const Threads& threads);

/// The reference: implicitly restarted Lanczos (Spectra) on 2I - D^-1/2 M D^-1/2, whose largest eigenvalue
/// belongs to the smallest of ours. Needs thousands of products where multigrid needs ten steps.
IterationResult smallest_eigenvector_lanczos(const BorderedMatrix& matrix, const Vector& mass,
                                             const IterationControl& control, const Threads& threads);

/// Solves M x = b for a positive definite M by conjugate gradients, preconditioned with one cycle.
/// `eigenvalue` of the result is 0; `residual` is |b - Mx| / |b|.
IterationResult conjugate_gradients(const SignedMultigrid& hierarchy, Vector b, const IterationControl& control,
                                    const Threads& threads);

} // namespace eigencrust
