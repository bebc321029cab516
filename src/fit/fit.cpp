// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/fit.h"

#include <algorithm>
#include <cmath>

#include "fit/widths.h"
#include "geometry/mesh_topology.h"
#include "surface/fans.h"

namespace eigencrust {
namespace {

// Noise below that share of the spacing cannot be told from curvature: clean statues read as 0.09 in places.
constexpr float least_noise_in_spacings = 0.1f;
constexpr double least_share_of_piece = 0.1;
// Tips and edges read as free of noise, for they have no flat neighbourhood; they are about that many edges wide.
constexpr int edges_around = 10;

// Steps of smoothing before the first fit, and of the normals that it starts from.
constexpr std::uint32_t smoothing_steps = 5;
constexpr int normal_steps = 10;
// The sides of the samples and the normals are taken from the fit before; the third still takes 3 % off the error.
constexpr int fits = 3;
// Widths are in units of the noise, or of so many spacings where that is more: fewer samples make no fit.
constexpr double least_unit_in_spacings = 0.7;
// Nothing moves farther than the bound of the noise and so many spacings.
constexpr double farthest_in_spacings = 12;

std::vector<std::uint32_t> pieces_of(const Surface& surface) {
  DisjointSets sets(surface.mesh.vertices.size());
  for (const auto& [a, b, c] : surface.mesh.triangles) {
    sets.unite(a, b);
    sets.unite(b, c);
  }
  std::vector<std::uint32_t> piece(surface.mesh.vertices.size());
  for (std::uint32_t v = 0; v < piece.size(); ++v) piece[v] = sets.find(v);
  return piece;
}

void make_unit(std::vector<Vec3>& normals) {
  for (Vec3& n : normals)
    if (const double length = norm(n); length > 0) n = (1 / length) * n;
}

/// Averaged over the vertices around.
std::vector<Vec3> averaged_normals(const TriangleMesh& mesh, const SurfaceFans& fans, const Threads& threads) {
  std::vector<Vec3> normal(mesh.vertices.size()), next(normal.size());
  for_each_index(threads, normal.size(), [&](std::size_t v) {
    const Vec3& at = mesh.vertices[v];
    for (const auto& wing : fans[v])
      normal[v] = normal[v] + cross(mesh.vertices[wing.next] - at, mesh.vertices[wing.last] - at);
  });
  make_unit(normal);
  for (int step = 0; step < normal_steps; ++step) {
    for_each_index(threads, normal.size(), [&](std::size_t v) {
      next[v] = normal[v];
      for (const auto& wing : fans[v]) next[v] = next[v] + normal[wing.next];
    });
    normal.swap(next);
    make_unit(normal);
  }
  return normal;
}

Vec3 limited(const Vec3& from, const Vec3& to, double farthest) {
  const double length = distance(from, to);
  return length > farthest ? from + (farthest / length) * (to - from) : to;
}

} // namespace

std::vector<float> noise_at_vertices(const Surface& surface, const SampleModel& model, const Threads& threads) {
  const std::size_t n = surface.mesh.vertices.size();
  std::vector<float> noise(n, 0);
  for_each_index(threads, n, [&](std::size_t v) {
    const std::uint32_t s = surface.sample_of[v].value;
    if (model.noise[s] > least_noise_in_spacings * model.spacing[s]) noise[v] = model.noise[s];
  });
  const std::vector<std::uint32_t> piece = pieces_of(surface);
  std::vector<std::uint32_t> all(n, 0), with_noise(n, 0);
  for (std::size_t v = 0; v < n; ++v) {
    ++all[piece[v]];
    with_noise[piece[v]] += noise[v] > 0;
  }
  for (std::size_t v = 0; v < n; ++v)
    if (static_cast<double>(with_noise[piece[v]]) < least_share_of_piece * static_cast<double>(all[piece[v]]))
      noise[v] = 0;
  const SurfaceFans fans(surface.mesh);
  std::vector<float> next(n);
  for (int edge = 0; edge < edges_around; ++edge) {
    for_each_index(threads, n, [&](std::size_t v) {
      next[v] = noise[v];
      if (noise[v] > 0) return;
      for (const auto& wing : fans[v]) next[v] = std::max(next[v], noise[wing.next]);
    });
    noise.swap(next);
  }
  return noise;
}

std::vector<Vec3> fitted_vertices(const Surface& surface, std::span<const Vec3> samples, const SampleModel& model,
                                  std::span<const float> noise, const Threads& threads) {
  const std::size_t n = surface.mesh.vertices.size();
  TriangleMesh smoothed{surface.mesh.vertices, surface.mesh.triangles, {}, {}};
  smooth(smoothed, Smoothing::laplacian, smoothing_steps, threads);
  const SurfaceFans fans(smoothed);
  const PointTree tree(samples);
  FitPlaces places{samples,
                   tree,
                   surface.mesh.vertices,
                   averaged_normals(smoothed, fans, threads),
                   std::vector<double>(n),
                   std::vector<double>(n)};
  std::vector<double> farthest(n);
  std::vector<std::uint8_t> moving(n);
  for (std::size_t v = 0; v < n; ++v) {
    const std::uint32_t s = surface.sample_of[v].value;
    const auto spacing = static_cast<double>(model.spacing[s]);
    moving[v] = noise[v] >= 0;
    places.noise[v] = std::max(0.0, static_cast<double>(noise[v]));
    places.unit[v] = std::max(places.noise[v], least_unit_in_spacings * spacing);
    farthest[v] = static_cast<double>(noise_bound) * places.noise[v] + farthest_in_spacings * spacing;
    if (moving[v]) places.position[v] = smoothed.vertices[v];
  }
  // Vertices that stay say which side the samples are on, but need no fit.
  std::vector<Vec3> result = surface.mesh.vertices;
  for (int fit = 0; fit < fits; ++fit) {
    const std::vector<Foot> feet = fit_with_chosen_widths(places, moving, fans, threads);
    for_each_index(threads, n, [&](std::size_t v) {
      if (!moving[v]) return;
      if (squared_norm(feet[v].normal) > 0) {
        places.position[v] = places.position[v] + feet[v].offset * places.normal[v];
        places.normal[v] = feet[v].normal;
      }
      if (fit + 1 == fits) result[v] = limited(surface.mesh.vertices[v], places.position[v], farthest[v]);
    });
  }
  return result;
}

} // namespace eigencrust
