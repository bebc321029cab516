// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <set>

#include "graphs.h"
#include "numerics/aggregation.h"
#include "numerics/components.h"
#include "numerics/dense.h"
#include "numerics/eigenvector.h"

namespace eigencrust {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using graphs::Planted;

VectorXd to_eigen(const Vector& x) { return Eigen::Map<const VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())); }

Vector random_vector(std::size_t n, std::uint64_t seed) {
  clouds::Random random(seed);
  Vector x(n);
  for (double& v : x) v = random.uniform(-1, 1);
  return x;
}

/// L of §3.2 from its definition, without the library's matrices.
MatrixXd dense_laplacian(const SignedGraph& g) {
  const std::uint32_t n = g.node_count();
  const auto k = static_cast<std::uint32_t>(g.supernodes.size());
  MatrixXd w = MatrixXd::Zero(n + k, n + k);
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint64_t e = g.row_begin[i]; e < g.row_begin[i + 1]; ++e)
      w(i, g.column[e]) = static_cast<double>(g.weight[e]);
  for (std::uint32_t s = 0; s < k; ++s) {
    for (std::uint32_t i = 0; i < n; ++i) w(i, n + s) = w(n + s, i) = static_cast<double>(g.supernodes[s].weight[i]);
    for (std::uint32_t t = 0; t < k; ++t) w(n + s, n + t) = g.supernode_weight[s][t];
  }
  MatrixXd laplacian = -w;
  laplacian.diagonal() = w.cwiseAbs().rowwise().sum();
  return laplacian;
}

/// Smallest eigenvector of D^-1/2 L D^-1/2 and the two smallest eigenvalues.
struct Oracle {
  VectorXd vector;
  double first = 0, second = 0;
};
Oracle dense_oracle(const SignedGraph& g) {
  const MatrixXd l = dense_laplacian(g);
  const VectorXd scale = l.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scale.asDiagonal() * l * scale.asDiagonal());
  return {scale.cwiseProduct(solver.eigenvectors().col(0)), solver.eigenvalues()(0), solver.eigenvalues()(1)};
}

SignedMultigrid hierarchy_of(const SignedGraph& g, const Threads& threads) {
  BorderedMatrix m = signed_laplacian(g, threads);
  Vector mass = full_diagonal(m);
  return {std::move(m), std::move(mass), threads};
}

VectorXd cycle(const SignedMultigrid& hierarchy, const Vector& b, const Threads& threads) {
  SignedMultigrid::Workspace workspace = hierarchy.workspace();
  FloatVector x;
  hierarchy.cycle(0, FloatVector(b.begin(), b.end()), x, workspace, threads);
  return to_eigen(Vector(x.begin(), x.end()));
}

IterationControl to_residual(double tolerance, std::uint32_t steps = 200) {
  IterationControl control;
  control.stop_on_stable_signs = false;
  control.tolerance = tolerance;
  control.max_steps = steps;
  return control;
}

/// Share of nodes that are on their planted side, up to a global flip.
double planted_share(const Planted& p, const Vector& x) {
  int sum = 0;
  for (std::size_t i = 0; i < p.side.size(); ++i) sum += p.side[i] * (x[i] > 0 ? 1 : x[i] < 0 ? -1 : 0);
  return (1 + std::fabs(static_cast<double>(sum)) / static_cast<double>(p.side.size())) / 2;
}

TEST(SignedLaplacian, EqualsItsDefinition) {
  Planted p = graphs::planted(60, 5, 0.3, true, 1);
  p.graph.supernodes.push_back(p.graph.supernodes[0]);
  p.graph.supernode_weight = {{0, -7.5}, {-7.5, 0}};
  const BorderedMatrix m = signed_laplacian(p.graph, Threads(2));
  EXPECT_LT((to_dense(m) - dense_laplacian(p.graph)).norm(), 1e-12);
}

TEST(BorderedMatrix, ProductsEqualTheDenseOnes) {
  Planted p = graphs::planted(80, 6, 0.2, true, 2);
  p.graph.supernodes.push_back({std::vector<float>(80, 0.5f)});
  p.graph.supernode_weight = {{0, -3}, {-3, 0}};
  const BorderedMatrix m = signed_laplacian(p.graph, Threads(1));
  const MatrixXd dense = to_dense(m);
  const Vector x = random_vector(m.size(), 3), b = random_vector(m.size(), 4);
  for (const unsigned threads : {1u, 3u}) {
    Vector y;
    multiply(m, x, y, Threads(threads));
    EXPECT_LT((to_eigen(y) - dense * to_eigen(x)).norm(), 1e-12 * dense.norm());
  }
  const Vector d = full_diagonal(m);
  EXPECT_NEAR(inner_product(x, b, Threads(1)), to_eigen(x).dot(to_eigen(b)), 1e-13);
  EXPECT_NEAR(weighted_product(x, d, b, Threads(1)), to_eigen(x).dot(to_eigen(d).cwiseProduct(to_eigen(b))), 1e-9);
}

TEST(Aggregation, CoversEveryNodeWithANeighbour) {
  for (const std::uint32_t n : {2u, 3u, 10u, 999u}) {
    const Planted p = graphs::planted(n, 4, 0.2, false, n);
    const Aggregation a = coarsen_by_pairs_twice(signed_laplacian(p.graph, Threads(1)), Threads(1)).aggregation;
    std::vector<int> members(a.count, 0);
    for (std::uint32_t i = 0; i < n; ++i) {
      ASSERT_LT(a.aggregate[i], a.count);
      ++members[a.aggregate[i]];
      EXPECT_EQ(std::abs(a.sign[i]), 1);
    }
    EXPECT_THAT(members, testing::Each(testing::Ge(n < 4 ? 1 : 2)));
    EXPECT_LE(a.count, std::max(1u, n / 2));
  }
}

TEST(Aggregation, OfAConsistentGraphMovesWithThePlantedSides) {
  const Planted p = graphs::planted(500, 5, 0, false, 5);
  const Aggregation a = coarsen_by_pairs_twice(signed_laplacian(p.graph, Threads(1)), Threads(1)).aggregation;
  std::vector<int> side(a.count, 0);
  for (std::uint32_t i = 0; i < 500; ++i) {
    const int s = p.side[i] * a.sign[i];
    int& common = side[a.aggregate[i]];
    if (common == 0) common = s;
    EXPECT_EQ(common, s);
  }
}

TEST(Aggregation, IsolatedNodesEndHere) {
  // Node 2 has no edge, node 3 hangs on the supernode alone.
  const SignedGraph g = graphs::from_edges(4, {{{0, 1}, -2.0}}, {{{3, 1.0}}});
  const Aggregation a = coarsen_by_pairs_twice(signed_laplacian(g, Threads(1)), Threads(1)).aggregation;
  EXPECT_EQ(a.count, 1u);
  EXPECT_EQ(a.aggregate[0], a.aggregate[1]);
  EXPECT_EQ(a.sign[0] * a.sign[1], -1);
  EXPECT_EQ(a.aggregate[2], no_index);
  EXPECT_EQ(a.aggregate[3], no_index);
}

TEST(Aggregation, OfAStarDoesNotStall) {
  graphs::Edges edges;
  for (std::uint32_t i = 1; i < 300; ++i) edges[{0, i}] = i % 2 ? 1.0 : -1.0;
  const Aggregation a =
      coarsen_by_pairs_twice(signed_laplacian(graphs::from_edges(300, edges), Threads(1)), Threads(1)).aggregation;
  EXPECT_EQ(a.count, 1u); // all leaves join the pair that holds the middle
}

TEST(Galerkin, EqualsTheDenseTripleProduct) {
  const Planted p = graphs::planted(120, 5, 0.3, true, 6);
  const BorderedMatrix m = signed_laplacian(p.graph, Threads(1));
  const Coarsening coarsening = coarsen_by_pairs_twice(m, Threads(1));
  const Aggregation& a = coarsening.aggregation;
  MatrixXd prolongation = MatrixXd::Zero(121, a.count + 1);
  for (std::uint32_t i = 0; i < 120; ++i) prolongation(i, a.aggregate[i]) = a.sign[i];
  prolongation(120, a.count) = 1; // the border is the same unknown on all levels
  const MatrixXd expected = prolongation.transpose() * to_dense(m) * prolongation;
  const BorderedMatrix coarse = galerkin(m, a, Threads(2));
  EXPECT_LT((to_dense(coarse) - expected).norm(), 1e-6 * expected.norm());
  EXPECT_LT((to_dense(coarsening.matrix) - expected).norm(), 1e-6 * expected.norm());
  for (std::uint32_t g = 0; g < a.count; ++g) {
    const std::vector<std::uint32_t> columns(
        coarse.column.begin() + static_cast<std::ptrdiff_t>(coarse.row_begin[g]),
        coarse.column.begin() + static_cast<std::ptrdiff_t>(coarse.row_begin[g + 1]));
    EXPECT_THAT(columns, testing::Not(testing::Contains(g)));
    EXPECT_EQ(std::set(columns.begin(), columns.end()).size(), columns.size());
  }
}

TEST(Aggregation, IsTheSameOnAnyNumberOfThreads) {
  // 100,000 nodes have four blocks of matching.
  const Planted p = graphs::planted(100000, 6, 0.2, false, 3);
  const BorderedMatrix m = signed_laplacian(p.graph, Threads(1));
  const Coarsening one = coarsen_by_pairs_twice(m, Threads(1)), three = coarsen_by_pairs_twice(m, Threads(3));
  EXPECT_EQ(one.aggregation.aggregate, three.aggregation.aggregate);
  EXPECT_EQ(one.aggregation.sign, three.aggregation.sign);
  EXPECT_EQ(one.matrix.value, three.matrix.value);
  EXPECT_LT(one.aggregation.count, 40000u);
}

TEST(Multigrid, CycleIsLinearSymmetricAndPositive) {
  // 20,000 nodes have three blocks of relaxation, which are joined by Jacobi.
  for (const std::uint32_t n : {1500u, 20000u}) {
    const Planted p = graphs::planted(n, 6, 0.2, true, n);
    const Threads threads(2);
    const SignedMultigrid hierarchy = hierarchy_of(p.graph, threads);
    ASSERT_GT(hierarchy.levels().size(), 1u);
    const Vector x = random_vector(n + 1, 7), y = random_vector(n + 1, 8);
    Vector sum = x;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += 2 * y[i];
    const VectorXd cx = cycle(hierarchy, x, threads), cy = cycle(hierarchy, y, threads),
                   csum = cycle(hierarchy, sum, threads);
    const double xx = to_eigen(x).dot(cx), yy = to_eigen(y).dot(cy);
    EXPECT_GT(xx, 0);
    EXPECT_GT(yy, 0);
    // To single precision.
    EXPECT_NEAR(to_eigen(x).dot(cy), to_eigen(y).dot(cx), 1e-5 * std::sqrt(xx * yy));
    EXPECT_LT((csum - cx - 2 * cy).norm(), 1e-5 * csum.norm());
  }
}

TEST(Multigrid, CycleOnTheCoarsestLevelSolves) {
  const Planted p = graphs::planted(200, 6, 0.3, true, 9);
  const SignedMultigrid hierarchy = hierarchy_of(p.graph, Threads(1));
  ASSERT_EQ(hierarchy.levels().size(), 1u);
  const Vector b = random_vector(201, 10);
  const VectorXd x = cycle(hierarchy, b, Threads(1));
  EXPECT_LT((dense_laplacian(p.graph) * x - to_eigen(b)).norm(), 1e-3 * to_eigen(b).norm());
}

TEST(SmallestEigenvector, EqualsTheDenseOne) {
  for (const std::uint32_t n : {200u, 500u, 1000u})
    for (const bool supernode : {false, true}) {
      const Planted p = graphs::planted(n, 8, 0.08, supernode, n);
      const Threads threads(2);
      const IterationResult result = smallest_eigenvector(hierarchy_of(p.graph, threads), to_residual(1e-7), threads);
      const Oracle oracle = dense_oracle(p.graph);
      EXPECT_EQ(result.status, SolverStatus::converged);
      EXPECT_NEAR(result.eigenvalue, oracle.first, 1e-7);
      const VectorXd x = to_eigen(result.x);
      const VectorXd d = dense_laplacian(p.graph).diagonal();
      const double aligned = std::fabs(x.dot(d.cwiseProduct(oracle.vector))) / std::sqrt(x.dot(d.cwiseProduct(x)));
      EXPECT_NEAR(aligned, 1, 1e-6) << "n " << n << " gap " << oracle.second - oracle.first;
    }
}

TEST(SmallestEigenvector, OfAFrustratedGraphIsNotAboveTheDenseValue) {
  // Half of all edges contradict: a spin glass, whose low spectrum is crowded.
  for (const std::uint64_t seed : {1u, 2u}) {
    const Planted p = graphs::planted(900, 6, 0.5, true, seed);
    const Threads threads(1);
    const IterationResult result =
        smallest_eigenvector(hierarchy_of(p.graph, threads), to_residual(1e-6, 500), threads);
    const Oracle oracle = dense_oracle(p.graph);
    EXPECT_EQ(result.status, SolverStatus::converged);
    EXPECT_NEAR(result.eigenvalue, oracle.first, 1e-6);
    EXPECT_LE(result.residual, 1e-6);
  }
}

TEST(SmallestEigenvector, OfAConsistentGraphHasItsExactSigns) {
  for (const std::uint32_t n : {100u, 1000u, 6000u})
    for (const bool supernode : {false, true}) {
      const Planted p = graphs::planted(n, 5, 0, supernode, n + 1);
      const Threads threads(2);
      IterationControl control;
      control.max_steps = 60;
      const IterationResult result = smallest_eigenvector(hierarchy_of(p.graph, threads), control, threads);
      EXPECT_EQ(result.status, SolverStatus::consistent);
      EXPECT_LT(std::fabs(result.eigenvalue), 1e-10);
      EXPECT_EQ(planted_share(p, result.x), 1.0);
      if (supernode) {
        EXPECT_GT(result.x[n] * result.x[0] * p.side[0], 0);
      }
    }
}

TEST(SmallestEigenvector, LanczosAndMultigridAgree) {
  const Planted p = graphs::planted(1500, 8, 0.05, true, 11);
  const Threads threads(2);
  const BorderedMatrix m = signed_laplacian(p.graph, threads);
  const IterationResult lanczos = smallest_eigenvector_lanczos(m, full_diagonal(m), to_residual(1e-9, 1000), threads);
  const IterationResult multigrid = smallest_eigenvector(hierarchy_of(p.graph, threads), to_residual(1e-8), threads);
  EXPECT_EQ(lanczos.status, SolverStatus::converged);
  EXPECT_NEAR(lanczos.eigenvalue, multigrid.eigenvalue, 1e-9);
  const double same = lanczos.x[0] * multigrid.x[0] > 0 ? 1 : -1;
  for (std::size_t i = 0; i < lanczos.x.size(); ++i) EXPECT_GT(same * lanczos.x[i] * multigrid.x[i], 0) << i;
}

TEST(SmallestEigenvector, IsTheSameForAnyThreads) {
  const Planted p = graphs::planted(30000, 6, 0.05, true, 12);
  std::vector<Vector> x;
  for (const unsigned count : {1u, 2u, 3u}) {
    const Threads threads(count);
    x.push_back(smallest_eigenvector(hierarchy_of(p.graph, threads), {}, threads).x);
  }
  EXPECT_EQ(x[0], x[1]);
  EXPECT_EQ(x[0], x[2]);
}

TEST(SmallestEigenvector, OfPathsAndStarsThatHaveNoCycles) {
  // No cycle, no contradiction: the signs are the products along the way.
  constexpr std::uint32_t n = 5000;
  Planted path, star;
  graphs::Edges along, spokes;
  path.side = star.side = {1};
  for (std::uint32_t i = 1; i < n; ++i) {
    const int sign = i % 3 == 0 ? -1 : 1;
    along[{i - 1, i}] = sign * (1.0 + i % 7);
    spokes[{0, i}] = sign * (1.0 + i % 7);
    path.side.push_back(path.side.back() * sign);
    star.side.push_back(sign);
  }
  path.graph = graphs::from_edges(n, along);
  star.graph = graphs::from_edges(n, spokes);
  const Threads threads(1);
  for (const Planted* p : {&path, &star}) {
    IterationControl control;
    control.max_steps = 100;
    const IterationResult result = smallest_eigenvector(hierarchy_of(p->graph, threads), control, threads);
    EXPECT_EQ(planted_share(*p, result.x), 1.0);
    EXPECT_EQ(result.status, SolverStatus::consistent);
  }
}

TEST(SmallestEigenvector, NodesOnTheSupernodeAloneFollowIt) {
  // A planted graph and 700 more nodes that have no edge but the one to the supernode.
  Planted p = graphs::planted(600, 6, 0, true, 13);
  SignedGraph& g = p.graph;
  clouds::Random random(14);
  for (int i = 0; i < 700; ++i) {
    const int sign = random.uniform() < 0.5 ? -1 : 1;
    g.row_begin.push_back(g.column.size());
    g.supernodes[0].weight.push_back(static_cast<float>(3 * sign));
    p.side.push_back(sign);
  }
  const Threads threads(1);
  const IterationResult result = smallest_eigenvector(hierarchy_of(g, threads), {}, threads);
  EXPECT_EQ(planted_share(p, result.x), 1.0);
  EXPECT_GT(result.x.back() * result.x[0] * p.side[0], 0);
}

TEST(SmallestEigenvector, EdgesThatCancelOnTheCoarseLevelAreNoCatastrophe) {
  // A chain of firm pairs; from each pair to the next one edge attracts and one repels with equal force.
  // Moved as one, pairs feel nothing of each other: the coarse matrix is diagonal. The true vector is
  // not zero all the same.
  graphs::Edges edges;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    edges[{2 * i, 2 * i + 1}] = 10;
    if (i + 1 == 1000) break;
    edges[{2 * i, 2 * i + 2}] = 1;
    edges[{2 * i + 1, 2 * i + 3}] = -1;
  }
  const SignedGraph g = graphs::from_edges(2000, edges);
  const Threads threads(1);
  const IterationResult result = smallest_eigenvector(hierarchy_of(g, threads), to_residual(1e-6), threads);
  EXPECT_GT(to_eigen(result.x).norm(), 0);
  EXPECT_NE(result.status, SolverStatus::consistent);
  EXPECT_GT(result.eigenvalue, 0.01); // every square of the chain contradicts itself
}

TEST(SmallestEigenvector, StopsOnStableSignsAndSaysSo) {
  const Planted p = graphs::planted(3000, 8, 0.05, true, 15);
  const Threads threads(1);
  IterationControl control;
  control.tolerance = 1e-14;
  control.max_steps = 50;
  const IterationResult stable = smallest_eigenvector(hierarchy_of(p.graph, threads), control, threads);
  EXPECT_EQ(stable.status, SolverStatus::signs_stable);
  ASSERT_GE(stable.sign_changes.size(), 2u);
  EXPECT_EQ(stable.sign_changes.size(), stable.steps);
  control.stop_on_stable_signs = false;
  control.max_steps = 1;
  const IterationResult stopped = smallest_eigenvector(hierarchy_of(p.graph, threads), control, threads);
  EXPECT_EQ(stopped.status, SolverStatus::not_converged);
  EXPECT_EQ(stopped.steps, 1u);
}

TEST(DenseEigenvector, RowsWithoutMassAreZero) {
  const SignedGraph g = graphs::from_edges(3, {{{0, 2}, -1.0}});
  const BorderedMatrix m = signed_laplacian(g, Threads(1));
  Vector x;
  EXPECT_NEAR(smallest_eigenvector_dense(m, full_diagonal(m), x), 0, 1e-15);
  EXPECT_EQ(x[1], 0);
  EXPECT_NEAR(x[0], -x[2], 1e-15);
  EXPECT_NEAR(x[0] * x[0] + x[2] * x[2], 1, 1e-14); // xᵀ D x = 1 with D = 1
}

TEST(ConjugateGradients, EqualTheDenseSolution) {
  // Attraction only, and every tenth node held: the second stage's kind of matrix.
  Planted p = graphs::planted(1200, 4, 0, true, 16);
  for (float& w : p.graph.weight) w = std::fabs(w);
  for (float& w : p.graph.supernodes[0].weight) w = std::fabs(w);
  BorderedMatrix m = signed_laplacian(p.graph, Threads(1));
  m.border.clear();
  m.corner.clear();
  const MatrixXd dense = to_dense(m);
  const Vector b = random_vector(1200, 17);
  const Threads threads(2);
  const SignedMultigrid hierarchy(std::move(m), {}, threads);
  const IterationResult result = conjugate_gradients(hierarchy, b, to_residual(1e-12), threads);
  EXPECT_EQ(result.status, SolverStatus::converged);
  const VectorXd expected = dense.ldlt().solve(to_eigen(b));
  EXPECT_LT((to_eigen(result.x) - expected).norm(), 1e-9 * expected.norm());
  EXPECT_LE(result.steps, 60u);
}

TEST(ConjugateGradients, NothingAskedNothingDone) {
  const Planted p = graphs::planted(50, 4, 0, false, 18);
  const SignedMultigrid hierarchy(signed_laplacian(p.graph, Threads(1)), {}, Threads(1));
  const IterationResult result = conjugate_gradients(hierarchy, Vector(50, 0), {}, Threads(1));
  EXPECT_EQ(result.status, SolverStatus::converged);
  EXPECT_THAT(result.x, testing::Each(0.0));
}

TEST(Components, SupernodesAreAllInComponentZero) {
  // 0-1 on the first supernode, 2 on the second, 3-4 free, 5 isolated.
  const SignedGraph g = graphs::from_edges(6, {{{0, 1}, 1.0}, {{3, 4}, -1.0}}, {{{1, 2.0}}, {{2, -2.0}}});
  const Components c = connected_components(g);
  EXPECT_EQ(c.count, 3u);
  EXPECT_THAT(c.of_node, testing::ElementsAre(0, 0, 0, 1, 1, 2));
  const SignedGraph free_part = extract_component(g, 1, {3, 4});
  EXPECT_EQ(free_part.node_count(), 2u);
  EXPECT_THAT(free_part.column, testing::ElementsAre(1, 0));
  EXPECT_TRUE(free_part.supernodes.empty());
  const SignedGraph held = extract_component(g, 0, {0, 1, 2});
  ASSERT_EQ(held.supernodes.size(), 2u);
  EXPECT_THAT(held.supernodes[0].weight, testing::ElementsAre(0, 2, 0));
}

} // namespace
} // namespace eigencrust
