// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/sample_clusters.h"

#include <algorithm>

namespace eigencrust {
namespace {

// Cosine: clusters that are joined.
constexpr double same_way = 0.8;
// Fewer clusters need no coarser ones.
constexpr std::size_t few = 64, least_levels = 3;

std::vector<Vec3> summed_normals(const ClusterLevel& fine, const CompressedRows<std::uint32_t>& children,
                                 const Threads& threads) {
  std::vector<Vec3> normal(children.begin.size() - 1);
  for_each_index(threads, normal.size(), [&](std::size_t p) {
    for (const std::uint32_t c : children[p]) normal[p] = normal[p] + fine.cluster[c].count * fine.normal[c];
    if (const double length = norm(normal[p]); length > 0) normal[p] = (1 / length) * normal[p];
  });
  return normal;
}

} // namespace

void SampleCluster::add(const SampleCluster& other) {
  if (!(other.count > 0)) return;
  const double total = count + other.count;
  const Vec3 d = other.mean - mean;
  const double mine = count / total, others = other.count / total, between = mine * others;
  const std::array<double, 6> apart{d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
  for (std::size_t k = 0; k < apart.size(); ++k)
    spread[k] = mine * spread[k] + others * other.spread[k] + between * apart[k];
  mean = mean + others * d;
  count = total;
}

ClusterPyramid::ClusterPyramid(const SurfaceFans& fans, std::span<const Vec3> position, std::vector<Vec3> normal,
                               std::span<const Vec3> samples, std::span<const std::uint32_t> vertex_of,
                               const Threads& threads) {
  ClusterLevel base;
  base.cluster.resize(normal.size());
  for (std::size_t v = 0; v < normal.size(); ++v) base.cluster[v].mean = position[v];
  for (std::size_t s = 0; s < samples.size(); ++s)
    if (vertex_of[s] != no_vertex) base.cluster[vertex_of[s]].add({samples[s], {}, 1});
  base.normal = std::move(normal);
  base.neighbours = build_rows<std::uint32_t>(threads, base.cluster.size(), default_block, [&fans] {
    return [&fans](std::size_t v, std::vector<std::uint32_t>& row) {
      for (const auto& wing : fans[v]) row.push_back(wing.next);
    };
  });
  levels_.push_back(std::move(base));
  while (levels_.size() < least_levels || (levels_.size() < most_levels && levels_.back().cluster.size() > few))
    levels_.push_back(coarser(levels_.back(), threads));
}

ClusterLevel ClusterPyramid::coarser(ClusterLevel& fine, const Threads& threads) {
  constexpr std::uint32_t free = no_vertex;
  ClusterLevel coarse;
  const auto n = static_cast<std::uint32_t>(fine.cluster.size());
  fine.parent.assign(n, free);
  for (std::uint32_t c = 0; c < n; ++c) {
    if (fine.parent[c] != free) continue;
    const auto p = static_cast<std::uint32_t>(coarse.seed.size());
    coarse.seed.push_back(c);
    fine.parent[c] = p;
    for (const std::uint32_t o : fine.neighbours[c])
      if (fine.parent[o] == free && dot(fine.normal[o], fine.normal[c]) > same_way) fine.parent[o] = p;
  }
  coarse.children = build_rows<std::uint32_t>(coarse.seed.size(), [&](auto&& visit) {
    for (std::uint32_t c = 0; c < n; ++c) visit(fine.parent[c], c);
  });
  coarse.cluster.resize(coarse.seed.size());
  coarse.place.resize(coarse.seed.size());
  coarse.child.resize(n);
  for_each_index(threads, coarse.seed.size(), [&](std::size_t p) {
    SampleCluster& cluster = coarse.cluster[p];
    cluster.mean = fine.cluster[coarse.seed[p]].mean;
    for (const std::uint32_t c : coarse.children[p]) cluster.add(fine.cluster[c]);
    coarse.place[p].mean = cluster.mean;
    double& extent = coarse.place[p].extent;
    for (const std::uint32_t c : coarse.children[p])
      extent = std::max(extent, distance(fine.cluster[c].mean, cluster.mean));
    for (std::size_t k = coarse.children.begin[p]; k < coarse.children.begin[p + 1]; ++k)
      coarse.child[k].cluster = fine.cluster[coarse.children.item[k]];
  });
  coarse.normal = summed_normals(fine, coarse.children, threads);
  copy_normals(fine, coarse, threads);
  const auto neighbours = [&] {
    return [&](std::size_t p, std::vector<std::uint32_t>& row) {
      const auto begin = static_cast<std::ptrdiff_t>(row.size());
      for (const std::uint32_t c : coarse.children[p])
        for (const std::uint32_t o : fine.neighbours[c])
          if (const std::uint32_t q = fine.parent[o]; q != p) row.push_back(q);
      std::sort(row.begin() + begin, row.end());
      row.erase(std::unique(row.begin() + begin, row.end()), row.end());
    };
  };
  coarse.neighbours = build_rows<std::uint32_t>(threads, coarse.seed.size(), default_block, neighbours);
  return coarse;
}

void ClusterPyramid::copy_normals(const ClusterLevel& fine, ClusterLevel& coarse, const Threads& threads) {
  for_each_index(threads, coarse.place.size(), [&](std::size_t p) {
    coarse.place[p].normal = coarse.normal[p];
    for (std::size_t k = coarse.children.begin[p]; k < coarse.children.begin[p + 1]; ++k)
      coarse.child[k].normal = fine.normal[coarse.children.item[k]];
  });
}

void ClusterPyramid::set_normals(std::vector<Vec3> normal, const Threads& threads) {
  levels_[0].normal = std::move(normal);
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    levels_[l].normal = summed_normals(levels_[l - 1], levels_[l].children, threads);
    copy_normals(levels_[l - 1], levels_[l], threads);
  }
}

} // namespace eigencrust
