// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/bordered_matrix.h"

namespace eigencrust {
namespace {

/// Row i of A and B times x, with the diagonal.
template <class X>
double row_product(const BorderedMatrix& m, const X& x, std::size_t i) {
  double sum = m.diagonal[i] * static_cast<double>(x[i]);
  for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e)
    sum += static_cast<double>(m.value[e]) * static_cast<double>(x[m.column[e]]);
  for (std::uint32_t k = 0; k < m.border_size(); ++k)
    sum += static_cast<double>(m.border[k][i]) * static_cast<double>(x[m.interior_size() + k]);
  return sum;
}

template <class X>
double border_row_product(const BorderedMatrix& m, const X& x, std::uint32_t k, const Threads& threads) {
  const std::size_t n = m.interior_size();
  double sum = sum_blocks<double>(threads, n, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) part += static_cast<double>(m.border[k][i]) * static_cast<double>(x[i]);
    return part;
  });
  for (std::uint32_t j = 0; j < m.border_size(); ++j) sum += m.corner[k][j] * static_cast<double>(x[n + j]);
  return sum;
}

template <class X>
void multiply_any(const BorderedMatrix& matrix, const X& x, Vector& y, const Threads& threads) {
  y.resize(matrix.size());
  for_each_index(threads, matrix.interior_size(), [&](std::size_t i) { y[i] = row_product(matrix, x, i); });
  for (std::uint32_t k = 0; k < matrix.border_size(); ++k)
    y[matrix.interior_size() + k] = border_row_product(matrix, x, k, threads);
}

} // namespace

void multiply(const BorderedMatrix& matrix, const Vector& x, Vector& y, const Threads& threads) {
  multiply_any(matrix, x, y, threads);
}

void multiply(const BorderedMatrix& matrix, const FloatVector& x, Vector& y, const Threads& threads) {
  multiply_any(matrix, x, y, threads);
}

double inner_product(const Vector& a, const Vector& b, const Threads& threads) {
  return sum_blocks<double>(threads, a.size(), [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) part += a[i] * b[i];
    return part;
  });
}

double weighted_product(const Vector& a, const Vector& d, const Vector& b, const Threads& threads) {
  return sum_blocks<double>(threads, a.size(), [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) part += a[i] * d[i] * b[i];
    return part;
  });
}

Vector full_diagonal(const BorderedMatrix& matrix) {
  Vector d = matrix.diagonal;
  for (std::uint32_t k = 0; k < matrix.border_size(); ++k) d.push_back(matrix.corner[k][k]);
  return d;
}

} // namespace eigencrust
