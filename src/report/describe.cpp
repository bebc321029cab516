// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/describe.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "evidence/evidence.h"
#include "fit/edge_flips.h"
#include "fit/uncross.h"
#include "numerics/quantile.h"
#include "points/point_results.h"
#include "repair/generators.h"
#include "repair/passed_sheets.h"
#include "report/run.h"
#include "samples/measures.h"
#include "settle/minimum_energy.h"
#include "settle/overlaps.h"
#include "surface/surface.h"
#include "surface/trim.h"
#include "surface/turned_over.h"

namespace eigencrust {
namespace {

void describe_noise(const SampleLengths& grid, Run& run) {
  if (grid.empty()) return;
  std::vector<float> grid_spacing = grid.raw();
  for (const auto& [name, share] :
       {std::pair{"grid_spacing_q10", 0.1}, std::pair{"grid_spacing_median", 0.5}, std::pair{"grid_spacing_q90", 0.9}})
    run.count("sample_model", name, static_cast<double>(quantile(grid_spacing, share)));
}

/// With as many digits as it takes to find it.
std::string place_in(const Box3& bounds, const Vec3& p) {
  constexpr double parts = 1000;
  const double part = bounds.diagonal() / parts;
  const int digits = part > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(part))), 0, 12) : 0;
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << p.x << "," << p.y << "," << p.z;
  return text.str();
}

/// Where half of the samples are farther off the surface than from one another; in merged range scans they are half as
/// far.
void warn_of_noise(const SampleModel& model, Run& run) {
  std::vector<float> noise = model.input_noise.raw(), in_spacings = noise;
  for (std::size_t s = 0; s < in_spacings.size(); ++s)
    if (in_spacings[s] > 0) in_spacings[s] /= model.spacing.raw()[s];
  if (in_spacings.empty() || !(median(in_spacings) > 1)) return;
  char text[32];
  const auto length = [&](double value) { return std::snprintf(text, sizeof text, "%.3g", value), std::string(text); };
  const double deviation = static_cast<double>(median(noise));
  run.warn("the noise is larger than the samples are apart (standard deviation " + length(deviation) +
           "): edges become round, and parts thinner than about " +
           length(2 * static_cast<double>(noise_bound) * deviation) +
           " may be missing or grown together; if that is too much, --noise takes its standard deviation");
}

/// What the options promise and the mesh is not.
std::vector<std::string> broken_guarantees(const MeshSummary& mesh, const Report& report) {
  const Options& options = report.options;
  std::vector<std::string> broken;
  if (!mesh.closed() && (report.surroundings.kind != SceneKind::facade || options.base) && !options.trim)
    broken.emplace_back("closed");
  if (options.manifold && !mesh.manifold()) broken.emplace_back("manifold");
  if (options.manifold && !mesh.oriented()) broken.emplace_back("consistently oriented");
  if (mesh.self_intersections > 0 && !options.base) broken.emplace_back("free of crossings");
  const bool rooms = report.surroundings.kind == SceneKind::interior;
  if (mesh.closed() && mesh.oriented() && (rooms ? mesh.volume > 0 : mesh.volume < 0))
    broken.emplace_back(rooms ? "oriented to the scanners" : "outward oriented");
  return broken;
}

/// What to try where the samples lie like ground or a façade, and nothing tells which; or where this is hardly a body,
/// and no sensor tells what it is.
std::string words_on_what_it_is(const Report& report, bool is_hardly_a_body) {
  const std::optional<Axis>& axis = report.surroundings.likely_facade;
  if (!axis)
    return is_hardly_a_body && report.sight_lines == 0 && report.surroundings.kind == SceneKind::body
               ? "; if this is ground with what stands on it, --facade +z leaves it open below; if the scanner stood "
                 "amid the points, --sensor with its place, as --sensor 0,0,0, finds the free space around it"
               : "";
  const std::string name = to_string(*axis);
  if (*axis == Axis::plus_z)
    return "; if this is ground with what stands on it, or a roof, --facade +z leaves it open below and --base closes "
           "it with a flat base";
  return "; if this is a facade, --facade " + name + " or --facade -" + name.substr(1) +
         " (the side that it was seen from) leaves it open behind";
}

/// Sheets that were taken in again leave no trace, as those of the sharp rim of a lens, or a hole, which is a handle.
void warn_of_torn_walls(Run& run) {
  const PassedSheetsReport& sheets = run.report().passed_sheets;
  if (sheets.sheets == 0 || !(run.report().mesh.genus > 0)) return;
  run.warn("the surface at first went past " + std::to_string(sheets.samples) +
           " samples that lie side by side, as those of a wall do whose other side was not scanned there, most of "
           "them around " +
           place_in(run.report().bounds, sheets.at) +
           ", and has holes: one may be there; look at it before you use it");
}

} // namespace

void describe(const Samples& samples, Run& run) {
  Report& report = run.report();
  report.points = samples.positions.size() + samples.duplicates + samples.nonfinite;
  report.duplicates = samples.duplicates;
  report.nonfinite = samples.nonfinite;
  report.bounds = samples.bounds;
}

void describe(const SampleMeasures& measures, Run& run) {
  run.report().spacing = measures.model.typical_spacing;
  run.report().grid_spacing = measures.scan_grid_spacing;
  describe_noise(measures.grid, run);
  warn_of_noise(measures.model, run);
  if (measures.model.eased > 0) run.count("sample_model", "eased", static_cast<double>(measures.model.eased));
  constexpr double least_in_sheets = 0.05; // three plates a few spacings apart have 0.15, scans 0.5 and more
  if (measures.model.sheet_share < least_in_sheets)
    run.warn(
        "the points fill a volume, hardly anywhere do they lie in a sheet: this is no surface, or its noise is as "
        "large as its parts; do not trust the result. Give the points of the surface only, or --noise with the "
        "standard deviation of the noise");
}

void describe(const Tetrahedralization& t, Run& run) {
  run.count("tetrahedra", t.tetrahedra.size());
  constexpr double usual = 7, many = 3 * usual; // per sample; points that fill a volume have 6.8
  const double share = static_cast<double>(t.tetrahedra.size()) / static_cast<double>(t.sample_count);
  if (share > many)
    run.warn(
        "there are " + std::to_string(std::lround(share)) + " tetrahedra per sample instead of " +
        std::to_string(std::lround(usual)) +
        ": the run takes as many times the memory and time of the forecast; if that is too much, --thin leaves out "
        "points");
}

void describe(const Poles& poles, Run& run) { run.count("poles", poles.tetrahedron.size()); }

void describe(const KnownBeforehand& known, Run& run) { run.report().surroundings = known.surroundings; }

void describe(const LinesOfSight& sight, Run& run) {
  run.report().one_sided = sight.one_sided;
  run.report().sight_lines = sight.crossings.begin.size() - 1;
  run.count("lines", static_cast<double>(run.report().sight_lines));
  run.count("disbelieved", static_cast<double>(sight.labels.disbelieved));
  run.count("outside", static_cast<double>(sight.labels.outside));
  run.count("inside", static_cast<double>(sight.labels.inside));
}

void describe(const Partition& partition, Run& run) {
  PartitionReport entry;
  entry.stage = run.name().substr(std::string("partition_").size());
  entry.nodes = partition.value.size();
  entry.edges = partition.edges;
  entry.eigenvalue = partition.eigenvalue;
  entry.residual = partition.residual;
  entry.iterations = partition.iterations;
  entry.sign_changes = partition.sign_changes;
  entry.components = partition.components;
  entry.free_components = partition.free_components;
  entry.status = partition.status;
  run.report().partitions.push_back(entry);
  run.report().undecided_nodes += partition.undecided;
  if (partition.status == SolverStatus::not_converged)
    run.warn("the solver of the " + entry.stage + " stopped before the signs settled (residual " +
             std::to_string(partition.residual) + "); --max-steps gives it more time");
  if (entry.stage == "tetrahedra" && supernodes_agree(partition))
    run.warn("the second eigenvector puts inside and outside on the same side; use --second-stage cut");
}

void describe(const PoleLabels& labels, Run& run) {
  run.count("vote", labels.vote);
  run.count("supernode_overruled", labels.reversed ? 1 : 0);
  run.count("contradicted", static_cast<double>(labels.contradicted));
  run.count("left_to_stage_two", static_cast<double>(labels.left_to_stage_two));
}

void describe(const MinimumLabels& labels, Run& run) {
  run.count("undecided", static_cast<double>(labels.undecided));
  run.count("energy", labels.energy);
}

void describe(const Overlaps& overlaps, Run& run) {
  run.count("chambers", overlaps.chambers);
  if (overlaps.chambers == 0) return;
  const bool is_one = overlaps.chambers == 1;
  run.warn(std::to_string(overlaps.chambers) + (is_one ? " chamber" : " chambers") + " where parts overlap " +
           (is_one ? "was" : "were") +
           " taken to be solid; where one is hollow name a point in it with --outside-point");
}

void describe(const ManifoldCounts& counts, Run& run) {
  run.count("edges_repaired", static_cast<double>(counts.edges));
  run.count("vertices_repaired", static_cast<double>(counts.vertices));
  run.count("tetrahedra_relabelled", static_cast<double>(counts.relabelled));
  if (counts.overruled > 0)
    run.warn(
        std::to_string(counts.overruled) +
        " tetrahedra named inside or outside were overruled by the manifold repair; check the points named, or leave "
        "the labels as they are with --no-manifold");
}

void describe(const PassedSheetsReport& sheets, Run& run) {
  run.report().passed_sheets = sheets;
  run.count("sheets", static_cast<double>(sheets.sheets));
  run.count("samples", static_cast<double>(sheets.samples));
}

void describe(const PieceCounts& counts, Run& run) { run.count("dropped", static_cast<double>(counts.dropped)); }

void describe(const HandleCounts& counts, Run& run) { run.count("closed", static_cast<double>(counts.closed)); }

void describe(const RecoveryCounts& counts, Run& run) { run.count("samples", static_cast<double>(counts.samples)); }

void describe(const Contradictions& contradictions, Run& run) {
  if (contradictions.all == 0) return;
  run.report().contradicting_rays = contradictions.lines;
  const double share = static_cast<double>(contradictions.lines) / static_cast<double>(contradictions.all);
  constexpr double usual = 0.05;
  if (share > usual)
    run.warn(std::to_string(std::lround(100 * share)) +
             " % of the lines of sight cross what was found to be inside; check the sensors' places, or ignore them "
             "with --sensors none");
}

void describe(const std::vector<DroppedComponent>& dropped, Run& run) {
  auto& all = run.report().dropped_components;
  all.insert(all.end(), dropped.begin(), dropped.end());
  constexpr double worth_a_word = 0.01, hardly_noise = 0.1; // of the rows
  for (const DroppedComponent& piece : dropped) {
    const double share = static_cast<double>(piece.vertices) / static_cast<double>(run.report().points);
    if (share > worth_a_word)
      run.warn("a piece with " + std::to_string(piece.vertices) +
               " vertices was left out as a part that the samples do not bear out; --components all keeps it" +
               (share > hardly_noise ? words_on_what_it_is(run.report(), true) : ""));
  }
}

void describe(const SamplesApart& samples, Run& run) {
  run.count("components", "samples_apart", static_cast<double>(samples.apart));
  run.count("components", "samples_apart_together", static_cast<double>(samples.in_company));
  const double share = static_cast<double>(samples.in_company) / static_cast<double>(samples.all);
  // Scattered outliers and noise of up to a spacing have 0.002, that of two spacings nearly as much as this.
  constexpr double usual = 0.01;
  if (!(share > usual)) return;
  run.warn(std::to_string(std::lround(100 * share)) +
           " % of the samples lie side by side apart from the surface: strays in clumps, or parts are missing, perhaps "
           "walls far thinner than the samples are apart, or the inside of something hollow that was seen through its "
           "opening; look at the result before you use it");
}

void describe(const UnsupportedTriangles& unsupported, Run& run) {
  Report& report = run.report();
  report.unsupported_area = unsupported.share_of_area;
  report.bridged = unsupported.bridged;
  run.count("unsupported", static_cast<double>(std::count(unsupported.marked.begin(), unsupported.marked.end(), 1)));
  constexpr double usual = 0.1, far_too_much = 1.0 / 3; // statues without their underside have a fifth
  if (report.unsupported_area > usual && !report.options.trim)
    run.warn(std::to_string(std::lround(100 * report.unsupported_area)) +
             " % of the surface's area was bridged without data: it is invented, no samples bear it out" +
             (report.one_sided ? " (the sensors all lie on one side)" : "") + "; --trim leaves it out" +
             words_on_what_it_is(report, report.unsupported_area > far_too_much));
}

void describe(const TurnedOver& turned, Run& run) {
  run.count("not_smoothed", static_cast<double>(turned.pieces));
  if (turned.pieces > 0)
    run.warn(std::to_string(turned.pieces) + (turned.pieces == 1 ? " piece" : " pieces") +
             " would have been flattened or turned inside out by smoothing and stayed as before; give fewer steps with "
             "--smooth");
}

void describe(const PointResults& results, Run& run) {
  run.count("inliers", static_cast<double>(std::count(results.inlier.begin(), results.inlier.end(), 1)));
}

void describe(const UncrossCounts& counts, Run& run) {
  run.count("pairs", static_cast<double>(counts.crossings));
  run.count("eased", static_cast<double>(counts.eased));
}

void describe(const EdgeFlipCounts& counts, Run& run) {
  run.count("triangles", static_cast<double>(counts.triangles));
  run.count("crossings", static_cast<double>(counts.crossings));
}

void describe(const MeshSummary& mesh, Run& run) {
  run.report().mesh = mesh;
  warn_of_torn_walls(run);
  run.report().broken_guarantees = broken_guarantees(mesh, run.report());
}

} // namespace eigencrust
