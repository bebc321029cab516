// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Aggregation multigrid for matrices whose off-diagonal entries have both signs.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "numerics/aggregation.h"
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
    Vector mass;             ///< diagonal of Pᵀ D P, interior then border; empty if D was
    Aggregation aggregation; ///< of the interior on the next level; empty on the last
    FloatVector inverse;     ///< 1 / diagonal of A; 0 where that is not positive; empty on the last
    /// Entries at the front of each row that a forward sweep from zero reads; empty on the last.
    std::vector<std::uint16_t> swept;
  };
  /// The vectors of one cycle, reused from cycle to cycle.
  struct Workspace {
    struct Vectors {
      FloatVector b, x, old;
    };
    std::vector<Vectors> level;
  };
  static constexpr std::uint32_t coarsest_size = 400; ///< solved densely

  /// \param matrix moved into the finest level
  /// \param mass   diagonal of D (n + k), or empty when no eigenproblem is solved
  SignedMultigrid(BorderedMatrix matrix, Vector mass, const Threads& threads);
  ~SignedMultigrid();
  SignedMultigrid(SignedMultigrid&&) noexcept;

  [[nodiscard]] const std::vector<Level>& levels() const { return levels_; }
  [[nodiscard]] const Level& finest() const { return levels_.front(); }

  /// The matrix given to the constructor, entries within its rows in any order; the hierarchy is of no use then.

  [[nodiscard]] Workspace workspace() const;
  /// One symmetric cycle from zero: x ≈ M⁻¹ b on `level`. Linear (to single precision) and positive definite
  /// in b. Single precision: as a preconditioner it only has to point the right way, and it is bound by memory.
  void cycle(std::size_t level, const FloatVector& b, FloatVector& x, Workspace& workspace,
             const Threads& threads) const;
  void cycle(std::size_t level, const Vector& b, FloatVector& x, Workspace& workspace, const Threads& threads) const;

  /// x on `level` from the next coarser one (nodes that ended here get 0).
  void prolongate(std::size_t level, const Vector& coarse, Vector& x, const Threads& threads) const;

 private:
  template <class B>
  void cycle_any(std::size_t level, const B& b, FloatVector& x, Workspace& workspace, const Threads& threads) const;
  template <class B>
  void restrict_residual(std::size_t level, const B& b, const FloatVector& x, FloatVector& r, FloatVector& coarse,
                         const Threads& threads) const;
  void add_correction(std::size_t level, const FloatVector& coarse, FloatVector& x, FloatVector& copy,
                      const Threads& threads) const;
  template <class B>
  void solve_coarsest(const B& b, FloatVector& x) const;

  std::vector<Level> levels_;
  struct Coarsest;
  std::unique_ptr<Coarsest> coarsest_;
};

} // namespace eigencrust
