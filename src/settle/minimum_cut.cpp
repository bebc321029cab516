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
#include <span>
#include <stdexcept>

namespace eigencrust {
namespace {

using Number = std::uint32_t; ///< of a node in the order of Clusters
constexpr Number no_node = CutProblem::none;
constexpr unsigned at_terminal = 4; ///< a parent that is the source or the sink itself
constexpr unsigned no_parent = 5;
/// Clusters up to this size are solved in groups of about this many nodes.
constexpr std::size_t group_size = 32768;

/// All that a step of the search needs of a node, in one cache line.
struct alignas(64) Node {
  std::array<Number, 4> to;              ///< the node itself where there is no edge
  std::array<std::uint32_t, 4> residual; ///< of the arc from here; unsigned as it can be twice an edge's capacity
  std::int64_t terminal;                 ///< residual capacity from the source (> 0) or to the sink (< 0)
  std::uint64_t stamp;                   ///< when `distance` was found
  std::uint32_t distance;                ///< of edges to the root of the tree, at least 1; an estimate since `stamp`
  Number next;                           ///< in the queue of active nodes, the last one's is itself; no_node: not in it
  std::int8_t tree;                      ///< +1: the source reaches it, -1: it reaches the sink, 0: neither (yet)
  std::uint8_t parent;                   ///< the arc to it, at_terminal or no_parent
  std::uint8_t sisters;                  ///< 2 bits per arc: which of the other node's arcs leads back

  [[nodiscard]] unsigned sister(unsigned arc) const { return (sisters >> (2 * arc)) & 3u; }
};
static_assert(sizeof(Node) == 64);

/// The nodes sorted by connected component.
struct Clusters {
  std::vector<std::uint32_t> order; ///< nodes of the problem, each cluster's together
  std::vector<Number> position;     ///< of each of the problem's nodes in `order`
  std::vector<Number> begin;        ///< of each cluster in `order`, and the end
};

/// Breadth-first, so that neighbours are near each other in memory whatever the order of the problem's nodes.
Clusters find_clusters(const CutProblem& problem) {
  const auto n = static_cast<std::uint32_t>(problem.terminal.size());
  Clusters c;
  c.order.reserve(n);
  c.position.assign(n, no_node);
  const auto place = [&](std::uint32_t i) {
    c.position[i] = static_cast<Number>(c.order.size());
    c.order.push_back(i);
  };
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (c.position[seed] != no_node) continue;
    std::size_t head = c.order.size();
    c.begin.push_back(static_cast<Number>(head));
    for (place(seed); head < c.order.size(); ++head) {
      const std::uint32_t i = c.order[head];
      for (unsigned a = 0; a < 4; ++a) {
        const std::uint32_t j = problem.neighbour[i][a];
        if (j < n && problem.capacity[i][a] > 0 && c.position[j] == no_node) place(j);
      }
    }
  }
  c.begin.push_back(n);
  return c;
}

void fill_node(const CutProblem& problem, const Clusters& clusters, Number number, Node& node) {
  const std::uint32_t i = clusters.order[number];
  std::int64_t total = 0;
  for (unsigned a = 0; a < 4; ++a) {
    const std::uint32_t j = problem.neighbour[i][a];
    const bool edge = j < problem.terminal.size() && j != i && problem.capacity[i][a] > 0;
    node.to[a] = edge ? clusters.position[j] : number;
    node.residual[a] = edge ? static_cast<std::uint32_t>(problem.capacity[i][a]) : 0;
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

std::unique_ptr<Node[]> make_nodes(const CutProblem& problem, const Clusters& clusters, const Threads& threads) {
  const std::size_t n = problem.terminal.size();
  // Not set to zero: the pages are first touched by all threads.
  auto nodes = std::make_unique_for_overwrite<Node[]>(n);
  for_each_index(threads, n, [&](std::size_t i) { fill_node(problem, clusters, static_cast<Number>(i), nodes[i]); });
  for_each_index(threads, n, [&](std::size_t i) {
    unsigned sisters = 0;
    for (unsigned a = 0; a < 4; ++a) sisters |= find_sister(nodes.get(), static_cast<Number>(i), a) << (2 * a);
    nodes[i].sisters = static_cast<std::uint8_t>(sisters);
  });
  return nodes;
}

/// Maximum flow on the nodes of one cluster. `sign` as a template parameter is the `tree` of the nodes in question.
class FlowSearch {
 public:
  explicit FlowSearch(Node* nodes) : nodes_(nodes) {}

  /// The flow on nodes [begin, end). Afterwards `tree` tells the nodes' sides.
  std::int64_t solve(Number begin, Number end) {
    flow_ = 0;
    saturate_short_paths(begin, end);
    plant_trees(begin, end);
    while (first_ != no_node) {
      const Number i = take_active();
      if (nodes_[i].tree > 0)
        grow<+1>(i);
      else if (nodes_[i].tree < 0)
        grow<-1>(i);
    }
    return flow_;
  }

 private:
  /// Residual capacity over the node's arc in the direction away from the root of a tree of this sign: with the
  /// node's own sign what it can do for a child at the other end, with the opposite sign what a parent there can do
  /// for it.
  template <int sign>
  std::uint32_t& away(Node& node, unsigned arc) {
    if constexpr (sign > 0)
      return node.residual[arc];
    else
      return nodes_[node.to[arc]].residual[node.sister(arc)];
  }
  Number parent_of(const Node& node) const { return node.to[node.parent]; }

  /// Most of the flow goes from the source over one edge to the sink: this needs no trees.
  void saturate_short_paths(Number begin, Number end) {
    for (Number i = begin; i < end; ++i) {
      Node& node = nodes_[i];
      for (unsigned a = 0; a < 4 && node.terminal > 0; ++a) {
        Node& other = nodes_[node.to[a]];
        if (other.terminal >= 0 || node.residual[a] == 0) continue;
        const std::int64_t amount =
            std::min({node.terminal, -other.terminal, static_cast<std::int64_t>(node.residual[a])});
        node.terminal -= amount;
        other.terminal += amount;
        send(node, a, amount);
        flow_ += amount;
      }
    }
  }
  void send(Node& from, unsigned arc, std::int64_t amount) {
    away<+1>(from, arc) -= static_cast<std::uint32_t>(amount);
    away<-1>(from, arc) += static_cast<std::uint32_t>(amount);
  }

  void plant_trees(Number begin, Number end) {
    time_ = 0;
    for (Number i = begin; i < end; ++i) {
      Node& node = nodes_[i];
      node.tree = static_cast<std::int8_t>(node.terminal > 0 ? 1 : node.terminal < 0 ? -1 : 0);
      node.parent = node.tree == 0 ? no_parent : at_terminal;
      node.next = no_node;
      node.stamp = 0;
      node.distance = 1;
      if (node.tree != 0) activate(i);
    }
  }
  /// An active node may have arcs to nodes outside its tree.
  void activate(Number i) {
    if (nodes_[i].next != no_node) return;
    nodes_[i].next = i;
    (first_ == no_node ? first_ : nodes_[last_].next) = i;
    last_ = i;
  }
  Number take_active() {
    const Number i = first_;
    first_ = i == last_ ? no_node : nodes_[i].next;
    nodes_[i].next = no_node;
    return i;
  }

  /// Adds free neighbours to the node's tree, and augments wherever it meets the other tree.
  template <int sign>
  void grow(Number i) {
    Node& node = nodes_[i];
    for (unsigned a = 0; a < 4; ++a)
      // Paths over this arc are used up to the last one, or until the node itself has lost its tree.
      while (away<sign>(node, a) > 0) {
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
    const std::int64_t amount = bottleneck<-1>(j, bottleneck<+1>(i, node.residual[arc]));
    send(node, arc, amount);
    flow_ += amount;
    ++time_;
    send_from_root<+1>(i, amount);
    adopt<+1>();
    send_from_root<-1>(j, amount);
    adopt<-1>();
  }
  template <int sign>
  std::int64_t bottleneck(Number i, std::int64_t amount) {
    for (;; i = parent_of(nodes_[i])) {
      Node& node = nodes_[i];
      if (node.parent == at_terminal) return std::min(amount, sign * node.terminal);
      amount = std::min<std::int64_t>(amount, away<-sign>(node, node.parent));
    }
  }
  template <int sign>
  void send_from_root(Number i, std::int64_t amount) {
    Node* node = &nodes_[i];
    while (node->parent != at_terminal) {
      const Number parent = parent_of(*node);
      away<sign>(*node, node->parent) += static_cast<std::uint32_t>(amount);
      std::uint32_t& left = away<-sign>(*node, node->parent);
      left -= static_cast<std::uint32_t>(amount);
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
      if (nodes_[j].tree != sign) continue;
      // Which could not be this node's parent now may be later.
      if (away<-sign>(node, a) > 0) activate(j);
      if (nodes_[j].parent == node.sister(a)) make_orphan(j);
    }
  }

  static constexpr std::uint32_t unreachable = std::numeric_limits<std::uint32_t>::max();
  Node* nodes_;
  Number first_ = no_node, last_ = no_node; ///< of the queue of active nodes
  std::vector<Number> orphans_;
  std::uint64_t time_ = 0; ///< number of augmentations
  std::int64_t flow_ = 0;
};

/// A range of clusters that one thread solves.
struct Group {
  std::size_t begin, end;
  std::size_t nodes;
};

/// Large clusters one by one, small ones in groups; the largest first, so that no thread gets a large one last.
std::vector<Group> group_clusters(const Clusters& clusters) {
  std::vector<Group> groups;
  for (std::size_t k = 0; k + 1 < clusters.begin.size(); ++k) {
    const std::size_t nodes = clusters.begin[k + 1] - clusters.begin[k];
    if (groups.empty() || groups.back().nodes + nodes > group_size) groups.push_back({k, k, 0});
    groups.back().end = k + 1;
    groups.back().nodes += nodes;
  }
  std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.nodes > b.nodes; });
  return groups;
}

/// Without both terminals nothing flows, and all nodes are where the only terminal is.
bool settle_trivial_cluster(std::span<Node> nodes) {
  bool source = false, sink = false;
  for (const Node& node : nodes) {
    source |= node.terminal > 0;
    sink |= node.terminal < 0;
  }
  if (source && sink) return false;
  for (Node& node : nodes) node.tree = static_cast<std::int8_t>(source - sink);
  return true;
}

} // namespace

CutResult minimum_cut(const CutProblem& problem, const Threads& threads) {
  const std::size_t n = problem.terminal.size();
  if (problem.neighbour.size() != n || problem.capacity.size() != n || n >= CutProblem::none)
    throw std::invalid_argument("minimum cut: the arrays are not of the same length, or too long");
  Clusters clusters = find_clusters(problem);
  const std::unique_ptr<Node[]> nodes = make_nodes(problem, clusters, threads);
  clusters.position = {};

  CutResult result;
  result.side.resize(n);
  result.clusters = clusters.begin.size() - 1;
  for (std::size_t k = 0; k < result.clusters; ++k)
    result.largest = std::max(result.largest, clusters.begin[k + 1] - clusters.begin[k]);

  const std::vector<Group> groups = group_clusters(clusters);
  std::vector<std::int64_t> flow(groups.size());
  threads.run(groups.size(), [&](std::size_t g) {
    FlowSearch search(nodes.get());
    for (std::size_t k = groups[g].begin; k < groups[g].end; ++k) {
      const Number begin = clusters.begin[k], end = clusters.begin[k + 1];
      if (!settle_trivial_cluster({&nodes[begin], end - begin})) flow[g] += search.solve(begin, end);
      for (Number i = begin; i < end; ++i)
        result.side[clusters.order[i]] = nodes[i].tree > 0   ? CutSide::source
                                         : nodes[i].tree < 0 ? CutSide::sink
                                                             : CutSide::either;
    }
  });
  result.flow = std::accumulate(flow.begin(), flow.end(), std::int64_t{0});
  return result;
}

} // namespace eigencrust
