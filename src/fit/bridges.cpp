// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/bridges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include <eigencrust/validate.h>
#include <Eigen/SparseCholesky>

#include "geometry/mesh_topology.h"
#include "numerics/quantile.h"

namespace eigencrust {
namespace {

// docs/decisions/0044. There are strays where of the isolated samples so many are passed by.
constexpr double strays_passed = 0.75;
// Vertices are strays whose third nearest neighbour is farther than so many of their spacings, and than so much of what
// strays that are passed by are from their 20th nearest sample: half of what they are from their third.
constexpr double stray_from = 3, stray_among_strays = 0.25;
// In radians: 25°. Edges of parts as coarse as that bend less, 14° to 24° on the mean, those of bridges 21° to 44°.
constexpr double least_bent = 25 * std::numbers::pi / 180;

/// Where there is nothing else there is no bridge.
std::vector<std::uint32_t> without_pieces_of_strays(std::vector<std::uint32_t> strays, const SurfaceFans& fans) {
  if (strays.empty()) return strays;
  const std::vector<std::uint32_t> piece = fans.pieces();
  std::vector<std::uint8_t> has_others(piece.size(), 0);
  auto stray = strays.begin();
  for (std::uint32_t v = 0; v < piece.size(); ++v)
    if (stray != strays.end() && *stray == v)
      ++stray;
    else
      has_others[piece[v]] = 1;
  std::erase_if(strays, [&](std::uint32_t v) { return has_others[piece[v]] == 0; });
  return strays;
}

/// How far strays are from other samples at least, as those show that the surface passes by; infinite where there are
/// hardly any.
double distance_of_strays(const Surface& surface, const SampleModel& model) {
  std::vector<std::uint8_t> on(model.isolated.size(), 0);
  for (const SampleIndex s : surface.sample_of) on[s.value] = 1;
  std::vector<double> passed;
  double isolated = 0;
  for (std::size_t s = 0; s < on.size(); ++s)
    if (const float to_20th = model.isolated.raw()[s]; to_20th > 0) {
      ++isolated;
      if (!on[s]) passed.push_back(static_cast<double>(to_20th));
    }
  if (passed.empty() || static_cast<double>(passed.size()) < strays_passed * isolated)
    return std::numeric_limits<double>::infinity();
  return stray_among_strays * median(passed);
}

/// Does the vertex stand off from all its neighbours but two? \param least see distance_of_strays()
bool stands_alone(const Surface& surface, std::span<const SurfaceFans::Wing> fan, const SampleModel& model,
                  double least, std::uint32_t v) {
  std::array<std::pair<double, std::uint32_t>, 3> nearest;
  nearest.fill({std::numeric_limits<double>::infinity(), v});
  for (const auto& wing : fan) {
    std::pair next{distance(surface.mesh.vertices[v], surface.mesh.vertices[wing.next]), wing.next};
    for (auto& near : nearest)
      if (next < near) std::swap(near, next);
  }
  // Of strays beside the surface the spacing is as wide as the gap between.
  double spacing = std::numeric_limits<double>::infinity();
  for (const auto& near : nearest) spacing = std::min(spacing, model.tolerance(surface.sample_of[near.second]));
  return nearest.back().first > std::max(least, stray_from * spacing);
}

/// By how much the edges around a vertex bend, in radians, and how many there are.
std::pair<double, double> bend_around(std::span<const SurfaceFans::Wing> fan, const std::vector<Vec3>& places,
                                      std::uint32_t v) {
  const auto normal = [&](const SurfaceFans::Wing& wing) {
    return cross(places[wing.next] - places[v], places[wing.last] - places[v]);
  };
  double bend = 0, edges = 0;
  for (const auto& wing : fan)
    for (const auto& before : fan) {
      if (before.last != wing.next) continue;
      const Vec3 a = normal(before), b = normal(wing);
      bend += std::atan2(norm(cross(a, b)), dot(a, b));
      ++edges;
    }
  return {bend, edges};
}

/// Those in patches whose edges bend more than those of a part of the surface that is as coarse.
/// \param vertices increasing
std::vector<std::uint32_t> in_rough_patches(const std::vector<std::uint32_t>& vertices, const SurfaceFans& fans,
                                            const std::vector<Vec3>& places) {
  DisjointSets patches(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i)
    for (const auto& wing : fans[vertices[i]]) {
      const auto at = std::lower_bound(vertices.begin(), vertices.end(), wing.next);
      if (at != vertices.end() && *at == wing.next) patches.unite(i, static_cast<std::uint32_t>(at - vertices.begin()));
    }
  std::vector<double> bend(vertices.size(), 0), edges(vertices.size(), 0);
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const auto [bend_here, edges_here] = bend_around(fans[vertices[i]], places, vertices[i]);
    bend[patches.find(i)] += bend_here;
    edges[patches.find(i)] += edges_here;
  }
  std::vector<std::uint32_t> rough;
  for (std::uint32_t i = 0; i < vertices.size(); ++i)
    if (const std::uint32_t patch = patches.find(i); bend[patch] > least_bent * edges[patch])
      rough.push_back(vertices[i]);
  return rough;
}

} // namespace

std::vector<std::uint32_t> strays_on_bridges(const Surface& surface, const SurfaceFans& fans, const SampleModel& model,
                                             const Threads& threads) {
  const auto count = static_cast<std::uint32_t>(surface.sample_of.size());
  std::vector<std::uint8_t> is_borne_out(count, 0);
  for (std::size_t i = 0; i < surface.mesh.triangles.size(); ++i)
    if (!surface.unsupported[i])
      for (const std::uint32_t v : surface.mesh.triangles[i]) is_borne_out[v] = 1;
  const double least = distance_of_strays(surface, model);
  std::vector<std::uint8_t> is_alone(count, 0);
  if (std::isfinite(least))
    for_each_index(threads, count, [&](std::size_t v) {
      is_alone[v] = stands_alone(surface, fans[v], model, least, static_cast<std::uint32_t>(v)) ? 1 : 0;
    });
  std::vector<std::uint32_t> invented, alone, strays;
  for (std::uint32_t v = 0; v < count; ++v) {
    const bool is_invented = model.isolated[surface.sample_of[v]] > 0 && !is_borne_out[v];
    if ((!is_invented && is_alone[v] == 0) || fans.at_rim(v)) continue;
    if (is_invented) invented.push_back(v);
    if (is_alone[v] != 0) alone.push_back(v);
  }
  alone = in_rough_patches(alone, fans, surface.mesh.vertices);
  std::set_union(invented.begin(), invented.end(), alone.begin(), alone.end(), std::back_inserter(strays));
  return without_pieces_of_strays(std::move(strays), fans);
}

void flatten_bridges(std::span<const std::uint32_t> strays, const SurfaceFans& fans, std::vector<Vec3>& vertices) {
  using Matrix = Eigen::SparseMatrix<double>;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d sums = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(strays.size()), 3);
  for (Eigen::Index row = 0; row < sums.rows(); ++row) {
    const auto wings = fans[strays[static_cast<std::size_t>(row)]];
    entries.emplace_back(row, row, static_cast<double>(wings.size()));
    for (const auto& [next, last] : wings) {
      const auto at = std::lower_bound(strays.begin(), strays.end(), next);
      if (at != strays.end() && *at == next)
        entries.emplace_back(row, at - strays.begin(), -1.0);
      else
        sums.row(row) += Eigen::RowVector3d(vertices[next].x, vertices[next].y, vertices[next].z);
    }
  }
  Matrix laplacian(sums.rows(), sums.rows());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixX3d places = Eigen::SimplicialLDLT<Matrix>(laplacian).solve(sums);
  for (Eigen::Index row = 0; row < places.rows(); ++row)
    vertices[strays[static_cast<std::size_t>(row)]] = {places(row, 0), places(row, 1), places(row, 2)};
}

} // namespace eigencrust
