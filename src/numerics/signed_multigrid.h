// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Aggregation multigrid for matrices whose off-diagonal entries have both signs.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "numerics/bordered_matrix.h"

namespace eigencrust {

/// A hierarchy of Galerkin matrices Pᵀ M P for a symmetric, weakly diagonally dominant M.
///
/// P is piecewise constant up to sign: a node moves with its aggregate or opposite to it, as the sign of
/// the entry that joined them says. Each level pairs nodes with their strongest neighbour
/// |M_ij| / √(M_ii M_jj) twice, so it is about four times smaller than the one above. Border entries are
/// never aggregated: they are the same unknowns on all levels. Nodes without interior neighbours have no
/// place on the next level; relaxation alone settles them.
class SignedMultigrid {
 public:
  struct Level {
    BorderedMatrix matrix;
    Vector mass;                          ///< diagonal of Pᵀ D P, interior then border; empty if D was
    std::vector<std::uint32_t> aggregate; ///< on the next level; none for nodes that end here
    std::vector<std::int8_t> sign;        ///< +1 or -1: moves with or against its aggregate
  };
  static constexpr std::uint32_t none = 0xffffffffu;
  static constexpr std::uint32_t coarsest_size = 400; ///< solved densely

  /// \param matrix moved into the finest level
  /// \param mass   diagonal of D (n + k), or empty when no eigenproblem is solved
  SignedMultigrid(BorderedMatrix matrix, Vector mass, const Threads& threads);
  ~SignedMultigrid();
  SignedMultigrid(SignedMultigrid&&) noexcept;

  [[nodiscard]] const std::vector<Level>& levels() const { return levels_; }
  [[nodiscard]] const Level& finest() const { return levels_.front(); }

  /// One symmetric cycle from zero: x ≈ M⁻¹ b on `level`. Linear and positive definite in b.
  void cycle(std::size_t level, const Vector& b, Vector& x, const Threads& threads) const;

  /// x on `level` from the next coarser one (nodes that ended here get 0).
  void prolongate(std::size_t level, const Vector& coarse, Vector& x, const Threads& threads) const;

 private:
  void restrict_to(std::size_t level, const Vector& fine, Vector& coarse, const Threads& threads) const;

  std::vector<Level> levels_;
  struct Coarsest;
  std::unique_ptr<Coarsest> coarsest_;
};

} // namespace eigencrust
