// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/error.h>
#include <gmock/gmock.h>

#include <Eigen/Dense>

#include "graphs.h"

namespace eigencrust {
namespace {

using graphs::Planted;

PoleGraph as_pole_graph(SignedGraph graph) { return {std::move(graph), {}}; }

Partition partition_of(const SignedGraph& graph, std::vector<std::uint32_t>* component = nullptr,
                       const SolverOptions& options = {}) {
  return partition_poles(as_pole_graph(graph), options, false, Threads(1), component);
}

SolverOptions lanczos() {
  SolverOptions options;
  options.eigensolver = Eigensolver::lanczos;
  return options;
}

/// A random second graph: nodes in a ring with chords, each held by a supernode with probability 0.1.
TetrahedronGraph second_graph(std::uint32_t n, std::uint64_t seed) {
  clouds::Random random(seed);
  graphs::Edges edges;
  for (std::uint32_t i = 0; i < n; ++i) {
    edges[std::minmax(i, (i + 1) % n)] = random.uniform(1, 5);
    const std::uint32_t j = random.below(n);
    if (j != i) edges[std::minmax(i, j)] = random.uniform(1, 5);
  }
  std::vector<std::map<std::uint32_t, double>> super(2);
  double sum = 0;
  for (std::uint32_t i = 0; i < n; ++i)
    for (auto& held : super)
      if (random.uniform() < 0.1) sum += held[i] = random.uniform(1, 5);
  TetrahedronGraph graph{graphs::from_edges(n, edges, super), {}};
  graph.graph.supernode_weight = {{0, -sum}, {-sum, 0}};
  return graph;
}

TEST(PartitionPoles, OfAConsistentGraphIsExactAndSaysSo) {
  for (const SolverOptions& options : {SolverOptions{}, lanczos()})
    for (const std::uint32_t n : {50u, 2000u}) {
      const Planted p = graphs::planted(n, 6, 0, true, n);
      const Partition partition = partition_of(p.graph, nullptr, options);
      if (options.eigensolver == Eigensolver::multigrid) {
        EXPECT_EQ(partition.status, SolverStatus::consistent);
      }
      EXPECT_NEAR(partition.eigenvalue, 0, 1e-8);
      EXPECT_EQ(partition.undecided, 0u);
      for (std::uint32_t i = 0; i < n; ++i)
        EXPECT_GT(partition.value[i] * partition.supernode_value[0] * p.side[i], 0) << i;
    }
}

TEST(PartitionPoles, ComponentsWithoutTheSupernodeAreSolvedOnTheirOwn) {
  // A held ring, a free ring of the same kind, a free pair that repels, an isolated node.
  const Planted held = graphs::planted(40, 4, 0, true, 1), free_ring = graphs::planted(40, 4, 0, false, 2);
  graphs::Edges edges;
  const auto add = [&](const SignedGraph& g, std::uint32_t shift) {
    for (std::uint32_t i = 0; i < g.node_count(); ++i)
      for (std::uint64_t e = g.row_begin[i]; e < g.row_begin[i + 1]; ++e)
        edges[std::minmax(i + shift, g.column[e] + shift)] = static_cast<double>(g.weight[e]);
  };
  add(held.graph, 0);
  add(free_ring.graph, 40);
  edges[{80, 81}] = -5;
  std::map<std::uint32_t, double> super;
  for (std::uint32_t i = 0; i < 40; ++i) super[i] = static_cast<double>(held.graph.supernodes[0].weight[i]);
  std::vector<std::uint32_t> component;
  const Partition partition = partition_of(graphs::from_edges(83, edges, {super}), &component);
  EXPECT_EQ(partition.components, 4u);
  EXPECT_EQ(partition.free_components, 3u);
  EXPECT_EQ(partition.undecided, 0u);
  ASSERT_EQ(component.size(), 83u);
  for (std::uint32_t i = 0; i < 40; ++i) {
    EXPECT_EQ(component[i], 0u);
    EXPECT_GT(partition.value[i] * partition.supernode_value[0] * held.side[i], 0);
    EXPECT_EQ(component[40 + i], 1u);
    EXPECT_GT(partition.value[40 + i] * partition.value[40] * static_cast<float>(free_ring.side[i] * free_ring.side[0]),
              0);
  }
  EXPECT_EQ(component[80], 2u);
  EXPECT_LT(partition.value[80] * partition.value[81], 0);
  EXPECT_EQ(component[82], 3u);
}

TEST(PartitionPoles, SupernodeWithoutEdgesIsNoObstacle) {
  Planted p = graphs::planted(500, 6, 0, false, 3);
  p.graph.supernodes.push_back({std::vector<float>(500, 0.0f)});
  p.graph.supernode_weight = {{0}};
  std::vector<std::uint32_t> component;
  const Partition partition = partition_of(p.graph, &component);
  EXPECT_THAT(component, testing::Each(1u));
  EXPECT_EQ(partition.supernode_value[0], 0);
  EXPECT_EQ(partition.status, SolverStatus::consistent);
  for (std::uint32_t i = 0; i < 500; ++i)
    EXPECT_GT(partition.value[i] * partition.value[0] * static_cast<float>(p.side[i] * p.side[0]), 0);
}

TEST(PartitionPoles, OfNoNodesIsTrivial) {
  const Partition partition = partition_of(graphs::from_edges(0, {}, {{}}));
  EXPECT_EQ(partition.status, SolverStatus::trivial);
  EXPECT_TRUE(partition.value.empty());
  ASSERT_EQ(partition.supernode_value.size(), 1u);
}

TEST(PartitionPoles, TwoSupernodesThatRepelEndOnOppositeSides) {
  Planted p = graphs::planted(600, 6, 0.02, true, 4);
  SignedGraph::Supernode inside{std::vector<float>(600, 0.0f)};
  for (std::uint32_t i = 5; i < 600; i += 10) inside.weight[i] = -4 * static_cast<float>(p.side[i]);
  p.graph.supernodes.push_back(inside);
  p.graph.supernode_weight = {{0, -5000}, {-5000, 0}};
  const Partition partition = partition_of(p.graph);
  EXPECT_LT(partition.supernode_value[0] * partition.supernode_value[1], 0);
}

TEST(PartitionPoles, MultigridAndLanczosPutEveryNodeOnTheSameSide) {
  const Planted p = graphs::planted(3000, 8, 0.05, true, 5);
  const Partition a = partition_of(p.graph), b = partition_of(p.graph, nullptr, lanczos());
  EXPECT_EQ(b.status, SolverStatus::converged);
  // What the early stop leaves open is 0 and counted; it is little, and all the rest is right.
  EXPECT_LT(a.undecided, 30u);
  EXPECT_EQ(b.undecided, 0u);
  for (std::uint32_t i = 0; i < 3000; ++i)
    if (a.value[i] != 0) {
      EXPECT_GT(a.value[i] * a.supernode_value[0] * b.value[i] * b.supernode_value[0], 0) << i;
    }
}

TEST(PartitionPoles, CheckpointMayCancel) {
  const Planted p = graphs::planted(2000, 8, 0.05, true, 6);
  for (const SolverOptions& options : {SolverOptions{}, lanczos()}) {
    const auto cancel = [](double) { throw Error(ErrorKind::cancelled, "here", "cancelled", "go on"); };
    PoleGraph graph = as_pole_graph(p.graph);
    EXPECT_THROW(partition_poles(graph, options, false, Threads(2), nullptr, cancel), Error);
  }
}

TEST(PartitionTetrahedra, HarmonicValuesEqualTheDenseSolution) {
  constexpr std::uint32_t n = 700;
  const TetrahedronGraph h = second_graph(n, 7);
  Eigen::MatrixXd l = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd rhs(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint64_t e = h.graph.row_begin[i]; e < h.graph.row_begin[i + 1]; ++e) {
      l(i, h.graph.column[e]) -= static_cast<double>(h.graph.weight[e]);
      l(i, i) += static_cast<double>(h.graph.weight[e]);
    }
    const auto out = static_cast<double>(h.graph.supernodes[0].weight[i]);
    const auto in = static_cast<double>(h.graph.supernodes[1].weight[i]);
    l(i, i) += out + in;
    rhs(i) = out - in;
  }
  const Eigen::VectorXd expected = l.ldlt().solve(rhs);
  SolverOptions options;
  options.stop_on_stable_signs = false;
  const Partition partition = partition_tetrahedra(h.graph, SecondStage::harmonic, options, Threads(2));
  EXPECT_EQ(partition.status, SolverStatus::converged);
  EXPECT_THAT(partition.supernode_value, testing::ElementsAre(1, -1));
  for (std::uint32_t i = 0; i < n; ++i) EXPECT_NEAR(partition.value[i], expected(i), 1e-6);
}

TEST(PartitionTetrahedra, HarmonicValuesStayBetweenTheSupernodes) {
  for (const std::uint32_t n : {30u, 3000u}) {
    SolverOptions options;
    options.stop_on_stable_signs = false;
    const Partition partition =
        partition_tetrahedra(second_graph(n, n).graph, SecondStage::harmonic, options, Threads(1));
    for (const float v : partition.value) {
      EXPECT_LE(v, 1 + 1e-6f);
      EXPECT_GE(v, -1 - 1e-6f);
    }
  }
}

TEST(PartitionTetrahedra, NodesHeldByOneSupernodeOnlyTakeItsSide) {
  // 0-1-2 hang on outside alone, 3-4 on inside alone: the values are exactly those of the supernodes.
  TetrahedronGraph h{graphs::from_edges(5, {{{0, 1}, 1.0}, {{1, 2}, 2.0}, {{3, 4}, 1.5}}, {{{0, 1.0}}, {{4, 3.0}}}),
                     {}};
  h.graph.supernode_weight = {{0, -4}, {-4, 0}};
  const Partition partition = partition_tetrahedra(h.graph, SecondStage::harmonic, {}, Threads(1));
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_NEAR(partition.value[i], i < 3 ? 1 : -1, 1e-5);
}

TEST(PartitionTetrahedra, EigenvectorSeparatesTwoClearHalves) {
  // Two rings of 300, one held outside and one inside, joined by one weak edge.
  graphs::Edges edges;
  std::vector<std::map<std::uint32_t, double>> super(2);
  for (std::uint32_t half = 0; half < 2; ++half)
    for (std::uint32_t i = 0; i < 300; ++i) {
      edges[std::minmax(300 * half + i, 300 * half + (i + 1) % 300)] = 2;
      if (i % 5 == 0) super[half][300 * half + i] = 2;
    }
  edges[{7, 407}] = 1;
  TetrahedronGraph h{graphs::from_edges(600, edges, super), {}};
  h.graph.supernode_weight = {{0, -240}, {-240, 0}};
  for (const SecondStage method : {SecondStage::eigenvector, SecondStage::harmonic}) {
    const Partition partition = partition_tetrahedra(h.graph, method, {}, Threads(1));
    EXPECT_LT(partition.supernode_value[0] * partition.supernode_value[1], 0);
    for (std::uint32_t i = 0; i < 600; ++i)
      EXPECT_GT(partition.value[i] * partition.supernode_value[i < 300 ? 0 : 1], 0) << i;
  }
}

TEST(PartitionTetrahedra, OfNoNodesKeepsTheSupernodesApart) {
  const TetrahedronGraph h{graphs::from_edges(0, {}, {{}, {}}), {}};
  for (const SecondStage method : {SecondStage::eigenvector, SecondStage::harmonic}) {
    const Partition partition = partition_tetrahedra(h.graph, method, {}, Threads(1));
    EXPECT_EQ(partition.status, SolverStatus::trivial);
    EXPECT_THAT(partition.supernode_value, testing::ElementsAre(1, -1));
  }
}

TEST(PartitionTetrahedra, IsTheSameForAnyThreads) {
  const TetrahedronGraph h = second_graph(40000, 8);
  for (const SecondStage method : {SecondStage::eigenvector, SecondStage::harmonic}) {
    const Partition one = partition_tetrahedra(h.graph, method, {}, Threads(1));
    const Partition three = partition_tetrahedra(h.graph, method, {}, Threads(3));
    EXPECT_EQ(one.value, three.value);
    EXPECT_EQ(one.iterations, three.iterations);
    EXPECT_EQ(one.residual, three.residual);
  }
}

} // namespace
} // namespace eigencrust
