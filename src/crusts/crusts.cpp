// SPDX-License-Identifier: GPL-3.0-or-later
#include "crusts/crusts.h"

#include <eigencrust/error.h>

#include <algorithm>
#include <limits>
#include <string>

#include "crusts/power_crust.h"
#include "crusts/robust_cocone.h"
#include "crusts/tight_cocone.h"
#include "poles/solve.h"
#include "settle/settle.h"
#include "surface/surface.h"
#include "tetrahedra/scene.h"

namespace eigencrust {
namespace {

/// As all these methods were described: every sample counts, all pieces stay, and nothing makes the surface a manifold.
Options options_of_crusts(Options options) {
  options.weights = Weights::paper;
  options.noise.kind = LengthChoice::Kind::off;
  options.manifold = false;
  if (options.components.kind == KeepComponents::Kind::supported) options.components.kind = KeepComponents::Kind::all;
  return options;
}

void reconstruct_tight_cocone(const PointCloud& cloud, const Context& context, Result& result) {
  Scene scene = make_scene(cloud, context);
  const Evidence evidence = gather_evidence(cloud, scene, context);
  Labels labels = context.run.stage("tight_cocone", [&] { return tight_cocone(scene, context.threads); });
  const IndexedArray<TetrahedronIndex, float> sure(labels.size(), 1.0f);
  Surface surface = make_surface(cloud, scene, evidence, {labels, sure}, {}, context);
  result.mesh = finish(std::move(surface), cloud, scene, context);
  check(result.mesh, cloud, scene, {}, context);
  result.tetrahedralization = std::move(scene.tetrahedralization);
  result.labels = std::move(labels);
}

/// The cloud with rows that are not on the outer boundary of the noise emptied, so that all others keep their numbers.
PointCloud outer_boundary(const PointCloud& cloud, const Context& context) {
  const Scene scene = make_scene(cloud, context);
  const auto kept = context.run.stage("outer_samples", [&] { return outer_samples(scene, context.threads); });
  // What is left is reconstructed as if it were all: a scrap of the cloud would pass for a whole.
  const auto count = static_cast<std::size_t>(std::count(kept.raw().begin(), kept.raw().end(), 1));
  if (static_cast<double>(count) < least_share_on_surface * static_cast<double>(kept.size()))
    throw Error(ErrorKind::no_surface, "outer_samples",
                "only " + std::to_string(count) + " of " + std::to_string(kept.size()) +
                    " samples lie on the outer boundary of what is there",
                "leave out points far from the object, or take --method eigencrust");
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  PointCloud boundary = cloud;
  for (std::size_t row = 0; row < boundary.points.size(); ++row)
    if (const SampleIndex s = scene.sample_of_row[row]; s.valid() && !kept[s]) boundary.points[row] = {nan, nan, nan};
  return boundary;
}

/// Of the first partition; where parts overlap inside, as all tetrahedra together tell.
Labels spectral_labels(const Scene& scene, const Evidence& evidence, const Context& context) {
  PoleLabels poles = label_poles(scene, evidence, context);
  for (const TetrahedronIndex i : settle(scene, evidence, poles, context).overlaps.tetrahedra)
    poles.labels[i] = Label::inside;
  return std::move(poles.labels);
}

/// Sides of the poles: known beforehand, with the spectral labels from the first partition, the rest by the queue.
IndexedArray<PoleIndex, Label> sides_of_poles(const Scene& scene, const Evidence& evidence, const PowerDiagram& diagram,
                                              const Context& context) {
  const Labels labels = context.options.method == Method::spectral_powercrust
                            ? spectral_labels(scene, evidence, context)
                            : evidence.labels;
  IndexedArray<PoleIndex, Label> known(scene.poles.tetrahedron.size());
  for (PoleIndex p{0}; p.value < known.size(); ++p.value) known[p] = labels[scene.poles.tetrahedron[p]];
  // What reaches to infinity is not inside: nothing would close it.
  for (std::size_t f = 0; f < diagram.facets.size(); ++f)
    if (diagram.polygon(f).empty())
      for (const std::uint32_t p : diagram.facets[f]) known[PoleIndex{p}] = Label::outside;
  return context.run.stage("queue", [&] { return queue_labels(scene, diagram, std::move(known)); });
}

void reconstruct_power_crust(const PointCloud& cloud, const Context& context, Result& result) {
  const auto& [options, run, threads] = context;
  Scene scene = make_scene(cloud, context);
  const Evidence evidence = gather_evidence(cloud, scene, context);
  const PowerDiagram diagram = run.stage("power_diagram", [&] { return power_diagram(scene.poles.sphere.raw()); });
  const auto side = sides_of_poles(scene, evidence, diagram, context);
  result.mesh = run.stage("power_crust", [&] { return power_crust(diagram, side); });
  if (result.mesh.triangles.empty())
    throw Error(ErrorKind::no_surface, "power_crust", "every pole was labelled outside",
                "check that the points surround a volume");
  if (options.smooth > 0)
    run.stage("smoothing", [&] { smooth(result.mesh, options.smoothing, options.smooth, threads); });
  for (Vec3& v : result.mesh.vertices) v = v + scene.tetrahedralization.origin;
  // The corners of its polygons are no samples: nothing is said of crossings, and many of them coincide.
  run.stage("validate", [&] {
    return validate(result.mesh, {.self_intersections = false, .merge_equal_vertices = false}, threads);
  });
  result.labels = Labels(scene.tetrahedralization.tetrahedra.size());
  for (PoleIndex p{0}; p.value < side.size(); ++p.value) result.labels[scene.poles.tetrahedron[p]] = side[p];
  result.tetrahedralization = std::move(scene.tetrahedralization);
}

} // namespace

void reconstruct_crust(const PointCloud& cloud, const Context& context, Result& result) {
  if (context.options.method == Method::eigencrust || context.options.method == Method::spectral_cocone) {
    const bool all = context.options.method == Method::eigencrust;
    return reconstruct_spectral(all ? cloud : outer_boundary(cloud, context), context, result);
  }
  const Options options = options_of_crusts(context.options);
  result.report.options = options; // what is promised follows from these
  const Context plain{options, context.run, context.threads};
  switch (options.method) {
    case Method::powercrust:
    case Method::spectral_powercrust:
      return reconstruct_power_crust(cloud, plain, result);
    case Method::tight_cocone:
      return reconstruct_tight_cocone(cloud, plain, result);
    case Method::robust_cocone:
      return reconstruct_tight_cocone(outer_boundary(cloud, plain), plain, result);
    case Method::spectral_cocone:
    case Method::eigencrust:
      return; // above
  }
}

} // namespace eigencrust
