// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Symmetric sparse matrices with a few dense rows kept apart.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/threads.h"

namespace eigencrust {

/// The symmetric matrix [A B; Bᵀ C]: A sparse (n × n), B a few dense columns (n × k), C small (k × k).
///
/// The rows of supernodes hold 10⁴ to 10⁶ entries; inside the sparse part they would fill every coarse
/// level and serialize every product, so they are a border of their own.
struct BorderedMatrix {
  std::vector<std::uint64_t> row_begin; ///< n + 1
  std::vector<std::uint32_t> column;    ///< off-diagonal entries of A only
  std::vector<float> value;
  std::vector<double> diagonal;            ///< of A, n
  std::vector<std::vector<float>> border;  ///< k columns of n entries
  std::vector<std::vector<double>> corner; ///< k × k, with its diagonal

  [[nodiscard]] std::uint32_t interior_size() const { return static_cast<std::uint32_t>(diagonal.size()); }
  [[nodiscard]] std::uint32_t border_size() const { return static_cast<std::uint32_t>(border.size()); }
  [[nodiscard]] std::uint32_t size() const { return interior_size() + border_size(); }
};

/// Vectors have interior_size() entries, then the border's.
using Vector = std::vector<double>;
using FloatVector = std::vector<float>;

/// y = M x
void multiply(const BorderedMatrix& matrix, const Vector& x, Vector& y, const Threads& threads);
void multiply(const BorderedMatrix& matrix, const FloatVector& x, Vector& y, const Threads& threads);

/// Σ a_i b_i in block order.
double inner_product(const Vector& a, const Vector& b, const Threads& threads);
/// Σ a_i d_i b_i in block order.
double weighted_product(const Vector& a, const Vector& d, const Vector& b, const Threads& threads);

/// All diagonal entries, interior then border.
Vector full_diagonal(const BorderedMatrix& matrix);

} // namespace eigencrust
