// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/handle_loops.h"
#include "parallel/compressed_rows.h"

#include <algorithm>
#include <numeric>

namespace eigencrust {
namespace {

constexpr std::uint32_t none = no_index;

struct Edge {
  std::uint32_t low, high;   ///< vertices
  std::uint32_t left, right; ///< triangles; right of a rim the number of all triangles: one face closes all rims
};

std::vector<Edge> edges_of(std::span<const Triangle> triangles, std::size_t vertices, const Threads& threads) {
  std::vector<Edge> edges;
  const std::vector<Side> sides = sorted_sides(triangles, vertices, threads);
  edges.reserve(sides.size() / 2);
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() > 2) return;
    const auto rim = static_cast<std::uint32_t>(triangles.size());
    edges.push_back({edge[0].low, edge[0].high, edge[0].triangle(), edge.size() == 2 ? edge[1].triangle() : rim});
  });
  return edges;
}

/// Breadth-first trees, one for each component, with the depth of every vertex.
struct Forest {
  std::vector<std::uint32_t> parent, depth;
  std::uint32_t trees = 0, isolated = 0; ///< isolated: trees of one vertex
};

Forest breadth_first(const std::vector<Edge>& edges, std::size_t vertices) {
  const auto neighbours = build_rows<std::uint32_t>(vertices, [&](auto&& visit) {
    for (const Edge& e : edges) {
      visit(e.low, e.high);
      visit(e.high, e.low);
    }
  });
  Forest forest{std::vector<std::uint32_t>(vertices, none), std::vector<std::uint32_t>(vertices, none), 0, 0};
  std::vector<std::uint32_t> queue;
  queue.reserve(vertices);
  for (std::uint32_t root = 0; root < vertices; ++root) {
    if (forest.depth[root] != none) continue;
    forest.depth[root] = 0;
    ++forest.trees;
    forest.isolated += neighbours[root].empty();
    queue.assign(1, root);
    for (std::size_t i = 0; i < queue.size(); ++i)
      for (const std::uint32_t v : neighbours[queue[i]]) {
        if (forest.depth[v] != none) continue;
        forest.depth[v] = forest.depth[queue[i]] + 1;
        forest.parent[v] = queue[i];
        queue.push_back(v);
      }
  }
  return forest;
}

/// Where the two paths to the root meet, if a loop of at most `longest` edges leads there; else none.
std::uint32_t meeting(const Forest& forest, std::uint32_t a, std::uint32_t b, std::size_t longest) {
  for (std::size_t length = 1; length <= longest; ++length) {
    if (a == b) return a;
    std::uint32_t& deeper = forest.depth[a] >= forest.depth[b] ? a : b;
    deeper = forest.parent[deeper];
  }
  return none;
}

/// For each edge off the trees the length of its loop; longest + 1 for all longer ones, 0 for edges of the trees.
std::vector<std::uint32_t> loop_lengths(const std::vector<Edge>& edges, const Forest& forest, std::uint32_t longest,
                                        const Threads& threads) {
  std::vector<std::uint32_t> length(edges.size());
  for_each_index(threads, edges.size(), [&](std::size_t i) {
    const Edge& e = edges[i];
    if (forest.parent[e.low] == e.high || forest.parent[e.high] == e.low) return;
    const std::uint32_t top = meeting(forest, e.low, e.high, longest);
    length[i] = top == none ? longest + 1 : forest.depth[e.low] + forest.depth[e.high] + 1 - 2 * forest.depth[top];
  });
  return length;
}

/// Edges off the trees, those with the longest loops first, then by their number.
std::vector<std::uint32_t> by_length(const std::vector<std::uint32_t>& length, std::uint32_t longest) {
  return build_rows<std::uint32_t>(longest + 1,
                                   [&](auto&& visit) {
                                     for (std::uint32_t i = 0; i < length.size(); ++i)
                                       if (length[i] > 0) visit(longest + 1 - length[i], i);
                                   })
      .item;
}

std::vector<std::uint32_t> loop_through(const Forest& forest, const Edge& edge) {
  const std::uint32_t top = meeting(forest, edge.low, edge.high, forest.depth.size());
  std::vector<std::uint32_t> loop;
  for (std::uint32_t v = edge.low; v != top; v = forest.parent[v]) loop.push_back(v);
  loop.push_back(top);
  const auto middle = static_cast<std::ptrdiff_t>(loop.size());
  for (std::uint32_t v = edge.high; v != top; v = forest.parent[v]) loop.push_back(v);
  std::reverse(loop.begin() + middle, loop.end());
  return loop;
}

} // namespace

std::vector<std::vector<std::uint32_t>> handle_loops(std::span<const Triangle> triangles, std::size_t vertices,
                                                     std::uint32_t longest, const Threads& threads) {
  const std::vector<Edge> edges = edges_of(triangles, vertices, threads);
  const Forest forest = breadth_first(edges, vertices);
  const bool has_rim =
      std::any_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.right == triangles.size(); });
  // Euler's formula for closed surfaces: nothing to look for where every piece is a sphere.
  const auto isolated = static_cast<std::int64_t>(forest.isolated);
  const std::int64_t euler = static_cast<std::int64_t>(vertices + triangles.size() + has_rim) - isolated -
                             static_cast<std::int64_t>(edges.size());
  if (euler == 2 * (static_cast<std::int64_t>(forest.trees) - isolated)) return {};
  // The cotree takes the edges with the longest loops, so that the shortest are left.
  const std::vector<std::uint32_t> length = loop_lengths(edges, forest, longest, threads);
  DisjointSets cotree(triangles.size() + 1);
  std::vector<std::vector<std::uint32_t>> loops;
  for (const std::uint32_t i : by_length(length, longest)) {
    const Edge& e = edges[i];
    if (cotree.find(e.left) != cotree.find(e.right))
      cotree.unite(e.left, e.right);
    else if (length[i] <= longest)
      loops.push_back(loop_through(forest, e));
  }
  std::reverse(loops.begin(), loops.end());
  return loops;
}

LoopsNearby::LoopsNearby(std::span<const Triangle> triangles, std::size_t vertices)
    : triangles_(triangles),
      of_vertex_(build_rows<std::uint32_t>(vertices,
                                           [&](auto&& visit) {
                                             for (std::uint32_t i = 0; i < triangles.size(); ++i)
                                               for (const std::uint32_t v : triangles[i]) visit(v, i);
                                           })),
      number_(vertices, none) {}

std::uint32_t LoopsNearby::number(std::uint32_t vertex) {
  if (number_[vertex] == none) {
    number_[vertex] = static_cast<std::uint32_t>(part_.size());
    part_.push_back(vertex);
  }
  return number_[vertex];
}

std::vector<std::vector<std::uint32_t>> LoopsNearby::at(std::uint32_t root, std::uint32_t radius,
                                                        const Threads& threads) {
  part_.clear();
  number(root);
  std::size_t begin = 0;
  for (std::uint32_t step = 0; step < radius; ++step) {
    const std::size_t end = part_.size();
    for (; begin < end; ++begin)
      for (const std::uint32_t i : of_vertex_[part_[begin]])
        for (const std::uint32_t v : triangles_[i]) number(v);
  }
  visited_ += part_.size();
  std::vector<std::uint32_t> inner;
  for (const std::uint32_t v : part_)
    for (const std::uint32_t i : of_vertex_[v]) {
      const Triangle& corners = triangles_[i];
      if (std::all_of(corners.begin(), corners.end(), [&](std::uint32_t w) { return number_[w] != none; }))
        inner.push_back(i);
    }
  std::sort(inner.begin(), inner.end());
  inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
  std::vector<Triangle> part;
  for (const std::uint32_t i : inner)
    part.push_back({number_[triangles_[i][0]], number_[triangles_[i][1]], number_[triangles_[i][2]]});
  for (const std::uint32_t v : part_) number_[v] = none;
  auto loops = handle_loops(part, part_.size(), 2 * radius, threads);
  for (auto& loop : loops)
    for (std::uint32_t& v : loop) v = part_[v];
  return loops;
}

} // namespace eigencrust
