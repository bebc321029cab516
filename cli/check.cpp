// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>

#include <eigencrust/measures.h>

#include "command.h"
#include "messages.h"

namespace eigencrust::cli {
namespace {

/// Angles, edges and the sentence.
std::string describe(const MeshSummary& summary, const MeshMeasures& m, std::size_t triangles, double metres) {
  const auto length = [&](double value) { return length_in_words(value, metres); };
  std::string text = "  angles " + rounded(m.smallest_angle) + " to " + rounded(m.largest_angle) +
                     " degrees, worst aspect ratio " + rounded(m.worst_aspect) + "\n  edges " +
                     length(m.shortest_edge) + " to " + length(m.longest_edge) + ", median " + length(m.median_edge) +
                     "\n";
  if (m.thinnest_wall)
    text += "  thinnest wall " + length(*m.thinnest_wall) + ", at " +
            show_point(m.thinnest_place, distance(summary.bounds.min, summary.bounds.max)) +
            (m.wall_rays < triangles ? ", looked for from " + grouped(m.wall_rays) + " of the triangles" : "") + "\n";
  return text + "  " + printability(summary, m, metres) + "\n";
}

} // namespace

int check_verb(const Arguments& arguments) {
  std::string path, unit;
  bool json = false, no_intersections = false, no_walls = false;
  unsigned threads = 0;
  OptionTable app("Is a mesh closed, manifold and oriented? Vertices with equal coordinates count as one.",
                  "eigencrust check");
  app.add_option("MESH", path, "Mesh to look at (ply obj off stl glb 3mf)")->required()->type_name(file_to_read);
  app.add_flag("--json", json, "Print the figures as JSON");
  app.add_flag("--no-self-intersections", no_intersections, "Skip the dearest of the checks");
  app.add_flag("--no-walls", no_walls, "Skip the search for the thinnest wall");
  app.add_option("--unit", unit,
                 "Unit of the mesh (um mm cm dm m km in ft), for lengths in words; else that of the file")
      ->type_name("UNIT");
  app.add_option("--threads", threads, "Threads, 0 for all cores")->capture_default_str();
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  MeshNotes notes;
  const TriangleMesh mesh = read_mesh(path, &notes);
  if (!unit.empty()) notes.metres = parse_unit(unit);
  for (const std::string& note : notes.notes) print_warning(path + ": " + note);
  const MeshSummary summary = validate(mesh, {.self_intersections = !no_intersections, .threads = threads});
  const MeshMeasures measures =
      measure(mesh, summary, {.most_rays = no_walls ? 0u : MeasureOptions{}.most_rays, .threads = threads});
  if (json)
    std::cout << to_json(summary, measures, notes.metres) << "\n";
  else
    std::cout << printable(path) << "\n"
              << cli::describe(summary) << describe(summary, measures, mesh.triangles.size(), notes.metres);
  const bool fine = summary.closed() && summary.manifold() && summary.oriented();
  return fine ? 0 : static_cast<int>(ErrorKind::guarantee);
}

} // namespace eigencrust::cli
