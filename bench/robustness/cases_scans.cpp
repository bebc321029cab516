// SPDX-License-Identifier: GPL-3.0-or-later
// Cases made from raw scans. Their unit is the metre; figures in millimetres.
#include <eigencrust/io.h>

#include "cases.h"
#include "degradations.h"
#include "reference_measures.h"
#include "sampling.h"

namespace eigencrust::bench {
namespace {

constexpr double millimetre = 1e-3, in_millimetres = 1e3;
const std::string bunny = "bunny/bunny_raw.ply", bunny_scans = "bunny/scan_index.u8";

/// The scan as it is: which points are strays is not known, only how many bodies there are.
Scene raw_scene(Sources& sources, const std::string& file) {
  Scene scene = clean_scene(sources.points(file), {}, sources.threads());
  scene.true_samples = 0;
  return scene;
}

/// The raw bunny beside what the preset `robust` makes of it undisturbed.
Scene bunny_scene(Sources& sources) {
  Truth truth = sources.reference(bunny);
  truth.components = 1;
  truth.genus = 0;
  return clean_scene(sources.points(bunny), std::move(truth), sources.threads());
}

Case scan_case(std::string group, std::string name, std::string description, std::vector<std::string> files) {
  Case c;
  c.group = std::move(group);
  c.name = std::move(name);
  c.description = std::move(description);
  c.files = std::move(files);
  c.large = true;
  c.view = view_of("");
  return c;
}

Case noisy_bunny(double sigma, double max_genus, double max_volume_error) {
  const std::string text = short_number(sigma) + "mm";
  Case c = scan_case("bunny", "bunny+" + text, "the raw bunny, noise in every coordinate of " + text, {bunny});
  c.make = [=](Sources& sources, std::uint64_t seed) {
    Scene scene = bunny_scene(sources);
    add_noise(scene.cloud.points, sigma * millimetre, seed);
    return scene;
  };
  c.requirements = {equals("components", 1),
                    max_genus > 0 ? at_most("genus", max_genus) : equals("genus", 0),
                    at_least("within_tolerance_of_reference", 0.98),
                    at_least("reference_within_tolerance", 0.98),
                    at_most("tip_1", 2 * sigma),
                    at_most("tip_2", 2 * sigma),
                    at_most("volume_error", max_volume_error)};
  c.measure_more = [=](const Scene& scene, const Result& result, Sources& sources, Figures& figures) {
    const double tolerance = (2 * sigma + 0.3) * millimetre, tip = 3 * millimetre;
    measure_tolerance(result.mesh, *scene.truth.mesh, tolerance, sources.threads(), figures);
    measure_tips(result.mesh, *scene.truth.mesh, tip, in_millimetres, sources.threads(), figures);
  };
  return c;
}

} // namespace

void add_bunny_cases(std::vector<Case>& cases) {
  Case raw = scan_case("bunny", "bunny", "the raw bunny, ten scans in one file", {bunny});
  raw.make = [](Sources& sources, std::uint64_t) { return raw_scene(sources, bunny); };
  raw.requirements = {equals("components", 1), equals("genus", 0)};
  cases.push_back(std::move(raw));

  cases.push_back(noisy_bunny(0.5, 0, 0.03));
  cases.push_back(noisy_bunny(0.7, 0, 0.03));
  cases.push_back(noisy_bunny(1.0, 0, 0.03));
  cases.push_back(noisy_bunny(1.4, 0, 0.08));
  cases.push_back(noisy_bunny(2.0, 2, 0.08));

  Case displaced = scan_case("bunny", "bunny-displaced",
                             "the raw bunny, each scan moved by 0.5 mm in a random direction", {bunny, bunny_scans});
  displaced.make = [](Sources& sources, std::uint64_t seed) {
    Scene scene = bunny_scene(sources);
    std::vector<Vec3>& points = scene.cloud.points;
    displace_scans(points, read_scan_index(sources.path(bunny_scans), points.size()), 0.5 * millimetre, seed);
    return scene;
  };
  displaced.requirements = {equals("components", 1), equals("genus", 0)};
  cases.push_back(std::move(displaced));
}

void add_raw_cases(std::vector<Case>& cases) {
  const std::string armadillo = "armadillo/armadillo_standflip_raw.ply", model = "meshes/armadillo.obj";
  const auto raw_case = [](std::string name, std::string description, std::vector<std::string> files) {
    Case c = scan_case("raw", std::move(name), std::move(description), std::move(files));
    c.make = [file = c.files.front()](Sources& sources, std::uint64_t) { return raw_scene(sources, file); };
    c.requirements = {equals("components", 1)};
    return c;
  };
  Case c = raw_case("armadillo-raw", "the raw armadillo, 11 scans, about 1 % strays all around", {armadillo, model});
  c.requirements.insert(c.requirements.end(), {equals("genus", 0), at_most("model_q99", 2), at_most("model_max", 10)});
  c.measure_more = [model](const Scene&, const Result& result, Sources& sources, Figures& figures) {
    measure_against_model(result.mesh, *sources.truth(model).mesh, in_millimetres, sources.threads(), figures);
  };
  c.view = view_of(armadillo);
  cases.push_back(std::move(c));

  c = raw_case("dragon-raw", "the raw dragon, 30 scans, strays from the backdrop",
               {"dragon/dragon_stand_side_raw.ply"});
  c.requirements.push_back(at_most("genus", 2));
  cases.push_back(std::move(c));
  c = raw_case("happy-raw", "the raw Happy Buddha, 30 scans", {"happy/happy_stand_side_raw.ply"});
  c.requirements.push_back(at_most("genus", 20));
  cases.push_back(std::move(c));
}

} // namespace eigencrust::bench
