// SPDX-License-Identifier: GPL-3.0-or-later
#include "document.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include <eigencrust/eigencrust.h>

namespace eigencrust::bench {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(); }

std::string hexadecimal(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

Json json_of(const Run& run) {
  Json figures = Json::object(), ratios = Json::object();
  for (const auto& [name, value] : run.figures.all()) figures[name] = json_of(value);
  const double delaunay = run.stage_seconds("delaunay");
  for (const StageReport& s : run.report.stages)
    if (delaunay > 0) ratios[s.name] = s.seconds / delaunay;
  Json json{{"preset", to_string(run.preset)},
            {"met", run.good()},
            {"missed", run.missed},
            {"excused", run.excused},
            {"error", run.error.empty() ? Json() : Json(run.error)},
            {"figures", std::move(figures)},
            {"seconds", run.report.seconds},
            {"seconds_per_delaunay", run.time_ratio()},
            {"stages_per_delaunay", std::move(ratios)}};
  if (run.error.empty()) json["report"] = Json::parse(to_json(run.report));
  return json;
}

Json json_of(const Outcome& outcome) {
  const Case& item = outcome.item;
  Json requirements = Json::array(), runs = Json::array();
  for (const Requirement& r : item.requirements) requirements.push_back(describe(r));
  for (const Run& run : outcome.runs) runs.push_back(json_of(run));
  Json json{{"group", item.group}, {"name", item.name}, {"description", item.description},
            {"files", item.files}, {"seed", item.seed}, {"requirements", std::move(requirements)}};
  if (!outcome.skipped.empty()) {
    json["skipped"] = outcome.skipped;
    return json;
  }
  json["points"] = outcome.points;
  json["true_samples"] = outcome.true_samples;
  json["spacing"] = outcome.spacing;
  json["cloud_fingerprint"] = hexadecimal(outcome.fingerprint);
  json["truth"] = {{"components", outcome.true_components}, {"genus", outcome.true_genus}};
  json["runs"] = std::move(runs);
  return json;
}

} // namespace

std::string to_json(const std::vector<Outcome>& outcomes, const std::vector<std::string>& command) {
  Json cases = Json::array();
  for (const Outcome& outcome : outcomes) cases.push_back(json_of(outcome));
  const Json json{{"schema", 1}, {"version", version()}, {"command", command}, {"cases", std::move(cases)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace eigencrust::bench
