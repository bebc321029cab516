// SPDX-License-Identifier: GPL-3.0-or-later
// --each: several clouds as several jobs.
#include <map>
#include <new>

#include "disk_memory.h"
#include "messages.h"
#include "method.h"

namespace eigencrust::cli {
namespace {

constexpr std::string_view mark = "{}"; ///< where the input's name goes

std::string filled(std::string pattern, const std::string& name) {
  for (std::size_t at = pattern.find(mark); at != std::string::npos; at = pattern.find(mark, at + name.size()))
    pattern.replace(at, mark.size(), name);
  return pattern;
}

/// \throws Error{usage} unless the input's name has a place in the names of all results
void require_marks(const Request& r) {
  for (const auto& [option, pattern] :
       {std::pair{"-o", r.output}, std::pair{"--report", r.report}, std::pair{"--dump-stages", r.dump_stages}})
    if (!pattern.empty() && pattern.find(mark) == std::string::npos)
      throw Error(ErrorKind::usage, pattern,
                  std::string("with --each, ") + option + " has to name a file for each input",
                  "put {} where the name of the input goes, for example -o meshes/{}.ply");
}

std::vector<Request> split_jobs(const Request& all, OutputKind kind) {
  require_marks(all);
  const InputOptions& input = all.input;
  for (const auto& [option, values] :
       {std::pair{"--sensor", &input.sensor}, std::pair{"--sensor-direction", &input.sensor_direction}})
    if (!values->empty() && values->size() != input.paths.size())
      throw Error(ErrorKind::usage, "command line", std::string("not one ") + option + " for each input",
                  "name one for each input, in order");
  for (std::size_t i = 0; i < input.paths.size(); ++i) scale_of_input(input, i); // as many as inputs, or one
  std::vector<Request> jobs;
  std::map<std::string, std::string> input_of;
  for (std::size_t i = 0; i < input.paths.size(); ++i) {
    Request job = all;
    job.input.paths = {input.paths[i]};
    if (input.unit.size() > 1) job.input.unit = {input.unit[i]};
    if (input.scale.size() > 1) job.input.scale = {input.scale[i]};
    if (!input.sensor.empty()) job.input.sensor = {input.sensor[i]};
    if (!input.sensor_direction.empty()) job.input.sensor_direction = {input.sensor_direction[i]};
    const std::string name = std::filesystem::path(input.paths[i]).stem().string();
    for (std::string* pattern : {&job.output, &job.report, &job.dump_stages}) *pattern = filled(*pattern, name);
    const auto [other, is_new] = input_of.emplace(job.output, input.paths[i]);
    if (!is_new)
      throw Error(ErrorKind::usage, job.output, other->second + " and " + input.paths[i] + " would be one result",
                  "give the inputs different names, or run them one by one");
    for (const std::string& path : input.paths) { // no job may overwrite what a later one reads
      std::error_code ignored;
      if (std::filesystem::equivalent(path, job.output, ignored))
        throw Error(ErrorKind::usage, job.output, "the output would overwrite an input", "choose another name");
    }
    check_outputs(job, kind);
    jobs.push_back(std::move(job));
  }
  return jobs;
}

} // namespace

int for_each_job(const Request& request, OutputKind kind, const std::function<int(const Request&)>& job) {
  if (!request.each) return job(request);
  int status = 0;
  for (const Request& one : split_jobs(request, kind)) {
    int ended = 0;
    try {
      ended = job(one);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      print_error((one.input.paths[0] + ": " + error.what()).c_str());
      ended = static_cast<int>(error.kind());
    } catch (const std::bad_alloc&) {
      print_error((one.input.paths[0] + ": " + memory_is_exhausted()).c_str());
      ended = static_cast<int>(ErrorKind::memory);
    }
    if (status == 0) status = ended;
  }
  return status;
}

} // namespace eigencrust::cli
