// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/surface.h"

#include <eigencrust/error.h>

#include "report/snapshots.h"
#include "surface/components.h"
#include "surface/support.h"
#include "surface/trim.h"

namespace eigencrust {
namespace {

void require_surface(const Surface& surface) {
  if (surface.mesh.triangles.empty())
    throw Error(
        ErrorKind::no_surface, "surface", "every tetrahedron was labelled outside",
        "check that the points surround a volume, take a smaller --grid-spacing or off, or name an inside point");
}

void require_trimmed(const Surface& surface) {
  if (surface.mesh.triangles.empty())
    throw Error(ErrorKind::no_surface, "trim", "no triangle is borne out by the samples",
                "leave out --trim, or check the places of the sensors");
}

/// The lines of all samples, also of isolated ones.
std::vector<SightLine> rays_of(const PointCloud& cloud, const Scene& scene) {
  const Tetrahedralization& t = scene.tetrahedralization;
  return sight_lines(cloud, scene.sample_of_row, t, std::vector<float>(t.sample_count, 0), {});
}

} // namespace

Surface make_surface(const PointCloud& cloud, const Scene& scene, const Evidence& evidence,
                     const TetrahedronLabels& labels, const Context& context) {
  const auto& [options, run, threads] = context;
  const Tetrahedralization& t = scene.tetrahedralization;
  const Neighbourhoods& around = scene.measures.around;
  const std::vector<float>& grid = scene.measures.grid;
  Surface surface = run.stage("surface", [&] { return extract_surface(t, labels.labels(), threads); });
  run.product("surface", [&] { return snapshot_of_surface(t, surface); });
  run.stage("support", [&] { measure_support(t, labels, around, grid, surface, threads); });
  run.stage("components", [&] { return filter_components(surface, options.components, t, grid, threads); });
  require_surface(surface);
  const bool one_sided = options.facade.has_value() || evidence.one_sided.has_value();
  UnsupportedTriangles unsupported = run.stage("trim", [&] {
    auto marked = unsupported_triangles(t, around, rays_of(cloud, scene), one_sided, surface, threads);
    const double share = share_of_area(surface, marked);
    return UnsupportedTriangles{std::move(marked), share};
  });
  if (options.trim) {
    trim(std::move(unsupported.marked), surface);
    describe(filter_components(surface, options.components, t, grid, threads), run);
    require_trimmed(surface);
  }
  return surface;
}

} // namespace eigencrust
