// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/aggregation.h"

#include <algorithm>
#include <cmath>

namespace eigencrust {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// One greedy matching in node order: deterministic, and along a space-filling curve also compact.
Aggregation match_pairs(const BorderedMatrix& m) {
  const std::uint32_t n = m.interior_size();
  Aggregation result;
  result.aggregate.assign(n, none);
  result.sign.assign(n, 1);
  std::vector<double> scale(n);
  for (std::uint32_t i = 0; i < n; ++i) scale[i] = m.diagonal[i] > 0 ? 1 / std::sqrt(m.diagonal[i]) : 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    if (result.aggregate[i] != none) continue;
    double best = 0;
    std::uint64_t best_entry = 0;
    bool found_free = false, found = false;
    for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e) {
      const std::uint32_t j = m.column[e];
      const bool is_free = result.aggregate[j] == none;
      if (found_free && !is_free) continue;
      const double strength = std::fabs(static_cast<double>(m.value[e])) * scale[j];
      // A free neighbour beats any taken one; a node without free neighbours joins its strongest
      // neighbour's aggregate, or coarsening would stall on stars.
      if (!found || (is_free && !found_free) || strength > best) {
        best = strength;
        best_entry = e;
        found = true;
        found_free = found_free || is_free;
      }
    }
    if (!found) continue;
    const std::uint32_t j = m.column[best_entry];
    const std::int8_t relative = m.value[best_entry] <= 0 ? 1 : -1; // M_ij < 0 attracts
    if (found_free) {
      result.aggregate[i] = result.aggregate[j] = result.count++;
      result.sign[j] = relative;
    } else {
      result.aggregate[i] = result.aggregate[j];
      result.sign[i] = static_cast<std::int8_t>(relative * result.sign[j]);
    }
  }
  return result;
}

/// Members of each aggregate in increasing order (compressed rows).
void list_members(const Aggregation& a, std::vector<std::uint32_t>& begin, std::vector<std::uint32_t>& member) {
  begin.assign(a.count + 1, 0);
  for (const std::uint32_t g : a.aggregate)
    if (g != none) ++begin[g + 1];
  for (std::uint32_t g = 0; g < a.count; ++g) begin[g + 1] += begin[g];
  member.resize(begin[a.count]);
  std::vector<std::uint32_t> cursor(begin.begin(), begin.end() - 1);
  for (std::uint32_t i = 0; i < a.aggregate.size(); ++i)
    if (a.aggregate[i] != none) member[cursor[a.aggregate[i]]++] = i;
}

struct RowBlock {
  std::vector<std::uint32_t> column;
  std::vector<float> value;
};

/// Rows of one block of aggregates; lengths go to row_length.
void galerkin_block(const BorderedMatrix& m, const Aggregation& a, const std::vector<std::uint32_t>& begin,
                    const std::vector<std::uint32_t>& member, std::size_t first, std::size_t last, RowBlock& rows,
                    std::vector<std::uint64_t>& row_length, std::vector<double>& diagonal) {
  std::vector<std::pair<std::uint32_t, double>> entries;
  for (std::size_t g = first; g < last; ++g) {
    entries.clear();
    double self = 0;
    for (std::uint32_t k = begin[g]; k < begin[g + 1]; ++k) {
      const std::uint32_t i = member[k];
      self += m.diagonal[i];
      for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e) {
        const std::uint32_t j = m.column[e];
        const double v = static_cast<double>(m.value[e]) * a.sign[i] * a.sign[j];
        if (a.aggregate[j] == g)
          self += v;
        else
          entries.emplace_back(a.aggregate[j], v);
      }
    }
    diagonal[g] = self;
    // Stable, so that equal columns are added in the order of the members.
    std::stable_sort(entries.begin(), entries.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
    const std::size_t before = rows.column.size();
    for (std::size_t k = 0; k < entries.size();) {
      const std::uint32_t c = entries[k].first;
      double sum = 0, size = 0;
      for (; k < entries.size() && entries[k].first == c; ++k) {
        sum += entries[k].second;
        size += std::fabs(entries[k].second);
      }
      if (std::fabs(sum) <= 1e-7 * size) continue;
      rows.column.push_back(c);
      rows.value.push_back(static_cast<float>(sum));
    }
    row_length[g + 1] = rows.column.size() - before;
  }
}

} // namespace

BorderedMatrix galerkin(const BorderedMatrix& matrix, const Aggregation& a, const Threads& threads) {
  BorderedMatrix coarse;
  std::vector<std::uint32_t> begin, member;
  list_members(a, begin, member);
  coarse.diagonal.resize(a.count);
  coarse.row_begin.assign(a.count + 1, 0);
  constexpr std::size_t block = 4096;
  std::vector<RowBlock> blocks((a.count + block - 1) / block);
  for_blocks(threads, a.count, block, [&](std::size_t first, std::size_t last, std::size_t b) {
    galerkin_block(matrix, a, begin, member, first, last, blocks[b], coarse.row_begin, coarse.diagonal);
  });
  for (std::uint32_t g = 0; g < a.count; ++g) coarse.row_begin[g + 1] += coarse.row_begin[g];
  coarse.column.resize(coarse.row_begin[a.count]);
  coarse.value.resize(coarse.row_begin[a.count]);
  threads.run(blocks.size(), [&](std::size_t b) {
    std::copy(blocks[b].column.begin(), blocks[b].column.end(),
              coarse.column.begin() + static_cast<std::ptrdiff_t>(coarse.row_begin[b * block]));
    std::copy(blocks[b].value.begin(), blocks[b].value.end(),
              coarse.value.begin() + static_cast<std::ptrdiff_t>(coarse.row_begin[b * block]));
    blocks[b] = {};
  });
  coarse.corner = matrix.corner;
  for (const std::vector<float>& border : matrix.border) {
    std::vector<double> sum(a.count, 0);
    for (std::uint32_t i = 0; i < border.size(); ++i)
      if (a.aggregate[i] != none) sum[a.aggregate[i]] += static_cast<double>(border[i]) * a.sign[i];
    coarse.border.emplace_back(sum.begin(), sum.end());
  }
  return coarse;
}

Aggregation aggregate_pairs_twice(const BorderedMatrix& matrix, const Threads& threads) {
  Aggregation first = match_pairs(matrix);
  const Aggregation second = match_pairs(galerkin(matrix, first, threads));
  // A pair without neighbours after the first round still is one unknown of the coarse level.
  std::vector<std::uint32_t> number = second.aggregate;
  std::uint32_t count = second.count;
  for (std::uint32_t& g : number)
    if (g == none) g = count++;
  for (std::uint32_t i = 0; i < first.aggregate.size(); ++i) {
    if (first.aggregate[i] == none) continue;
    const std::uint32_t g = first.aggregate[i];
    first.sign[i] = static_cast<std::int8_t>(first.sign[i] * second.sign[g]);
    first.aggregate[i] = number[g];
  }
  first.count = count;
  return first;
}

} // namespace eigencrust
