// SPDX-License-Identifier: GPL-3.0-or-later
#include "speed_document.h"

#include <nlohmann/json.hpp>

#include <eigencrust/eigencrust.h>

namespace eigencrust::bench {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const SpeedOutcome& outcome, const WholeTimes& whole) {
  const double seconds = median(whole.seconds), after = whole.seconds_after_delaunay();
  Json stages = Json::array();
  for (const auto& [name, times] : whole.stages)
    stages.push_back(
        {{"name", name}, {"seconds", times}, {"median", median(times)}, {"ratio", outcome.ratio(median(times))}});
  return {{"threads", whole.threads},
          {"seconds", whole.seconds},
          {"median", seconds},
          {"ratio", outcome.ratio(seconds)},
          {"user_seconds", whole.user_seconds},
          {"after_delaunay", after},
          {"ratio_after_delaunay", outcome.ratio(after)},
          {"peak_memory_bytes", whole.peak_memory_bytes},
          {"bytes_per_point", outcome.per_point(static_cast<double>(whole.peak_memory_bytes))},
          {"steps", {{"poles", whole.pole_steps}, {"tetrahedra", whole.tetrahedron_steps}}},
          {"stages", std::move(stages)}};
}

Json json_of(const SpeedOutcome& outcome) {
  Json json{{"name", outcome.item.name}, {"generated", outcome.item.file.empty()}};
  if (!outcome.item.file.empty()) json["file"] = outcome.item.file;
  if (!outcome.skipped.empty()) json["skipped"] = outcome.skipped;
  if (!outcome.error.empty()) json["error"] = outcome.error;
  if (!outcome.measured()) return json;
  json["points"] = outcome.points;
  json["cgal"] = {{"seconds", outcome.cgal.seconds},
                  {"median", median(outcome.cgal.seconds)},
                  {"tetrahedra", outcome.cgal.tetrahedra},
                  {"peak_memory_bytes", outcome.cgal.peak_memory_bytes},
                  {"bytes_per_point", outcome.per_point(static_cast<double>(outcome.cgal.peak_memory_bytes))}};
  json["whole"] = Json::array();
  for (const WholeTimes& whole : outcome.whole) json["whole"].push_back(json_of(outcome, whole));
  return json;
}

} // namespace

std::string to_json(const std::vector<SpeedOutcome>& outcomes, const Machine& machine, unsigned runs,
                    const std::vector<std::string>& command) {
  Json cases = Json::array(), bandwidth = Json::array(), growth = Json::array();
  for (const auto& [threads, rate] : machine.bandwidth)
    bandwidth.push_back({{"threads", threads}, {"bytes_per_second", rate}});
  for (const SpeedOutcome& outcome : outcomes) cases.push_back(json_of(outcome));
  for (const Growth& g : growth_of(outcomes))
    growth.push_back({{"name", g.name},
                      {"points", g.points},
                      {"threads", g.threads},
                      {"cgal", g.cgal},
                      {"delaunay", g.delaunay},
                      {"rest", g.rest},
                      {"rest_to_cgal", g.rest_to_cgal()}});
  const Json json{{"schema", 1},
                  {"version", version()},
                  {"command", command},
                  {"runs", runs},
                  {"machine",
                   {{"processor", machine.processor},
                    {"processors", machine.processors},
                    {"memory_bandwidth", std::move(bandwidth)}}},
                  {"cases", std::move(cases)},
                  {"growth", std::move(growth)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace eigencrust::bench
