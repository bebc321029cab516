// SPDX-License-Identifier: GPL-3.0-or-later
#include "points.h"

namespace eigencrust::cli {

int orient_verb(const Arguments& arguments) {
  Request request;
  bool drop_outliers = false;
  CLI::App app("The cloud with unit normals that look outward; those of outliers are NaN.", "eigencrust orient");
  add_input_options(app, request.input);
  app.add_option("-o,--output", request.output,
                 "Cloud to write (ply xyz txt asc csv): all rows in order, with nx, ny and nz")
      ->required()
      ->type_name(file_to_write);
  app.add_flag("--drop-outliers", drop_outliers, "Leave out the rows that have no normal");
  add_method_options(app, request);
  add_run_options(app, request);
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;

  Options options = effective_options(request);
  options.point_results = true;
  MethodRun run(request, arguments, OutputKind::cloud);
  run.reconstruct(options);
  for (const auto& [name, axis] : {std::pair{"nx", &Vec3::x}, std::pair{"ny", &Vec3::y}, std::pair{"nz", &Vec3::z}}) {
    std::vector<float> values;
    values.reserve(run.result.normals.size());
    for (const Vec3& normal : run.result.normals) values.push_back(static_cast<float>(normal.*axis));
    set_attribute(run.cloud, make_attribute(name, values));
  }
  return write_points(run, request, drop_outliers);
}

} // namespace eigencrust::cli
