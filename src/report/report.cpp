// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/report.h>

#include <sys/resource.h>
#include <nlohmann/json.hpp>
#include <numbers>

#include <eigencrust/eigencrust.h>
#include <eigencrust/measures.h>

namespace eigencrust {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

Json json_of(const MeshSummary& m) {
  constexpr std::size_t listed = 100;
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(listed, m.component_list.size()); ++i) {
    const ComponentSummary& c = m.component_list[i];
    list.push_back({{"vertices", c.vertices}, {"triangles", c.triangles}, {"euler", c.euler}, {"genus", c.genus}});
  }
  Json json{{"vertices", m.vertices},
            {"triangles", m.triangles},
            {"unreferenced_vertices", m.unreferenced_vertices},
            {"boundary_edges", m.boundary_edges},
            {"boundary_loops", m.boundary_loops},
            {"nonmanifold_edges", m.nonmanifold_edges},
            {"nonmanifold_vertices", m.nonmanifold_vertices},
            {"inconsistent_edges", m.inconsistent_edges},
            {"degenerate_triangles", m.degenerate_triangles},
            {"self_intersections", m.self_intersections < 0 ? Json() : Json(m.self_intersections)},
            {"all_self_intersections", m.self_intersections < 0 ? Json() : Json(m.all_self_intersections)},
            {"components", m.components},
            {"genus", m.genus},
            {"euler", m.euler},
            {"volume", m.closed() ? Json(m.volume) : Json()},
            {"area", m.area}};
  if (!m.bounds.empty()) json["bounds"] = {{"min", json_of(m.bounds.min)}, {"max", json_of(m.bounds.max)}};
  json["component_list"] = std::move(list);
  return json;
}

Json json_of(const Options& o) {
  Json points_out = Json::array(), points_in = Json::array();
  for (const Vec3& p : o.outside_points) points_out.push_back(json_of(p));
  for (const Vec3& p : o.inside_points) points_in.push_back(json_of(p));
  return {{"preset", to_string(o.preset)},
          {"weights", to_string(o.weights)},
          {"eigensolver", to_string(o.solver.eigensolver)},
          {"stop_on_stable_signs", o.solver.stop_on_stable_signs},
          {"stable_share", o.solver.stable_share},
          {"tolerance", o.solver.tolerance},
          {"max_steps", o.solver.max_steps},
          {"method", to_string(o.method)},
          {"second_stage", to_string(o.second_stage)},
          {"grid_spacing", to_string(o.grid_spacing)},
          {"noise", to_string(o.noise)},
          {"questionable", to_string(o.questionable)},
          {"global_sign", to_string(o.global_sign)},
          {"manifold", o.manifold},
          {"manifold_rule", to_string(o.manifold_rule)},
          {"components", to_string(o.components)},
          {"surface", to_string(o.surface)},
          {"smooth", o.smooth},
          {"smoothing", to_string(o.smoothing)},
          {"triangles", o.triangles},
          {"max_error", to_string(o.max_error)},
          {"edge", to_string(o.edge)},
          {"outside_points", std::move(points_out)},
          {"inside_points", std::move(points_in)},
          {"crossing_depth", o.crossing_depth ? Json(*o.crossing_depth) : Json("auto")},
          {"facade", o.facade          ? to_string(*o.facade)
                     : o.detect_facade ? "auto"
                                       : "off"},
          {"base", o.base},
          {"trim", o.trim},
          {"point_results", o.point_results},
          {"threads", o.threads},
          {"max_memory", o.max_memory == 0 ? Json() : Json(o.max_memory)}};
}

Json json_of(const StageReport& s) {
  Json json{{"name", s.name}, {"seconds", s.seconds}, {"peak_memory_bytes", s.peak_memory_bytes}};
  for (const auto& [name, value] : s.counts) {
    const bool whole = value == static_cast<double>(static_cast<std::int64_t>(value));
    json[name] = whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
  }
  return json;
}

Json json_of(const PartitionReport& p) {
  return {{"stage", p.stage},
          {"nodes", p.nodes},
          {"edges", p.edges},
          {"eigenvalue", p.eigenvalue},
          {"residual", p.residual},
          {"iterations", p.iterations},
          {"sign_changes", p.sign_changes},
          {"components", p.components},
          {"free_components", p.free_components},
          {"status", to_string(p.status)}};
}

Json json_of(const std::optional<OneSided>& scan) {
  if (!scan) return {};
  return {{"direction", json_of(scan->direction)}, {"widest_angle", scan->widest_angle * 180 / std::numbers::pi}};
}

Json json_of(const PassedSheetsReport& sheets) {
  return {
      {"sheets", sheets.sheets}, {"samples", sheets.samples}, {"at", sheets.sheets > 0 ? json_of(sheets.at) : Json()}};
}

Json json_of(const BridgedReport& bridged) {
  return {{"places", bridged.places},
          {"widest", bridged.widest},
          {"at", bridged.places > 0 ? json_of(bridged.at) : Json()}};
}

Json json_of(const std::optional<MovedReport>& moved) {
  if (!moved) return {};
  return {{"vertices", moved->vertices},
          {"median", moved->median},
          {"q99", moved->q99},
          {"max", moved->max},
          {"strays", moved->strays}};
}

Json json_of(const DistanceReport& distances) { return {{"mean", distances.mean}, {"max", distances.max}}; }

Json json_of(const std::optional<SimplifiedReport>& simplified) {
  if (!simplified) return {};
  const SimplifiedReport& s = *simplified;
  Json json{{"before", {{"vertices", s.vertices_before}, {"triangles", s.triangles_before}}},
            {"after", {{"vertices", s.vertices}, {"triangles", s.triangles}}},
            {"error", {{"to_full", json_of(s.deviation.to_full)}, {"from_full", json_of(s.deviation.from_full)}}},
            {"max_error", s.max_error > 0 ? Json(s.max_error) : Json()},
            {"edge", s.edge > 0 ? Json(s.edge) : Json()},
            {"held", s.held}};
  json["shape"] =
      s.shape
          ? Json{{"least_angle", s.shape->least_angle}, {"low_angle", s.shape->low_angle}, {"edges", s.shape->edges}}
          : Json();
  return json;
}

Json json_of(const std::optional<Base>& base) {
  if (!base) return {};
  return {{"vertices", base->vertices}, {"level", base->level}, {"volume_above_rim", base->volume_above_rim}};
}

/// What is known of the sensors of a file; null: nothing.
Json json_of_sensors(const InputFile& file) {
  if (file.sensors.empty()) return {};
  constexpr std::size_t listed = 100;
  Json places = Json::array();
  for (std::size_t i = 0; i < std::min(listed, file.sensors.size()); ++i)
    places.push_back({{file.sensors[i].at_infinity ? "direction" : "position", json_of(file.sensors[i].place)}});
  return {{"count", file.sensors.size()}, {"points", file.points_with_sensor}, {"places", std::move(places)}};
}

Json json_of_input(const Report& report) {
  Json files = Json::array();
  for (const InputFile& f : report.files)
    files.push_back({{"path", f.path}, {"sha256", f.sha256}, {"points", f.points}, {"sensor", json_of_sensors(f)}});
  Json json{{"files", std::move(files)},
            {"points", report.points},
            {"duplicates", report.duplicates},
            {"nonfinite", report.nonfinite},
            {"spacing", report.spacing}};
  json["bounds"] = {{"min", json_of(report.bounds.min)}, {"max", json_of(report.bounds.max)}};
  return json;
}

} // namespace

std::string to_json(const MeshSummary& mesh) { return json_of(mesh).dump(2); }

std::string to_json(const MeshSummary& mesh, const MeshMeasures& m, double metres) {
  Json json = json_of(mesh);
  json["unit_metres"] = metres > 0 ? Json(metres) : Json();
  json["smallest_angle"] = m.smallest_angle;
  json["largest_angle"] = m.largest_angle;
  json["worst_aspect"] = m.worst_aspect;
  json["edges"] = {{"shortest", m.shortest_edge}, {"median", m.median_edge}, {"longest", m.longest_edge}};
  json["thinnest_wall"] = m.thinnest_wall ? Json(*m.thinnest_wall) : Json();
  json["thinnest_place"] = m.thinnest_wall ? json_of(m.thinnest_place) : Json();
  json["wall_rays"] = m.wall_rays;
  json["printability"] = printability(mesh, m, metres);
  return json.dump(2);
}

std::string to_json(const Report& report) {
  Json stages = Json::array(), partitions = Json::array(), dropped = Json::array();
  for (const StageReport& s : report.stages) stages.push_back(json_of(s));
  for (const PartitionReport& p : report.partitions) partitions.push_back(json_of(p));
  for (const DroppedComponent& d : report.dropped_components)
    dropped.push_back(
        {{"vertices", d.vertices}, {"triangles", d.triangles}, {"support", d.support}, {"centre", json_of(d.centre)}});
  const Json json{
      {"schema", 1},
      {"version", version()},
      {"command", report.command},
      {"input", json_of_input(report)},
      {"options", json_of(report.options)},
      {"stages", std::move(stages)},
      {"partitions", std::move(partitions)},
      {"mesh", json_of(report.mesh)},
      {"grid_spacing", report.grid_spacing},
      {"dropped_components", std::move(dropped)},
      {"undecided_nodes", report.undecided_nodes},
      {"sight_lines", report.sight_lines},
      {"contradicting_rays", report.contradicting_rays},
      {"scene", to_string(report.surroundings.kind)},
      {"facade", report.surroundings.kind == SceneKind::facade ? Json(to_string(report.surroundings.front)) : Json()},
      {"one_sided", json_of(report.one_sided)},
      {"base", json_of(report.base)},
      {"unsupported_area", report.unsupported_area},
      {"bridged", json_of(report.bridged)},
      {"passed_sheets", json_of(report.passed_sheets)},
      {"moved", json_of(report.moved)},
      {"simplified", json_of(report.simplified)},
      {"seconds", report.seconds},
      {"peak_memory_bytes", report.peak_memory_bytes},
      {"peak_disk_bytes", report.peak_disk_bytes},
      {"warnings", report.warnings},
      {"broken_guarantees", report.broken_guarantees}};
  // Paths may hold bytes that are no UTF-8; a report must still come out.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

const char* to_string(SolverStatus status) {
  switch (status) {
    case SolverStatus::converged:
      return "converged";
    case SolverStatus::signs_stable:
      return "signs_stable";
    case SolverStatus::consistent:
      return "consistent";
    case SolverStatus::not_converged:
      return "not_converged";
    case SolverStatus::trivial:
      return "trivial";
  }
  return "?";
}

} // namespace eigencrust
