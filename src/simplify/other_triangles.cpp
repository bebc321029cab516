// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/other_triangles.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <eigencrust/error.h>

#include "geometry/resolution.h"
#include "numerics/quantile.h"
#include "report/run.h"
#include "simplify/remesh.h"
#include "simplify/simplify.h"

namespace eigencrust {
namespace {

/// The length as one; 0, and a warning: the noise that it is given in is none.
double resolve(const SurfaceLength& length, const char* name, const Report& report, const SampleModel& model,
               Run& run) {
  double sigma = 0;
  if (length.kind == SurfaceLength::Kind::sigma && !model.input_noise.empty()) {
    std::vector<float> noise = model.input_noise.raw();
    sigma = std::max(0.0, static_cast<double>(median(noise)));
  }
  const double result = length.resolve(report.bounds.diagonal(), sigma);
  if (length.kind == SurfaceLength::Kind::sigma && !(result > 0))
    run.warn(std::string("no noise was measured, so that --") + name + " " + to_string(length) +
             " is no length: the triangles stay; give a length or N%");
  return result;
}

/// What a vertex and a triangle were made from.
struct Origin {
  std::vector<std::uint32_t> vertex, triangle;
};
Origin origin_of(const TriangleMesh& mesh, const TriangleMesh& full, const TriangleTree& tree, const Threads& threads) {
  Origin origin{std::vector<std::uint32_t>(mesh.vertices.size()), std::vector<std::uint32_t>(mesh.triangles.size())};
  for_each_index(
      threads, mesh.vertices.size(),
      [&](std::size_t v) {
        const Vec3& p = mesh.vertices[v];
        const auto& corners = full.triangles[tree.nearest(p).triangle];
        origin.vertex[v] = *std::min_element(corners.begin(), corners.end(), [&](std::uint32_t a, std::uint32_t b) {
          return std::pair(squared_norm(full.vertices[a] - p), a) < std::pair(squared_norm(full.vertices[b] - p), b);
        });
      },
      costly_block);
  for_each_index(
      threads, mesh.triangles.size(),
      [&](std::size_t t) {
        const auto& [a, b, c] = mesh.triangles[t];
        origin.triangle[t] =
            tree.nearest((1.0 / 3) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c])).triangle;
      },
      costly_block);
  return origin;
}

template <class T>
std::vector<T> taken(const std::vector<T>& values, const std::vector<std::uint32_t>& from) {
  std::vector<T> result;
  result.reserve(from.size());
  for (const std::uint32_t i : from) result.push_back(values[i]);
  return result;
}

void put_in_place(OtherTriangles made, const TriangleTree& tree, const Threads& threads, Surface& surface) {
  const Origin origin = origin_of(made.mesh, surface.mesh, tree, threads);
  surface.sample_of = taken(surface.sample_of, origin.vertex);
  surface.support = taken(surface.support, origin.triangle);
  surface.inside = taken(surface.inside, origin.triangle);
  if (!surface.unsupported.empty()) surface.unsupported = taken(surface.unsupported, origin.triangle);
  surface.mesh = std::move(made.mesh);
}

void warn_of_too_many(const SimplifiedReport& report, const Options& options, Run& run) {
  if (options.triangles == 0 || options.max_error.kind != SurfaceLength::Kind::off ||
      report.triangles <= options.triangles || report.triangles_before <= options.triangles)
    return;
  run.warn("there are " + std::to_string(report.triangles) + " triangles, for --triangles " +
           std::to_string(options.triangles) +
           " cannot be reached: each piece, handle and rim takes some, and none may cross another");
}

} // namespace

bool asks_for_other_triangles(const Options& options) {
  return options.triangles > 0 || options.max_error.kind != SurfaceLength::Kind::off ||
         options.edge.kind != SurfaceLength::Kind::off;
}

void make_other_triangles(Surface& surface, const SampleModel& model, const Context& context) {
  const auto& [options, run, threads] = context;
  const TriangleMesh& full = surface.mesh;
  SimplifiedReport report;
  report.vertices_before = full.vertices.size();
  report.triangles_before = full.triangles.size();
  const bool is_remeshed = options.edge.kind != SurfaceLength::Kind::off;
  if (options.max_error.kind != SurfaceLength::Kind::off) {
    report.max_error = resolve(options.max_error, "max-error", run.report(), model, run);
    if (!(report.max_error > 0)) return;
    if (!is_resolved(report.max_error, full.vertices, {}))
      throw Error(ErrorKind::input, "simplify", "the coordinates are so large that they round by more than --max-error",
                  "give more, or move the cloud nearer to zero with --shift");
  }
  if (is_remeshed) {
    report.edge = resolve(options.edge, "edge", run.report(), model, run);
    if (!(report.edge > 0)) return;
  }
  run.stage(is_remeshed ? "remesh" : "simplify", [&] {
    const FullSurface before(full, threads);
    const double most = report.max_error > 0 ? report.max_error : std::numeric_limits<double>::infinity();
    OtherTriangles made = is_remeshed
                              ? remesh(full, before, report.edge, model.typical_spacing, threads)
                              : simplify(full, before, {options.triangles, most}, model.typical_spacing, threads);
    report.vertices = made.mesh.vertices.size();
    report.triangles = made.mesh.triangles.size();
    report.deviation = made.deviation;
    report.held = made.held;
    report.crossing = made.crossing;
    if (is_remeshed) report.shape = shape_of(made.mesh, report.edge, threads);
    put_in_place(std::move(made), before.tree(), threads, surface);
  });
  warn_of_too_many(report, options, run);
  run.report().simplified = std::move(report);
}

} // namespace eigencrust
