// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds that people brought. The files are not part of the project: without them these cases are skipped.
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>

#include <algorithm>

#include "cases.h"
#include "sampling.h"

namespace eigencrust::bench {
namespace {

/// A file of the field data; what is known of the body is its genus and, where not 0, its volume.
Case real_case(const std::string& file, std::string description, double volume, std::int64_t genus) {
  Case c;
  c.group = "field";
  c.name = file.substr(0, file.rfind('.'));
  std::replace(c.name.begin(), c.name.end(), '_', '-');
  c.description = std::move(description);
  c.files = {"field/" + file};
  c.make = [=, path = c.files.front()](Sources& sources, std::uint64_t) {
    Truth truth;
    truth.volume = volume;
    truth.genus = genus;
    return clean_scene(sources.points(path), std::move(truth), sources.threads());
  };
  return c;
}

} // namespace

void add_real_field_cases(std::vector<Case>& cases) {
  struct Row {
    const char *file, *description;
    double volume;
    std::int64_t genus;
  };
  // Right since version 0.1.0; the volumes are its, but that of the frame, which its notched edges made smaller:
  // 7883.7. Screened Poisson through the same points has 7,988 to 8,004 (depths 8 to 10, normals of either surface).
  for (const Row& row :
       {Row{"real_tooth16.npy", "a tooth", 388.8, 0}, Row{"real_wireframe.ply", "a frame of many bars", 8000, 23},
        Row{"real_city_94.ply", "houses from the air", 10'492, 3}}) {
    Case c = real_case(row.file, row.description, row.volume, row.genus);
    c.requirements = {equals("components", 1), equals("genus", static_cast<double>(row.genus)),
                      at_most("volume_error", 0.01)};
    cases.push_back(std::move(c));
  }
  Case c = real_case("real_metatron.ply", "a clean part of many bars with sharp edges", 0, 11);
  c.requirements = {at_most("area", 43'600)};
  cases.push_back(std::move(c));

  c = real_case("real_abc_noisy_00994122.npy", "a machined part, noise of 3 spacings", 0, 0);
  const std::string truth = "field/real_abc_00994122_truth.ply";
  c.files.push_back(truth);
  c.requirements = {at_least("volume_iou", 0.6), equals("warns_of_noise", 1)};
  c.measure_more = [truth](const Scene&, const Result& result, Sources& sources, Figures& figures) {
    figures.set("volume_iou", volume_iou(result.mesh, *sources.truth(truth).mesh, 256, sources.threads()));
    const auto& warnings = result.report.warnings;
    figures.set("warns_of_noise",
                std::any_of(warnings.begin(), warnings.end(),
                            [](const std::string& text) { return text.find("nois") != std::string::npos; })
                    ? 1
                    : 0);
  };
  cases.push_back(std::move(c));
  cases.push_back(real_case("real_city_001.ply", "ground and houses from the air", 0, 0));
  cases.push_back(real_case("real_rotating_lidar.csv", "one turn of a lidar on a car", 0, 0));
}

} // namespace eigencrust::bench
