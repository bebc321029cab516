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

/// Euler's formula for closed surfaces; one face closes all rims. Nothing to look for where every piece is a sphere.
bool all_are_spheres(std::span<const Triangle> triangles, std::size_t vertices, const std::vector<Edge>& edges) {
  DisjointSets joined(vertices);
  std::vector<std::uint8_t> used(vertices, 0);
  std::int64_t pieces = 0,
               euler = static_cast<std::int64_t>(triangles.size()) - static_cast<std::int64_t>(edges.size());
  for (const Edge& e : edges) {
    for (const std::uint32_t v : {e.low, e.high}) {
      euler += !used[v];
      pieces += !used[v];
      used[v] = 1;
    }
    const std::uint32_t a = joined.find(e.low), b = joined.find(e.high);
    if (a == b) continue;
    joined.unite(a, b);
    --pieces;
  }
  euler += std::any_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.right == triangles.size(); });
  return euler == 2 * pieces;
}

/// Breadth-first trees, one for each component, with the depth of every vertex.
struct Forest {
  std::vector<std::uint32_t> parent, depth;
};

Forest breadth_first(const std::vector<Edge>& edges, std::size_t vertices) {
  const auto neighbours = build_rows<std::uint32_t>(vertices, [&](auto&& visit) {
    for (const Edge& e : edges) {
      visit(e.low, e.high);
      visit(e.high, e.low);
    }
  });
  Forest forest{std::vector<std::uint32_t>(vertices, none), std::vector<std::uint32_t>(vertices, none)};
  std::vector<std::uint32_t> queue;
  queue.reserve(vertices);
  for (std::uint32_t root = 0; root < vertices; ++root) {
    if (forest.depth[root] != none) continue;
    forest.depth[root] = 0;
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
  if (all_are_spheres(triangles, vertices, edges)) return {};
  const Forest forest = breadth_first(edges, vertices);
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

LoopsNearby::LoopsNearby(std::size_t vertices, TrianglesAt triangles_at)
    : triangles_at_(std::move(triangles_at)), number_(vertices, none) {}

void LoopsNearby::take(std::uint32_t vertex) {
  if (number_[vertex] != none) return;
  number_[vertex] = static_cast<std::uint32_t>(part_.size());
  part_.push_back(vertex);
}

std::vector<std::vector<std::uint32_t>> LoopsNearby::at(std::uint32_t root, std::uint32_t radius,
                                                        const Threads& threads) {
  part_.clear();
  take(root);
  std::vector<NamedTriangle> triangles;
  std::size_t looked_at = 0, looked_through = 0;
  const auto was_looked_at = [&](std::uint32_t v) { return number_[v] < looked_at; };
  for (std::uint32_t step = 0; step <= radius; ++step) {
    for (const std::size_t ring_end = part_.size(); looked_at < ring_end; ++looked_at) {
      const auto before = static_cast<std::ptrdiff_t>(triangles.size());
      triangles_at_(part_[looked_at], triangles);
      // Each once, from the first of its corners.
      triangles.erase(std::remove_if(triangles.begin() + before, triangles.end(),
                                     [&](const NamedTriangle& triangle) {
                                       return std::any_of(triangle.corners.begin(), triangle.corners.end(),
                                                          was_looked_at);
                                     }),
                      triangles.end());
    }
    if (step == radius) break; // the last ring takes no more vertices
    for (; looked_through < triangles.size(); ++looked_through)
      for (const std::uint32_t v : triangles[looked_through].corners) take(v);
  }
  visited_ += part_.size();
  std::sort(triangles.begin(), triangles.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  std::vector<Triangle> inner;
  for (const auto& [name, corners] : triangles) {
    const Triangle in_part{number_[corners[0]], number_[corners[1]], number_[corners[2]]};
    if (std::find(in_part.begin(), in_part.end(), none) == in_part.end()) inner.push_back(in_part);
  }
  for (const std::uint32_t v : part_) number_[v] = none;
  auto loops = handle_loops(inner, part_.size(), 2 * radius, threads);
  for (auto& loop : loops)
    for (std::uint32_t& v : loop) v = part_[v];
  return loops;
}

} // namespace eigencrust
