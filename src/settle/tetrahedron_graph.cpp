// SPDX-License-Identifier: GPL-3.0-or-later
// §3.4: the second graph, on the tetrahedra that have no label yet.
#include <algorithm>
#include <cmath>

#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust {
namespace {

/// Longest over shortest edge of the face opposite vertex k: skinny faces resist being cut.
double face_weight(const Tetrahedralization& t, const std::array<SampleIndex, 4>& v, std::size_t k) {
  const Vec3 &a = t.positions[v[(k + 1) % 4]], &b = t.positions[v[(k + 2) % 4]], &c = t.positions[v[(k + 3) % 4]];
  const double ab = squared_norm(a - b), bc = squared_norm(b - c), ca = squared_norm(c - a);
  return std::sqrt(std::max({ab, bc, ca}) / std::min({ab, bc, ca}));
}

/// How a circumcentre c lies to the poles of one sample s of its tetrahedron: on the side of the outside
/// pole, of the inside pole, or beside both.
void add_ties_of_sample(const Vec3& s, const Vec3& c, const Sphere& outside, const Sphere& inside, double& out,
                        double& in) {
  const Vec3 towards = c - s;
  const double length = norm(towards);
  const auto cosine = [&](const Sphere& pole) {
    return std::clamp(dot(pole.centre - s, towards) / (norm(pole.centre - s) * length), -1.0, 1.0);
  };
  // e^(4+4cos) is the weight of the pole graph's edges between tangent spheres (§3.1); relative to faces
  // only its shape matters, so the constant e^4 goes into the factor.
  out += std::exp(4 * cosine(outside));
  in += std::exp(4 * cosine(inside));
}

/// Ties each unlabelled tetrahedron to the poles of its four samples (docs/decisions/0006). In the long
/// Voronoi cell of a sample on a smooth surface every circumcentre lies on the side of one of its two
/// poles; where the poles have opposite labels, that says on which side the tetrahedron is.
void add_pole_ties(const Tetrahedralization& t, const Poles& poles, const Labels& labels, double factor,
                   std::span<const float> reach, TetrahedronGraph& result, const Threads& threads) {
  std::vector<SignedGraph::Supernode>& super = result.graph.supernodes;
  for_each_index(threads, result.tetrahedron.size(), [&](std::size_t i) {
    const auto& v = t.tetrahedra[result.tetrahedron.raw()[i]];
    const Vec3 c = circumcentre(t.positions[v[0]], t.positions[v[1]], t.positions[v[2]], t.positions[v[3]]);
    double out = 0, in = 0;
    for (const SampleIndex s : v) {
      // Around a sample that is off the surface by more than the spacing, directions mean nothing.
      if (t.is_corner(s) || (!reach.empty() && reach[s.value] > 0)) continue;
      auto [first, second] = poles.of_sample[s];
      if (!first.valid() || !second.valid()) continue;
      if (labels[poles.tetrahedron[first]] == Label::inside) std::swap(first, second);
      if (labels[poles.tetrahedron[first]] != Label::outside || labels[poles.tetrahedron[second]] != Label::inside)
        continue;
      add_ties_of_sample(t.positions[s], c, poles.sphere[first], poles.sphere[second], out, in);
    }
    super[0].weight[i] += static_cast<float>(factor * out);
    super[1].weight[i] += static_cast<float>(factor * in);
  });
}

} // namespace

TetrahedronGraph tetrahedron_graph(const Tetrahedralization& t, const Poles& poles, const Labels& labels,
                                   double pole_ties, std::span<const float> reach, const Threads& threads) {
  TetrahedronGraph result;
  std::vector<std::uint32_t> node_of(t.tetrahedra.size(), NodeIndex::none);
  for (std::uint32_t i = 0; i < t.tetrahedra.size(); ++i) {
    if (labels.raw()[i] != Label::unlabelled) continue;
    node_of[i] = result.tetrahedron.size();
    result.tetrahedron.raw().push_back(TetrahedronIndex{i});
  }
  const std::uint32_t nodes = result.tetrahedron.size();
  SignedGraph& graph = result.graph;
  graph.row_begin.assign(nodes + 1, 0);
  for_each_index(threads, nodes, [&](std::size_t i) {
    for (const TetrahedronIndex n : t.neighbours[result.tetrahedron.raw()[i]])
      if (n.valid() && node_of[n.value] != NodeIndex::none) ++graph.row_begin[i + 1];
  });
  for (std::uint32_t i = 0; i < nodes; ++i) graph.row_begin[i + 1] += graph.row_begin[i];
  graph.column.resize(graph.row_begin[nodes]);
  graph.weight.resize(graph.row_begin[nodes]);
  graph.supernodes.assign(2, {std::vector<float>(nodes, 0.0f)});
  for_each_index(threads, nodes, [&](std::size_t i) {
    const TetrahedronIndex tetrahedron = result.tetrahedron.raw()[i];
    // Insertion keeps the row sorted; it has at most four entries.
    std::uint64_t end = graph.row_begin[i];
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours[tetrahedron][k];
      if (!n.valid()) continue;
      const auto w = static_cast<float>(face_weight(t, t.tetrahedra[tetrahedron], k));
      const std::uint32_t node = node_of[n.value];
      if (node == NodeIndex::none) {
        graph.supernodes[labels[n] == Label::outside ? 0 : 1].weight[i] += w;
        continue;
      }
      std::uint64_t at = end++;
      for (; at > graph.row_begin[i] && graph.column[at - 1] > node; --at) {
        graph.column[at] = graph.column[at - 1];
        graph.weight[at] = graph.weight[at - 1];
      }
      graph.column[at] = node;
      graph.weight[at] = w;
    }
  });
  if (pole_ties > 0) add_pole_ties(t, poles, labels, pole_ties, reach, result, threads);
  // The one negative edge: as strong as all other edges of the supernodes together.
  double sum = 0;
  for (const SignedGraph::Supernode& super : graph.supernodes)
    for (const float w : super.weight) sum += static_cast<double>(w);
  graph.supernode_weight = {{0, -sum}, {-sum, 0}};
  return result;
}

} // namespace eigencrust
