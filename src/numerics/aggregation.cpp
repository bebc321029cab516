// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/aggregation.h"

#include <algorithm>
#include <cmath>

namespace eigencrust {
namespace {

constexpr std::uint32_t none = 0xffffffffu;
// Nodes are matched inside blocks of this many, all threads at a time; what is left over is matched after.
constexpr std::size_t matching_block = 32768;

/// Greedy matching in node order: deterministic, and along a space-filling curve also compact.
class Matching {
 public:
  explicit Matching(const BorderedMatrix& m, const Threads& threads)
      : m_(m), partner_(m.interior_size(), none), scale_(m.interior_size()) {
    for_each_index(threads, scale_.size(), [&](std::size_t i) {
      scale_[i] = m.diagonal[i] > 0 ? static_cast<float>(1 / std::sqrt(m.diagonal[i])) : 0.0f;
    });
    for_blocks(threads, scale_.size(), matching_block, [&](std::size_t begin, std::size_t end, std::size_t) {
      match(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
    });
    match(0, m.interior_size());
  }

  /// The strongest neighbour of a node that found none free; none for a node without neighbours.
  std::uint64_t strongest(std::uint32_t i) const {
    float best = -1;
    std::uint64_t entry = no_entry;
    for (std::uint64_t e = m_.row_begin[i]; e < m_.row_begin[i + 1]; ++e) {
      const float strength = std::fabs(m_.value[e]) * scale_[m_.column[e]];
      if (strength > best) {
        best = strength;
        entry = e;
      }
    }
    return entry;
  }
  std::uint32_t partner(std::uint32_t i) const { return partner_[i]; }
  static constexpr std::uint64_t no_entry = ~0ull;

 private:
  /// Pairs free nodes of [begin, end) with each other.
  void match(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) {
      if (partner_[i] != none) continue;
      float best = -1;
      std::uint32_t with = none;
      for (std::uint64_t e = m_.row_begin[i]; e < m_.row_begin[i + 1]; ++e) {
        const std::uint32_t j = m_.column[e];
        if (j < begin || j >= end || partner_[j] != none) continue;
        const float strength = std::fabs(m_.value[e]) * scale_[j];
        if (strength > best) {
          best = strength;
          with = j;
        }
      }
      if (with == none) continue;
      partner_[i] = with;
      partner_[with] = i;
    }
  }

  const BorderedMatrix& m_;
  std::vector<std::uint32_t> partner_;
  std::vector<float> scale_;
};

float entry_between(const BorderedMatrix& m, std::uint32_t i, std::uint32_t j) {
  for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e)
    if (m.column[e] == j) return m.value[e];
  return 0;
}

void list_members(Aggregation& a) {
  a.begin.assign(a.count + 1, 0);
  for (const std::uint32_t g : a.aggregate)
    if (g != none) ++a.begin[g + 1];
  for (std::uint32_t g = 0; g < a.count; ++g) a.begin[g + 1] += a.begin[g];
  a.member.resize(a.begin[a.count]);
  std::vector<std::uint32_t> cursor(a.begin.begin(), a.begin.end() - 1);
  for (std::uint32_t i = 0; i < a.aggregate.size(); ++i)
    if (a.aggregate[i] != none) a.member[cursor[a.aggregate[i]]++] = i;
}

struct RowBlock {
  std::vector<std::uint32_t> column;
  std::vector<float> value;
};

/// Sums of one row by column, in a small table that is emptied after each row. Sums are formed in the order in
/// which they are given.
class RowSums {
 public:
  RowSums() : slot_(512, none) {}

  void add(std::uint32_t column, double value) {
    std::size_t at = (column * 2654435769u) & (slot_.size() - 1);
    while (slot_[at] != none && entry_[slot_[at]].column != column) at = (at + 1) & (slot_.size() - 1);
    if (slot_[at] == none) {
      slot_[at] = static_cast<std::uint32_t>(entry_.size());
      entry_.push_back({column, value, std::fabs(value)});
      place_.push_back(static_cast<std::uint32_t>(at));
      if (2 * entry_.size() > slot_.size()) grow();
      return;
    }
    Entry& entry = entry_[slot_[at]];
    entry.sum += value;
    entry.size += std::fabs(value);
  }

  /// Appends what does not cancel, columns increasing, and empties the table.
  void move_to(RowBlock& rows) {
    std::sort(entry_.begin(), entry_.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
    for (const Entry& e : entry_) {
      if (std::fabs(e.sum) <= 1e-7 * e.size) continue;
      rows.column.push_back(e.column);
      rows.value.push_back(static_cast<float>(e.sum));
    }
    for (const std::uint32_t at : place_) slot_[at] = none;
    entry_.clear();
    place_.clear();
  }

 private:
  struct Entry {
    std::uint32_t column;
    double sum, size;
  };

  void grow() {
    slot_.assign(2 * slot_.size(), none);
    for (std::uint32_t k = 0; k < entry_.size(); ++k) {
      std::size_t at = (entry_[k].column * 2654435769u) & (slot_.size() - 1);
      while (slot_[at] != none) at = (at + 1) & (slot_.size() - 1);
      slot_[at] = k;
      place_[k] = static_cast<std::uint32_t>(at);
    }
  }

  std::vector<std::uint32_t> slot_; ///< entry numbers; a power of two
  std::vector<Entry> entry_;
  std::vector<std::uint32_t> place_; ///< slots that are taken
};

/// Rows of one block of aggregates; lengths go to row_length.
void galerkin_block(const BorderedMatrix& m, const Aggregation& a, std::size_t first, std::size_t last, RowBlock& rows,
                    std::vector<std::uint64_t>& row_length, std::vector<double>& diagonal) {
  RowSums sums;
  for (std::size_t g = first; g < last; ++g) {
    double self = 0;
    for (std::uint32_t k = a.begin[g]; k < a.begin[g + 1]; ++k) {
      const std::uint32_t i = a.member[k];
      self += m.diagonal[i];
      for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e) {
        const std::uint32_t j = m.column[e];
        const double v = static_cast<double>(a.sign[i] == a.sign[j] ? m.value[e] : -m.value[e]);
        if (a.aggregate[j] == g)
          self += v;
        else
          sums.add(a.aggregate[j], v);
      }
    }
    diagonal[g] = self;
    const std::size_t before = rows.column.size();
    sums.move_to(rows);
    row_length[g + 1] = rows.column.size() - before;
  }
}

} // namespace

Aggregation match_pairs(const BorderedMatrix& m, const Threads& threads) {
  const std::uint32_t n = m.interior_size();
  const Matching matching(m, threads);
  Aggregation a;
  a.aggregate.assign(n, none);
  a.sign.assign(n, 1);
  const auto relative = [](float entry) { return static_cast<std::int8_t>(entry <= 0 ? 1 : -1); }; // < 0 attracts
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = matching.partner(i);
    if (j == none || j < i) continue;
    a.aggregate[i] = a.aggregate[j] = a.count++;
    a.sign[j] = relative(entry_between(m, i, j));
  }
  // A node without free neighbours joins its strongest neighbour, or coarsening would stall on stars. All
  // its neighbours have partners: of two free neighbours one would have taken the other.
  for (std::uint32_t i = 0; i < n; ++i) {
    if (matching.partner(i) != none) continue;
    const std::uint64_t e = matching.strongest(i);
    if (e == Matching::no_entry) continue;
    const std::uint32_t j = m.column[e];
    a.aggregate[i] = a.aggregate[j];
    a.sign[i] = static_cast<std::int8_t>(relative(m.value[e]) * a.sign[j]);
  }
  list_members(a);
  return a;
}

BorderedMatrix galerkin(const BorderedMatrix& matrix, const Aggregation& a, const Threads& threads) {
  BorderedMatrix coarse;
  coarse.diagonal.resize(a.count);
  coarse.row_begin.assign(a.count + 1, 0);
  constexpr std::size_t block = 4096;
  std::vector<RowBlock> blocks((a.count + block - 1) / block);
  for_blocks(threads, a.count, block, [&](std::size_t first, std::size_t last, std::size_t b) {
    galerkin_block(matrix, a, first, last, blocks[b], coarse.row_begin, coarse.diagonal);
  });
  for (std::uint32_t g = 0; g < a.count; ++g) coarse.row_begin[g + 1] += coarse.row_begin[g];
  coarse.column.resize(coarse.row_begin[a.count]);
  coarse.value.resize(coarse.row_begin[a.count]);
  threads.run(blocks.size(), [&](std::size_t b) {
    const auto at = static_cast<std::ptrdiff_t>(coarse.row_begin[b * block]);
    std::copy(blocks[b].column.begin(), blocks[b].column.end(), coarse.column.begin() + at);
    std::copy(blocks[b].value.begin(), blocks[b].value.end(), coarse.value.begin() + at);
    blocks[b] = {};
  });
  coarse.corner = matrix.corner;
  for (const std::vector<float>& border : matrix.border) {
    std::vector<float> sums(a.count);
    for_each_index(threads, a.count, [&](std::size_t g) {
      double sum = 0;
      for (std::uint32_t k = a.begin[g]; k < a.begin[g + 1]; ++k)
        sum += static_cast<double>(border[a.member[k]]) * a.sign[a.member[k]];
      sums[g] = static_cast<float>(sum);
    });
    coarse.border.push_back(std::move(sums));
  }
  return coarse;
}

Coarsening coarsen_by_pairs_twice(const BorderedMatrix& matrix, const Threads& threads) {
  Coarsening result;
  Aggregation& a = result.aggregation;
  a = match_pairs(matrix, threads);
  const BorderedMatrix pairs = galerkin(matrix, a, threads);
  Aggregation second = match_pairs(pairs, threads);
  // A pair without neighbours after the first round still is one unknown of the coarse level.
  for (std::uint32_t& g : second.aggregate)
    if (g == none) g = second.count++;
  list_members(second);
  result.matrix = galerkin(pairs, second, threads);
  for_each_index(threads, a.aggregate.size(), [&](std::size_t i) {
    if (a.aggregate[i] == none) return;
    const std::uint32_t g = a.aggregate[i];
    a.sign[i] = static_cast<std::int8_t>(a.sign[i] * second.sign[g]);
    a.aggregate[i] = second.aggregate[g];
  });
  a.count = second.count;
  list_members(a);
  return result;
}

} // namespace eigencrust
