// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse_again.h"

#include <algorithm>
#include <utility>

#include "geometry/mesh_topology.h"
#include "simplify/crossings.h"
#include "surface/fans.h"

namespace eigencrust {
namespace {

struct Mixed {
  TriangleMesh mesh;
  std::vector<Quadric> quadrics;
  std::vector<float> limits;
  std::vector<std::uint32_t> into; ///< of each vertex before
};

Mixed mix(const Collapsed& before, const Collapsed& after, std::span<const float> limits,
          std::span<const std::uint8_t> apart) {
  Mixed mixed;
  const auto take = [&](const Collapsed& from, std::uint32_t v, float limit) {
    mixed.mesh.vertices.push_back(from.mesh.vertices[v]);
    mixed.quadrics.push_back(from.quadrics[v]);
    mixed.limits.push_back(limit);
    return static_cast<std::uint32_t>(mixed.limits.size() - 1);
  };
  std::vector<std::uint32_t> number(after.mesh.vertices.size(), no_index);
  mixed.into.resize(after.into.size());
  for (std::uint32_t v = 0; v < after.into.size(); ++v) {
    const std::uint32_t now = after.into[v];
    if (apart[now] != 0) {
      mixed.into[v] = take(before, v, limits[v]);
      continue;
    }
    if (number[now] == no_index) number[now] = take(after, now, limits[v]);
    mixed.into[v] = number[now];
    mixed.limits[number[now]] = std::min(mixed.limits[number[now]], limits[v]);
  }
  for (const auto& [a, b, c] : before.mesh.triangles) {
    const Triangle t{mixed.into[a], mixed.into[b], mixed.into[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mixed.mesh.triangles.push_back(t);
  }
  return mixed;
}

/// Is one fan or one ring of triangles around the vertex?
bool is_one_fan(std::span<const SurfaceFans::Wing> wings) {
  if (wings.empty()) return true;
  const auto with = [&](std::uint32_t SurfaceFans::Wing::*side, std::uint32_t v) {
    return std::find_if(wings.begin(), wings.end(), [&](const auto& wing) { return wing.*side == v; });
  };
  auto first = wings.begin();
  for (auto wing = wings.begin(); wing != wings.end(); ++wing) {
    if (with(&SurfaceFans::Wing::next, wing->next) != wing || with(&SurfaceFans::Wing::last, wing->last) != wing)
      return false; // more than two triangles at an edge, or two that look different ways
    if (with(&SurfaceFans::Wing::last, wing->next) == wings.end()) first = wing;
  }
  std::size_t count = 1;
  for (auto wing = with(&SurfaceFans::Wing::next, first->last); wing != wings.end() && wing != first; ++count)
    wing = with(&SurfaceFans::Wing::next, wing->last);
  return count == wings.size();
}

/// Takes more apart where the mixed mesh is no manifold. \return was there such a place?
bool take_more_apart(const Mixed& mixed, const Collapsed& after, const Threads& threads,
                     std::vector<std::uint8_t>& apart) {
  const SurfaceFans fans(mixed.mesh);
  std::vector<std::uint8_t> bad(mixed.mesh.vertices.size());
  for_each_index(threads, bad.size(), [&](std::size_t v) { bad[v] = is_one_fan(fans[v]) ? 0 : 1; });
  if (std::find(bad.begin(), bad.end(), 1) == bad.end()) return false;
  widen(mixed.mesh, 1, bad);
  for (std::size_t v = 0; v < after.into.size(); ++v)
    if (bad[mixed.into[v]] != 0) apart[after.into[v]] = 1;
  return true;
}

/// Of a manifold twice its Euler characteristic: 2 V - 2 E + 2 F, where sides are those of triangles and open edges.
std::int64_t twice_euler(const TriangleMesh& mesh, const Threads& threads) {
  const SurfaceFans fans(mesh);
  const std::vector<std::uint8_t> at_rim = fans.rim_vertices(threads);
  std::int64_t result = -static_cast<std::int64_t>(mesh.triangles.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!fans[v].empty()) result += 2;
    if (at_rim[v])
      for (const auto& wing : fans[v]) result -= fans.is_open(v, wing.next) ? 1 : 0; // each open edge once
  }
  return result;
}

} // namespace

std::optional<Collapsed> collapse_again(const Collapsed& before, const Collapsed& after, std::span<const float> limits,
                                        std::span<const std::uint8_t> apart, const CollapseGoal& goal,
                                        const Threads& threads) {
  constexpr int rounds = 4; // of a few hundred places one or two ask for a second
  std::vector<std::uint8_t> all(apart.begin(), apart.end());
  Mixed mixed = mix(before, after, limits, all);
  for (int round = 0; take_more_apart(mixed, after, threads, all); ++round) {
    if (round == rounds) return std::nullopt;
    mixed = mix(before, after, limits, all);
  }
  if (twice_euler(mixed.mesh, threads) != twice_euler(before.mesh, threads)) return std::nullopt;
  Collapsed again = collapse_edges(mixed.mesh, mixed.quadrics, mixed.limits, {}, goal);
  if (!again.is_manifold) return std::nullopt;
  for (std::uint32_t& v : mixed.into) v = again.into[v];
  again.into = std::move(mixed.into);
  return again;
}

} // namespace eigencrust
