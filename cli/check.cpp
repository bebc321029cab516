// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>

#include "command.h"

namespace eigencrust::cli {

int check_verb(const Arguments& arguments) {
  std::string path;
  bool json = false, no_intersections = false;
  unsigned threads = 0;
  OptionTable app("Is a mesh closed, manifold and oriented? Vertices with equal coordinates count as one.",
                  "eigencrust check");
  app.add_option("MESH", path, "Mesh to look at (ply obj off stl)")->required()->type_name(file_to_read);
  app.add_flag("--json", json, "Print the figures as JSON");
  app.add_flag("--no-self-intersections", no_intersections, "Skip the dearest of the checks");
  app.add_option("--threads", threads, "Threads, 0 for all cores")->capture_default_str();
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  const TriangleMesh mesh = read_mesh(path);
  const MeshSummary summary = validate(mesh, {.self_intersections = !no_intersections, .threads = threads});
  if (json)
    std::cout << to_json(summary) << "\n";
  else
    std::cout << printable(path) << "\n" << describe(summary);
  const bool fine = summary.closed() && summary.manifold() && summary.oriented();
  return fine ? 0 : static_cast<int>(ErrorKind::guarantee);
}

} // namespace eigencrust::cli
