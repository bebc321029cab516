// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <ostream>

#include "method.h"

namespace eigencrust::cli {
namespace {

bool holds_triangles(const std::string& path) {
  try {
    return can_write_mesh(path) && !read_mesh(path).triangles.empty();
  } catch (const Error&) {
    return false;
  }
}

/// `eigencrust scan.ply mesh.ply` is how everybody types it first. What could be a second scan is not overwritten.
/// \param command gets the -o that was left out. \throws Error{usage} unless it is plain which name is the result's
void find_output(Request& r, std::vector<std::string>& command) {
  if (!r.output.empty()) return;
  auto& names = r.input.paths;
  const auto fail = [](const std::string& cause, const std::string& remedy) {
    throw Error(ErrorKind::usage, "command line", cause, remedy);
  };
  if (r.each) fail("nothing says where the results go: -o, --output is missing", "add -o meshes/{}.ply");
  if (names.size() == 1)
    fail("nothing says where the result goes: -o, --output is missing", "add -o mesh.ply behind " + names[0]);
  if (names.size() > 2)
    fail("none of the " + std::to_string(names.size()) + " names is known to be the result's: -o, --output is missing",
         "add -o before it");
  std::error_code ignored;
  if (std::filesystem::exists(names[1], ignored)) {
    const bool is_mesh = holds_triangles(names[1]);
    if (!is_mesh && !std::filesystem::exists(names[0], ignored))
      fail(names[0] + " does not exist, and " + names[1] + " does", "name the input first, or add -o " + names[0]);
    if (!is_mesh)
      fail(names[1] + " exists and is no mesh: it may be a second scan", "add -o before the name of the result");
  } else if (!can_write_mesh(names[1], r.format)) {
    fail(names[1] + " does not exist, and no mesh format is known by this name",
         "end the result's name in .ply, .obj, .off, .stl, .glb or .3mf, or add -o before it");
  }
  r.output = names[1];
  names.pop_back();
  const auto word = std::find(command.rbegin(), command.rend(), r.output);
  if (word == command.rend()) return;
  command.erase(std::next(word).base());
  command.insert(command.begin() + (command.size() > 1 && command[1] == "reconstruct" ? 2 : 1), {"-o", r.output});
}

int reconstruct(const Request& request, const std::vector<std::string>& command) {
  const Options options = effective_options(request);
  MethodRun run(request, command, OutputKind::mesh);
  run.reconstruct(options);
  run.finish([&](OutputFiles& files, const std::string& path, const WriteOptions& how) {
    return files.add_mesh(path, run.result.mesh, how);
  });
  const Report& report = run.result.report;
  std::ostream& out = run.summary();
  out << printable(request.output) << ": " << grouped(report.points) << " points in " << run.cost() << "\n"
      << run.selection() << describe(report);
  if (report.one_sided)
    out << "  one-sided scan: every line of sight is within "
        << std::lround(report.one_sided->widest_angle * 180 / std::numbers::pi) << " degrees of their mean direction\n";
  if (!report.dropped_components.empty())
    out << "  pieces without support left out: " << report.dropped_components.size() << " (listed in --report)\n";
  return run.status();
}

} // namespace

int reconstruct_verb(const Arguments& arguments) {
  Request request;
  request.ranks = arguments.ranks;
  OptionTable app("Point clouds to a closed, manifold, outward oriented triangle mesh.", "eigencrust reconstruct");
  add_input_options(app, request.input);
  add_output_options(app, request,
                     "Mesh to write (ply obj off stl glb 3mf); of two names without it the second is the result");
  add_smoothing_options(app, request);
  add_method_options(app, request);
  add_run_options(app, request);
  Parsed parsed = parse(app, arguments);
  if (parsed.done) return parsed.status;
  find_output(request, parsed.command);
  return for_each_job(request, OutputKind::mesh, [&](const Request& job) { return reconstruct(job, parsed.command); });
}

} // namespace eigencrust::cli
