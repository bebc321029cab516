// SPDX-License-Identifier: GPL-3.0-or-later
#include "method.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include <eigencrust/memory_forecast.h>
#include <eigencrust/option_table.h>

#include "disk_memory.h"
#include "files.h"
#include "messages.h"
#include "page.h"
#include "standard_streams.h"

namespace eigencrust::cli {
namespace {

// Of what is forecast. Points and attributes, and the many small arrays, stay in memory.
constexpr std::uint64_t least_part_in_memory = 8;

/// " [auto; paper: off]". What is off unless it is named, or empty, goes without saying, and so does the tolerance,
/// which means something else once it is given.
std::string shown_default(const OptionEntry& entry) {
  const std::string text = describe_default(entry);
  const bool is_shown = entry.kind == OptionEntry::Kind::flag
                            ? text == "on"
                            : entry.kind != OptionEntry::Kind::points && entry.kind != OptionEntry::Kind::number;
  return is_shown ? " [" + text + "]" : std::string();
}

/// The options of the library's table.
void add_group(OptionTable& app, Request& r, OptionEntry::Group group) {
  app.begin_chapter(std::string(chapter(group)));
  for (const OptionEntry& entry : option_table()) {
    if (entry.group != group) continue;
    const std::string name = "--" + std::string(entry.name), help = std::string(entry.help) + shown_default(entry);
    MethodValue& value = r.method[std::string(entry.name)];
    if (entry.kind == OptionEntry::Kind::flag) {
      value.flag = describe_default(entry) == "on";
      app.add_flag(value.flag ? name + ",!--no-" + std::string(entry.name) : name, value.flag, help);
      continue;
    }
    Option* option = entry.kind == OptionEntry::Kind::points  ? app.add_option(name, value.points, help)
                     : entry.kind == OptionEntry::Kind::count ? app.add_option(name, value.count, help)
                                                              : app.add_option(name, value.text, help);
    if (const std::vector<std::string> words = choices(entry); !words.empty())
      option->usually_of(words);
    else
      option->type_name(std::string(entry.value));
  }
}

} // namespace

void add_output_options(OptionTable& app, Request& r, const std::string& what) {
  app.begin_chapter("Results");
  app.add_option("-o,--output", r.output, what)->type_name(file_to_write);
  app.add_option("--format", r.format, "Format of the result, instead of that of its name's ending; needed with -o -")
      ->type_name("NAME");
  app.add_option("--report", r.report, "Write what was done and found: .html, a page to look at; else JSON")
      ->type_name(file_to_write);
  app.add_flag("--each", r.each,
               "Each input is a job of its own; {} in -o and --report stands for its name: -o meshes/{}.ply");
}

void add_method_options(OptionTable& app, Request& r) {
  add_group(app, r, OptionEntry::Group::known);
  app.add_option("--outside-points", r.outside_files, "File of points known to be outside; repeatable")
      ->type_name(file_to_read);
  app.add_option("--inside-points", r.inside_files, "File of points known to be inside; repeatable")
      ->type_name(file_to_read);
  add_group(app, r, OptionEntry::Group::method);
}

void add_smoothing_options(OptionTable& app, Request& r) { add_group(app, r, OptionEntry::Group::smoothing); }

void add_run_options(OptionTable& app, Request& r) {
  add_group(app, r, OptionEntry::Group::run);
  app.add_option("--progress", r.progress, "auto, bar, jsonl or off; on stderr")
      ->one_of({"auto", "bar", "jsonl", "off"})
      ->capture_default_str();
  app.add_option("--dump-stages", r.dump_stages, "Folder for the stages' products as PLY files")
      ->type_name(folder_to_write);
  app.add_option("--temp-dir", r.temp_dir,
                 "Folder that keeps the tetrahedra until the result is there, and takes what exceeds --max-memory")
      ->type_name("DIR");
  app.add_flag("--resume", r.resume, "Take the tetrahedra that an ended run of these points left in --temp-dir");
  app.add_flag("-q,--quiet", r.quiet, "Print nothing but errors");
}

Options effective_options(const Request& r) {
  Options o;
  for (const OptionEntry& entry : option_table()) { // the preset comes first
    const auto found = r.method.find(entry.name);
    if (found == r.method.end()) continue;
    const MethodValue& value = found->second;
    if (entry.kind == OptionEntry::Kind::flag) entry.set(o, value.flag ? "on" : "off");
    if (value.text) entry.set(o, *value.text);
    if (value.count) entry.set(o, std::to_string(*value.count));
    for (const std::string& point : value.points) entry.set(o, point);
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

namespace {

/// - is written as /dev/stdout is.
std::string real_output(const std::string& path) { return is_standard_output(path) ? "/dev/stdout" : path; }

void check_format(const Request& r, OutputKind kind) {
  const bool mesh = kind == OutputKind::mesh;
  if (mesh ? can_write_mesh(r.output, r.format) : can_write_point_cloud(r.output, r.format)) return;
  const std::string known = mesh ? "ply, obj, off, stl, glb or 3mf" : "ply, pcd, las, xyz, txt, asc, csv or obj";
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
  std::error_code error;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !is_folder(folder, error)) {
    if (error)
      throw Error(ErrorKind::usage, path, "the folder " + folder.string() + " cannot be used: " + error.message(),
                  "check its disk and its permissions, or name another");
    throw Error(ErrorKind::usage, path, "the folder " + folder.string() + " does not exist",
                "create it first: mkdir -p " + folder.string());
  }
  if (is_folder(path)) throw Error(ErrorKind::usage, path, "this is a folder", "name a file in it");
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
  if (is_page(r.report)) read_viewer(r.report);
  check_files({inputs_of(r), outputs_of(r), {}});
  for (const std::string& path : {r.output, r.report})
    if (!path.empty() && !is_standard_output(path)) require_writable(path);
  if (r.resume && r.temp_dir.empty())
    throw Error(ErrorKind::usage, "--resume", "nothing says where the ended run kept its work",
                "add --temp-dir with the folder that it had");
  for (const std::string& folder : {r.dump_stages, r.temp_dir}) {
    if (folder.empty() || is_folder(folder)) continue;
    std::error_code ignored; // whatever it is, the folder cannot be used
    if (!fs::create_directories(folder, ignored))
      throw Error(ErrorKind::usage, folder, "the folder cannot be created", "choose another one");
  }
}

MethodRun::MethodRun(const Request& request, std::vector<std::string> command, OutputKind kind)
    : request_(request), command_(std::move(command)) {
  forget_files();
  check_outputs(request, kind);
  observer_ = make_observer(request.progress, request.dump_stages, request.quiet);
  if (is_page(request.report)) page_ = std::make_unique<PageObserver>(*observer_);
  FileStage stage(*observer_, "reading");
  cloud = read_inputs(request.input, read_, [&](double fraction) { stage.progress(fraction); });
  stage.end();
  for (std::size_t i = 0; i < read_.files.size(); ++i)
    for (const std::string& text : read_.notes[i].warnings) warn_at_once(read_.files[i].path + ": " + text);
  for (const std::string& text : read_.together) warn_at_once(text);
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
  *found = derived_attribute(make_attribute("source_index", rows));
}

/// Where more memory is forecast than allowed, the folder for temporary files takes the large arrays.
/// \return whether it does. \throws Error{memory} where that is not enough, or the disk too small
bool MethodRun::goes_out_of_core(const Options& options) {
  const std::uint64_t needed = forecast(cloud).memory_bytes, limit = options.max_memory;
  if (limit == 0 || request_.temp_dir.empty() || needed <= limit) return false;
  const std::string said = "the forecast for " + grouped(cloud.points.size()) + " points, " + describe_bytes(needed);
  if (limit < needed / least_part_in_memory)
    throw Error(ErrorKind::memory, "memory", said + ", exceeds " + describe_bytes(limit) + " too far",
                "raise --max-memory to " + describe_bytes(needed / least_part_in_memory) + " at least");
  std::error_code unknown;
  const auto room = std::filesystem::space(request_.temp_dir, unknown);
  if (!unknown && room.available < needed)
    throw Error(ErrorKind::memory, request_.temp_dir,
                said + ", exceeds the " + describe_bytes(room.available) + " free on its disk",
                "name another folder with --temp-dir, or give fewer points");
  lend_disk(request_.temp_dir, limit);
  if (lies_in_memory(request_.temp_dir))
    warn_at_once(request_.temp_dir + " lies in memory itself (tmpfs): name a folder on a disk with --temp-dir");
  return true;
}

void MethodRun::reconstruct(const Options& options) {
  const bool out_of_core = goes_out_of_core(options);
  if (!out_of_core) {
    check_memory(cloud, options.max_memory);
    warn_at_once(memory_warning(forecast(cloud), available_memory_bytes()));
  }
  const auto smoothing = request_.method.find("smoothing");
  if (smoothing != request_.method.end() && smoothing->second.text && options.smooth == 0)
    warn_at_once("--smoothing has no effect without --smooth N");
  Options complete = options;
  if (out_of_core) complete.max_memory = 0; // lend_disk() sees to it
  // A page shows outliers, of which the other methods know nothing.
  complete.point_results = options.point_results || (page_ && options.method == Method::eigencrust);
  if (!request_.temp_dir.empty())
    kept_ = std::make_unique<KeptTetrahedra>(request_.temp_dir, request_.resume, request_.ranks, options.max_memory);
  result = eigencrust::reconstruct(cloud, complete, page_ ? *page_ : *observer_, kept_ ? kept_.get() : request_.ranks);
  if (kept_)
    for (const std::string& text : kept_->warnings()) warn_at_once(text);
  if (page_) page_->finished(cloud, result);
  name_rows_of_files();
  result.report.options.max_memory = options.max_memory;
  result.report.command = command_;
  result.report.files = std::move(read_.files);
  result.report.warnings.insert(result.report.warnings.begin(), told_.begin(), told_.end());
}

void MethodRun::finish(const std::function<WriteResult(OutputFiles&, const std::string&, const WriteOptions&)>& write) {
  Report& report = result.report;
  FileStage stage(*observer_, "writing");
  OutputFiles files;
  std::vector<std::string> comments = frame_comments(request_.input);
  comments.insert(comments.begin(), std::string("made by eigencrust ") + version());
  const WriteResult written = write(files, real_output(request_.output),
                                    {.spacing = report.spacing,
                                     .comments = std::move(comments),
                                     .format = request_.format,
                                     .shift = shift_of_inputs(request_.input),
                                     .metres = metres_of_result(request_.input)});
  report.warnings.insert(report.warnings.end(), written.warnings.begin(), written.warnings.end());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  report.peak_memory_bytes = peak_memory_bytes();
  report.peak_disk_bytes = peak_of_lent_disk();
  if (page_) {
    const std::string viewer = read_viewer(request_.report);
    files.add(request_.report, [&](std::ostream& out) { write_page(out, viewer, result, page_->products()); });
  } else if (!request_.report.empty()) {
    const std::string text = to_json(report) + "\n";
    files.add(real_output(request_.report), [&](std::ostream& out) { out << text; });
  }
  Commit commit;
  files.put_in_place();
  commit.done(report.broken_guarantees.empty() ? 0 : static_cast<int>(ErrorKind::guarantee));
  if (kept_) kept_->forget();
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
  const auto megabytes = [](std::uint64_t bytes) { return rounded(static_cast<double>(bytes) / 1e6) + " MB"; };
  const Report& report = result.report;
  return rounded(report.seconds) + " s, " + megabytes(report.peak_memory_bytes) +
         (report.peak_disk_bytes > 0 ? " and " + megabytes(report.peak_disk_bytes) + " on disk" : "");
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
