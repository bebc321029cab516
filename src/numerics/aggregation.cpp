// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/aggregation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/distinct_numbers.h"

namespace eigencrust {
namespace {

// Nodes are matched inside blocks of this many, all threads at a time; what is left over is matched after.
constexpr std::size_t matching_block = 32768;

/// Sums of one row by column. They are formed in the order in which they are given, and columns are kept in the order
/// of their first appearance.
class RowSums {
 public:
  struct Entry {
    std::uint32_t column;
    double sum, size;
  };

  explicit RowSums(std::size_t columns) : place_(columns, no_index) {}

  void add(std::uint32_t column, double value) {
    std::uint32_t& place = place_[column];
    if (place == no_index) {
      place = static_cast<std::uint32_t>(entry_.size());
      entry_.push_back({column, value, std::fabs(value)});
      return;
    }
    entry_[place].sum += value;
    entry_[place].size += std::fabs(value);
  }

  /// Calls visit(column, sum) for what does not cancel, and empties the table.
  template <class Visit>
  void take(const Visit& visit) {
    for (const Entry& e : entry_) {
      place_[e.column] = no_index;
      if (std::fabs(e.sum) > 1e-7 * e.size) visit(e.column, static_cast<float>(e.sum));
    }
    entry_.clear();
  }

 private:
  std::vector<std::uint32_t> place_; ///< in entry_
  std::vector<Entry> entry_;
};

/// The entries of M itself.
class EntriesOfNodes {
 public:
  explicit EntriesOfNodes(const BorderedMatrix& m) : m_(m) {}
  [[nodiscard]] std::uint32_t size() const { return m_.interior_size(); }
  [[nodiscard]] double diagonal(std::uint32_t i) const { return m_.diagonal[i]; }

  /// visit(column, value) for the entries of a row with columns in [begin, end).
  class Reader {
   public:
    Reader(const EntriesOfNodes& entries, std::uint32_t begin, std::uint32_t end)
        : m_(entries.m_), begin_(begin), end_(end) {}
    template <class Visit>
    void operator()(std::uint32_t i, const Visit& visit) {
      for (std::uint64_t e = m_.row_begin[i]; e < m_.row_begin[i + 1]; ++e)
        if (m_.column[e] >= begin_ && m_.column[e] < end_) visit(m_.column[e], m_.value[e]);
    }

   private:
    const BorderedMatrix& m_;
    std::uint32_t begin_, end_;
  };

 private:
  const BorderedMatrix& m_;
};

/// The entries of Pᵀ M P, summed when they are asked for: half of the rows never are.
class EntriesOfAggregates {
 public:
  EntriesOfAggregates(const BorderedMatrix& m, const Aggregation& a) : m_(m), a_(a) {}
  [[nodiscard]] std::uint32_t size() const { return a_.count; }
  [[nodiscard]] double diagonal(std::uint32_t g) const {
    double sum = 0;
    for (const std::uint32_t i : a_.members[g]) {
      sum += m_.diagonal[i];
      for (std::uint64_t e = m_.row_begin[i]; e < m_.row_begin[i + 1]; ++e)
        if (a_.aggregate[m_.column[e]] == g) sum += signed_entry(m_, a_, i, e);
    }
    return sum;
  }
  static double signed_entry(const BorderedMatrix& m, const Aggregation& a, std::uint32_t i, std::uint64_t e) {
    return static_cast<double>(a.sign[i] == a.sign[m.column[e]] ? m.value[e] : -m.value[e]);
  }

  class Reader {
   public:
    Reader(const EntriesOfAggregates& entries, std::uint32_t begin, std::uint32_t end)
        : m_(entries.m_), a_(entries.a_), begin_(begin), end_(end), sums_(end - begin) {}
    template <class Visit>
    void operator()(std::uint32_t g, const Visit& visit) {
      for (const std::uint32_t i : a_.members[g]) {
        for (std::uint64_t e = m_.row_begin[i]; e < m_.row_begin[i + 1]; ++e) {
          const std::uint32_t column = a_.aggregate[m_.column[e]];
          if (column != g && column >= begin_ && column < end_) sums_.add(column - begin_, signed_entry(m_, a_, i, e));
        }
      }
      sums_.take([&](std::uint32_t column, float value) { visit(column + begin_, value); });
    }

   private:
    const BorderedMatrix& m_;
    const Aggregation& a_;
    std::uint32_t begin_, end_;
    RowSums sums_;
  };

 private:
  const BorderedMatrix& m_;
  const Aggregation& a_;
};

/// Greedy matching in node order: deterministic, and along a space-filling curve also compact.
template <class Entries>
class Matching {
 public:
  Matching(const Entries& entries, const Threads& threads)
      : entries_(entries), partner_(entries.size(), no_index), attracts_(entries.size(), 1), scale_(entries.size()) {
    for_each_index(threads, scale_.size(), [&](std::size_t i) {
      const double d = entries.diagonal(static_cast<std::uint32_t>(i));
      scale_[i] = d > 0 ? static_cast<float>(1 / std::sqrt(d)) : 0.0f;
    });
    for_blocks(threads, scale_.size(), matching_block, [&](std::size_t begin, std::size_t end, std::size_t) {
      typename Entries::Reader read(entries_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
      for (std::size_t i = begin; i < end; ++i) match(static_cast<std::uint32_t>(i), read);
    });
    match_between_blocks(threads);
  }

  /// The number of pairs, and for each node its pair's number and sign; nodes left alone join the pair of their
  /// strongest neighbour, or coarsening would stall on stars. (All their neighbours have partners: of two free
  /// neighbours one would have taken the other.) Nodes without neighbours get none.
  Aggregation aggregation(const Threads& threads) const {
    Aggregation a;
    const std::size_t n = partner_.size();
    a.aggregate.assign(n, no_index);
    a.sign.assign(n, 1);
    std::vector<std::uint32_t> pairs((n + default_block - 1) / default_block);
    const auto leads = [&](std::size_t i) { return partner_[i] != no_index && partner_[i] > i; };
    for_blocks(threads, n, default_block, [&](std::size_t begin, std::size_t end, std::size_t b) {
      for (std::size_t i = begin; i < end; ++i) pairs[b] += leads(i);
    });
    for (std::uint32_t& count : pairs) a.count += std::exchange(count, a.count);
    for_blocks(threads, n, default_block, [&](std::size_t begin, std::size_t end, std::size_t b) {
      std::uint32_t next = pairs[b];
      for (std::size_t i = begin; i < end; ++i) {
        if (!leads(i)) continue;
        a.aggregate[i] = a.aggregate[partner_[i]] = next++;
        a.sign[partner_[i]] = attracts_[i];
      }
    });
    for (const auto& [i, neighbour, attracts] : followers(threads)) {
      a.aggregate[i] = a.aggregate[neighbour];
      a.sign[i] = static_cast<std::int8_t>(attracts * a.sign[neighbour]);
    }
    return a;
  }

 private:
  struct Strongest {
    std::uint32_t node = no_index;
    float strength = -1;
    std::int8_t attracts = 1; ///< +1 or -1
  };
  struct Follower {
    std::uint32_t node, neighbour;
    std::int8_t attracts;
  };

  template <class Allowed>
  Strongest strongest(std::uint32_t i, typename Entries::Reader& read, const Allowed& allowed) const {
    Strongest best;
    read(i, [&](std::uint32_t j, float value) {
      const float strength = std::fabs(value) * scale_[j];
      if (strength > best.strength && allowed(j)) best = {j, strength, static_cast<std::int8_t>(value <= 0 ? 1 : -1)};
    });
    return best;
  }

  /// Pairs a free node with its strongest free neighbour.
  void match(std::uint32_t i, typename Entries::Reader& read) {
    if (partner_[i] != no_index) return;
    const Strongest best = strongest(i, read, [&](std::uint32_t j) { return partner_[j] == no_index; });
    if (best.node == no_index) return;
    partner_[i] = best.node;
    partner_[best.node] = i;
    attracts_[i] = attracts_[best.node] = best.attracts;
  }

  std::vector<std::uint32_t> free_nodes() const {
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < partner_.size(); ++i)
      if (partner_[i] == no_index) result.push_back(i);
    return result;
  }

  /// work(k, read) for k in [0, n) on all threads.
  template <class Work>
  void for_each_with_reader(const Threads& threads, std::size_t n, const Work& work) const {
    for_blocks(threads, n, std::max<std::size_t>(1024, n / 16 + 1),
               [&](std::size_t begin, std::size_t end, std::size_t) {
                 typename Entries::Reader read(entries_, 0, entries_.size());
                 for (std::size_t k = begin; k < end; ++k) work(k, read);
               });
  }

  void match_between_blocks(const Threads& threads) {
    const std::vector<std::uint32_t> free = free_nodes();
    std::vector<std::uint8_t> has_choice(free.size());
    for_each_with_reader(threads, free.size(), [&](std::size_t k, typename Entries::Reader& read) {
      has_choice[k] =
          strongest(free[k], read, [&](std::uint32_t j) { return partner_[j] == no_index; }).node != no_index;
    });
    typename Entries::Reader read(entries_, 0, entries_.size());
    for (std::size_t k = 0; k < free.size(); ++k)
      if (has_choice[k]) match(free[k], read);
  }

  std::vector<Follower> followers(const Threads& threads) const {
    const std::vector<std::uint32_t> free = free_nodes();
    std::vector<Strongest> best(free.size());
    for_each_with_reader(threads, free.size(), [&](std::size_t k, typename Entries::Reader& read) {
      best[k] = strongest(free[k], read, [](std::uint32_t) { return true; });
    });
    std::vector<Follower> result;
    for (std::size_t k = 0; k < free.size(); ++k)
      if (best[k].node != no_index) result.push_back({free[k], best[k].node, best[k].attracts});
    return result;
  }

  const Entries& entries_;
  std::vector<std::uint32_t> partner_;
  std::vector<std::int8_t> attracts_; ///< +1: moves with its partner, -1: against it
  std::vector<float> scale_;
};

void list_members(Aggregation& a) {
  a.members = build_rows<std::uint32_t>(a.count, [&](auto&& visit) {
    for (std::uint32_t i = 0; i < a.aggregate.size(); ++i)
      if (a.aggregate[i] != no_index) visit(a.aggregate[i], i);
  });
}

/// Adds what the members of an aggregate have to the sums by column. \return the entry on the diagonal
double add_row(const BorderedMatrix& m, const Aggregation& a, std::size_t g, RowSums& sums) {
  double self = 0;
  for (const std::uint32_t i : a.members[g]) {
    self += m.diagonal[i];
    for (std::uint64_t e = m.row_begin[i]; e < m.row_begin[i + 1]; ++e) {
      const std::uint32_t column = a.aggregate[m.column[e]];
      const double v = EntriesOfAggregates::signed_entry(m, a, i, e);
      if (column == g)
        self += v;
      else
        sums.add(column, v);
    }
  }
  return self;
}

} // namespace

Aggregation match_pairs(const BorderedMatrix& m, const Threads& threads) {
  const EntriesOfNodes entries(m);
  Aggregation a = Matching(entries, threads).aggregation(threads);
  list_members(a);
  return a;
}

BorderedMatrix galerkin(const BorderedMatrix& matrix, const Aggregation& a, const Threads& threads) {
  BorderedMatrix coarse;
  coarse.diagonal.resize(a.count);
  using Entry = std::pair<std::uint32_t, float>;
  auto rows = build_rows<Entry>(threads, a.count, block_with_table(a.count), [&] {
    return [&, sums = RowSums(a.count)](std::size_t g, std::vector<Entry>& row) mutable {
      coarse.diagonal[g] = add_row(matrix, a, g, sums);
      sums.take([&](std::uint32_t column, float value) { row.emplace_back(column, value); });
    };
  });
  split_rows(std::move(rows), coarse.row_begin, coarse.column, coarse.value, threads);
  coarse.corner = matrix.corner;
  for (const std::vector<float>& border : matrix.border) {
    std::vector<float> sums(a.count);
    for_each_index(threads, a.count, [&](std::size_t g) {
      double sum = 0;
      for (const std::uint32_t i : a.members[g]) sum += static_cast<double>(border[i]) * a.sign[i];
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
  const EntriesOfAggregates pairs(matrix, a);
  Aggregation second = Matching(pairs, threads).aggregation(threads);
  // A pair without neighbours after the first round still is one unknown of the coarse level.
  for (std::uint32_t& g : second.aggregate)
    if (g == no_index) g = second.count++;
  for_each_index(threads, a.aggregate.size(), [&](std::size_t i) {
    if (a.aggregate[i] == no_index) return;
    const std::uint32_t g = a.aggregate[i];
    a.sign[i] = static_cast<std::int8_t>(a.sign[i] * second.sign[g]);
    a.aggregate[i] = second.aggregate[g];
  });
  a.count = second.count;
  list_members(a);
  result.matrix = galerkin(matrix, a, threads);
  return result;
}

} // namespace eigencrust
