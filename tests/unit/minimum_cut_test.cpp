// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/minimum_cut.h"

#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

namespace eigencrust {

static void PrintTo(CutSide side, std::ostream* out) { *out << static_cast<int>(side); }

namespace {

using testing::ElementsAre;
using Random = std::mt19937_64;

int uniform(Random& random, int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }

CutProblem without_edges(std::size_t n) {
  CutProblem p;
  p.neighbour.assign(n, {CutProblem::none, CutProblem::none, CutProblem::none, CutProblem::none});
  p.capacity.assign(n, {0, 0, 0, 0});
  p.terminal.assign(n, 0);
  return p;
}

/// Takes a random free place at both nodes; nothing if one of them has none.
void connect(CutProblem& p, std::uint32_t i, std::uint32_t j, std::int32_t capacity, Random& random) {
  const auto free_place = [&](std::uint32_t node) {
    const int first = uniform(random, 0, 3);
    for (int k = 0; k < 4; ++k)
      if (p.neighbour[node][(first + k) % 4] == CutProblem::none) return (first + k) % 4;
    return -1;
  };
  const int a = free_place(i), b = free_place(j);
  if (i == j || a < 0 || b < 0) return;
  p.neighbour[i][a] = j;
  p.neighbour[j][b] = i;
  p.capacity[i][a] = p.capacity[j][b] = static_cast<std::uint16_t>(capacity);
}

struct Recipe {
  double edges = 2;        ///< tries per node
  int capacity = 10;       ///< greatest
  int terminal = 20;       ///< greatest
  int with_terminal = 100; ///< per cent
  int reach = 0;           ///< edges join nodes whose numbers differ by at most this; 0: any
};

CutProblem random_problem(std::uint32_t n, const Recipe& recipe, Random& random) {
  CutProblem p = without_edges(n);
  for (std::int32_t& t : p.terminal)
    if (uniform(random, 1, 100) <= recipe.with_terminal) t = uniform(random, -recipe.terminal, recipe.terminal);
  const auto edges = static_cast<std::size_t>(recipe.edges * n);
  for (std::size_t e = 0; e < edges; ++e) {
    const int i = uniform(random, 0, static_cast<int>(n) - 1);
    const int reach = recipe.reach > 0 ? recipe.reach : static_cast<int>(n);
    const int j = uniform(random, std::max(0, i - reach), std::min(static_cast<int>(n) - 1, i + reach));
    connect(p, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), uniform(random, 0, recipe.capacity),
            random);
  }
  return p;
}

/// Cubes cut into six tetrahedra each, one per order of the axes: from corner 000 along the first axis, then along the
/// second, then along the third to 111. Terminals are a noisy height, on some of the nodes only.
CutProblem tetrahedral_grid(int size, int noise, int with_terminal, Random& random) {
  static constexpr int axes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const auto number = [&](std::array<int, 3> cube, int a, int b, int c) {
    for (const int x : cube)
      if (x < 0 || x >= size) return CutProblem::none;
    int order = 0;
    while (axes[order][0] != a || axes[order][1] != b || axes[order][2] != c) ++order;
    return static_cast<std::uint32_t>(((cube[2] * size + cube[1]) * size + cube[0]) * 6 + order);
  };
  CutProblem p = without_edges(static_cast<std::size_t>(size) * size * size * 6);
  for (std::uint32_t i = 0; i < p.neighbour.size(); ++i) {
    const int cube = static_cast<int>(i / 6);
    const std::array<int, 3> at{cube % size, cube / size % size, cube / size / size};
    const auto [a, b, c] = axes[i % 6];
    std::array<int, 3> ahead = at, behind = at;
    ++ahead[a];
    --behind[c];
    p.neighbour[i] = {number(ahead, b, c, a), number(at, b, a, c), number(at, a, c, b), number(behind, c, a, b)};
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t j = p.neighbour[i][k];
      if (j == CutProblem::none) continue;
      // Faces 0 and 3 are each other's counterpart, 1 and 2 their own.
      p.capacity[i][k] = j < i ? p.capacity[j][k == 0   ? 3
                                               : k == 3 ? 0
                                                        : k]
                               : static_cast<std::uint16_t>(uniform(random, 10, 2000));
    }
    if (uniform(random, 1, 100) <= with_terminal)
      p.terminal[i] = std::clamp((at[2] - size / 2) * 500, -1000, 1000) + uniform(random, -noise, noise);
  }
  return p;
}

CutProblem renumbered(const CutProblem& p, const std::vector<std::uint32_t>& to) {
  CutProblem q = p;
  for (std::uint32_t i = 0; i < to.size(); ++i) {
    q.neighbour[to[i]] = p.neighbour[i];
    for (std::uint32_t& j : q.neighbour[to[i]])
      if (j != CutProblem::none) j = to[j];
    q.capacity[to[i]] = p.capacity[i];
    q.terminal[to[i]] = p.terminal[i];
  }
  return q;
}

/// \param source whether a node is on the source's side
template <class Source>
std::int64_t cut_value(const CutProblem& p, const Source& source) {
  std::int64_t value = 0;
  for (std::uint32_t i = 0; i < p.terminal.size(); ++i) {
    value += source(i) ? std::max<std::int64_t>(0, -p.terminal[i]) : std::max<std::int64_t>(0, p.terminal[i]);
    for (int k = 0; k < 4; ++k)
      if (p.neighbour[i][k] != CutProblem::none && source(i) && !source(p.neighbour[i][k])) value += p.capacity[i][k];
  }
  return value;
}

struct Arc {
  std::size_t from, to;
  std::int64_t capacity;
  std::size_t pair; ///< twice the number of its edge, and one more for the way back
};

/// All arcs both ways, sorted by their first node; the source is node n, the sink n + 1.
std::vector<Arc> arcs_of(const CutProblem& p) {
  const std::size_t n = p.terminal.size();
  std::vector<Arc> arcs;
  const auto add = [&](std::size_t from, std::size_t to, std::int64_t there, std::int64_t back) {
    arcs.push_back({from, to, there, arcs.size()});
    arcs.push_back({to, from, back, arcs.size()});
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (p.terminal[i] > 0) add(n, i, p.terminal[i], 0);
    if (p.terminal[i] < 0) add(i, n + 1, -p.terminal[i], 0);
    for (int k = 0; k < 4; ++k)
      if (p.neighbour[i][k] != CutProblem::none && i < p.neighbour[i][k])
        add(i, p.neighbour[i][k], p.capacity[i][k], p.capacity[i][k]);
  }
  std::stable_sort(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) { return a.from < b.from; });
  return arcs;
}

std::int64_t boost_flow(const CutProblem& p) {
  using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                   boost::no_property, std::size_t>;
  using Edge = Graph::edge_descriptor;
  const std::size_t n = p.terminal.size();
  const std::vector<Arc> arcs = arcs_of(p);
  std::vector<std::pair<std::size_t, std::size_t>> ends;
  std::vector<std::int64_t> capacity, residual(arcs.size()), distance(n + 2);
  std::vector<Edge> by_pair(arcs.size()), reverse, predecessor(n + 2);
  std::vector<boost::default_color_type> color(n + 2);
  for (std::size_t e = 0; e < arcs.size(); ++e) {
    ends.emplace_back(arcs[e].from, arcs[e].to);
    capacity.push_back(arcs[e].capacity);
    by_pair[arcs[e].pair] = Edge(arcs[e].from, e);
  }
  for (const Arc& arc : arcs) reverse.push_back(by_pair[arc.pair ^ 1]);
  // They are sorted, and stay as they are; but GCC 12 warns of Boost's constructor for sorted edges.
  const Graph graph(boost::edges_are_unsorted_multi_pass, ends.begin(), ends.end(), n + 2);
  const auto of_edge = [&](auto& values) {
    return boost::make_iterator_property_map(values.begin(), get(boost::edge_index, graph));
  };
  const auto of_node = [&](auto& values) {
    return boost::make_iterator_property_map(values.begin(), get(boost::vertex_index, graph));
  };
  return boost::boykov_kolmogorov_max_flow(graph, of_edge(capacity), of_edge(residual), of_edge(reverse),
                                           of_node(predecessor), of_node(color), of_node(distance),
                                           get(boost::vertex_index, graph), n, n + 1);
}

/// Both extreme cuts have the value of the flow.
void expect_cuts_match(const CutProblem& p, const CutResult& result) {
  ASSERT_EQ(result.side.size(), p.terminal.size());
  EXPECT_EQ(cut_value(p, [&](std::uint32_t i) { return result.side[i] == CutSide::source; }), result.flow);
  EXPECT_EQ(cut_value(p, [&](std::uint32_t i) { return result.side[i] != CutSide::sink; }), result.flow);
}

void expect_like_boost(const CutProblem& p, const CutResult& result) {
  EXPECT_EQ(result.flow, boost_flow(p));
  expect_cuts_match(p, result);
}

void expect_like_all_cuts(const CutProblem& p) {
  const auto n = static_cast<std::uint32_t>(p.terminal.size());
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  std::uint32_t always = 0, ever = 0; // on the source's side
  for (std::uint32_t cut = 0; cut < 1u << n; ++cut) {
    const std::int64_t value = cut_value(p, [&](std::uint32_t i) { return (cut >> i & 1) != 0; });
    if (value < least) {
      least = value;
      always = ever = cut;
    } else if (value == least) {
      always &= cut;
      ever |= cut;
    }
  }
  std::vector<CutSide> sides;
  for (std::uint32_t i = 0; i < n; ++i)
    sides.push_back((always >> i & 1) != 0 ? CutSide::source : (ever >> i & 1) != 0 ? CutSide::either : CutSide::sink);
  const CutResult result = minimum_cut(p, Threads(1));
  EXPECT_EQ(result.flow, least);
  EXPECT_EQ(result.side, sides);
}

TEST(MinimumCut, EmptyProblem) {
  const CutResult result = minimum_cut({}, Threads(2));
  EXPECT_TRUE(result.side.empty());
  EXPECT_EQ(result.flow, 0);
}

TEST(MinimumCut, WithoutEdgesEachNodeFollowsItsTerminal) {
  CutProblem p = without_edges(3);
  p.terminal = {7, -7, 0};
  const CutResult result = minimum_cut(p, Threads(1));
  EXPECT_THAT(result.side, ElementsAre(CutSide::source, CutSide::sink, CutSide::either));
  EXPECT_EQ(result.flow, 0);
}

TEST(MinimumCut, EdgesWithoutCapacityJoinNothing) {
  Random random(1);
  const CutProblem p = random_problem(500, {.edges = 3, .capacity = 0}, random);
  const CutResult result = minimum_cut(p, Threads(2));
  EXPECT_EQ(result.flow, 0);
  expect_cuts_match(p, result);
}

TEST(MinimumCut, ATieLeavesBothSidesOpen) {
  Random random(1);
  CutProblem p = without_edges(3);
  p.terminal = {9, 0, -9};
  connect(p, 0, 1, 5, random);
  connect(p, 1, 2, 5, random);
  EXPECT_THAT(minimum_cut(p, Threads(1)).side, ElementsAre(CutSide::source, CutSide::either, CutSide::sink));
}

TEST(MinimumCut, ParallelEdgesAddUpEvenInDifferentOrder) {
  CutProblem p = without_edges(2);
  p.neighbour = {{1, 1, CutProblem::none, 1}, {0, CutProblem::none, 0, 0}};
  p.capacity = {{3, 5, 0, 3}, {5, 0, 3, 3}};
  p.terminal = {100, -100};
  const CutResult result = minimum_cut(p, Threads(1));
  EXPECT_EQ(result.flow, 11);
  EXPECT_THAT(result.side, ElementsAre(CutSide::source, CutSide::sink));
}

TEST(MinimumCut, GreatestNumbersDoNotOverflow) {
  Random random(1);
  constexpr std::int32_t most = CutProblem::largest_capacity;
  CutProblem p = without_edges(3);
  p.terminal = {std::numeric_limits<std::int32_t>::max(), 0, std::numeric_limits<std::int32_t>::min()};
  for (int k = 0; k < 2; ++k) {
    connect(p, 0, 1, most, random);
    connect(p, 1, 2, most, random);
  }
  const CutResult result = minimum_cut(p, Threads(1));
  EXPECT_EQ(result.flow, 2 * std::int64_t{most});
  EXPECT_THAT(result.side, ElementsAre(CutSide::source, CutSide::either, CutSide::sink));
}

TEST(MinimumCut, EdgesThatStandWithOneNodeOnlyAreRefused) {
  CutProblem p = without_edges(3);
  p.neighbour[0][2] = 1;
  p.capacity[0][2] = 4;
  EXPECT_THROW(minimum_cut(p, Threads(2)), std::invalid_argument);
  p.neighbour[1][0] = 0;
  p.capacity[1][0] = 3;
  EXPECT_THROW(minimum_cut(p, Threads(2)), std::invalid_argument);
  p.capacity[1][0] = 4;
  EXPECT_EQ(minimum_cut(p, Threads(2)).flow, 0);
  p.capacity[0][2] = p.capacity[1][0] = CutProblem::largest_capacity + 1;
  EXPECT_THROW(minimum_cut(p, Threads(2)), std::invalid_argument);
  p.terminal.pop_back();
  EXPECT_THROW(minimum_cut(p, Threads(2)), std::invalid_argument);
}

TEST(MinimumCut, SidesAreThoseOfAllMinimumCutsOfTinyGraphs) {
  Random random(2);
  for (int round = 0; round < 1500 && !testing::Test::HasFailure(); ++round) {
    // Small numbers make ties, few nodes make parallel edges.
    const Recipe recipe{.edges = 0.25 * uniform(random, 1, 16),
                        .capacity = uniform(random, 0, 4),
                        .terminal = uniform(random, 1, 8),
                        .with_terminal = uniform(random, 20, 100)};
    expect_like_all_cuts(
        random_problem(static_cast<std::uint32_t>(uniform(random, 1, round % 20 == 0 ? 12 : 9)), recipe, random));
  }
}

TEST(MinimumCut, RandomGraphsLikeBoost) {
  Random random(3);
  for (int round = 0; round < 300 && !testing::Test::HasFailure(); ++round) {
    const auto n = static_cast<std::uint32_t>(uniform(random, 2, round % 30 == 0 ? 20000 : 400));
    const Recipe recipe{.edges = 0.25 * uniform(random, 1, 16),
                        .capacity = round % 3 == 0 ? 3 : 1000,
                        .terminal = round % 5 == 0 ? 3 : 1000,
                        .with_terminal = round % 2 == 0 ? 100 : uniform(random, 1, 30),
                        .reach = round % 7 == 0 ? 0 : uniform(random, 1, 20)};
    const CutProblem p = random_problem(n, recipe, random);
    expect_like_boost(p, minimum_cut(p, Threads(1)));
  }
}

TEST(MinimumCut, LongChain) {
  Random random(4);
  constexpr std::uint32_t n = 100000;
  CutProblem p = without_edges(n);
  for (std::uint32_t i = 0; i + 1 < n; ++i) connect(p, i, i + 1, i == 70000 ? 4 : 5, random);
  p.terminal.front() = 9;
  p.terminal.back() = -9;
  const CutResult result = minimum_cut(p, Threads(1));
  EXPECT_EQ(result.flow, 4);
  EXPECT_EQ(std::count(result.side.begin(), result.side.end(), CutSide::source), 70001);
  EXPECT_EQ(std::count(result.side.begin(), result.side.end(), CutSide::sink), n - 70001);
}

TEST(MinimumCut, TetrahedralGridLikeBoost) {
  Random random(5);
  for (const auto& [noise, with_terminal] : {std::pair{900, 100}, {400, 8}}) {
    const CutProblem p = tetrahedral_grid(32, noise, with_terminal, random);
    const CutResult result = minimum_cut(p, Threads(2));
    expect_like_boost(p, result);
    EXPECT_GT(std::count(result.side.begin(), result.side.end(), CutSide::source), 70000);
    EXPECT_GT(std::count(result.side.begin(), result.side.end(), CutSide::sink), 70000);
  }
}

TEST(MinimumCut, SameForAnyNumberOfThreadsAndOrderOfNodes) {
  Random random(6);
  // Few edges make thousands of clusters, more make one large and many small ones.
  for (const double edges : {0.3, 0.6, 0.9}) {
    const CutProblem p =
        random_problem(80000, {.edges = edges, .capacity = 6, .terminal = 6, .with_terminal = 60}, random);
    const CutResult one = minimum_cut(p, Threads(1));
    expect_cuts_match(p, one);
    std::vector<std::uint32_t> to(p.terminal.size());
    std::iota(to.begin(), to.end(), 0u);
    std::shuffle(to.begin(), to.end(), random);
    const CutProblem shuffled = renumbered(p, to);
    for (const unsigned threads : {2u, 3u, 8u}) {
      const CutResult several = minimum_cut(p, Threads(threads));
      EXPECT_EQ(several.side, one.side);
      EXPECT_EQ(several.flow, one.flow);
      const CutResult other = minimum_cut(shuffled, Threads(threads));
      EXPECT_EQ(other.flow, one.flow);
      std::size_t different = 0;
      for (std::size_t i = 0; i < to.size(); ++i) different += other.side[to[i]] != one.side[i];
      EXPECT_EQ(different, 0u);
    }
  }
}

} // namespace
} // namespace eigencrust
