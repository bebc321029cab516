// SPDX-License-Identifier: GPL-3.0-or-later
// Which pieces of the surface are kept (not in the paper, which keeps all).
#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include <eigencrust/stages.h>
#include <eigencrust/validate.h>

#include "geometry/nearest.h"
#include "parallel/threads.h"
#include "samples/local_frame.h"
#include "surface/components.h"
#include "surface/drop_triangles.h"

namespace eigencrust {
namespace {

// docs/decisions/0004: specks, pieces lost in the noise, pieces that the samples do not bear out, and pieces of a
// filled volume.
constexpr double speck_vertices = 20, speck_share = 5e-4;
constexpr double extent_in_sigmas = 5;
constexpr double least_support = 0.4;
// Samples looked at around each vertex: one in seven such sets is flat where samples fill space.
constexpr std::size_t neighbourhood = 10;
// A piece of a volume that samples fill passes by a quarter of them and more; one of a surface, hardly any.
constexpr double most_passed = 0.1;
// Of all samples: a larger part is no clump of outliers, and thick perhaps because its noise could not be measured.
constexpr double most_in_clump = 0.01;

struct Piece {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> vertices;
  double support = 0; ///< mean over the area
  double extent = 0;  ///< diagonal of its box in mean deviations of the noise; infinite where there is no noise
  Vec3 centre;
};

double area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& v) {
  return norm(cross(mesh.vertices[v[1]] - mesh.vertices[v[0]], mesh.vertices[v[2]] - mesh.vertices[v[0]])) / 2;
}

/// \param met vertices that this function has met; marks those of the piece
void measure(const Surface& surface, std::span<const float> noise, std::uint32_t number, Piece& piece,
             std::vector<std::uint32_t>& met) {
  double supported = 0, whole = 0;
  for (const std::uint32_t i : piece.triangles) {
    const auto& v = surface.mesh.triangles[i];
    for (const std::uint32_t corner : v)
      if (std::exchange(met[corner], number) != number) piece.vertices.push_back(corner);
    const double a = area(surface.mesh, v);
    supported += a * static_cast<double>(surface.support[i]);
    whole += a;
  }
  piece.support = whole > 0 ? supported / whole : 0;
  const auto count = static_cast<double>(piece.vertices.size());
  Box3 box;
  double sigma = 0;
  for (const std::uint32_t v : piece.vertices) {
    box.add(surface.mesh.vertices[v]);
    piece.centre = piece.centre + (1 / count) * surface.mesh.vertices[v];
    if (!noise.empty()) sigma += static_cast<double>(noise[surface.sample_of[v].value]) / count;
  }
  piece.extent = box.diagonal() / sigma; // no noise: infinite
}

std::vector<Piece> measure_pieces(const Surface& surface, std::span<const float> noise, const Threads& threads) {
  const std::vector<std::uint32_t> component = triangle_components(surface.mesh, threads.size());
  std::vector<Piece> pieces;
  for (std::uint32_t i = 0; i < component.size(); ++i) {
    if (component[i] >= pieces.size()) pieces.resize(component[i] + 1);
    pieces[component[i]].triangles.push_back(i);
  }
  std::vector<std::uint32_t> met(surface.mesh.vertices.size(), SampleIndex::none);
  for (std::uint32_t c = 0; c < pieces.size(); ++c) measure(surface, noise, c, pieces[c], met);
  return pieces;
}

/// Tells pieces of surface from pieces of a volume that samples fill, as clumps of outliers do.
class FilledVolumes {
 public:
  FilledVolumes(const Surface& surface, const Tetrahedralization& t, std::span<const float> noise)
      : surface_(surface),
        positions_(t.positions.raw().data(), t.sample_count),
        noise_(noise),
        tree_(positions_),
        met_(t.sample_count, 0),
        on_surface_(t.sample_count, 0) {
    for (const SampleIndex s : surface.sample_of) on_surface_[s.value] = 1;
  }

  /// Is it no large part, are most neighbourhoods thicker than surface and noise explain, and are samples among them
  /// passed by?
  bool hold(const Piece& piece) {
    const auto vertices = static_cast<double>(piece.vertices.size());
    if (vertices > most_in_clump * static_cast<double>(positions_.size())) return false;
    std::size_t thick = 0, passed = 0;
    for (const std::uint32_t v : piece.vertices) {
      const std::uint32_t s = surface_.sample_of[v].value;
      std::array<std::uint32_t, neighbourhood> index{};
      std::array<double, neighbourhood> square{};
      const auto around =
          std::span(index).first(tree_.nearest(positions_[s], neighbourhood, index.data(), square.data()));
      const LocalFrame frame = local_frame(positions_, around, positions_[s]);
      const double sigma = noise_.empty() ? 0 : static_cast<double>(noise_[s]);
      thick += !frame.is_flat() && frame.variance[0] > sigma * sigma;
      for (const std::uint32_t n : around) passed += !std::exchange(met_[n], 1) && !on_surface_[n];
    }
    return 2 * static_cast<double>(thick) > vertices && static_cast<double>(passed) > most_passed * vertices;
  }

 private:
  const Surface& surface_;
  std::span<const Vec3> positions_;
  std::span<const float> noise_;
  PointTree tree_;
  std::vector<std::uint8_t> met_, on_surface_;
};

/// The largest piece always stays: a cloud of ten points still has a surface.
/// \param order pieces, the largest first
std::vector<std::uint8_t> supported(const std::vector<Piece>& pieces, std::span<const std::uint32_t> order,
                                    const std::function<FilledVolumes()>& volumes) {
  std::vector<std::uint8_t> kept(pieces.size(), 1);
  std::optional<FilledVolumes> filled;
  for (const std::uint32_t i : order.subspan(std::min<std::size_t>(1, order.size()))) {
    const Piece& piece = pieces[i];
    const double least = speck_vertices + speck_share * static_cast<double>(pieces[order[0]].vertices.size());
    kept[i] = static_cast<double>(piece.vertices.size()) >= least && piece.extent >= extent_in_sigmas &&
              piece.support >= least_support;
    if (!kept[i]) continue;
    if (!filled) filled.emplace(volumes());
    kept[i] = !filled->hold(piece);
  }
  return kept;
}

std::vector<std::uint8_t> choose(const std::vector<Piece>& pieces, const KeepComponents& keep,
                                 const std::function<FilledVolumes()>& volumes) {
  using Kind = KeepComponents::Kind;
  std::vector<std::uint8_t> kept(pieces.size(), 1);
  if (keep.kind == Kind::all) return kept;
  std::vector<std::uint32_t> order(pieces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return pieces[a].vertices.size() > pieces[b].vertices.size();
  });
  if (keep.kind == Kind::supported) return supported(pieces, order, volumes);
  for (std::size_t i = keep.kind == Kind::largest ? 1 : keep.count; i < order.size(); ++i) kept[order[i]] = 0;
  return kept;
}

} // namespace

void drop_triangles(std::span<const std::uint8_t> gone, Surface& surface) {
  Surface rest;
  std::vector<std::uint32_t> vertex_of(surface.mesh.vertices.size(), SampleIndex::none);
  for (std::size_t i = 0; i < gone.size(); ++i)
    if (!gone[i])
      for (const std::uint32_t v : surface.mesh.triangles[i]) vertex_of[v] = 0;
  for (std::uint32_t v = 0; v < vertex_of.size(); ++v) {
    if (vertex_of[v] == SampleIndex::none) continue;
    vertex_of[v] = static_cast<std::uint32_t>(rest.sample_of.size());
    rest.sample_of.push_back(surface.sample_of[v]);
    rest.mesh.vertices.push_back(surface.mesh.vertices[v]);
  }
  for (std::size_t i = 0; i < gone.size(); ++i)
    if (!gone[i]) {
      const auto& [a, b, c] = surface.mesh.triangles[i];
      rest.mesh.triangles.push_back({vertex_of[a], vertex_of[b], vertex_of[c]});
      rest.inside.push_back(surface.inside[i]);
      rest.support.push_back(surface.support[i]);
    }
  surface = std::move(rest);
}

std::vector<DroppedComponent> filter_components(Surface& surface, const KeepComponents& keep,
                                                const Tetrahedralization& t, std::span<const float> noise,
                                                const Threads& threads) {
  const std::vector<Piece> pieces = measure_pieces(surface, noise, threads);
  const std::vector<std::uint8_t> kept = choose(pieces, keep, [&] { return FilledVolumes(surface, t, noise); });
  std::vector<DroppedComponent> dropped;
  std::vector<std::uint8_t> gone(surface.mesh.triangles.size(), 0);
  for (std::size_t c = 0; c < pieces.size(); ++c) {
    if (kept[c]) continue;
    dropped.push_back({static_cast<std::uint32_t>(pieces[c].vertices.size()),
                       static_cast<std::uint32_t>(pieces[c].triangles.size()), pieces[c].support,
                       pieces[c].centre + t.origin});
    for (const std::uint32_t i : pieces[c].triangles) gone[i] = 1;
  }
  if (dropped.empty()) return dropped;
  drop_triangles(gone, surface);
  std::stable_sort(dropped.begin(), dropped.end(),
                   [](const auto& a, const auto& b) { return a.vertices > b.vertices; });
  return dropped;
}

} // namespace eigencrust
