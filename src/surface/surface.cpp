// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/surface.h"

#include <eigencrust/error.h>
#include <eigencrust/metrics.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "report/snapshots.h"
#include "surface/components.h"
#include "surface/rim_strays.h"
#include "surface/support.h"
#include "surface/trim.h"

namespace eigencrust {
namespace {

/// \param found pieces before some of them were left out
void require_surface(const Surface& surface, bool found) {
  if (surface.mesh.triangles.empty())
    throw Error(
        ErrorKind::no_surface, "surface",
        found ? "nothing but the wall of a cavity was found" : "every tetrahedron was labelled outside",
        "check that the points surround a volume, give less --noise or off, or name an inside point; of one side, "
        "name which was seen, as --facade +z");
}

/// \throws Error{no_surface} for a scrap, see least_share_on_surface
void require_samples_near(const Surface& surface, const Scene& scene, const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const auto needed = static_cast<std::uint64_t>(std::ceil(least_share_on_surface * t.sample_count));
  if (surface.sample_of.size() >= needed) return;
  const TriangleTree tree(surface.mesh);
  const SampleModel& model = scene.measures.model;
  const auto near = sum_blocks<std::uint64_t>(
      threads, t.sample_count,
      [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t s = begin; s < end; ++s)
          count += tree.nearest(t.positions.raw()[s]).distance <=
                   model.tolerance(SampleIndex{static_cast<std::uint32_t>(s)});
        return count;
      },
      costly_block);
  if (near < needed)
    throw Error(ErrorKind::no_surface, "surface",
                "only " + std::to_string(near) + " of " + std::to_string(t.sample_count) +
                    " samples lie on the surface that was found, or near it",
                "check that the points surround a volume with walls at least a spacing thick; --components all keeps "
                "every piece, --noise off trusts every sample");
}

SamplesApart samples_apart(const Surface& surface, const Scene& scene, const Overlaps& overlaps,
                           const Threads& threads) {
  const Tetrahedralization& t = scene.tetrahedralization;
  const SampleModel& model = scene.measures.model;
  IndexedArray<VertexIndex, std::uint8_t> on_surface(t.positions.size(), 0);
  for (const SampleIndex s : surface.sample_of) on_surface[s] = 1;
  IndexedArray<VertexIndex, std::uint8_t> in_overlap(t.positions.size(), 0);
  for (const TetrahedronIndex i : overlaps.tetrahedra)
    for (const VertexIndex v : t.tetrahedra[i]) in_overlap[v] = 1;
  const auto is_apart = [&](SampleIndex s) {
    if (on_surface[s] || in_overlap[s] || model.isolated[s] > 0 || model.is_noisy(s)) return false;
    const auto star = scene.stars[s];
    return std::none_of(star.begin(), star.end(), [&](TetrahedronIndex i) {
      return std::any_of(t.tetrahedra[i].begin(), t.tetrahedra[i].end(), [&](VertexIndex n) {
        return on_surface[n] && distance(t.positions[n], t.positions[s]) <= model.tolerance(s);
      });
    });
  };
  IndexedArray<SampleIndex, std::uint8_t> apart(t.sample_count, 0);
  for_each_index(threads, apart.size(), [&](std::size_t i) {
    const SampleIndex s{static_cast<std::uint32_t>(i)};
    apart[s] = is_apart(s);
  });
  // Of a part that was left out most samples around are left out too; around outliers most are on the surface.
  const auto is_in_company = [&](SampleIndex s) {
    std::size_t near = 0, apart_too = 0;
    for (const TetrahedronIndex i : scene.stars[s])
      for (const VertexIndex n : t.tetrahedra[i]) {
        if (t.is_corner(n) || t.sample(n) == s) continue;
        if (distance(t.positions[n], t.positions[s]) > 2 * model.tolerance(s)) continue;
        ++near;
        apart_too += apart[t.sample(n)];
      }
    return 2 * apart_too > near;
  };
  const auto count = [&](const auto& is_one) {
    return sum_blocks<std::uint64_t>(threads, t.sample_count, [&](std::size_t begin, std::size_t end) {
      std::uint64_t found = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const SampleIndex s{static_cast<std::uint32_t>(i)};
        found += apart[s] && is_one(s);
      }
      return found;
    });
  };
  return {count([](SampleIndex) { return true; }), count(is_in_company), t.sample_count};
}

void require_trimmed(const Surface& surface) {
  if (surface.mesh.triangles.empty())
    throw Error(ErrorKind::no_surface, "trim", "no triangle is borne out by the samples",
                "leave out --trim, or check the places of the sensors");
}

/// The lines of all samples, also of isolated ones.
std::vector<SightLine> rays_of(const PointCloud& cloud, const Scene& scene) {
  const Tetrahedralization& t = scene.tetrahedralization;
  return sight_lines(cloud, scene.sample_of_row, t, SampleLengths(t.sample_count, 0), {});
}

} // namespace

Surface make_surface(const PointCloud& cloud, const Scene& scene, const Evidence& evidence,
                     const TetrahedronLabels& labels, const Overlaps& overlaps, const Context& context) {
  const auto& [options, run, threads] = context;
  const Tetrahedralization& t = scene.tetrahedralization;
  const SampleModel& model = scene.measures.model;
  const SampleLengths& grid = scene.measures.grid;
  Surface surface = run.stage("surface", [&] { return extract_surface(t, labels.labels(), threads); });
  run.stage("support", [&] { measure_support(t, labels, model, grid, surface, threads); });
  const bool found = !surface.mesh.triangles.empty();
  const Surface all = run.wants_products() ? surface : Surface();
  run.stage("components",
            [&] { return filter_components(surface, options.components, t, model, labels.labels(), threads); });
  require_surface(surface, found);
  // Who asks for all pieces may want a scrap; crusts keep all without being asked.
  if (options.components.kind == KeepComponents::Kind::supported || options.method != Method::eigencrust)
    require_samples_near(surface, scene, threads);
  describe(samples_apart(surface, scene, overlaps, threads), run);
  const bool is_open = evidence.surroundings.kind == SceneKind::facade;
  const bool one_sided = is_open || evidence.one_sided.has_value();
  UnsupportedTriangles unsupported = run.stage("trim", [&] {
    const std::vector<SightLine> rays = rays_of(cloud, scene);
    const RangeGrid pixels(cloud, scene.sample_of_row, t, rays);
    surface.unsupported = unsupported_triangles(t, model, rays, one_sided, pixels, surface, threads);
    if (is_open && !options.trim && !options.base) {
      // The hull that a façade ends at hangs between its outermost samples like a curtain, and strays stand beyond the
      // rim; behind some there are others.
      for (std::size_t before = 0; before != surface.mesh.triangles.size();) {
        before = surface.mesh.triangles.size();
        std::vector<std::uint8_t> gone = triangles_at_strays(model, surface);
        std::transform(gone.begin(), gone.end(), surface.unsupported.begin(), gone.begin(), std::bit_or());
        trim(marked_at_rim(surface.mesh, gone), surface);
      }
      close_smallest_rims(t, scene.stars, surface);
    }
    return UnsupportedTriangles{surface.unsupported, share_of_area(surface, surface.unsupported),
                                bridged_places(surface, surface.unsupported, model, t.origin, threads)};
  });
  if (options.trim) trim(std::move(unsupported.marked), surface);
  if (options.trim || (is_open && !options.base)) {
    describe(filter_components(surface, options.components, t, model, labels.labels(), threads), run);
    require_trimmed(surface);
  }
  run.product("surface", [&] { return snapshot_of_surface(t, all, surface); });
  return surface;
}

} // namespace eigencrust
