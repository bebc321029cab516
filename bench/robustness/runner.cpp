// SPDX-License-Identifier: GPL-3.0-or-later
#include "runner.h"

#include <algorithm>
#include <new>

#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>

#include "measures.h"
#include "sampling.h"

namespace eigencrust::bench {
namespace {

/// "armadillo+10%box1.2" and "robust" -> "armadillo+10%box1.2-robust.ply"; names hold no slash but may hold
/// what some file systems refuse.
std::filesystem::path file_in(const std::filesystem::path& folder, const Case& item, Preset preset,
                              const char* extension) {
  std::string name = item.name + "-" + to_string(preset) + extension;
  std::replace(name.begin(), name.end(), ':', '_');
  return folder / name;
}

void keep(const Case& item, const Run& run, const TriangleMesh& mesh, const RunnerOptions& options) {
  WriteOptions write;
  write.spacing = run.report.spacing;
  if (!options.meshes.empty()) write_mesh(file_in(options.meshes, item, run.preset, ".ply"), mesh, write);
  if (!options.pictures.empty())
    write_png(file_in(options.pictures, item, run.preset, ".png"), render(mesh, item.view));
}

/// Calls work; \return what it threw, in words.
template <class Work>
std::string error_of(Work&& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

void run_preset(const Case& item, const Scene& scene, Sources& sources, const RunnerOptions& options, Run& run) {
  Options how = Options::of(run.preset);
  how.threads = sources.threads();
  how.surface = options.surface;
  if (item.how) item.how(how);
  Result result = reconstruct(scene.cloud, how);
  run.report = result.report;
  measure(scene, result, sources.threads(), run.figures);
  if (item.measure_more) item.measure_more(scene, result, sources, run.figures);
  run.missed = missed(item.requirements, run.figures);
  for (const std::string& broken : run.report.broken_guarantees) run.missed.push_back("guarantee: " + broken);
  keep(item, run, result.mesh, options);
}

/// Sets run.excused where the requirements are missed and the method says why.
void excuse(const Case& item, Run& run) {
  const auto says_why = [&](const std::string& text) { return text.find(item.excuse) != std::string::npos; };
  if (item.excuse.empty() || run.good()) return;
  if (says_why(run.error)) run.excused = run.error;
  if (!run.error.empty() || run.figures.find("true_samples_kept").value_or(0) < 0.01) return;
  const auto& warnings = run.report.warnings;
  const auto found = std::find_if(warnings.begin(), warnings.end(), says_why);
  if (found != warnings.end()) run.excused = *found;
}

} // namespace

double Run::stage_seconds(const std::string& stage) const {
  double seconds = 0;
  for (const StageReport& s : report.stages)
    if (s.name == stage) seconds += s.seconds;
  return seconds;
}

double Run::time_ratio() const {
  const double delaunay = stage_seconds("delaunay");
  return delaunay > 0 ? report.seconds / delaunay : 0;
}

Outcome run_case(const Case& item, Sources& sources, const RunnerOptions& options,
                 const std::function<void(const Outcome&, const Run&)>& progress) {
  Outcome outcome;
  outcome.item = item;
  for (const std::string& file : item.files)
    if (!sources.has(file)) {
      outcome.skipped = "there is no " + file;
      return outcome;
    }
  Scene scene;
  const std::string no_scene = error_of([&] { scene = item.make(sources, item.seed); });
  outcome.points = scene.cloud.points.size();
  outcome.true_samples = scene.true_samples;
  outcome.spacing = scene.spacing;
  outcome.fingerprint = fingerprint(scene.cloud.points);
  outcome.true_components = scene.truth.components;
  outcome.true_genus = scene.truth.genus;
  for (const Preset preset : options.presets) {
    Run run;
    run.preset = preset;
    run.error = no_scene;
    if (no_scene.empty()) run.error = error_of([&] { run_preset(item, scene, sources, options, run); });
    excuse(item, run);
    progress(outcome, run);
    outcome.runs.push_back(std::move(run));
  }
  return outcome;
}

} // namespace eigencrust::bench
