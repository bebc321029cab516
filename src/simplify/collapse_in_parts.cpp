// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse_in_parts.h"

#include <algorithm>
#include <utility>

#include "geometry/mesh_topology.h"
#include "geometry/spatial_order.h"

namespace eigencrust {
namespace {

// Enough that few vertices lie where parts meet, few enough that a part stays in the cache.
constexpr std::size_t triangles_of_a_part = 60'000;

struct Part {
  std::vector<std::uint32_t> vertex; ///< of the whole, for each of its own
  TriangleMesh mesh;
  std::vector<Quadric> quadrics;
  std::vector<float> limits;
  Collapsed result; ///< with these limits
};

} // namespace

class CollapseInParts::Parts {
 public:
  Parts(const TriangleMesh& mesh, std::span<const Quadric> quadrics, const StandFor& before, const CollapseGoal& goal,
        const Threads& threads)
      : mesh_(mesh), quadrics_(quadrics), before_(before), goal_(goal), threads_(threads) {
    const std::size_t n = mesh.triangles.size();
    Box3 box;
    for (const Vec3& p : mesh.vertices) box.add(p);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> along(n); // a Hilbert curve
    for_each_index(threads, n, [&](std::size_t t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3 middle = (1.0 / 3) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]);
      along[t] = {hilbert_key(middle, box), static_cast<std::uint32_t>(t)};
    });
    sort_blocks(threads, along);
    const std::size_t count = (n + triangles_of_a_part / 2) / triangles_of_a_part;
    parts_.resize(std::max<std::size_t>(count, 1));
    owner_.assign(mesh.vertices.size(), no_index);
    std::vector<std::vector<std::uint32_t>> triangles(parts_.size());
    for (std::size_t i = 0; i < n; ++i) {
      const auto p = static_cast<std::uint32_t>(i * parts_.size() / n);
      triangles[p].push_back(along[i].second);
      for (const std::uint32_t v : mesh.triangles[along[i].second])
        owner_[v] = owner_[v] == no_index || owner_[v] == p ? p : shared;
    }
    std::vector<std::uint32_t> own(mesh.vertices.size()); // number in the only part, of those that are not shared
    threads.run(parts_.size(), [&](std::size_t p) { take(triangles[p], own, parts_[p]); });
  }

  Collapsed run(std::span<const float> limits) {
    threads_.run(parts_.size(), [&](std::size_t p) {
      Part& part = parts_[p];
      std::vector<float> own;
      for (const std::uint32_t v : part.vertex) own.push_back(owner_[v] == shared ? -1 : limits[v]);
      if (own == part.limits) return;
      part.limits = std::move(own);
      const double share =
          static_cast<double>(part.mesh.triangles.size()) / static_cast<double>(mesh_.triangles.size());
      // What cannot go where parts meet is not taken from the rest.
      const auto stay = static_cast<std::size_t>(
          std::count_if(part.vertex.begin(), part.vertex.end(), [&](std::uint32_t v) { return owner_[v] == shared; }));
      const auto most = static_cast<std::size_t>(share * static_cast<double>(goal_.triangles)) + 2 * stay;
      std::vector<std::uint32_t> some_triangle(part.vertex.size()); // of each vertex
      for (std::uint32_t t = 0; t < part.mesh.triangles.size(); ++t)
        for (const std::uint32_t v : part.mesh.triangles[t]) some_triangle[v] = t;
      const StandFor before{before_.surface, before_.origin, part.mesh.vertices, some_triangle};
      part.result = collapse_edges(part.mesh, part.quadrics, part.limits, before, {most, goal_.max_error});
    });
    return joined();
  }

 private:
  static constexpr std::uint32_t shared = no_index - 1;

  void take(const std::vector<std::uint32_t>& triangles, std::vector<std::uint32_t>& number, Part& part) const {
    for (const std::uint32_t t : triangles)
      part.vertex.insert(part.vertex.end(), mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    std::sort(part.vertex.begin(), part.vertex.end());
    part.vertex.erase(std::unique(part.vertex.begin(), part.vertex.end()), part.vertex.end());
    for (const std::uint32_t v : part.vertex) {
      if (owner_[v] != shared) number[v] = static_cast<std::uint32_t>(part.mesh.vertices.size());
      part.mesh.vertices.push_back(mesh_.vertices[v]);
      part.quadrics.push_back(quadrics_[v]);
    }
    for (const std::uint32_t t : triangles) {
      auto& own = part.mesh.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh_.triangles[t][k];
        own[k] = owner_[v] != shared
                     ? number[v]
                     : static_cast<std::uint32_t>(std::lower_bound(part.vertex.begin(), part.vertex.end(), v) -
                                                  part.vertex.begin());
      }
    }
  }

  [[nodiscard]] Collapsed joined() const {
    Collapsed whole;
    whole.into.assign(mesh_.vertices.size(), no_index);
    for (const Part& part : parts_) {
      std::vector<std::uint32_t> number(part.result.mesh.vertices.size(), no_index); // in the whole
      for (std::size_t i = 0; i < part.vertex.size(); ++i) {
        const std::uint32_t v = part.vertex[i], left = part.result.into[i];
        if (owner_[v] == shared && whole.into[v] != no_index) number[left] = whole.into[v];
        if (number[left] == no_index) {
          number[left] = static_cast<std::uint32_t>(whole.mesh.vertices.size());
          whole.mesh.vertices.push_back(part.result.mesh.vertices[left]);
          whole.quadrics.push_back(owner_[v] == shared ? quadrics_[v] : part.result.quadrics[left]);
        }
        whole.into[v] = number[left];
      }
      for (const auto& [a, b, c] : part.result.mesh.triangles)
        whole.mesh.triangles.push_back({number[a], number[b], number[c]});
    }
    for (std::uint32_t& v : whole.into) // in no triangle
      if (v == no_index) v = 0;
    return whole;
  }

  const TriangleMesh& mesh_;
  std::span<const Quadric> quadrics_;
  StandFor before_;
  CollapseGoal goal_;
  const Threads& threads_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> owner_; ///< of each vertex the part, or shared
};

CollapseInParts::CollapseInParts(const TriangleMesh& mesh, std::span<const Quadric> quadrics, const StandFor& before,
                                 const CollapseGoal& goal, const Threads& threads)
    : parts_(std::make_unique<Parts>(mesh, quadrics, before, goal, threads)) {}
CollapseInParts::~CollapseInParts() = default;

Collapsed CollapseInParts::run(std::span<const float> limits) { return parts_->run(limits); }

} // namespace eigencrust
