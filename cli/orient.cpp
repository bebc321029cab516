// SPDX-License-Identifier: GPL-3.0-or-later
#include "points.h"

namespace eigencrust::cli {
namespace {

int add_normals(const Request& request, const std::vector<std::string>& command, const std::string& keep) {
  const Options options = options_for_points(request);
  MethodRun run(request, command, OutputKind::cloud);
  run.reconstruct(options);
  for (const auto& [name, axis] : {std::pair{"nx", &Vec3::x}, std::pair{"ny", &Vec3::y}, std::pair{"nz", &Vec3::z}}) {
    std::vector<float> values;
    values.reserve(run.result.normals.size());
    for (const Vec3& normal : run.result.normals) values.push_back(static_cast<float>(normal.*axis));
    set_attribute(run.cloud, make_attribute(name, values));
  }
  return write_points(run, request, keep);
}

} // namespace

int orient_verb(const Arguments& arguments) {
  Request request;
  request.ranks = arguments.ranks;
  std::string keep;
  bool drop_outliers = false;
  OptionTable app("The cloud with unit normals that look outward; those of outliers are NaN.", "eigencrust orient");
  add_input_options(app, request.input);
  add_output_options(app, request,
                     "Cloud to write (ply pcd las xyz txt asc csv obj): all rows in order, with nx, ny and nz");
  add_keep_option(app, keep);
  app.add_flag("--drop-outliers", drop_outliers, "The same as --keep inliers");
  add_method_options(app, request);
  add_run_options(app, request);
  app.find("--output")->required();
  const Parsed parsed = parse(app, arguments);
  if (parsed.done) return parsed.status;
  if (drop_outliers) keep = "inliers";
  return for_each_job(request, OutputKind::cloud,
                      [&](const Request& job) { return add_normals(job, parsed.command, keep); });
}

} // namespace eigencrust::cli
