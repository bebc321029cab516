// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>
#include <nlohmann/json.hpp>

#include <eigencrust/metrics.h>

#include "command.h"

namespace eigencrust::cli {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const DistanceStatistics& d) {
  return {{"count", d.count}, {"mean", d.mean}, {"rms", d.rms}, {"median", d.median},
          {"q90", d.q90},     {"q95", d.q95},   {"q99", d.q99}, {"max", d.max}};
}

Json json_of(const Comparison& c) {
  return {{"to_reference", json_of(c.to_reference)},
          {"from_reference", json_of(c.from_reference)},
          {"hausdorff", c.hausdorff},
          {"threshold", c.threshold},
          {"precision", c.precision},
          {"recall", c.recall},
          {"f_score", c.f_score},
          {"normal_consistency", c.normal_consistency},
          {"oriented_normal_consistency", c.oriented_normal_consistency},
          {"volume_iou", c.volume_iou < 0 ? Json() : Json(c.volume_iou)}};
}

void print(const char* what, const DistanceStatistics& d) {
  std::cout << "  " << what << " mean " << rounded(d.mean) << ", median " << rounded(d.median) << ", 95 % "
            << rounded(d.q95) << ", 99 % " << rounded(d.q99) << ", max " << rounded(d.max) << "\n";
}

} // namespace

int compare_verb(const Arguments& arguments) {
  std::string mesh_path, reference_path;
  bool json = false;
  CompareOptions options;
  OptionTable app("How far a mesh is from a reference: distances between points spread over both surfaces.",
                  "eigencrust compare");
  app.add_option("MESH", mesh_path, "Mesh to judge (ply obj off stl glb 3mf)")->required()->type_name(file_to_read);
  app.add_option("REFERENCE", reference_path, "Mesh taken for the truth")->required()->type_name(file_to_read);
  app.add_option("--samples", options.samples, "Points on each surface")->capture_default_str();
  app.add_option("--seed", options.seed, "Seed of their places")->capture_default_str();
  app.add_option("--threshold", options.threshold, "Distance of the F-score; 0: 1 % of the reference's diagonal")
      ->capture_default_str();
  app.add_option("--threads", options.threads, "Threads, 0 for all cores")->capture_default_str();
  app.add_flag("--json", json, "Print the figures as JSON");
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  const Comparison c = compare(read_mesh(mesh_path), read_mesh(reference_path), options);
  if (json) {
    std::cout << json_of(c).dump(2) << "\n";
    return 0;
  }
  std::cout << printable(mesh_path) << " against " << printable(reference_path) << "\n";
  print("to the reference:  ", c.to_reference);
  print("from the reference:", c.from_reference);
  std::cout << "  F-score " << rounded(c.f_score) << " at " << rounded(c.threshold) << " (precision "
            << rounded(c.precision) << ", recall " << rounded(c.recall) << "), normals "
            << rounded(c.normal_consistency) << ", volume IoU "
            << (c.volume_iou < 0 ? "not defined (one is open)" : rounded(c.volume_iou)) << "\n";
  return 0;
}

} // namespace eigencrust::cli
