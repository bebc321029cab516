// SPDX-License-Identifier: GPL-3.0-or-later
#include "method.h"

#include <algorithm>
#include <iostream>

#include <eigencrust/memory_forecast.h>

#include "messages.h"
#include "standard_streams.h"

namespace eigencrust::cli {
namespace {

std::string defaults(const std::string& robust, const std::string& paper) {
  return robust == paper ? " [" + robust + "]" : " [" + robust + "; paper: " + paper + "]";
}

} // namespace

void add_output_options(OptionTable& app, Request& r, const std::string& what) {
  app.begin_chapter("Results");
  app.add_option("-o,--output", r.output, what)->type_name(file_to_write);
  app.add_option("--format", r.format, "Format of the result, instead of that of its name's ending; needed with -o -")
      ->type_name("NAME");
  app.add_option("--report", r.report, "Write what was done and found as JSON")->type_name(file_to_write);
  app.add_flag("--each", r.each,
               "Each input is a job of its own; {} in -o and --report stands for its name: -o meshes/{}.ply");
}

namespace {

void add_named_points(OptionTable& app, Request& r) {
  app.begin_chapter("What is known beforehand");
  app.add_option("--outside-point", r.outside_points, "x,y,z of a point known to be outside; repeatable")
      ->type_name("X,Y,Z");
  app.add_option("--inside-point", r.inside_points, "x,y,z of a point known to be inside; repeatable")
      ->type_name("X,Y,Z");
  app.add_option("--outside-points", r.outside_files, "File of points known to be outside; repeatable")
      ->type_name(file_to_read);
  app.add_option("--inside-points", r.inside_files, "File of points known to be inside; repeatable")
      ->type_name(file_to_read);
}

} // namespace

void add_method_options(OptionTable& app, Request& r) {
  add_named_points(app, r);
  app.begin_chapter("Method");
  const Options robust = Options::of(Preset::robust), paper = Options::of(Preset::paper);
  app.add_option("--preset", r.preset,
                 "robust: the measured best; paper: Kolluri, Shewchuk, O'Brien 2004 to the letter")
      ->capture_default_str()
      ->usually_of({"robust", "paper"});
  app.add_option("--noise", r.noise,
                 "Standard deviation of the noise: auto (measured at the samples), off, a length, N%" +
                     defaults(to_string(robust.noise), to_string(paper.noise)))
      ->type_name("L");
  app.add_option("--grid-spacing", r.grid_spacing,
                 "Diagonal of the scanner's grid squares: auto, off, a length, N%" +
                     defaults(to_string(robust.grid_spacing), to_string(paper.grid_spacing)))
      ->type_name("L");
  app.add_option("--questionable", r.questionable,
                 "Tetrahedra under 4 grid spacings lose their say before or after the first partition, or never" +
                     defaults(to_string(robust.questionable), to_string(paper.questionable)))
      ->usually_of({"before", "after", "never"});
  app.add_option("--weights", r.weights,
                 "Pole pairs: evidence (isolated samples, which may be outliers, count little) or paper (all count)" +
                     defaults(to_string(robust.weights), to_string(paper.weights)))
      ->usually_of({"evidence", "paper"});
  app.add_option("--second-stage", r.second_stage,
                 "How all tetrahedra are settled: cut, or as the paper does: harmonic, eigenvector" +
                     defaults(to_string(robust.second_stage), to_string(paper.second_stage)))
      ->usually_of({"cut", "harmonic", "eigenvector"});
  app.add_option("--eigensolver", r.eigensolver,
                 "multigrid or lanczos (the slow reference)" +
                     defaults(to_string(robust.solver.eigensolver), to_string(paper.solver.eigensolver)))
      ->usually_of({"multigrid", "lanczos"});
  app.add_option("--tolerance", r.tolerance,
                 "Residual at which an eigenvector counts as converged; given, signs alone do not stop it")
      ->type_name("X");
  app.add_option("--max-steps", r.max_steps,
                 "Steps of the solver at most" +
                     defaults(std::to_string(robust.solver.max_steps), std::to_string(paper.solver.max_steps)))
      ->type_name("N");
  app.add_flag("--manifold,!--no-manifold", r.manifold, "Make the surface a manifold [on]");
  app.add_option("--components", r.components,
                 "Pieces to keep: supported, all, largest or a number" +
                     defaults(to_string(robust.components), to_string(paper.components)))
      ->type_name("KEEP");
  app.add_option("--crossing-depth", r.crossing_depth,
                 "Where sensors are known: a line of sight crosses what it enters farther than this from its sample; "
                 "auto or a length" +
                     defaults("auto", "auto"))
      ->type_name("L");
  app.add_option(
         "--facade", r.facade,
         "One-sided scan: auto (found from the sensors), off, or outside in front along +x -x +y -y +z or -z: the "
         "mesh stays open [auto]")
      ->usually_of({"auto", "off", "+x", "-x", "+y", "-y", "+z", "-z"});
  app.add_flag("--trim", r.trim, "Leave out triangles that the samples do not bear out: the mesh is then open");
}

void add_smoothing_options(OptionTable& app, Request& r) {
  app.begin_chapter("Results");
  const Options robust = Options::of(Preset::robust), paper = Options::of(Preset::paper);
  app.add_option("--surface", r.surface,
                 "Vertices: samples (input points), fitted (moved to the middle of the noise), auto (fitted where "
                 "noise was measured)" +
                     defaults(to_string(robust.surface), to_string(paper.surface)))
      ->usually_of({"auto", "samples", "fitted"});
  app.add_option("--smooth", r.smooth,
                 "Smoothing steps; vertices then leave the samples" +
                     defaults(std::to_string(robust.smooth), std::to_string(paper.smooth)))
      ->type_name("N");
  app.add_option(
         "--smoothing", r.smoothing,
         "laplacian or taubin (keeps the volume)" + defaults(to_string(robust.smoothing), to_string(paper.smoothing)))
      ->usually_of({"laplacian", "taubin"});
}

void add_run_options(OptionTable& app, Request& r) {
  app.begin_chapter("Running");
  app.add_option("--threads", r.threads, "Threads, 0 for all cores; the result is the same for any number")
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--max-memory", r.max_memory,
                 "Refuse the cloud, before any work, if more memory is forecast: 4G, 500M, bytes [none]")
      ->type_name("SIZE");
  app.add_option("--progress", r.progress, "auto, bar, jsonl or off; on stderr")
      ->one_of({"auto", "bar", "jsonl", "off"})
      ->capture_default_str();
  app.add_option("--dump-stages", r.dump_stages, "Folder for the stages' products as PLY files")
      ->type_name(folder_to_write);
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

namespace {

/// - is written as /dev/stdout is.
std::string real_output(const std::string& path) { return is_standard_output(path) ? "/dev/stdout" : path; }

void check_format(const Request& r, OutputKind kind) {
  const bool mesh = kind == OutputKind::mesh;
  if (mesh ? can_write_mesh(r.output, r.format) : can_write_point_cloud(r.output, r.format)) return;
  const std::string known = mesh ? "ply, obj, off or stl" : "ply, pcd, las, xyz, txt, asc, csv or obj";
  if (!r.format.empty())
    throw Error(ErrorKind::usage, "--format",
                std::string("there is no format of ") + (mesh ? "meshes" : "clouds") + " named " + r.format,
                "use " + known);
  if (is_standard_output(r.output))
    throw Error(ErrorKind::usage, r.output, "standard output has no ending that tells the format",
                "add --format ply, or another of " + known);
  throw Error(
      ErrorKind::usage, r.output,
      mesh ? "no mesh format is known by this name" : "no format of clouds that can be written is known by this name",
      "end it in ." + known + ", or add --format");
}

/// \throws Error{usage} where a folder is missing or in the way, Error{input} for what cannot be written
void check_place(const std::string& path) {
  namespace fs = std::filesystem;
  if (path.empty() || is_standard_output(path)) return;
  std::error_code ignored;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    throw Error(ErrorKind::usage, path, "the folder " + folder.string() + " does not exist",
                "create it first: mkdir -p " + folder.string());
  if (fs::is_directory(path, ignored)) throw Error(ErrorKind::usage, path, "this is a folder", "name a file in it");
}

} // namespace

namespace {

std::vector<std::string> inputs_of(const Request& r) {
  std::vector<std::string> paths = r.input.paths;
  for (const auto& more : {std::vector{r.input.scan_index, r.input.sensors}, r.outside_files, r.inside_files})
    paths.insert(paths.end(), more.begin(), more.end());
  return paths;
}

std::vector<std::string> outputs_of(const Request& r) { return {r.output, r.report}; }

} // namespace

void check_outputs(const Request& r, OutputKind kind) {
  namespace fs = std::filesystem;
  for (const std::string& path : {r.output, r.report}) check_place(path);
  check_format(r, kind);
  check_files({inputs_of(r), outputs_of(r), {}});
  for (const std::string& path : {r.output, r.report})
    if (!path.empty() && !is_standard_output(path)) require_writable(path);
  std::error_code ignored; // whatever it is, the folder cannot be used
  if (r.dump_stages.empty() || fs::is_directory(r.dump_stages, ignored)) return;
  if (!fs::create_directories(r.dump_stages, ignored))
    throw Error(ErrorKind::usage, r.dump_stages, "the folder cannot be created", "choose another one");
}

MethodRun::MethodRun(const Request& request, std::vector<std::string> command, OutputKind kind)
    : request_(request), command_(std::move(command)) {
  forget_files();
  check_outputs(request, kind);
  observer_ = make_observer(request.progress, request.dump_stages, request.quiet);
  FileStage stage(*observer_, "reading");
  cloud = read_inputs(request.input, read_, [&](double fraction) { stage.progress(fraction); });
  stage.end();
}

void MethodRun::warn_at_once(const std::string& text) {
  if (text.empty()) return;
  if (!request_.quiet) print_warning(text);
  told_.push_back(text);
}

/// source_index counts the rows of the files, also where some of them were left out before the work.
void MethodRun::name_rows_of_files() {
  auto& attributes = result.mesh.vertex_attributes;
  const auto found =
      std::find_if(attributes.rbegin(), attributes.rend(), [](const Attribute& a) { return a.name == "source_index"; });
  if (read_.rows.empty() || found == attributes.rend()) return;
  std::vector<std::uint32_t> rows(result.mesh.vertices.size());
  for (std::size_t v = 0; v < rows.size(); ++v)
    rows[v] = read_.rows[static_cast<std::size_t>(attribute_value(*found, v))];
  *found = make_attribute("source_index", rows);
}

void MethodRun::reconstruct(const Options& options) {
  check_memory(cloud, options.max_memory);
  warn_at_once(memory_warning(forecast(cloud), available_memory_bytes()));
  if (!request_.smoothing.empty() && options.smooth == 0) warn_at_once("--smoothing has no effect without --smooth N");
  result = eigencrust::reconstruct(cloud, options, *observer_);
  name_rows_of_files();
  result.report.command = command_;
  result.report.files = std::move(read_.files);
  result.report.warnings.insert(result.report.warnings.begin(), told_.begin(), told_.end());
}

void MethodRun::finish(const std::function<WriteResult(OutputFiles&, const std::string&, const WriteOptions&)>& write) {
  Report& report = result.report;
  FileStage stage(*observer_, "writing");
  OutputFiles files;
  const WriteResult written = write(files, real_output(request_.output),
                                    {.spacing = report.spacing,
                                     .comments = {std::string("made by eigencrust ") + version()},
                                     .format = request_.format});
  report.warnings.insert(report.warnings.end(), written.warnings.begin(), written.warnings.end());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  report.peak_memory_bytes = peak_memory_bytes();
  if (!request_.report.empty()) {
    const std::string text = to_json(report) + "\n";
    files.add(real_output(request_.report), [&](std::ostream& out) { out << text; });
  }
  Commit commit;
  files.put_in_place();
  commit.done(report.broken_guarantees.empty() ? 0 : static_cast<int>(ErrorKind::guarantee));
  stage.end();
  clear_progress();
  if (request_.quiet) return;
  for (std::size_t i = told_.size(); i < report.warnings.size(); ++i) print_warning(report.warnings[i]);
}

std::ostream& MethodRun::summary() const {
  static std::ostream nowhere(nullptr);
  if (request_.quiet) return nowhere;
  const bool taken = is_standard_output(request_.output) || is_standard_output(request_.report);
  return !taken ? std::cout : speaks_json() ? nowhere : std::cerr;
}

std::string MethodRun::cost() const {
  return rounded(result.report.seconds) + " s, " + rounded(static_cast<double>(result.report.peak_memory_bytes) / 1e6) +
         " MB";
}

std::string MethodRun::selection() const {
  if (read_.rows.empty() || read_.rows.size() == read_.rows_read) return {};
  const std::string by = request_.input.thin.empty()   ? "--crop"
                         : request_.input.crop.empty() ? "--thin"
                                                       : "--crop and --thin";
  return "  " + grouped(read_.rows.size()) + " of " + grouped(read_.rows_read) + " points kept by " + by + "\n";
}

int MethodRun::status() const {
  if (result.report.broken_guarantees.empty()) return 0;
  for (const std::string& text : result.report.broken_guarantees)
    print_error(("the mesh is not " + text + " (validate); report this as a fault of the program").c_str());
  return static_cast<int>(ErrorKind::guarantee);
}

} // namespace eigencrust::cli
