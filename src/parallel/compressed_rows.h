// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Rows of different lengths in one array.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "parallel/threads.h"

namespace eigencrust {

/// Block length where blocks have to be joined afterwards: few of them, that their seams be short.
constexpr std::size_t long_block = 65536;

template <class T>
struct CompressedRows {
  std::vector<std::uint64_t> begin; ///< rows + 1
  std::vector<T> item;

  [[nodiscard]] std::span<const T> operator[](std::size_t row) const {
    return {item.data() + begin[row], item.data() + begin[row + 1]};
  }
};

/// From entries in any order: `for_each(visit)` calls visit(row, item) for each of them, and does so twice, in the
/// same order, which is that of the items in their rows.
template <class T, class ForEach>
CompressedRows<T> build_rows(std::size_t rows, ForEach&& for_each) {
  CompressedRows<T> result;
  result.begin.assign(rows + 1, 0);
  for_each([&](std::size_t row, const T&) { ++result.begin[row + 1]; });
  for (std::size_t row = 0; row < rows; ++row) result.begin[row + 1] += result.begin[row];
  result.item.resize(result.begin.back());
  std::vector<std::uint64_t> place(result.begin.begin(), result.begin.end() - 1);
  for_each([&](std::size_t row, const T& item) { result.item[place[row]++] = item; });
  return result;
}

/// Row by row on all threads. Each block of rows has a writer of its own, which make_writer() gives: writer(row,
/// items) appends the row to items.
template <class T, class MakeWriter>
CompressedRows<T> build_rows(const Threads& threads, std::size_t rows, std::size_t block, MakeWriter&& make_writer) {
  CompressedRows<T> result;
  result.begin.assign(rows + 1, 0);
  std::vector<std::vector<T>> parts((rows + block - 1) / block);
  for_blocks(threads, rows, block, [&](std::size_t first, std::size_t last, std::size_t b) {
    auto writer = make_writer();
    for (std::size_t row = first; row < last; ++row) {
      const std::size_t before = parts[b].size();
      writer(row, parts[b]);
      result.begin[row + 1] = parts[b].size() - before;
    }
  });
  for (std::size_t row = 0; row < rows; ++row) result.begin[row + 1] += result.begin[row];
  result.item.resize(result.begin.back());
  threads.run(parts.size(), [&](std::size_t b) {
    std::copy(parts[b].begin(), parts[b].end(),
              result.item.begin() + static_cast<std::ptrdiff_t>(result.begin[b * block]));
    parts[b] = {};
  });
  return result;
}

/// Sorts each row.
template <class T, class Less>
void sort_rows(CompressedRows<T>& rows, const Threads& threads, Less&& less) {
  for_each_index(threads, rows.begin.size() - 1, [&](std::size_t row) {
    const auto at = [&](std::uint64_t k) { return rows.item.begin() + static_cast<std::ptrdiff_t>(k); };
    std::sort(at(rows.begin[row]), at(rows.begin[row + 1]), less);
  });
}

/// The two arrays of rows of pairs, as graphs and matrices have their columns and weights.
template <class A, class B>
void split_rows(CompressedRows<std::pair<A, B>> rows, std::vector<std::uint64_t>& begin, std::vector<A>& first,
                std::vector<B>& second, const Threads& threads) {
  begin = std::move(rows.begin);
  first.resize(rows.item.size());
  second.resize(rows.item.size());
  for_each_index(threads, rows.item.size(), [&](std::size_t i) { std::tie(first[i], second[i]) = rows.item[i]; });
}

/// The same of a symmetric matrix, from the entries right of its diagonal.
template <class B>
void mirror_rows(CompressedRows<std::pair<std::uint32_t, B>> upper, std::vector<std::uint64_t>& begin,
                 std::vector<std::uint32_t>& column, std::vector<B>& value, const Threads& threads) {
  const std::size_t rows = upper.begin.size() - 1;
  begin.assign(rows + 1, 0);
  for (const auto& [j, v] : upper.item) ++begin[j + 1];
  for (std::size_t i = 0; i < rows; ++i) begin[i + 1] += begin[i] + upper[i].size();
  column.resize(begin.back());
  value.resize(begin.back());
  std::vector<std::uint64_t> place(begin.begin(), begin.end() - 1);
  for (std::uint32_t i = 0; i < rows; ++i)
    for (const auto& [j, v] : upper[i]) {
      column[place[j]] = i;
      value[place[j]++] = v;
    }
  for_each_index(threads, rows, [&](std::size_t i) {
    std::uint64_t at = place[i];
    for (const auto& [j, v] : upper[i]) {
      column[at] = j;
      value[at++] = v;
    }
  });
}

} // namespace eigencrust
