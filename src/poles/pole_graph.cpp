// SPDX-License-Identifier: GPL-3.0-or-later
// §3.1: the signed graph on the poles.
#include <algorithm>
#include <cmath>

#include <eigencrust/stages.h>

#include "geometry/distinct_numbers.h"
#include "numerics/weight_table.h"
#include "parallel/compressed_rows.h"
#include "parallel/prefetch.h"
#include "poles/pole_weights.h"

namespace eigencrust {
namespace {

constexpr std::uint32_t no_node = NodeIndex::none;
constexpr std::uint32_t outside_node = no_node - 1; ///< collapsed into the outside supernode
constexpr std::uint32_t inside_node = no_node - 2;

using Lists = CompressedRows<std::uint32_t>;

/// Delaunay neighbours of every sample, without cube corners.
Lists sample_neighbours(const Tetrahedralization& t, const VertexStars& stars, const Threads& threads) {
  return build_rows<std::uint32_t>(threads, t.sample_count, block_with_table(t.sample_count), [&] {
    return [&, distinct = DistinctNumbers(t.sample_count)](std::size_t s, std::vector<std::uint32_t>& row) mutable {
      distinct.clear();
      for (const TetrahedronIndex tetrahedron : stars[SampleIndex{static_cast<std::uint32_t>(s)}])
        for (const VertexIndex v : t.tetrahedra[tetrahedron])
          if (v.value != s && !t.is_corner(v)) distinct.add(v.value);
      row.insert(row.end(), distinct.numbers().begin(), distinct.numbers().end());
    };
  });
}

/// Samples that chose each pole, increasing.
Lists samples_of_poles(const Poles& poles) {
  return build_rows<std::uint32_t>(poles.tetrahedron.size(), [&](auto&& visit) {
    for (std::uint32_t s = 0; s < poles.of_sample.size(); ++s)
      for (const PoleIndex p : {poles.of_sample.raw()[s].first, poles.of_sample.raw()[s].second})
        if (p.valid()) visit(p.value, s);
  });
}

/// How much an isolated sample's pole pair counts: only as far as its Voronoi cell is long compared with its
/// neighbourhood, which an outlier's never is (docs/decisions/0013).
double trust_in_isolated(double shorter_pole, double neighbourhood) {
  return std::clamp(shorter_pole / neighbourhood - 1, 0.0, 1.0);
}

/// cos φ of two spheres: -1 where one touches the other from within, 1 from outside; more where they do not meet.
double cosine_of_spheres(const Sphere& a, const Sphere& b) {
  const double d2 = squared_norm(a.centre - b.centre);
  return (d2 - a.radius * a.radius - b.radius * b.radius) / (2 * a.radius * b.radius);
}

/// Same side: e^(4-4cosφ); 0 where the spheres do not meet.
double same_weight(const Sphere& a, const Sphere& b) {
  const double cosine = cosine_of_spheres(a, b);
  if (!(cosine <= 1)) return 0;
  return std::exp(steepness * (1 - std::max(cosine, -1.0)));
}

/// Calls visit for both poles of all neighbours of a sample, and for the neighbour.
template <class Visit>
void for_each_pole_beside(const Poles& poles, const Lists& neighbours, std::uint32_t sample, Visit&& visit) {
  for (const std::uint32_t neighbour : neighbours[sample]) {
    visit(poles.of_sample.raw()[neighbour].first, neighbour);
    visit(poles.of_sample.raw()[neighbour].second, neighbour);
  }
}

/// Clusters of poles (docs/decisions/0025): balls that nearly coincide are on the same side, so each pole joins the
/// largest ball around that its own nearly coincides with. Only upward: a chain of balls through the noise would
/// otherwise join one side with the other. Going upward through the gap in a wall is such a chain, too, so in noise a
/// pole joins the first, largest ball of a cluster or none.
class Contraction {
 public:
  Contraction(const Poles& poles, const Lists& neighbours, const Lists& samples_of,
              const std::vector<std::uint32_t>& node_of, const PoleGraphSamples& samples, const Threads& threads)
      : spheres_(poles.sphere.raw()),
        radius_(spheres_.size()),
        in_noise_(spheres_.size(), 0),
        first_(spheres_.size(), no_node) {
    for_each_index(threads, spheres_.size(),
                   [&](std::size_t p) { radius_[p] = node_of[p] < inside_node ? spheres_[p].radius : 0; });
    const auto is_isolated = [&](std::uint32_t s) {
      return !samples.isolated.empty() && samples.isolated[SampleIndex{s}] > 0;
    };
    const auto may_join = build_rows<std::uint32_t>(threads, spheres_.size(), block_with_table(spheres_.size()), [&] {
      return [&, larger = DistinctNumbers(spheres_.size())](std::size_t p, std::vector<std::uint32_t>& row) mutable {
        if (node_of[p] >= inside_node) return;
        larger.clear();
        for (const std::uint32_t s : samples_of[p]) {
          if (!samples.noisy.empty() && samples.noisy[s] != 0) in_noise_[p] = 1;
          if (is_isolated(s)) continue;
          for_each_pole_beside(poles, neighbours, s, [&](PoleIndex q, std::uint32_t neighbour) {
            if (q.valid() && is_larger(q.value, p) && !is_isolated(neighbour)) larger.add(q.value);
          });
        }
        append_joinable(static_cast<std::uint32_t>(p), larger.numbers(), row);
      };
    });
    for (std::uint32_t p = 0; p < first_.size(); ++p) join(p, may_join);
  }

  /// The largest pole of the cluster.
  [[nodiscard]] std::uint32_t first_of(std::uint32_t p) const { return first_[p]; }

 private:
  // Between -0.98 and -0.9 all raw scans come out the same but for a handle, at -0.8 clusters of the raw armadillo hold
  // poles of both sides. In noise the first ball may differ more from one that joins it than its neighbours do
  // (docs/decisions/0025).
  static constexpr double nearly_one = -0.93, nearly_one_with_first = -0.8;

  [[nodiscard]] bool is_larger(std::size_t p, std::size_t q) const {
    return radius_[p] > radius_[q] || (radius_[p] == radius_[q] && p < q);
  }
  [[nodiscard]] bool coincide(std::uint32_t p, std::uint32_t q, double cosine) const {
    return cosine_of_spheres(spheres_[p], spheres_[q]) < cosine;
  }

  /// In noise every larger ball that the pole's own nearly coincides with, else the largest one.
  void append_joinable(std::uint32_t p, const std::vector<std::uint32_t>& larger, std::vector<std::uint32_t>& row) {
    std::uint32_t largest = p;
    for (const std::uint32_t q : larger) {
      if (!(in_noise_[p] || is_larger(q, largest)) || !coincide(p, q, nearly_one)) continue;
      if (in_noise_[p])
        row.push_back(q);
      else
        largest = q;
    }
    if (largest != p) row.push_back(largest);
  }

  /// Finds the first of a pole, after those of all that it may join, which are larger.
  void join(std::uint32_t p, const Lists& may_join) {
    waiting_.push_back(p);
    while (!waiting_.empty()) {
      const std::uint32_t here = waiting_.back();
      const std::size_t before = waiting_.size();
      if (first_[here] != no_node) { // one of those before led to it
        waiting_.pop_back();
        continue;
      }
      for (const std::uint32_t q : may_join[here])
        if (first_[q] == no_node) waiting_.push_back(q);
      if (waiting_.size() > before) continue;
      waiting_.pop_back();
      std::uint32_t first = here;
      for (const std::uint32_t q : may_join[here])
        if (is_larger(first_[q], first) && (!in_noise_[here] || coincide(here, first_[q], nearly_one_with_first)))
          first = first_[q];
      first_[here] = first;
    }
  }

  const std::vector<Sphere>& spheres_;
  std::vector<double> radius_;         ///< of each pole, 0: no node
  std::vector<std::uint8_t> in_noise_; ///< of each pole: one of its samples is noisy
  std::vector<std::uint32_t> first_, waiting_;
};

using Entry = std::pair<std::uint32_t, float>; ///< column and weight

/// Assembles rows one by one from the stars, each edge in the row of the smaller node: no pair list, no global sort,
/// and no edge within a cluster.
class RowAssembler {
 public:
  RowAssembler(const Tetrahedralization& t, const Poles& poles, const Lists& neighbours, const Lists& samples_of,
               const std::vector<std::uint32_t>& node_of, std::uint32_t nodes, SampleLengthsView isolated)
      : t_(t),
        poles_(poles),
        neighbours_(neighbours),
        samples_of_(samples_of),
        node_of_(node_of),
        isolated_(isolated),
        candidates_(node_of.size()),
        sums_(nodes) {}

  /// Appends the edges of a node, the poles `members`, to larger ones. \return sums to the supernodes
  std::array<double, 2> append(std::uint32_t node, std::span<const std::uint32_t> members, std::vector<Entry>& row) {
    sums_.clear();
    std::array<double, 2> super{};
    for (const std::uint32_t p : members) add_edges_of(node, p, super);
    const auto begin = static_cast<std::ptrdiff_t>(row.size());
    sums_.for_each([&](std::uint32_t other, float w) { row.emplace_back(other, w); });
    std::sort(row.begin() + begin, row.end());
    return super;
  }

 private:
  struct Opposite {
    std::uint32_t pole, sample;
    friend bool operator<(const Opposite& a, const Opposite& b) {
      return std::pair(a.pole, a.sample) < std::pair(b.pole, b.sample);
    }
  };

  void add_edges_of(std::uint32_t own, std::uint32_t p, std::array<double, 2>& super) {
    collect(own, p);
    for (const std::uint32_t q : candidates_.numbers()) {
      const auto opposite =
          std::find_if(opposite_.begin(), opposite_.end(), [&](const Opposite& o) { return o.pole == q; });
      const double w = opposite != opposite_.end() ? weight_of_pair(SampleIndex{opposite->sample}, p, q)
                                                   : same_weight(poles_.sphere.raw()[p], poles_.sphere.raw()[q]);
      if (w == 0) continue;
      const std::uint32_t node = node_of_[q];
      if (node == outside_node)
        super[0] += w;
      else if (node == inside_node)
        super[1] += w;
      else
        sums_.add(node, w);
    }
  }

  double weight_of_pair(SampleIndex sample, std::uint32_t p, std::uint32_t q) const {
    const Sphere &a = poles_.sphere.raw()[p], &b = poles_.sphere.raw()[q];
    const Vec3& s = t_.positions[sample];
    const double w = opposite_weight(s, a, b);
    if (isolated_.empty() || !(isolated_[sample] > 0)) return w;
    const double shorter = std::min(distance(a.centre, s), distance(b.centre, s));
    return w * trust_in_isolated(shorter, static_cast<double>(isolated_[sample]));
  }

  void collect(std::uint32_t own, std::uint32_t p) {
    candidates_.clear();
    opposite_.clear();
    const auto add = [&](PoleIndex q) {
      if (!q.valid() || node_of_[q.value] == no_node || node_of_[q.value] <= own) return;
      candidates_.add(q.value);
      prefetch(poles_.sphere[q]);
    };
    for (const std::uint32_t s : samples_of_[p]) {
      const PolePair& pair = poles_.of_sample.raw()[s];
      const PoleIndex other = pair.first.value == p ? pair.second : pair.first;
      add(other);
      if (other.valid()) opposite_.push_back({other.value, s});
      for_each_pole_beside(poles_, neighbours_, s, [&](PoleIndex q, std::uint32_t) { add(q); });
    }
    // Pairs chosen by several samples count once, measured at the smallest of them.
    std::sort(opposite_.begin(), opposite_.end());
    opposite_.erase(std::unique(opposite_.begin(), opposite_.end(),
                                [](const Opposite& a, const Opposite& b) { return a.pole == b.pole; }),
                    opposite_.end());
  }

  const Tetrahedralization& t_;
  const Poles& poles_;
  const Lists &neighbours_, &samples_of_;
  const std::vector<std::uint32_t>& node_of_;
  SampleLengthsView isolated_;
  DistinctNumbers candidates_;
  WeightTable sums_;
  std::vector<Opposite> opposite_;
};

/// One large negative edge between the supernodes: as much as all their other edges together (as in §3.4).
void repel_supernodes(SignedGraph& graph) {
  double sum = 0;
  for (const SignedGraph::Supernode& super : graph.supernodes)
    for (const float w : super.weight) sum += std::fabs(static_cast<double>(w));
  graph.supernode_weight[0][1] = graph.supernode_weight[1][0] = -std::max(sum, 1.0);
}

/// Gives the poles that are nodes (0 before) their numbers, by the first pole of each. \return how many nodes
std::uint32_t number_nodes(const Poles& poles, const Lists& neighbours, const Lists& samples_of, bool contract,
                           const PoleGraphSamples& samples, const Threads& threads,
                           std::vector<std::uint32_t>& node_of) {
  std::uint32_t nodes = 0;
  if (!contract) {
    for (std::uint32_t& node : node_of)
      if (node < inside_node) node = nodes++;
    return nodes;
  }
  const Contraction clusters(poles, neighbours, samples_of, node_of, samples, threads);
  std::vector<std::uint32_t> node_of_first(node_of.size(), no_node);
  for (std::uint32_t p = 0; p < node_of.size(); ++p) {
    if (node_of[p] >= inside_node) continue;
    std::uint32_t& node = node_of_first[clusters.first_of(p)];
    if (node == no_node) node = nodes++;
    node_of[p] = node;
  }
  return nodes;
}

/// The poles of each node, increasing.
Lists members_of(const std::vector<std::uint32_t>& node_of, std::uint32_t nodes) {
  return build_rows<std::uint32_t>(nodes, [&](auto&& visit) {
    for (std::uint32_t p = 0; p < node_of.size(); ++p)
      if (node_of[p] < inside_node) visit(node_of[p], p);
  });
}

} // namespace

PoleGraph pole_graph(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, const Labels& known,
                     std::span<const std::uint8_t> left_out, const PoleGraphSamples& samples, bool contract,
                     const Threads& threads) {
  std::vector<std::uint32_t> node_of(poles.tetrahedron.size(), no_node);
  for (std::uint32_t p = 0; p < poles.tetrahedron.size(); ++p) {
    const TetrahedronIndex tetrahedron = poles.tetrahedron.raw()[p];
    if (known[tetrahedron] == Label::outside)
      node_of[p] = outside_node;
    else if (known[tetrahedron] == Label::inside)
      node_of[p] = inside_node;
    else if (left_out.empty() || !left_out[tetrahedron.value])
      node_of[p] = 0;
  }
  const bool some_inside = std::any_of(known.begin(), known.end(), [](Label l) { return l == Label::inside; });
  const std::size_t supernodes = some_inside ? 2 : 1;
  const Lists neighbours = sample_neighbours(t, stars, threads);
  const Lists samples_of = samples_of_poles(poles);
  const std::uint32_t nodes = number_nodes(poles, neighbours, samples_of, contract, samples, threads, node_of);
  const Lists members = members_of(node_of, nodes);

  PoleGraph result;
  SignedGraph& graph = result.graph;
  graph.supernodes.assign(supernodes, {std::vector<float>(nodes, 0.0f)});
  graph.supernode_weight.assign(supernodes, std::vector<double>(supernodes, 0.0));
  auto rows = build_rows<Entry>(threads, nodes, block_with_table(nodes), [&] {
    return [&, assembler = RowAssembler(t, poles, neighbours, samples_of, node_of, nodes, samples.isolated)](
               std::size_t i, std::vector<Entry>& row) mutable {
      const auto super = assembler.append(static_cast<std::uint32_t>(i), members[i], row);
      for (std::size_t k = 0; k < supernodes; ++k) graph.supernodes[k].weight[i] = static_cast<float>(super[k]);
    };
  });
  mirror_rows(std::move(rows), graph.row_begin, graph.column, graph.weight, threads);
  if (supernodes == 2) repel_supernodes(graph);
  result.node = IndexedArray<PoleIndex, NodeIndex>(poles.tetrahedron.size());
  for (std::uint32_t p = 0; p < node_of.size(); ++p)
    if (node_of[p] < inside_node) result.node.raw()[p] = NodeIndex{node_of[p]};
  return result;
}

} // namespace eigencrust
