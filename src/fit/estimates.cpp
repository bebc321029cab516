// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/estimates.h"

#include <cmath>
#include <optional>

#include "fit/local_quadric.h"
#include "samples/place_model.h"

namespace eigencrust {
namespace {

// In widths: how far a fit serves vertices in place of one of their own, and where its weight ends. Fits at all
// vertices are no better: on scans with noise of 0.25 and 0.5 spacings within 2 %.
constexpr double cover = 0.25, reach = 0.5;
// Cosines: samples and fits of one side, and vertices that share a fit.
constexpr double same_side = 0.5, same_fit = 0.8;
// Blocks of vertices along the curve choose their fits without looking at others.
constexpr std::size_t vertices_per_block = 4096;

/// Vertices at which to fit, increasing.
std::vector<std::uint32_t> fit_centres(const FitPlaces& places, const PointTree& vertices, double width,
                                       std::span<const std::uint8_t> wanted, const Threads& threads) {
  const std::size_t n = places.position.size();
  std::vector<std::uint8_t> covered(n, 0);
  std::vector<std::vector<std::uint32_t>> chosen((n + vertices_per_block - 1) / vertices_per_block);
  for_blocks(threads, n, vertices_per_block, [&](std::size_t begin, std::size_t end, std::size_t block) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      if (!wanted[v] || covered[v]) continue;
      chosen[block].push_back(v);
      for (const std::uint32_t o : vertices.within(places.position[v], cover * width * places.unit[v]))
        if (o > v && o < end && dot(places.normal[o], places.normal[v]) > same_fit) covered[o] = 1;
    }
  });
  std::vector<std::uint32_t> centres;
  for (const auto& part : chosen) centres.insert(centres.end(), part.begin(), part.end());
  return centres;
}

std::optional<LocalQuadric> fit_at(const FitPlaces& places, std::span<const std::uint32_t> vertex_of, std::size_t v,
                                   double width) {
  // Where the width ends samples are still as thick as in the middle.
  const double thickness = static_cast<double>(noise_bound) * places.noise[v];
  QuadricFit fit(places.position[v], places.normal[v], width);
  for (const std::uint32_t s : places.sample_tree.within(places.position[v], std::hypot(width, thickness)))
    if (dot(places.normal[vertex_of[s]], places.normal[v]) > same_side) fit.add(places.samples[s]);
  return fit.solve();
}

} // namespace

std::vector<std::uint32_t> nearest_vertices(const PointTree& vertices, std::span<const Vec3> samples,
                                            const Threads& threads) {
  std::vector<std::uint32_t> nearest(samples.size());
  for_each_index(
      threads, samples.size(),
      [&](std::size_t s) {
        double square = 0;
        vertices.nearest(samples[s], 1, &nearest[s], &square);
      },
      costly_block);
  return nearest;
}

std::vector<Estimate> estimates(const FitPlaces& places, const PointTree& vertices,
                                std::span<const std::uint32_t> vertex_of, double width,
                                std::span<const std::uint8_t> wanted, const Threads& threads) {
  const std::vector<std::uint32_t> centres = fit_centres(places, vertices, width, wanted, threads);
  std::vector<std::optional<LocalQuadric>> fits(centres.size());
  std::vector<Vec3> at;
  at.reserve(centres.size());
  for (const std::uint32_t v : centres) at.push_back(places.position[v]);
  for_each_index(
      threads, centres.size(),
      [&](std::size_t c) { fits[c] = fit_at(places, vertex_of, centres[c], width * places.unit[centres[c]]); },
      costly_block);
  std::vector<Estimate> result(places.position.size());
  if (centres.empty()) return result;
  const PointTree tree(at);
  const auto blend = [&](std::size_t v) {
    if (!wanted[v]) return;
    const Vec3 &position = places.position[v], &normal = places.normal[v];
    const double radius = reach * width * places.unit[v];
    Estimate sum;
    double total = 0, variance = 0;
    for (const std::uint32_t c : tree.within(position, radius)) {
      if (!fits[c] || !(dot(fits[c]->normal, normal) > same_side)) continue;
      const double nearness = 1 - squared_norm(at[c] - position) / (radius * radius);
      if (!(nearness > 0)) continue;
      const double w = nearness * nearness / fits[c]->variance;
      sum.offset += w * fits[c]->offset(position, normal);
      sum.noise += w * fits[c]->noise_variance;
      sum.normal = sum.normal + w * fits[c]->normal_at(position);
      variance += w * fits[c]->variance;
      total += w;
    }
    if (!(total > 0) || !(norm(sum.normal) > 0)) return;
    result[v] = {sum.offset / total, std::sqrt(variance / total), std::sqrt(sum.noise / total),
                 (1 / norm(sum.normal)) * sum.normal};
  };
  for_each_index(threads, result.size(), blend, costly_block);
  return result;
}

} // namespace eigencrust
