// SPDX-License-Identifier: GPL-3.0-or-later
#include "points.h"

namespace eigencrust::cli {
namespace {

int flag_points(const Request& request, const std::vector<std::string>& command, const std::string& keep) {
  const Options options = options_for_points(request);
  MethodRun run(request, command, OutputKind::cloud);
  run.reconstruct(options);
  const std::vector<double> inlier(run.result.inlier.begin(), run.result.inlier.end());
  set_attribute(run.cloud, make_attribute("inlier", ScalarType::uint8, inlier));
  set_attribute(run.cloud, make_attribute("confidence", run.result.confidence));
  return write_points(run, request, keep);
}

/// \throws Error{usage} where the format would lose what was asked for
void check_room(const Request& r, const std::string& keep) {
  const std::string ending = std::filesystem::path(r.output).extension().string();
  if (keep.empty() && (r.format == "obj" || (r.format.empty() && (ending == ".obj" || ending == ".OBJ"))))
    throw Error(ErrorKind::usage, r.output, "OBJ has no room for the flag of inliers",
                "add --keep inliers or --keep outliers, or write another format");
}

} // namespace

int outliers_verb(const Arguments& arguments) {
  Request request;
  request.ranks = arguments.ranks;
  std::string keep;
  OptionTable app("The cloud with a flag for the points that belong to the surface, and how sure that is.",
                  "eigencrust outliers");
  add_input_options(app, request.input);
  add_output_options(app, request,
                     "Cloud to write (ply pcd las xyz txt asc csv obj): all rows in order, with inlier (1 or 0) and "
                     "confidence");
  add_keep_option(app, keep);
  add_method_options(app, request);
  add_run_options(app, request);
  app.find("--output")->required();
  const Parsed parsed = parse(app, arguments);
  if (parsed.done) return parsed.status;
  check_room(request, keep);
  return for_each_job(request, OutputKind::cloud,
                      [&](const Request& job) { return flag_points(job, parsed.command, keep); });
}

} // namespace eigencrust::cli
