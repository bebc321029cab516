// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Rows of different lengths in one array.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "parallel/threads.h"

namespace eigencrust {

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

} // namespace eigencrust
