// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <iostream>
#include <numbers>

#include "method.h"

namespace eigencrust::cli {

int reconstruct_verb(const Arguments& arguments) {
  Request request;
  CLI::App app("Point clouds to a closed, manifold, outward oriented triangle mesh.", "eigencrust reconstruct");
  add_input_options(app, request.input);
  app.add_option("-o,--output", request.output, "Mesh to write (ply obj off stl)")->required();
  add_method_options(app, request);
  add_smoothing_options(app, request);
  add_run_options(app, request);
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;

  const Options options = effective_options(request);
  MethodRun run(request, arguments, OutputKind::mesh);
  run.reconstruct(options);
  run.finish(write_mesh(request.output, run.result.mesh, run.write_options()));
  const Report& report = run.result.report;
  if (!request.quiet) {
    std::cout << request.output << ": " << grouped(report.points) << " points in " << run.cost() << "\n"
              << describe(report.mesh);
    if (report.moved)
      std::cout << "  " << grouped(report.moved->vertices) << " vertices moved from their samples: median "
                << rounded(report.moved->median) << ", 99 % below " << rounded(report.moved->q99) << "\n";
    if (report.one_sided)
      std::cout << "  one-sided scan: every line of sight is within "
                << std::lround(report.one_sided->widest_angle * 180 / std::numbers::pi)
                << " degrees of their mean direction\n";
    if (!report.dropped_components.empty())
      std::cout << "  pieces without support left out: " << report.dropped_components.size()
                << " (listed in --report)\n";
  }
  return run.status();
}

} // namespace eigencrust::cli
