// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/signed_multigrid.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <tuple>
#include <utility>

#include "numerics/aggregation.h"
#include "numerics/dense.h"

namespace eigencrust {
namespace {

// Rows are relaxed by Gauss-Seidel inside fixed blocks and by Jacobi between them, so that the result
// does not depend on the number of threads.
constexpr std::size_t relaxation_block = 8192;
// Piecewise constants under-correct smooth errors; below 2 the cycle stays positive definite
// (docs/decisions/0019).
constexpr float over_correction = 1.5f;

float border_part(const BorderedMatrix& m, const FloatVector& x, std::size_t i) {
  float sum = 0;
  for (std::uint32_t s = 0; s < m.border_size(); ++s) sum += m.border[s][i] * x[m.interior_size() + s];
  return sum;
}

/// Σ value[e] x[column[e]] over entries [begin, end).
float product(const BorderedMatrix& m, std::uint64_t begin, std::uint64_t end, const FloatVector& x) {
  float sum = 0;
  for (std::uint64_t e = begin; e < end; ++e) sum += m.value[e] * x[m.column[e]];
  return sum;
}

/// Puts the entries that a forward sweep from zero reads in front of each row: earlier columns of the same block.
/// \returns how many they are, for each row
std::vector<std::uint16_t> swept_entries_first(BorderedMatrix& m, const Threads& threads) {
  static_assert(relaxation_block <= 65536);
  std::vector<std::uint16_t> count(m.interior_size());
  for_blocks(threads, m.interior_size(), relaxation_block, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<std::pair<std::uint32_t, float>> others;
    for (std::size_t i = begin; i < end; ++i) {
      const auto is_swept = [&](std::uint64_t e) { return m.column[e] >= begin && m.column[e] < i; };
      const std::uint64_t last = m.row_begin[i + 1];
      std::uint64_t to = m.row_begin[i];
      while (to < last && is_swept(to)) ++to;
      std::uint64_t later = to;
      while (later < last && !is_swept(later)) ++later;
      if (later < last) { // most rows are in order
        others.clear();
        for (std::uint64_t e = to; e < last; ++e) {
          if (is_swept(e)) {
            m.column[to] = m.column[e];
            m.value[to++] = m.value[e];
          } else
            others.emplace_back(m.column[e], m.value[e]);
        }
        for (std::size_t k = 0; k < others.size(); ++k) std::tie(m.column[to + k], m.value[to + k]) = others[k];
      }
      count[i] = static_cast<std::uint16_t>(to - m.row_begin[i]);
    }
  });
  return count;
}

/// The first sweep, from x = 0: only what was set earlier in the same block counts.
template <class B>
void relax_from_zero(const SignedMultigrid::Level& level, const B& b, FloatVector& x, const Threads& threads) {
  const BorderedMatrix& m = level.matrix;
  for_blocks(threads, m.interior_size(), relaxation_block, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      x[i] = (static_cast<float>(b[i]) - product(m, m.row_begin[i], m.row_begin[i] + level.swept[i], x)) *
             level.inverse[i];
  });
}

/// The last sweep, backwards. \param old a copy of x
template <class B>
void relax_backward(const SignedMultigrid::Level& level, const B& b, const FloatVector& old, FloatVector& x,
                    const Threads& threads) {
  const BorderedMatrix& m = level.matrix;
  for_blocks(threads, m.interior_size(), relaxation_block, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = end; i-- > begin;) {
      float sum = static_cast<float>(b[i]) - border_part(m, x, i);
      for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e) {
        const std::size_t j = m.column[e];
        sum -= m.value[e] * (j - begin < end - begin ? x[j] : old[j]);
      }
      x[i] = sum * level.inverse[i];
    }
  });
}

double border_row_product(const BorderedMatrix& m, const FloatVector& x, std::uint32_t s, const Threads& threads) {
  const std::size_t n = m.interior_size();
  double sum = sum_blocks<double>(threads, n, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) part += static_cast<double>(m.border[s][i]) * static_cast<double>(x[i]);
    return part;
  });
  for (std::uint32_t t = 0; t < m.border_size(); ++t)
    if (t != s) sum += m.corner[s][t] * static_cast<double>(x[n + t]);
  return sum;
}

template <class B>
void relax_border(const BorderedMatrix& m, const B& b, FloatVector& x, const Threads& threads) {
  const std::size_t n = m.interior_size();
  for (std::uint32_t s = 0; s < m.border_size(); ++s)
    if (m.corner[s][s] > 0)
      x[n + s] =
          static_cast<float>((static_cast<double>(b[n + s]) - border_row_product(m, x, s, threads)) / m.corner[s][s]);
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
  levels_.push_back({std::move(matrix), std::move(mass), {}, {}, {}});
  while (levels_.back().matrix.interior_size() > coarsest_size) {
    Level& fine = levels_.back();
    Coarsening next = coarsen_by_pairs_twice(fine.matrix, threads);
    fine.aggregation = std::move(next.aggregation);
    const Aggregation& a = fine.aggregation;
    Level coarse;
    coarse.matrix = std::move(next.matrix);
    const std::uint32_t n = fine.matrix.interior_size(), k = fine.matrix.border_size();
    if (!fine.mass.empty()) {
      coarse.mass.assign(a.count + k, 0);
      for_each_index(threads, a.count, [&](std::size_t g) {
        for (const std::uint32_t i : a.members[g]) coarse.mass[g] += fine.mass[i];
      });
      for (std::uint32_t s = 0; s < k; ++s) coarse.mass[a.count + s] = fine.mass[n + s];
    }
    fine.inverse.resize(n);
    for_each_index(threads, n, [&](std::size_t i) {
      const double d = fine.matrix.diagonal[i];
      fine.inverse[i] = d > 0 ? static_cast<float>(1 / d) : 0.0f;
    });
    fine.swept = swept_entries_first(fine.matrix, threads);
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
  const Aggregation& a = fine.aggregation;
  const std::uint32_t n = fine.matrix.interior_size();
  x.resize(fine.matrix.size());
  for_each_index(threads, n,
                 [&](std::size_t i) { x[i] = a.aggregate[i] == no_index ? 0.0 : a.sign[i] * coarse[a.aggregate[i]]; });
  for (std::uint32_t s = 0; s < fine.matrix.border_size(); ++s) x[n + s] = coarse[a.count + s];
}

SignedMultigrid::Workspace SignedMultigrid::workspace() const {
  Workspace result;
  result.level.resize(levels_.size());
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const std::size_t size = levels_[l].matrix.size();
    if (l > 0) result.level[l] = {FloatVector(size), FloatVector(size), {}};
    if (l + 1 < levels_.size()) result.level[l].old.resize(size);
  }
  return result;
}

/// Pᵀ (b - M x) after a forward sweep from zero, which used up b with the diagonal and the entries it read. The
/// residual is written down first: aggregates are scattered, and rows want to be streamed.
template <class B>
void SignedMultigrid::restrict_residual(std::size_t level, const B& b, const FloatVector& x, FloatVector& r,
                                        FloatVector& coarse, const Threads& threads) const {
  const Level& here = levels_[level];
  const BorderedMatrix& m = here.matrix;
  const Aggregation& a = here.aggregation;
  for_each_index(threads, m.interior_size(), [&](std::size_t i) {
    r[i] = -border_part(m, x, i) - product(m, m.row_begin[i] + here.swept[i], m.row_begin[i + 1], x);
  });
  for_each_index(threads, a.count, [&](std::size_t g) {
    float sum = 0;
    for (const std::uint32_t i : a.members[g]) sum += a.sign[i] > 0 ? r[i] : -r[i];
    coarse[g] = sum;
  });
  const std::size_t n = m.interior_size();
  for (std::uint32_t s = 0; s < m.border_size(); ++s)
    coarse[a.count + s] = static_cast<float>(static_cast<double>(b[n + s]) - border_row_product(m, x, s, threads) -
                                             m.corner[s][s] * static_cast<double>(x[n + s]));
}

void SignedMultigrid::add_correction(std::size_t level, const FloatVector& coarse, FloatVector& x, FloatVector& copy,
                                     const Threads& threads) const {
  const Aggregation& a = levels_[level].aggregation;
  const std::size_t n = levels_[level].matrix.interior_size();
  for_each_index(threads, n, [&](std::size_t i) {
    if (a.aggregate[i] != no_index) {
      const float c = over_correction * coarse[a.aggregate[i]];
      x[i] += a.sign[i] > 0 ? c : -c;
    }
    copy[i] = x[i];
  });
  for (std::uint32_t s = 0; s < levels_[level].matrix.border_size(); ++s)
    x[n + s] += over_correction * coarse[a.count + s];
}

template <class B>
void SignedMultigrid::solve_coarsest(const B& b, FloatVector& x) const {
  const auto& kept = coarsest_->kept;
  std::fill(x.begin(), x.end(), 0.0f);
  Eigen::VectorXd rhs(static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) rhs(static_cast<Eigen::Index>(i)) = static_cast<double>(b[kept[i]]);
  const Eigen::VectorXd solution = coarsest_->factors.solve(rhs);
  for (std::size_t i = 0; i < kept.size(); ++i) x[kept[i]] = static_cast<float>(solution(static_cast<Eigen::Index>(i)));
}

template <class B>
void SignedMultigrid::cycle_any(std::size_t level, const B& b, FloatVector& x, Workspace& workspace,
                                const Threads& threads) const {
  const Level& here = levels_[level];
  x.resize(here.matrix.size());
  if (level + 1 == levels_.size()) return solve_coarsest(b, x);
  FloatVector &coarse_b = workspace.level[level + 1].b, &coarse_x = workspace.level[level + 1].x;
  FloatVector& old = workspace.level[level].old;
  for (std::size_t z = here.matrix.interior_size(); z < x.size(); ++z) x[z] = 0;
  relax_from_zero(here, b, x, threads);
  relax_border(here.matrix, b, x, threads);
  restrict_residual(level, b, x, old, coarse_b, threads);
  cycle(level + 1, coarse_b, coarse_x, workspace, threads);
  add_correction(level, coarse_x, x, old, threads);
  relax_border(here.matrix, b, x, threads);
  relax_backward(here, b, old, x, threads);
}

void SignedMultigrid::cycle(std::size_t level, const FloatVector& b, FloatVector& x, Workspace& workspace,
                            const Threads& threads) const {
  cycle_any(level, b, x, workspace, threads);
}

void SignedMultigrid::cycle(std::size_t level, const Vector& b, FloatVector& x, Workspace& workspace,
                            const Threads& threads) const {
  cycle_any(level, b, x, workspace, threads);
}

} // namespace eigencrust
