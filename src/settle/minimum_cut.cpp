// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Maximum flow by augmenting paths between two trees that are kept from path to path: Boykov and Kolmogorov, "An
/// experimental comparison of min-cut/max-flow algorithms for energy minimization in vision", PAMI 26(9), 2004. The
/// time stamps and distances that save most walks to the roots are those of Kolmogorov's thesis (Cornell, 2004).
/// Incremental breadth-first search (Goldberg et al., ESA 2011) was as fast where most nodes have a terminal of the
/// right sign, but took up to 1.6 times as long where few have.
#include "settle/minimum_cut.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "parallel/compressed_rows.h"

namespace eigencrust {
namespace {

using Number = std::uint32_t; ///< of a node
/// Where a node hangs: at the arc of that number, or at the source or the sink itself, or nowhere.
enum Parent : std::uint8_t { first_arc, second_arc, third_arc, fourth_arc, at_terminal, no_parent };
/// Nodes of a part that one thread solves on its own at first. Neighbours should mostly be in the same part.
constexpr Number part_size = long_block;

/// All that a step of the search needs of a node.
struct Node {
  std::array<Number, 4> to;              ///< the node itself where there is no edge
  std::array<std::uint16_t, 4> residual; ///< of the arc from here, at most twice an edge's capacity
  std::int32_t terminal;                 ///< residual capacity from the source (> 0) or to the sink (< 0)
  std::uint32_t stamp;                   ///< when `distance` was found
  std::uint32_t distance;                ///< of edges to the root of the tree, at least 1; an estimate since `stamp`
  std::int8_t tree;                      ///< +1: the source reaches it, -1: it reaches the sink, 0: neither (yet)
  std::uint8_t parent;                   ///< the arc to it, at_terminal or no_parent
  std::uint8_t sisters;                  ///< 2 bits per arc: which of the other node's arcs leads back
  bool active;                           ///< in the queue

  [[nodiscard]] unsigned sister(unsigned arc) const { return (sisters >> (2 * arc)) % 4; }
};

void fill_node(const CutProblem& problem, Number i, Node& node) {
  std::int32_t total = 0;
  for (unsigned a = 0; a < 4; ++a) {
    const std::uint32_t j = problem.neighbour[i][a];
    if (problem.capacity[i][a] > CutProblem::largest_capacity)
      throw std::invalid_argument("minimum cut: a capacity is too large");
    const bool edge = j < problem.terminal.size() && j != i && problem.capacity[i][a] > 0;
    node.to[a] = edge ? j : i;
    node.residual[a] = edge ? problem.capacity[i][a] : std::uint16_t{0};
    total += node.residual[a];
  }
  // More than that can never be used up, and without it no sum can overflow.
  node.terminal = std::clamp(problem.terminal[i], -total - 1, total + 1);
}

/// Which arc of node to[arc] leads back. Of equal edges the m-th here is the m-th there.
unsigned find_sister(const Node* nodes, Number i, unsigned arc) {
  const Node& node = nodes[i];
  if (node.to[arc] == i) return arc;
  const Node& other = nodes[node.to[arc]];
  unsigned matches = 0; // a bit per arc, because branches would mispredict
  for (unsigned a = 0; a < 4; ++a)
    matches |= static_cast<unsigned>(other.to[a] == i && other.residual[a] == node.residual[arc]) << a;
  if (!std::has_single_bit(matches))
    for (unsigned a = 0; a < arc; ++a)
      if (node.to[a] == node.to[arc] && node.residual[a] == node.residual[arc]) matches &= matches - 1;
  if (matches == 0) throw std::invalid_argument("minimum cut: an edge is not the same from both its nodes");
  return static_cast<unsigned>(std::countr_zero(matches));
}

std::unique_ptr<Node[]> make_nodes(const CutProblem& problem, const Threads& threads) {
  const std::size_t n = problem.terminal.size();
  // Not set to zero: the pages are first touched by all threads.
  auto nodes = std::make_unique_for_overwrite<Node[]>(n);
  for_each_index(threads, n, [&](std::size_t i) { fill_node(problem, static_cast<Number>(i), nodes[i]); });
  for_each_index(threads, n, [&](std::size_t i) {
    unsigned sisters = 0;
    for (unsigned a = 0; a < 4; ++a) sisters |= find_sister(nodes.get(), static_cast<Number>(i), a) << (2 * a);
    nodes[i].sisters = static_cast<std::uint8_t>(sisters);
  });
  return nodes;
}

/// Maximum flow on nodes [begin, end), as if edges to others were none. `sign` as a template parameter is the `tree` of
/// the nodes in question.
class FlowSearch {
 public:
  FlowSearch(Node* nodes, Number begin, Number end) : nodes_(nodes), begin_(begin), end_(end) {}

  /// The flow. Afterwards `tree` tells the nodes' sides.
  std::int64_t solve() {
    saturate_short_paths();
    plant_trees();
    search();
    return flow_;
  }

  /// What more flows after the parts were solved on their own: their trees meet (Liu and Sun, "Parallel graph-cuts by
  /// adaptive bottom-up merging", CVPR 2010).
  std::int64_t join_parts() {
    for (Number i = begin_; i < end_; ++i) {
      const auto& [a, b, c, d] = nodes_[i].to;
      const Number part = i / part_size;
      time_ = std::max(time_, nodes_[i].stamp);
      if (a / part_size != part || b / part_size != part || c / part_size != part || d / part_size != part) activate(i);
    }
    search();
    return flow_;
  }

 private:
  [[nodiscard]] bool holds(Number i) const { return i - begin_ < end_ - begin_; }

  void search() {
    while (!active_.empty()) {
      const Number i = take_active();
      if (nodes_[i].tree > 0)
        grow<+1>(i);
      else if (nodes_[i].tree < 0)
        grow<-1>(i);
    }
  }

  /// Residual capacity over the node's arc in the direction away from the root of a tree of this sign: with the
  /// node's own sign what it can do for a child at the other end, with the opposite sign what a parent there can do
  /// for it.
  template <int sign>
  std::uint16_t& away(Node& node, unsigned arc) {
    if constexpr (sign > 0)
      return node.residual[arc];
    else
      return nodes_[node.to[arc]].residual[node.sister(arc)];
  }
  Number parent_of(const Node& node) const { return node.to[node.parent]; }

  /// Most of the flow goes from the source over one edge to the sink: this needs no trees.
  void saturate_short_paths() {
    for (Number i = begin_; i < end_; ++i) {
      Node& node = nodes_[i];
      for (unsigned a = 0; a < 4 && node.terminal > 0; ++a) {
        if (!holds(node.to[a])) continue;
        Node& other = nodes_[node.to[a]];
        if (other.terminal >= 0 || node.residual[a] == 0) continue;
        const std::int32_t amount = std::min({node.terminal, -other.terminal, std::int32_t{node.residual[a]}});
        node.terminal -= amount;
        other.terminal += amount;
        send(node, a, amount);
        flow_ += amount;
      }
    }
  }
  void send(Node& from, unsigned arc, std::int32_t amount) {
    add(away<+1>(from, arc), -amount);
    add(away<-1>(from, arc), amount);
  }
  static void add(std::uint16_t& residual, std::int32_t amount) {
    residual = static_cast<std::uint16_t>(residual + amount);
  }

  void plant_trees() {
    for (Number i = begin_; i < end_; ++i) {
      Node& node = nodes_[i];
      node.tree = static_cast<std::int8_t>(node.terminal > 0 ? 1 : node.terminal < 0 ? -1 : 0);
      node.parent = node.tree == 0 ? no_parent : at_terminal;
      node.active = false;
      node.stamp = 0;
      node.distance = 1;
      if (node.tree != 0) activate(i);
    }
  }
  /// An active node may have arcs to nodes outside its tree.
  void activate(Number i) {
    if (nodes_[i].active) return;
    nodes_[i].active = true;
    active_.push_back(i);
  }
  Number take_active() {
    const Number i = active_[static_cast<std::size_t>(next_++)];
    nodes_[i].active = false;
    if (2 * next_ >= std::ssize(active_)) { // most have been taken
      active_.erase(active_.begin(), active_.begin() + next_);
      next_ = 0;
    }
    return i;
  }

  /// Adds free neighbours to the node's tree, and augments wherever it meets the other tree.
  template <int sign>
  void grow(Number i) {
    Node& node = nodes_[i];
    for (unsigned a = 0; a < 4; ++a)
      // Paths over this arc are used up to the last one, or until the node itself has lost its tree.
      while (holds(node.to[a]) && away<sign>(node, a) > 0) {
        Node& other = nodes_[node.to[a]];
        if (other.tree == -sign) {
          if constexpr (sign > 0)
            augment(i, a);
          else
            augment(node.to[a], node.sister(a));
          if (node.tree != sign) return;
          continue;
        }
        const bool free = other.tree == 0;
        // A node of the same tree is better off as a child if that surely is a shorter way.
        if (free || (other.stamp <= node.stamp && other.distance > node.distance + 1)) {
          other.parent = static_cast<std::uint8_t>(node.sister(a));
          other.stamp = node.stamp;
          other.distance = node.distance + 1;
        }
        if (free) {
          other.tree = sign;
          activate(node.to[a]);
        }
        break;
      }
  }

  /// Sends what it can over the path whose middle is the arc from a node of the source's tree to one of the sink's.
  void augment(Number i, unsigned arc) {
    Node& node = nodes_[i];
    const Number j = node.to[arc];
    const std::int32_t amount = bottleneck<-1>(j, bottleneck<+1>(i, node.residual[arc]));
    send(node, arc, amount);
    flow_ += amount;
    ++time_;
    send_from_root<+1>(i, amount);
    adopt<+1>();
    send_from_root<-1>(j, amount);
    adopt<-1>();
  }
  template <int sign>
  std::int32_t bottleneck(Number i, std::int32_t amount) {
    for (;; i = parent_of(nodes_[i])) {
      Node& node = nodes_[i];
      if (node.parent == at_terminal) return std::min(amount, sign * node.terminal);
      amount = std::min<std::int32_t>(amount, away<-sign>(node, node.parent));
    }
  }
  template <int sign>
  void send_from_root(Number i, std::int32_t amount) {
    Node* node = &nodes_[i];
    while (node->parent != at_terminal) {
      const Number parent = parent_of(*node);
      add(away<sign>(*node, node->parent), amount);
      std::uint16_t& left = away<-sign>(*node, node->parent);
      add(left, -amount);
      if (left == 0) make_orphan(i);
      i = parent;
      node = &nodes_[i];
    }
    node->terminal -= sign * amount;
    if (node->terminal == 0) make_orphan(i);
    // Those next to the root come first: others may find their parent among what hangs on them.
    std::reverse(orphans_.begin(), orphans_.end());
  }

  void make_orphan(Number i) {
    nodes_[i].parent = no_parent;
    orphans_.push_back(i);
  }
  template <int sign>
  void adopt() {
    for (std::size_t k = 0; k < orphans_.size(); ++k) // by number, as they become more meanwhile
      if (!find_parent<sign>(orphans_[k])) leave_tree<sign>(orphans_[k]);
    orphans_.clear();
  }
  template <int sign>
  bool find_parent(Number i) {
    Node& node = nodes_[i];
    std::uint32_t best = unreachable;
    unsigned arc = no_parent; // the node stays an orphan during the search: no way to the root leads over it
    for (unsigned a = 0; a < 4; ++a) {
      if (!holds(node.to[a])) continue;
      const Node& other = nodes_[node.to[a]];
      if (other.tree != sign || other.parent == no_parent || away<-sign>(node, a) == 0) continue;
      const std::uint32_t distance = distance_to_root(node.to[a]);
      if (distance >= best) continue;
      best = distance;
      arc = a;
    }
    if (best == unreachable) return false;
    node.parent = static_cast<std::uint8_t>(arc);
    node.stamp = time_;
    node.distance = best + 1;
    return true;
  }
  /// unreachable if the way to the root ends at an orphan; else the nodes on it are marked, so that the next search
  /// ends at them.
  std::uint32_t distance_to_root(Number start) {
    std::uint32_t steps = 0;
    Number i = start;
    for (; nodes_[i].stamp != time_; i = parent_of(nodes_[i])) {
      Node& node = nodes_[i];
      if (node.parent == no_parent) return unreachable;
      if (node.parent == at_terminal) {
        node.stamp = time_;
        node.distance = 1;
        break;
      }
      ++steps;
    }
    const std::uint32_t distance = steps + nodes_[i].distance;
    std::uint32_t left = distance;
    for (i = start; nodes_[i].stamp != time_; i = parent_of(nodes_[i])) {
      nodes_[i].stamp = time_;
      nodes_[i].distance = left--;
    }
    return distance;
  }
  template <int sign>
  void leave_tree(Number i) {
    Node& node = nodes_[i];
    node.tree = 0;
    for (unsigned a = 0; a < 4; ++a) {
      const Number j = node.to[a];
      if (!holds(j) || nodes_[j].tree != sign) continue;
      // Which could not be this node's parent now may be later.
      if (away<-sign>(node, a) > 0) activate(j);
      if (nodes_[j].parent == node.sister(a)) make_orphan(j);
    }
  }

  static constexpr std::uint32_t unreachable = std::numeric_limits<std::uint32_t>::max();
  Node* nodes_;
  Number begin_, end_;
  std::vector<Number> active_; ///< first in, first out, from next_ on
  std::ptrdiff_t next_ = 0;
  std::vector<Number> orphans_;
  std::uint32_t time_ = 0; ///< number of augmentations
  std::int64_t flow_ = 0;
};

} // namespace

CutResult minimum_cut(const CutProblem& problem, const Threads& threads) {
  const std::size_t n = problem.terminal.size();
  if (problem.neighbour.size() != n || problem.capacity.size() != n || n >= CutProblem::none)
    throw std::invalid_argument("minimum cut: the arrays are not of the same length, or too long");
  const std::unique_ptr<Node[]> nodes = make_nodes(problem, threads);
  const auto end = static_cast<Number>(n);
  std::vector<std::int64_t> flow((n + part_size - 1) / part_size);
  threads.run(flow.size(), [&](std::size_t part) {
    const auto first = static_cast<Number>(part * part_size);
    flow[part] = FlowSearch(nodes.get(), first, std::min(first + part_size, end)).solve();
  });
  CutResult result;
  result.flow = std::accumulate(flow.begin(), flow.end(), FlowSearch(nodes.get(), 0, end).join_parts());
  result.side.resize(n);
  for_each_index(threads, n, [&](std::size_t i) {
    result.side[i] = nodes[i].tree > 0 ? CutSide::source : nodes[i].tree < 0 ? CutSide::sink : CutSide::either;
  });
  return result;
}

} // namespace eigencrust
