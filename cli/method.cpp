// SPDX-License-Identifier: GPL-3.0-or-later
#include "method.h"

#include <iostream>

#include <eigencrust/memory_forecast.h>

namespace eigencrust::cli {
namespace {

std::string defaults(const std::string& robust, const std::string& paper) {
  return robust == paper ? " [" + robust + "]" : " [" + robust + "; paper: " + paper + "]";
}

} // namespace

void add_method_options(CLI::App& app, Request& r) {
  const Options robust = Options::of(Preset::robust), paper = Options::of(Preset::paper);
  app.add_option("--preset", r.preset,
                 "robust: the measured best; paper: Kolluri, Shewchuk, O'Brien 2004 to the letter")
      ->capture_default_str();
  app.add_option("--noise", r.noise,
                 "Standard deviation of the noise: auto (measured at the samples), off, a length, N%" +
                     defaults(to_string(robust.noise), to_string(paper.noise)));
  app.add_option("--grid-spacing", r.grid_spacing,
                 "Diagonal of the scanner's grid squares: auto, off, a length, N%" +
                     defaults(to_string(robust.grid_spacing), to_string(paper.grid_spacing)));
  app.add_option("--questionable", r.questionable,
                 "Tetrahedra under 4 grid spacings lose their say before or after the first partition, or never" +
                     defaults(to_string(robust.questionable), to_string(paper.questionable)));
  app.add_option("--weights", r.weights,
                 "Pole pairs: evidence (isolated samples, which may be outliers, count little) or paper (all count)" +
                     defaults(to_string(robust.weights), to_string(paper.weights)));
  app.add_option("--second-stage", r.second_stage,
                 "How all tetrahedra are settled: cut, or as the paper does: harmonic, eigenvector" +
                     defaults(to_string(robust.second_stage), to_string(paper.second_stage)));
  app.add_option("--eigensolver", r.eigensolver,
                 "multigrid or lanczos (the slow reference)" +
                     defaults(to_string(robust.solver.eigensolver), to_string(paper.solver.eigensolver)));
  app.add_option("--tolerance", r.tolerance,
                 "Residual at which an eigenvector counts as converged; given, signs alone do not stop it");
  app.add_option("--max-steps", r.max_steps,
                 "Steps of the solver at most" +
                     defaults(std::to_string(robust.solver.max_steps), std::to_string(paper.solver.max_steps)));
  app.add_flag("--manifold,!--no-manifold", r.manifold, "Make the surface a manifold [on]");
  app.add_option("--components", r.components,
                 "Pieces to keep: supported, all, largest or a number" +
                     defaults(to_string(robust.components), to_string(paper.components)));
  app.add_option("--outside-point", r.outside_points, "x,y,z of a point known to be outside; repeatable")
      ->allow_extra_args(false);
  app.add_option("--inside-point", r.inside_points, "x,y,z of a point known to be inside; repeatable")
      ->allow_extra_args(false);
  app.add_option("--outside-points", r.outside_files, "File of points known to be outside; repeatable");
  app.add_option("--inside-points", r.inside_files, "File of points known to be inside; repeatable");
  app.add_option("--crossing-depth", r.crossing_depth,
                 "Where sensors are known: a line of sight crosses what it enters farther than this from its sample; "
                 "auto or a length" +
                     defaults("auto", "auto"));
  app.add_option(
      "--facade", r.facade,
      "One-sided scan: auto (found from the sensors), off, or outside in front along +x -x +y -y +z or -z: the "
      "mesh stays open [auto]");
  app.add_flag("--trim", r.trim, "Leave out triangles that the samples do not bear out: the mesh is then open");
}

void add_smoothing_options(CLI::App& app, Request& r) {
  const Options robust = Options::of(Preset::robust), paper = Options::of(Preset::paper);
  app.add_option(
      "--surface", r.surface,
      "Vertices: samples (input points), fitted (moved to the middle of the noise), auto (fitted where noise "
      "was measured)" +
          defaults(to_string(robust.surface), to_string(paper.surface)));
  app.add_option("--smooth", r.smooth,
                 "Smoothing steps; vertices then leave the samples" +
                     defaults(std::to_string(robust.smooth), std::to_string(paper.smooth)));
  app.add_option(
      "--smoothing", r.smoothing,
      "laplacian or taubin (keeps the volume)" + defaults(to_string(robust.smoothing), to_string(paper.smoothing)));
}

void add_run_options(CLI::App& app, Request& r) {
  app.add_option("--threads", r.threads, "Threads, 0 for all cores; the result is the same for any number")
      ->capture_default_str();
  app.add_option("--max-memory", r.max_memory,
                 "Refuse the cloud, before any work, if more memory is forecast: 4G, 500M, bytes [none]");
  app.add_option("--report", r.report, "Write what was done and found as JSON");
  app.add_option("--progress", r.progress, "auto, bar, jsonl or off; on stderr")
      ->check(CLI::IsMember({"auto", "bar", "jsonl", "off"}))
      ->capture_default_str();
  app.add_option("--dump-stages", r.dump_stages, "Folder for the stages' products as PLY files");
  app.add_flag("-q,--quiet", r.quiet, "Print nothing but errors");
}

Options effective_options(const Request& r) {
  Options o = Options::of(parse_preset(r.preset));
  if (!r.grid_spacing.empty()) o.grid_spacing = parse_length_choice("grid spacing", r.grid_spacing);
  if (!r.noise.empty()) o.noise = parse_length_choice("noise", r.noise);
  if (!r.questionable.empty()) o.questionable = parse_questionable(r.questionable);
  if (!r.weights.empty()) o.weights = parse_weights(r.weights);
  if (!r.second_stage.empty()) o.second_stage = parse_second_stage(r.second_stage);
  if (!r.eigensolver.empty()) o.solver.eigensolver = parse_eigensolver(r.eigensolver);
  if (r.tolerance) {
    o.solver.tolerance = *r.tolerance;
    o.solver.stop_on_stable_signs = false;
  }
  if (r.max_steps) o.solver.max_steps = *r.max_steps;
  o.manifold = r.manifold;
  o.trim = r.trim;
  if (!r.components.empty()) o.components = parse_components(r.components);
  if (!r.surface.empty()) o.surface = parse_surface_kind(r.surface);
  if (r.smooth) o.smooth = *r.smooth;
  if (!r.smoothing.empty()) o.smoothing = parse_smoothing(r.smoothing);
  for (const std::string& text : r.outside_points) o.outside_points.push_back(parse_point(text));
  for (const std::string& text : r.inside_points) o.inside_points.push_back(parse_point(text));
  for (const auto& [files, points] :
       {std::pair{&r.outside_files, &o.outside_points}, std::pair{&r.inside_files, &o.inside_points}})
    for (const std::string& file : *files) {
      const PointCloud named = read_point_cloud(file);
      points->insert(points->end(), named.points.begin(), named.points.end());
    }
  if (!r.crossing_depth.empty()) o.crossing_depth = parse_crossing_depth(r.crossing_depth);
  o.detect_facade = r.facade.empty() || r.facade == "auto";
  if (!r.facade.empty() && r.facade != "auto" && r.facade != "off") o.facade = parse_axis(r.facade);
  o.threads = r.threads;
  if (!r.max_memory.empty()) o.max_memory = parse_memory_size(r.max_memory);
  check_options(o);
  return o;
}

void check_outputs(const Request& r, OutputKind kind) {
  namespace fs = std::filesystem;
  if (kind == OutputKind::mesh && !can_write_mesh(r.output))
    throw Error(ErrorKind::usage, r.output, "no mesh format is known by this name",
                "end it in .ply, .obj, .off or .stl");
  if (kind == OutputKind::cloud && !can_write_point_cloud(r.output))
    throw Error(ErrorKind::usage, r.output, "no format of clouds that can be written is known by this name",
                "end it in .ply, .xyz, .txt, .asc or .csv");
  for (const std::string& path : {r.output, r.report}) {
    if (path.empty()) continue;
    const fs::path folder = fs::path(path).parent_path();
    if (!folder.empty() && !fs::is_directory(folder))
      throw Error(ErrorKind::usage, path, "the folder " + folder.string() + " does not exist", "create it first");
    if (fs::is_directory(path)) throw Error(ErrorKind::usage, path, "this is a folder", "name a file");
  }
  std::error_code ignored;
  std::vector<std::string> inputs = r.input.paths;
  inputs.push_back(r.input.scan_index);
  inputs.push_back(r.input.sensors);
  for (const std::string& path : {r.output, r.report})
    for (const std::string& input : inputs)
      if (fs::equivalent(input, path, ignored))
        throw Error(ErrorKind::usage, path, "the output would overwrite an input", "choose another name");
  const auto place = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  };
  if (!r.report.empty() && place(r.output) == place(r.report))
    throw Error(ErrorKind::usage, r.report, "output and report would be the same file", "choose another name");
  if (!r.dump_stages.empty() && !fs::is_directory(r.dump_stages) && !fs::create_directories(r.dump_stages))
    throw Error(ErrorKind::usage, r.dump_stages, "the folder cannot be created", "choose another one");
}

MethodRun::MethodRun(const Request& request, const Arguments& arguments, OutputKind kind)
    : request_(request), arguments_(arguments) {
  check_outputs(request, kind);
  catch_interrupts();
  observer_ = make_observer(request.progress, request.dump_stages, request.quiet);
  cloud = read_inputs(request.input, files_);
}

void MethodRun::warn_at_once(const std::string& text) {
  if (text.empty()) return;
  if (!request_.quiet) print_warning(text);
  told_.push_back(text);
}

void MethodRun::reconstruct(const Options& options) {
  check_memory(cloud, options.max_memory);
  warn_at_once(memory_warning(forecast(cloud), available_memory_bytes()));
  if (!request_.smoothing.empty() && options.smooth == 0) warn_at_once("--smoothing has no effect without --smooth N");
  result = eigencrust::reconstruct(cloud, options, *observer_);
  result.report.command = arguments_.command;
  result.report.files = std::move(files_);
  result.report.warnings.insert(result.report.warnings.begin(), told_.begin(), told_.end());
}

WriteOptions MethodRun::write_options() const {
  throw_if_cancelled(*observer_, "writing");
  return {.spacing = result.report.spacing, .comments = {std::string("made by eigencrust ") + version()}};
}

void MethodRun::finish(const WriteResult& written) {
  Report& report = result.report;
  report.warnings.insert(report.warnings.end(), written.warnings.begin(), written.warnings.end());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  report.peak_memory_bytes = peak_memory_bytes();
  if (!request_.report.empty())
    write_file_atomically(request_.report, [&](std::ostream& out) { out << to_json(report) << "\n"; });
  clear_progress();
  if (request_.quiet) return;
  for (std::size_t i = told_.size(); i < report.warnings.size(); ++i) print_warning(report.warnings[i]);
}

std::string MethodRun::cost() const {
  return rounded(result.report.seconds) + " s, " + rounded(static_cast<double>(result.report.peak_memory_bytes) / 1e6) +
         " MB";
}

int MethodRun::status() const {
  if (result.report.broken_guarantees.empty()) return 0;
  for (const std::string& text : result.report.broken_guarantees)
    std::cerr << "eigencrust: error: the mesh is not " << text
              << " (validate); report this as a fault of the program\n";
  return static_cast<int>(ErrorKind::guarantee);
}

} // namespace eigencrust::cli
