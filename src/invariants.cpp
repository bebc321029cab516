// SPDX-License-Identifier: GPL-3.0-or-later
#include "invariants.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "geometry/mesh_topology.h"
#include "geometry/predicates.h"
#include "repair/unsound_stars.h"

namespace eigencrust {
namespace {

using Text = std::string;

Text numbered(const char* what, std::size_t number) { return std::string(what) + " " + std::to_string(number); }

/// Compressed rows over `items` items.
Text fault_in_rows(std::span<const std::uint64_t> begin, std::size_t rows, std::size_t items, const char* what) {
  if (begin.size() != rows + 1) return numbered(what, rows) + ": the rows are not as many";
  if (begin.front() != 0 || begin.back() != items) return Text(what) + ": rows and items do not end together";
  if (!std::is_sorted(begin.begin(), begin.end())) return Text(what) + ": rows go back";
  return {};
}

Text fault_in_samples(const Scene& scene, const PointCloud& cloud) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const std::size_t n = t.sample_count;
  if (t.positions.size() != n + 8 || t.source.size() != n) return "samples and their rows are not as many";
  if (scene.sample_of_row.size() != cloud.points.size()) return "not each row has its sample";
  for (std::size_t row = 0; row < cloud.points.size(); ++row) {
    const SampleIndex s = scene.sample_of_row[row];
    if (s.valid() != is_finite(cloud.points[row])) return numbered("a sample of no place, or none of one: row", row);
    if (!s.valid()) continue;
    if (s.value >= n) return numbered("no such sample: row", row);
    if (t.source[s] > row || cloud.points[t.source[s]] != cloud.points[row])
      return numbered("another sample's row", row);
  }
  for (SampleIndex s{0}; s.value < n; ++s.value)
    if (scene.sample_of_row[t.source[s]] != s) return numbered("not its row's sample:", s.value);
  std::vector<Vec3> sorted = t.positions.raw();
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return "two samples at one place";
  return {};
}

/// Does neighbour k share the face opposite vertex k, and is this its neighbour in turn?
bool is_mutual(const Tetrahedralization& t, TetrahedronIndex i, std::size_t k) {
  const TetrahedronIndex n = t.neighbours[i][k];
  if (n.value >= t.tetrahedra.size()) return false;
  const auto& back = t.neighbours[n];
  const auto at = static_cast<std::size_t>(std::find(back.begin(), back.end(), i) - back.begin());
  if (at == 4) return false;
  std::array<VertexIndex, 4> here = t.tetrahedra[i], there = t.tetrahedra[n];
  here[k] = there[at] = VertexIndex{};
  std::sort(here.begin(), here.end());
  std::sort(there.begin(), there.end());
  return here == there;
}

Text fault_in_tetrahedra(const Tetrahedralization& t) {
  if (t.neighbours.size() != t.tetrahedra.size()) return "neighbours and tetrahedra are not as many";
  for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value) {
    const auto& [a, b, c, d] = t.tetrahedra[i];
    if (std::max({a, b, c, d}).value >= t.positions.size())
      return numbered("a vertex that is not: tetrahedron", i.value);
    if (a >= b || b >= c || b >= d) return numbered("not in canonical order: tetrahedron", i.value);
    if (i.value > 0 && !(t.tetrahedra[{i.value - 1}] < t.tetrahedra[i]))
      return numbered("out of order: tetrahedron", i.value);
    if (orientation(t.positions[a], t.positions[b], t.positions[c], t.positions[d]) <= 0)
      return numbered("flat, or inside out: tetrahedron", i.value);
    for (std::size_t k = 0; k < 4; ++k) {
      if (t.neighbours[i][k].valid() && !is_mutual(t, i, k))
        return numbered("no neighbour of its own: tetrahedron", i.value);
      if (t.neighbours[i][k].valid()) continue;
      for (std::size_t j = 0; j < 4; ++j)
        if (j != k && !t.is_corner(t.tetrahedra[i][j])) return numbered("a hole beside tetrahedron", i.value);
    }
  }
  return {};
}

Text fault_in_stars(const Tetrahedralization& t, const VertexStars& stars) {
  Text fault = fault_in_rows(stars.begin, t.positions.size(), stars.tetrahedra.size(), "stars");
  if (!fault.empty()) return fault;
  if (stars.tetrahedra.size() != std::size_t{4} * t.tetrahedra.size()) return "the stars are not complete";
  for (VertexIndex s{0}; s.value < t.positions.size(); ++s.value) {
    const auto star = stars[s];
    for (std::size_t k = 0; k < star.size(); ++k) {
      if (star[k].value >= t.tetrahedra.size() || (k > 0 && !(star[k - 1] < star[k])))
        return numbered("out of order: the star of vertex", s.value);
      const auto& v = t.tetrahedra[star[k]];
      if (std::find(v.begin(), v.end(), s) == v.end()) return numbered("a stranger in the star of vertex", s.value);
    }
  }
  return {};
}

Text fault_in_poles(const Tetrahedralization& t, const Poles& poles) {
  const std::uint32_t count = poles.tetrahedron.size();
  if (poles.sphere.size() != count || poles.of_sample.size() != t.sample_count) return "poles are missing";
  for (const TetrahedronIndex i : poles.tetrahedron)
    if (i.value >= t.tetrahedra.size()) return "a pole that is no tetrahedron";
  for (const PolePair& pair : poles.of_sample)
    for (const PoleIndex p : {pair.first, pair.second})
      if (p.valid() && p.value >= count) return "a sample's pole that is none";
  return {};
}

Text fault_in_measures(const SampleMeasures& measures, std::size_t samples) {
  const SampleModel& model = measures.model;
  if (model.spacing.size() != samples || model.noise.size() != samples || model.input_noise.size() != samples ||
      model.isolated.size() != samples || (!measures.grid.empty() && measures.grid.size() != samples))
    return "not each sample is measured";
  for (SampleIndex s{0}; s.value < samples; ++s.value)
    if (!(model.spacing[s] > 0) || !(model.noise[s] >= 0) || !(model.input_noise[s] >= model.noise[s]) ||
        !(model.isolated[s] >= 0) || !std::isfinite(model.input_noise[s]) || !std::isfinite(model.spacing[s]))
      return numbered("no length: what was measured at sample", s.value);
  return {};
}

/// With a façade the surface reaches the cube.
bool is_open_at_cube(const Tetrahedralization& t, const TetrahedronLabels& labels) {
  bool inside = false, outside = false;
  for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value)
    if (t.touches_cube(i)) (labels[i] == Label::inside ? inside : outside) = true;
  return inside && outside;
}

/// One side for each tetrahedron, and a value that agrees.
Text fault_in_sides(const TetrahedronLabels& labels, const Scene& scene) {
  if (labels.size() != scene.tetrahedralization.tetrahedra.size() || labels.values().size() != labels.size())
    return "not each tetrahedron has a label";
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value) {
    if (labels[i] != Label::inside && labels[i] != Label::outside) return numbered("no side: tetrahedron", i.value);
    if (!std::isfinite(labels.value(i)) || std::signbit(labels.value(i)) != (labels[i] == Label::inside))
      return numbered("value and label disagree: tetrahedron", i.value);
  }
  return {};
}

} // namespace

std::string fault_in(const Scene& scene, const PointCloud& cloud) {
  for (const auto& look :
       {+[](const Scene&s, const PointCloud&c) { return fault_in_samples(s, c); },
        +[](const Scene&s, const PointCloud&) { return fault_in_tetrahedra(s.tetrahedralization); },
        +[](const Scene&s, const PointCloud&) { return fault_in_stars(s.tetrahedralization, s.stars); },
        +[](const Scene&s, const PointCloud&) { return fault_in_poles(s.tetrahedralization, s.poles); }})
    if (Text fault = look(scene, cloud); !fault.empty()) return fault;
  return fault_in_measures(scene.measures, scene.tetrahedralization.sample_count);
}

std::string fault_in(const Evidence& evidence, const Scene& scene) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const std::uint32_t n = t.tetrahedra.size();
  if (evidence.named.size() != n || evidence.labels.size() != n) return "not each tetrahedron has evidence";
  for (TetrahedronIndex i{0}; i.value < n; ++i.value) {
    if (evidence.named[i] == Label::unlabelled && t.touches_cube(i))
      return numbered("unknown at the cube: tetrahedron", i.value);
    if (evidence.named[i] != Label::unlabelled && evidence.labels[i] != evidence.named[i])
      return numbered("a line overrules what was named: tetrahedron", i.value);
  }
  if (!evidence.crossings) return {};
  const SightCrossings& crossings = *evidence.crossings;
  for (const TetrahedronIndex i : crossings.tetrahedra)
    if (i.value >= n) return "a line crosses what is not there";
  if (evidence.sight && (evidence.sight->front.size() != n || evidence.sight->behind.size() != n))
    return "not each tetrahedron's lines are counted";
  return fault_in_rows(crossings.begin, crossings.begin.size() - 1, crossings.tetrahedra.size(), "lines");
}

std::string fault_in(const SignedGraph& graph) {
  const std::uint32_t n = graph.node_count();
  if (graph.row_begin.empty()) return {};
  if (graph.weight.size() != graph.column.size()) return "weights and columns are not as many";
  if (Text fault = fault_in_rows(graph.row_begin, n, graph.column.size(), "graph"); !fault.empty()) return fault;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint64_t e = graph.row_begin[i]; e < graph.row_begin[i + 1]; ++e) {
      const std::uint32_t j = graph.column[e];
      if (j >= n || j == i || (e > graph.row_begin[i] && graph.column[e - 1] >= j))
        return numbered("columns of node", i);
      if (!std::isfinite(graph.weight[e])) return numbered("a weight of node", i);
      const auto begin = graph.column.begin() + static_cast<std::ptrdiff_t>(graph.row_begin[j]),
                 end = graph.column.begin() + static_cast<std::ptrdiff_t>(graph.row_begin[j + 1]);
      const auto back = std::lower_bound(begin, end, i);
      if (back == end || *back != i ||
          graph.weight[static_cast<std::size_t>(back - graph.column.begin())] != graph.weight[e])
        return numbered("not symmetric: an edge of node", i);
    }
  for (const SignedGraph::Supernode& super : graph.supernodes)
    if (super.weight.size() != n ||
        !std::all_of(super.weight.begin(), super.weight.end(), [](float w) { return std::isfinite(w); }))
      return "a supernode's weights";
  return {};
}

std::string fault_in(const PoleLabels& poles, const Scene& scene, const Evidence& evidence) {
  const std::uint32_t n = scene.tetrahedralization.tetrahedra.size();
  if (poles.labels.size() != n || poles.trust.size() != n) return "not each tetrahedron has a place for its label";
  for (TetrahedronIndex i{0}; i.value < n; ++i.value)
    if (evidence.labels[i] != Label::unlabelled && poles.labels[i] != evidence.labels[i])
      return numbered("not what is known: tetrahedron", i.value);
  return {};
}

std::string fault_in(const Settled& settled, const Scene& scene, const Options& options) {
  const Tetrahedralization& t = scene.tetrahedralization;
  if (Text fault = fault_in_sides(settled.labels, scene); !fault.empty()) return fault;
  const Energy& energy = settled.energy;
  if (energy.data.size() != t.tetrahedra.size() || energy.known.size() != t.tetrahedra.size())
    return "not each tetrahedron has its term";
  if (options.second_stage != SecondStage::cut) return {};
  constexpr double rounding = 0.01; // capacities are whole thousandths
  for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value) {
    if (!std::isfinite(energy.data[i])) return numbered("no number: the term of tetrahedron", i.value);
    if (energy.known[i] != Label::unlabelled) {
      if (settled.labels[i] != energy.known[i]) return numbered("not what is known: tetrahedron", i.value);
      continue;
    }
    const TetrahedronIndex one[] = {i};
    if (energy.change(t, settled.labels.labels(), one) < -rounding) return numbered("no minimum: tetrahedron", i.value);
  }
  return {};
}

std::string fault_in(const TetrahedronLabels& labels, const Scene& scene, const Options& options) {
  if (Text fault = fault_in_sides(labels, scene); !fault.empty()) return fault;
  if (!options.manifold) return {};
  const auto unsound = unsound_stars(scene.tetrahedralization, scene.stars, labels.labels(), Threads(1));
  return unsound.empty() ? Text{} : numbered("no disc: the star of sample", unsound.front());
}

std::string fault_in(const Surface& surface, const Scene& scene, const TetrahedronLabels& labels,
                     const Options& options) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const auto& [mesh, sample_of, inside, support, unsupported] = surface;
  if (mesh.vertices.size() != sample_of.size() || mesh.triangles.size() != inside.size() ||
      mesh.triangles.size() != support.size() || (!unsupported.empty() && mesh.triangles.size() != unsupported.size()))
    return "the surface's lists are not as long";
  for (std::size_t v = 0; v < sample_of.size(); ++v)
    if (sample_of[v].value >= t.sample_count || (v > 0 && !(sample_of[v - 1] < sample_of[v])) ||
        mesh.vertices[v] != t.positions[sample_of[v]])
      return numbered("no sample: vertex", v);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& corners = t.tetrahedra[inside[i]];
    std::size_t opposite = 0 + 1 + 2 + 3;
    for (const std::uint32_t v : mesh.triangles[i]) {
      const auto at = v >= sample_of.size() ? corners.end() : std::find(corners.begin(), corners.end(), sample_of[v]);
      if (at == corners.end()) return numbered("no face of its tetrahedron: triangle", i);
      opposite -= static_cast<std::size_t>(at - corners.begin());
    }
    // Either may be the inner side: where a shell was dropped, its cavity is a body. A lid on a rim of three edges
    // (close_smallest_rims) has no support.
    const TetrahedronIndex before = t.neighbours[inside[i]][opposite];
    if (!before.valid() || (labels[before] == labels[inside[i]] && support[i] > 0))
      return numbered("nothing divided by triangle", i);
    if (!(support[i] >= 0 && support[i] <= 1)) return numbered("no share: the support of triangle", i);
  }
  if (!options.manifold || options.trim || is_open_at_cube(t, labels)) return {};
  Text fault;
  const std::vector<Side> sides = sorted_sides(mesh.triangles, mesh.vertices.size(), Threads(1));
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() != 2 || edge[0].forward == edge[1].forward)
      fault = numbered("not two triangles at an edge of vertex", edge[0].low);
  });
  return fault;
}

void stop_at(const std::string& fault, const char* file, int line) {
  if (fault.empty()) return;
  std::fprintf(stderr, "%s:%d: invariant: %s\n", file, line, fault.c_str());
  std::abort();
}

} // namespace eigencrust
