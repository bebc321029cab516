// SPDX-License-Identifier: GPL-3.0-or-later
#include "method.h"

#include <iostream>

#include <eigencrust/memory_forecast.h>
#include <eigencrust/option_table.h>

namespace eigencrust::cli {
namespace {

/// What --help shows in place of the value.
const char* value_name(OptionEntry::Kind kind) {
  switch (kind) {
    case OptionEntry::Kind::count:
      return "UINT";
    case OptionEntry::Kind::number:
      return "FLOAT";
    default:
      return "TEXT";
  }
}

void add_group(CLI::App& app, Request& r, OptionEntry::Group group) {
  for (const OptionEntry& entry : option_table()) {
    if (entry.group != group) continue;
    const std::string name(entry.name), option = "--" + name,
                                        help = std::string(entry.help) + " [" + describe_default(entry) + "]";
    if (entry.kind == OptionEntry::Kind::flag) {
      const bool can_be_negated = entry.get(Options{}) == "on";
      app.add_flag_function(
          can_be_negated ? option + ",!--no-" + name : option,
          [&r, name](std::int64_t count) { r.method[name] = {count > 0 ? "on" : "off"}; }, help);
    } else if (entry.kind == OptionEntry::Kind::points) {
      app.add_option(option, r.method[name], help)->allow_extra_args(false);
    } else {
      app.add_option_function<std::string>(
             option, [&r, name](const std::string& value) { r.method[name] = {value}; }, help)
          ->type_name(value_name(entry.kind));
    }
  }
}

} // namespace

void add_method_options(CLI::App& app, Request& r) {
  add_group(app, r, OptionEntry::Group::method);
  app.add_option("--outside-points", r.outside_files, "File of points known to be outside; repeatable");
  app.add_option("--inside-points", r.inside_files, "File of points known to be inside; repeatable");
}

void add_smoothing_options(CLI::App& app, Request& r) { add_group(app, r, OptionEntry::Group::smoothing); }

void add_run_options(CLI::App& app, Request& r) {
  add_group(app, r, OptionEntry::Group::run);
  app.add_option("--report", r.report, "Write what was done and found as JSON");
  app.add_option("--progress", r.progress, "auto, bar, jsonl or off; on stderr")
      ->check(CLI::IsMember({"auto", "bar", "jsonl", "off"}))
      ->capture_default_str();
  app.add_option("--dump-stages", r.dump_stages, "Folder for the stages' products as PLY files");
  app.add_flag("-q,--quiet", r.quiet, "Print nothing but errors");
}

Options effective_options(const Request& r) {
  Options o;
  for (const OptionEntry& entry : option_table()) { // the preset first
    const auto given = r.method.find(entry.name);
    if (given == r.method.end()) continue;
    for (const std::string& value : given->second) entry.set(o, value);
  }
  for (const auto& [files, points] :
       {std::pair{&r.outside_files, &o.outside_points}, std::pair{&r.inside_files, &o.inside_points}})
    for (const std::string& file : *files) {
      const PointCloud named = read_point_cloud(file);
      points->insert(points->end(), named.points.begin(), named.points.end());
    }
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
  if (request_.method.contains("smoothing") && options.smooth == 0)
    warn_at_once("--smoothing has no effect without --smooth N");
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
