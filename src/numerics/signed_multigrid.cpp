// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/signed_multigrid.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "numerics/aggregation.h"
#include "numerics/dense.h"

namespace eigencrust {
namespace {

// Rows are relaxed by Gauss-Seidel inside fixed blocks and by Jacobi between them, so that the result
// does not depend on the number of threads.
constexpr std::size_t relaxation_block = 8192;

template <bool forward>
void relax_interior(const BorderedMatrix& m, const Vector& b, Vector& x, Vector& old, const Threads& threads) {
  const std::size_t n = m.interior_size();
  const bool blocked = n > relaxation_block;
  if (blocked) {
    old.resize(n);
    for_each_index(threads, n, [&](std::size_t i) { old[i] = x[i]; });
  }
  for_blocks(threads, n, relaxation_block, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = forward ? k : end - 1 - (k - begin);
      if (!(m.diagonal[i] > 0)) continue;
      double sum = b[i];
      for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e) {
        const std::size_t j = m.column[e];
        const double xj = (j >= begin && j < end) || !blocked ? x[j] : old[j];
        sum -= static_cast<double>(m.value[e]) * xj;
      }
      for (std::uint32_t s = 0; s < m.border_size(); ++s) sum -= static_cast<double>(m.border[s][i]) * x[n + s];
      x[i] = sum / m.diagonal[i];
    }
  });
}

void relax_border(const BorderedMatrix& m, const Vector& b, Vector& x, const Threads& threads) {
  const std::size_t n = m.interior_size();
  for (std::uint32_t s = 0; s < m.border_size(); ++s) {
    if (!(m.corner[s][s] > 0)) continue;
    double sum = b[n + s] - sum_blocks<double>(threads, n, [&](std::size_t begin, std::size_t end) {
                   double part = 0;
                   for (std::size_t i = begin; i < end; ++i) part += static_cast<double>(m.border[s][i]) * x[i];
                   return part;
                 });
    for (std::uint32_t t = 0; t < m.border_size(); ++t)
      if (t != s) sum -= m.corner[s][t] * x[n + t];
    x[n + s] = sum / m.corner[s][s];
  }
}

} // namespace

/// Factors of the dense coarsest matrix, shifted by a hair: a consistent graph makes it singular.
struct SignedMultigrid::Coarsest {
  Eigen::LDLT<Eigen::MatrixXd> factors;
  std::vector<std::uint32_t> kept; ///< rows with a positive diagonal
};

SignedMultigrid::~SignedMultigrid() = default;
SignedMultigrid::SignedMultigrid(SignedMultigrid&&) noexcept = default;

SignedMultigrid::SignedMultigrid(BorderedMatrix matrix, Vector mass, const Threads& threads)
    : coarsest_(std::make_unique<Coarsest>()) {
  levels_.push_back({std::move(matrix), std::move(mass), {}, {}});
  while (levels_.back().matrix.interior_size() > coarsest_size) {
    Level& fine = levels_.back();
    Aggregation a = aggregate_pairs_twice(fine.matrix, threads);
    Level coarse;
    coarse.matrix = galerkin(fine.matrix, a, threads);
    const std::uint32_t n = fine.matrix.interior_size(), k = fine.matrix.border_size();
    if (!fine.mass.empty()) {
      coarse.mass.assign(a.count + k, 0);
      for (std::uint32_t i = 0; i < n; ++i)
        if (a.aggregate[i] != none) coarse.mass[a.aggregate[i]] += fine.mass[i];
      for (std::uint32_t s = 0; s < k; ++s) coarse.mass[a.count + s] = fine.mass[n + s];
    }
    fine.aggregate = std::move(a.aggregate);
    fine.sign = std::move(a.sign);
    levels_.push_back(std::move(coarse));
  }
  const BorderedMatrix& last = levels_.back().matrix;
  Eigen::MatrixXd dense = to_dense(last);
  for (Eigen::Index i = 0; i < dense.rows(); ++i)
    if (dense(i, i) > 0) coarsest_->kept.push_back(static_cast<std::uint32_t>(i));
  Eigen::MatrixXd kept = dense(coarsest_->kept, coarsest_->kept);
  kept.diagonal() *= 1 + 1e-6;
  coarsest_->factors.compute(kept);
}

void SignedMultigrid::prolongate(std::size_t level, const Vector& coarse, Vector& x, const Threads& threads) const {
  const Level& fine = levels_[level];
  const std::uint32_t n = fine.matrix.interior_size();
  const std::uint32_t n_coarse = levels_[level + 1].matrix.interior_size();
  x.resize(fine.matrix.size());
  for_each_index(threads, n, [&](std::size_t i) {
    x[i] = fine.aggregate[i] == none ? 0.0 : fine.sign[i] * coarse[fine.aggregate[i]];
  });
  for (std::uint32_t s = 0; s < fine.matrix.border_size(); ++s) x[n + s] = coarse[n_coarse + s];
}

void SignedMultigrid::restrict_to(std::size_t level, const Vector& fine, Vector& coarse, const Threads&) const {
  const Level& from = levels_[level];
  const std::uint32_t n = from.matrix.interior_size();
  const BorderedMatrix& to = levels_[level + 1].matrix;
  coarse.assign(to.size(), 0);
  for (std::uint32_t i = 0; i < n; ++i)
    if (from.aggregate[i] != none) coarse[from.aggregate[i]] += from.sign[i] * fine[i];
  for (std::uint32_t s = 0; s < to.border_size(); ++s) coarse[to.interior_size() + s] = fine[n + s];
}

void SignedMultigrid::cycle(std::size_t level, const Vector& b, Vector& x, const Threads& threads) const {
  const BorderedMatrix& m = levels_[level].matrix;
  x.assign(m.size(), 0);
  if (level + 1 == levels_.size()) {
    const auto& kept = coarsest_->kept;
    Eigen::VectorXd rhs(static_cast<Eigen::Index>(kept.size()));
    for (std::size_t i = 0; i < kept.size(); ++i) rhs(static_cast<Eigen::Index>(i)) = b[kept[i]];
    const Eigen::VectorXd solution = coarsest_->factors.solve(rhs);
    for (std::size_t i = 0; i < kept.size(); ++i) x[kept[i]] = solution(static_cast<Eigen::Index>(i));
    return;
  }
  Vector old, r, coarse_b, coarse_x, correction;
  relax_interior<true>(m, b, x, old, threads);
  relax_border(m, b, x, threads);
  // Twice on small levels (W-cycle): piecewise constants under-correct, and the small levels cost little.
  const int visits = level == 0 ? 1 : 2;
  for (int visit = 0; visit < visits; ++visit) {
    residual(m, b, x, r, threads);
    restrict_to(level, r, coarse_b, threads);
    cycle(level + 1, coarse_b, coarse_x, threads);
    prolongate(level, coarse_x, correction, threads);
    add_scaled(1.0, correction, x, threads);
  }
  relax_border(m, b, x, threads);
  relax_interior<false>(m, b, x, old, threads);
}

} // namespace eigencrust
