// SPDX-License-Identifier: GPL-3.0-or-later
#include "points.h"

namespace eigencrust::cli {

int classify_verb(const Arguments& arguments) {
  Request request;
  CLI::App app("The cloud with a flag for the points that belong to the surface, and how sure that is.",
               "eigencrust classify");
  add_input_options(app, request.input);
  app.add_option("-o,--output", request.output,
                 "Cloud to write (ply xyz txt asc csv): all rows in order, with inlier (1 or 0) and confidence")
      ->required()
      ->type_name(file_to_write);
  add_method_options(app, request);
  add_run_options(app, request);
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;

  Options options = effective_options(request);
  options.point_results = true;
  MethodRun run(request, arguments, OutputKind::cloud);
  run.reconstruct(options);
  const std::vector<double> inlier(run.result.inlier.begin(), run.result.inlier.end());
  set_attribute(run.cloud, make_attribute("inlier", ScalarType::uint8, inlier));
  set_attribute(run.cloud, make_attribute("confidence", run.result.confidence));
  return write_points(run, request, false);
}

} // namespace eigencrust::cli
