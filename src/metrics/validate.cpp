// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>

#include <eigencrust/error.h>
#include <eigencrust/validate.h>

#include "geometry/mesh_topology.h"
#include "geometry/self_intersections.h"
#include "geometry/signed_volume.h"
#include "parallel/compressed_rows.h"
#include "parallel/threads.h"

namespace eigencrust {
namespace {

/// Triangles with vertices of equal coordinates made one, in two views: all of them, and without those
/// that have two equal corners. The latter have no sides to join anything by: topology goes without.
struct MergedTriangles {
  std::vector<std::uint32_t> first; ///< for each vertex of the mesh the one it became
  std::vector<Triangle> all, proper;
};

MergedTriangles merged_triangles(const TriangleMesh& mesh, bool merge) {
  MergedTriangles merged;
  merged.all = mesh.triangles;
  if (merge) {
    merged.first = first_equal_vertex(mesh.vertices);
    for (Triangle& t : merged.all)
      for (std::uint32_t& v : t) v = merged.first[v];
  } else {
    merged.first.resize(mesh.vertices.size());
    std::iota(merged.first.begin(), merged.first.end(), 0u);
  }
  merged.proper.reserve(merged.all.size());
  for (const Triangle& t : merged.all)
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) merged.proper.push_back(t);
  return merged;
}

/// How the triangles hang together. The surface is cut open along every edge that does not have
/// exactly two triangles; what then hangs together is a manifold piece with boundary, whose corners
/// around one vertex form one fan.
struct Connectivity {
  explicit Connectivity(std::size_t triangles) : components(triangles), fans(3 * triangles), sheets(2 * triangles) {}

  DisjointSets components; ///< of triangles, joined along all edges
  DisjointSets fans;       ///< of corners, joined along edges with two triangles
  DisjointSets rims;       ///< of corners: a cut side joins the fans at its ends, so that loops form
  DisjointSets sheets;     ///< of triangle sides 2t (front) and 2t+1 (back): joined = not orientable
  std::vector<Side> cut;   ///< sides of edges that do not have exactly two triangles
};

void join_sheets(DisjointSets& sheets, const Side& a, const Side& b) {
  const std::uint32_t flip = a.forward == b.forward ? 1 : 0;
  sheets.unite(2 * a.triangle(), 2 * b.triangle() + flip);
  sheets.unite(2 * a.triangle() + 1, 2 * b.triangle() + 1 - flip);
}

/// Fills the counts of edges of the summary on the way.
Connectivity connect(std::span<const Side> sides, std::size_t triangles, MeshSummary& summary, const Threads& threads) {
  Connectivity c(triangles);
  // The sets know nothing of each other: each has a thread of its own.
  threads.run(3, [&](std::size_t set) {
    for_each_edge(sides, [&](std::span<const Side> edge) {
      if (set == 0)
        for (const Side& s : edge) c.components.unite(edge[0].triangle(), s.triangle());
      else if (edge.size() == 2)
        set == 1 ? join_fans(c.fans, edge[0], edge[1]) : join_sheets(c.sheets, edge[0], edge[1]);
    });
  });
  for_each_edge(sides, [&](std::span<const Side> edge) {
    const auto forward = std::count_if(edge.begin(), edge.end(), [](const Side& s) { return s.forward; });
    if (edge.size() > 1 && 2 * static_cast<std::size_t>(forward) != edge.size()) ++summary.inconsistent_edges;
    if (edge.size() == 2) return;
    ++(edge.size() == 1 ? summary.boundary_edges : summary.nonmanifold_edges);
    c.cut.insert(c.cut.end(), edge.begin(), edge.end());
  });
  if (!c.cut.empty()) c.rims = c.fans;
  for (const Side& s : c.cut) c.rims.unite(s.start(), s.end());
  return c;
}

/// What is counted for each component before its genus is known.
struct Tally {
  std::int64_t triangles = 0, edges = 0, vertices = 0;
  std::int64_t pieces = 0, split_edges = 0, fans = 0, loops = 0; ///< after cutting open
  bool orientable = true;
};

/// Component number of each triangle by first triangle, and their count.
std::pair<std::vector<std::uint32_t>, std::uint32_t> number_components(DisjointSets& sets, std::size_t triangles) {
  std::vector<std::uint32_t> number(triangles);
  std::uint32_t count = 0;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const std::uint32_t root = sets.find(t); // the smallest member, hence numbered before t
    number[t] = root == t ? count++ : number[root];
  }
  return {std::move(number), count};
}

/// Counts fans per vertex and vertices per component; non-manifold vertices go to the summary.
void tally_vertices(std::span<const Triangle> triangles, std::size_t vertices, Connectivity& c,
                    std::span<const std::uint32_t> component, std::vector<Tally>& tallies, MeshSummary& summary) {
  std::vector<std::uint32_t> fans_at(vertices, 0);
  for_each_corner(triangles, [&](std::uint32_t t, std::uint32_t v, std::uint32_t corner) {
    if (c.fans.find(corner) != corner) return;
    ++fans_at[v];
    ++tallies[component[t]].fans;
  });
  for (const std::uint32_t fans : fans_at) {
    if (fans > 0) ++summary.vertices;
    if (fans > 1) ++summary.nonmanifold_vertices;
  }
  // Triangles component by component, so that one mark per vertex tells whether it was met there.
  std::vector<std::uint32_t> order(triangles.size()), seen_in(vertices, no_index);
  std::iota(order.begin(), order.end(), 0u);
  if (tallies.size() > 1)
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return component[a] < component[b]; });
  for (const std::uint32_t t : order)
    for (const std::uint32_t v : triangles[t])
      if (std::exchange(seen_in[v], component[t]) != component[t]) ++tallies[component[t]].vertices;
}

/// Counts loops of cut sides: per component for the genus; in the summary those with a true boundary edge.
void tally_loops(Connectivity& c, std::span<const std::uint32_t> component, std::vector<Tally>& tallies,
                 MeshSummary& summary) {
  std::vector<std::uint32_t> loops, boundary_loops;
  for (std::size_t i = 0; i < c.cut.size(); ++i) {
    const Side& s = c.cut[i];
    const auto same = [&](std::size_t j) {
      return j < c.cut.size() && c.cut[j].low == s.low && c.cut[j].high == s.high;
    };
    loops.push_back(c.rims.find(s.start()));
    if (!same(i + 1) && (i == 0 || !same(i - 1))) boundary_loops.push_back(loops.back());
  }
  const auto keep_distinct = [](std::vector<std::uint32_t>& v) {
    std::sort(v.begin(), v.end());
    v.erase(std::unique(v.begin(), v.end()), v.end());
  };
  keep_distinct(loops);
  keep_distinct(boundary_loops);
  for (const std::uint32_t corner : loops) ++tallies[component[corner / 3]].loops;
  summary.boundary_loops = boundary_loops.size();
}

std::vector<Tally> tally_components(std::span<const Triangle> triangles, std::size_t vertices,
                                    std::span<const Side> sides, MeshSummary& summary, const Threads& threads) {
  Connectivity c = connect(sides, triangles.size(), summary, threads);
  const auto [component, count] = number_components(c.components, triangles.size());
  std::vector<Tally> tallies(count);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    Tally& tally = tallies[component[t]];
    ++tally.triangles;
    const std::uint32_t front = c.sheets.find(2 * t), back = c.sheets.find(2 * t + 1);
    if (front == back) tally.orientable = false;
    // The smallest member of a piece's sheets is a front; orientable pieces have two sheets.
    if (std::min(front, back) == 2 * t) ++tally.pieces;
  }
  for_each_edge(sides, [&](std::span<const Side> edge) {
    Tally& tally = tallies[component[edge[0].triangle()]];
    ++tally.edges;
    tally.split_edges += edge.size() == 2 ? 1 : static_cast<std::int64_t>(edge.size());
    ++summary.euler; // number of edges for now
  });
  tally_vertices(triangles, vertices, c, component, tallies, summary);
  tally_loops(c, component, tallies, summary);
  summary.euler =
      static_cast<std::int64_t>(summary.vertices) - summary.euler + static_cast<std::int64_t>(triangles.size());
  return tallies;
}

void summarize_topology(std::span<const Triangle> triangles, std::size_t vertices, MeshSummary& summary,
                        const Threads& threads) {
  const std::vector<Side> sides = sorted_sides(triangles, vertices, threads);
  const std::vector<Tally> tallies = tally_components(triangles, vertices, sides, summary, threads);
  summary.components = tallies.size();
  summary.component_list.reserve(tallies.size());
  for (const Tally& t : tallies) {
    ComponentSummary component;
    component.vertices = static_cast<std::uint32_t>(t.vertices);
    component.triangles = static_cast<std::uint32_t>(t.triangles);
    component.euler = t.vertices - t.edges + t.triangles;
    // Sum of 2 - 2g - loops over the manifold pieces is their Euler number.
    component.genus = t.orientable ? (2 * t.pieces - (t.fans - t.split_edges + t.triangles) - t.loops) / 2 : -1;
    if (!t.orientable || summary.genus < 0)
      summary.genus = -1;
    else
      summary.genus += component.genus;
    summary.component_list.push_back(component);
  }
  std::stable_sort(summary.component_list.begin(), summary.component_list.end(),
                   [](const auto& a, const auto& b) { return a.triangles > b.triangles; });
}

struct Measures {
  SignedVolume volume;
  double area = 0;
  Measures operator+(const Measures& o) const { return {volume + o.volume, area + o.area}; }
};

/// Volume by the divergence theorem, with the origin in the middle of the box: far from zero the terms
/// would otherwise be large and cancel.
Measures measure(std::span<const Vec3> vertices, std::span<const Triangle> triangles, const Vec3& centre,
                 const Threads& threads) {
  return sum_blocks<Measures>(threads, triangles.size(), [&](std::size_t begin, std::size_t end) {
    Measures sum;
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3 a = vertices[triangles[t][0]] - centre, b = vertices[triangles[t][1]] - centre,
                 c = vertices[triangles[t][2]] - centre;
      sum.volume.add(a, b, c);
      sum.area += norm(cross(b - a, c - a)) / 2;
    }
    return sum;
  });
}

/// Vertices that no triangle with three distinct corners uses, equal ones counted once.
std::uint64_t count_unreferenced(const MergedTriangles& merged) {
  std::vector<std::uint8_t> used(merged.first.size(), 0);
  for (const Triangle& t : merged.proper)
    for (const std::uint32_t v : t) used[v] = 1;
  std::uint64_t unreferenced = 0;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (merged.first[v] == v && used[v] == 0) ++unreferenced;
  return unreferenced;
}

} // namespace

MeshSummary validate(const TriangleMesh& mesh, const ValidateOptions& options) {
  return validate(mesh, options, Threads(options.threads));
}

MeshSummary validate(const TriangleMesh& mesh, const ValidateOptions& options, const Threads& threads) {
  require_valid_indices(mesh, "validate");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!is_finite(mesh.vertices[v]))
      throw Error(ErrorKind::input, "validate", "vertex " + std::to_string(v) + " is not finite", "repair the mesh");

  MeshSummary summary;
  const MergedTriangles merged = merged_triangles(mesh, options.merge_equal_vertices);
  summary.triangles = merged.all.size();
  summary.unreferenced_vertices = count_unreferenced(merged);
  summarize_topology(merged.proper, mesh.vertices.size(), summary, threads);

  for (const Triangle& t : merged.proper)
    for (const std::uint32_t v : t) summary.bounds.add(mesh.vertices[v]);
  if (!summary.bounds.empty()) {
    const Measures m = measure(mesh.vertices, merged.proper, summary.bounds.centre(), threads);
    summary.volume = m.volume.known();
    summary.area = m.area;
  }
  const auto degenerate = find_degenerate_triangles(mesh.vertices, merged.all, threads);
  summary.degenerate_triangles = static_cast<std::uint64_t>(std::count(degenerate.begin(), degenerate.end(), 1));
  if (options.self_intersections) {
    // Where vertices were left apart, equal ones still count as shared: touching there is no crossing.
    const std::vector<Triangle> joined = options.merge_equal_vertices ? merged.all : merged_triangles(mesh, true).all;
    const Crossings crossings = count_self_intersections(mesh.vertices, joined, degenerate, threads);
    summary.self_intersections = static_cast<std::int64_t>(crossings.pairs);
    summary.all_self_intersections = crossings.all;
  }
  return summary;
}

TriangleMesh merge_equal_vertices(const TriangleMesh& mesh) {
  require_valid_indices(mesh, "merge_equal_vertices");
  const std::vector<std::uint32_t> first = first_equal_vertex(mesh.vertices);
  std::vector<std::uint32_t> kept, number(mesh.vertices.size());
  TriangleMesh result;
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (first[v] != v) {
      number[v] = number[first[v]];
      continue;
    }
    number[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(v);
    result.vertices.push_back(mesh.vertices[v]);
  }
  result.triangles = mesh.triangles;
  for (Triangle& t : result.triangles)
    for (std::uint32_t& v : t) v = number[v];
  for (const Attribute& attribute : mesh.vertex_attributes) result.vertex_attributes.push_back(gather(attribute, kept));
  result.triangle_attributes = mesh.triangle_attributes;
  return result;
}

std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh, unsigned threads) {
  require_valid_indices(mesh, "triangle_components");
  struct End {
    std::uint32_t high, triangle;
  };
  auto ends = build_rows<End>(mesh.vertices.size(), [&](auto&& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
        if (from != to) visit(std::min(from, to), End{std::max(from, to), t});
    }
  });
  DisjointSets sets(mesh.triangles.size());
  sort_rows(ends, Threads(threads), [](const End& a, const End& b) { return a.high < b.high; });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    for (std::size_t i = ends.begin[v] + 1; i < ends.begin[v + 1]; ++i)
      if (ends.item[i].high == ends.item[i - 1].high) sets.unite(ends.item[i - 1].triangle, ends.item[i].triangle);
  return number_components(sets, mesh.triangles.size()).first;
}

} // namespace eigencrust
