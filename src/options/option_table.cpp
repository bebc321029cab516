// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include <eigencrust/error.h>
#include <eigencrust/memory_forecast.h>
#include <eigencrust/option_table.h>

#include "options/values.h"

namespace eigencrust {
namespace {

using Kind = OptionEntry::Kind;
using Group = OptionEntry::Group;

std::uint32_t parse_count(const char* what, const std::string& text) {
  const auto count = count_in(text);
  if (!count) reject_value(what, text, "a whole number, 0 or more");
  return *count;
}

bool parse_flag(const std::string& text) {
  if (text == "on" || text == "true") return true;
  if (text != "off" && text != "false") reject_value("flag", text, "on or off");
  return false;
}

std::string flag_text(bool value) { return value ? "on" : "off"; }

std::string points_text(const std::vector<Vec3>& points) {
  std::string text;
  for (const Vec3& p : points)
    text += (text.empty() ? "" : "; ") + shortest(p.x) + "," + shortest(p.y) + "," + shortest(p.z);
  return text.empty() ? "none" : text;
}

void set_tolerance(Options& o, const std::string& text) {
  const auto value = number_in(text);
  if (!value) reject_value("tolerance", text, "a number in (0, 1)");
  o.solver.tolerance = *value;
  o.solver.stop_on_stable_signs = false;
}

void set_stable_share(Options& o, const std::string& text) {
  const auto value = number_in(text);
  if (!value) reject_value("share", text, "a number in (0, 1]");
  o.solver.stable_share = *value;
}

/// The value of that name among those from the first to the last. \throws Error{usage}
template <class Value>
Value parse_value(const char* what, const std::string& text, Value first, Value last) {
  std::string accepted;
  for (int i = static_cast<int>(first); i <= static_cast<int>(last); ++i) {
    const std::string name = to_string(static_cast<Value>(i));
    if (text == name) return static_cast<Value>(i);
    accepted += (accepted.empty() ? "" : ", ") + name;
  }
  reject_value(what, text, "one of " + accepted);
}

void set_global_sign(Options& o, const std::string& text) {
  o.global_sign = parse_value("global sign", text, GlobalSign::vote, GlobalSign::supernode);
}

void set_manifold_rule(Options& o, const std::string& text) {
  o.manifold_rule = parse_value("manifold rule", text, ManifoldRule::cheapest, ManifoldRule::paper);
}

void set_facade(Options& o, const std::string& text) {
  o.detect_facade = text == "auto";
  o.facade.reset();
  if (text != "auto" && text != "off") o.facade = parse_axis(text);
}

std::string facade_text(const Options& o) {
  if (o.facade) return to_string(*o.facade);
  return o.detect_facade ? "auto" : "off";
}

constexpr std::array<OptionEntry, 30> table{{
    {"preset", Kind::choice, Group::method, "robust|paper",
     "robust: the measured best; paper: Kolluri, Shewchuk, O'Brien 2004 to the letter",
     [](Options& o, const std::string& text) { o = Options::of(parse_preset(text)); },
     [](const Options& o) { return to_string(o.preset); }},
    {"method", Kind::choice, Group::method,
     "eigencrust|powercrust|spectral-powercrust|tight-cocone|robust-cocone|spectral-cocone",
     "Which surface: eigencrust, or to compare powercrust, spectral-powercrust, tight-cocone, robust-cocone, "
     "spectral-cocone",
     [](Options& o, const std::string& text) { o.method = parse_method(text); },
     [](const Options& o) { return to_string(o.method); }},
    {"noise", Kind::length, Group::method, "L",
     "Standard deviation of the noise: auto (measured at the samples), off, a length, N%",
     [](Options& o, const std::string& text) { o.noise = parse_length_choice("noise", text); },
     [](const Options& o) { return to_string(o.noise); }},
    {"grid-spacing", Kind::length, Group::method, "L",
     "Diagonal of the scanner's grid squares: auto, off, a length, N%",
     [](Options& o, const std::string& text) { o.grid_spacing = parse_length_choice("grid spacing", text); },
     [](const Options& o) { return to_string(o.grid_spacing); }},
    {"questionable", Kind::choice, Group::method, "before|after|never",
     "Tetrahedra under 4 grid spacings lose their say before or after the first partition, or never",
     [](Options& o, const std::string& text) { o.questionable = parse_questionable(text); },
     [](const Options& o) { return to_string(o.questionable); }},
    {"weights", Kind::choice, Group::method, "evidence|paper",
     "Pole pairs: evidence (isolated samples, which may be outliers, count little) or paper (all count)",
     [](Options& o, const std::string& text) { o.weights = parse_weights(text); },
     [](const Options& o) { return to_string(o.weights); }},
    {"second-stage", Kind::choice, Group::method, "cut|harmonic|eigenvector",
     "How all tetrahedra are settled: cut, or as the paper does: harmonic, eigenvector",
     [](Options& o, const std::string& text) { o.second_stage = parse_second_stage(text); },
     [](const Options& o) { return to_string(o.second_stage); }},
    {"eigensolver", Kind::choice, Group::method, "multigrid|lanczos", "multigrid or lanczos (the slow reference)",
     [](Options& o, const std::string& text) { o.solver.eigensolver = parse_eigensolver(text); },
     [](const Options& o) { return to_string(o.solver.eigensolver); }},
    {"tolerance", Kind::number, Group::method, "X",
     "Residual at which an eigenvector counts as converged; given, signs alone do not stop it", set_tolerance,
     [](const Options& o) { return shortest(o.solver.tolerance); }},
    {"max-steps", Kind::count, Group::method, "N", "Steps of the solver at most",
     [](Options& o, const std::string& text) { o.solver.max_steps = parse_count("number of steps", text); },
     [](const Options& o) { return std::to_string(o.solver.max_steps); }},
    {"manifold", Kind::flag, Group::method, "", "Make the surface a manifold",
     [](Options& o, const std::string& text) { o.manifold = parse_flag(text); },
     [](const Options& o) { return flag_text(o.manifold); }},
    {"components", Kind::choice, Group::method, "KEEP", "Pieces to keep: supported, all, largest or a number",
     [](Options& o, const std::string& text) { o.components = parse_components(text); },
     [](const Options& o) { return to_string(o.components); }},
    {"outside-point", Kind::points, Group::known, "X,Y,Z", "x,y,z of a point known to be outside; repeatable",
     [](Options& o, const std::string& text) { o.outside_points.push_back(parse_point(text)); },
     [](const Options& o) { return points_text(o.outside_points); }},
    {"inside-point", Kind::points, Group::known, "X,Y,Z", "x,y,z of a point known to be inside; repeatable",
     [](Options& o, const std::string& text) { o.inside_points.push_back(parse_point(text)); },
     [](const Options& o) { return points_text(o.inside_points); }},
    {"crossing-depth", Kind::length, Group::method, "L",
     "Where sensors are known: a line of sight crosses what it enters farther than this from its sample; auto or a "
     "length",
     [](Options& o, const std::string& text) { o.crossing_depth = parse_crossing_depth(text); },
     [](const Options& o) { return o.crossing_depth ? shortest(*o.crossing_depth) : std::string("auto"); }},
    {"facade", Kind::choice, Group::method, "auto|off|+x|-x|+y|-y|+z|-z",
     "One-sided scan: auto (found out: rooms and one side from the sensors, ground from how the samples lie), off, or "
     "outside in front along +x -x +y -y +z or -z: the mesh stays open",
     set_facade, facade_text},
    {"base", Kind::flag, Group::method, "", "Close ground or a facade with a flat base behind it: the volume of a pile",
     [](Options& o, const std::string& text) { o.base = parse_flag(text); },
     [](const Options& o) { return flag_text(o.base); }},
    {"trim", Kind::flag, Group::method, "",
     "Leave out triangles that the samples do not bear out: the mesh is then open",
     [](Options& o, const std::string& text) { o.trim = parse_flag(text); },
     [](const Options& o) { return flag_text(o.trim); }},
    {"surface", Kind::choice, Group::smoothing, "auto|samples|fitted|delaunay",
     "Vertices: auto (moved to the middle of the noise where some was measured), fitted (also where the fit itself "
     "finds some), samples (input points), delaunay (input points, no edge flipped)",
     [](Options& o, const std::string& text) { o.surface = parse_surface_kind(text); },
     [](const Options& o) { return to_string(o.surface); }},
    {"smooth", Kind::count, Group::smoothing, "N", "Smoothing steps; vertices then leave the samples",
     [](Options& o, const std::string& text) { o.smooth = parse_count("number of steps", text); },
     [](const Options& o) { return std::to_string(o.smooth); }},
    {"smoothing", Kind::choice, Group::smoothing, "laplacian|taubin", "laplacian or taubin (keeps the volume)",
     [](Options& o, const std::string& text) { o.smoothing = parse_smoothing(text); },
     [](const Options& o) { return to_string(o.smoothing); }},
    {"triangles", Kind::count, Group::smoothing, "N",
     "Make triangles fewer, down to N, and stay as near to the surface as may be; 0: all stay",
     [](Options& o, const std::string& text) { o.triangles = parse_count("number of triangles", text); },
     [](const Options& o) { return std::to_string(o.triangles); }},
    {"max-error", Kind::length, Group::smoothing, "L",
     "Make triangles fewer, nowhere farther off the surface than a length, N% or 'N sigma' (of the noise); off: all "
     "stay",
     [](Options& o, const std::string& text) { o.max_error = parse_surface_length("largest error", text); },
     [](const Options& o) { return to_string(o.max_error); }},
    {"edge", Kind::length, Group::smoothing, "L",
     "Make triangles regular, with edges of about a length, N% or 'N sigma'; off: they stay",
     [](Options& o, const std::string& text) { o.edge = parse_surface_length("length of edges", text); },
     [](const Options& o) { return to_string(o.edge); }},
    {"threads", Kind::count, Group::run, "N", "Threads, 0 for all cores; the result is the same for any number",
     [](Options& o, const std::string& text) { o.threads = parse_count("number of threads", text); },
     [](const Options& o) { return std::to_string(o.threads); }},
    {"max-memory", Kind::bytes, Group::run, "SIZE",
     "Refuse the cloud, before any work, if more memory is forecast: 4G, 500M, bytes",
     [](Options& o, const std::string& text) { o.max_memory = parse_memory_size(text); },
     [](const Options& o) { return o.max_memory == 0 ? std::string("none") : std::to_string(o.max_memory); }},
    {"point-results", Kind::flag, Group::library, "",
     "Also say of every input row whether it belongs to the surface, and its normal",
     [](Options& o, const std::string& text) { o.point_results = parse_flag(text); },
     [](const Options& o) { return flag_text(o.point_results); }},
    {"global-sign", Kind::choice, Group::library, "vote|supernode",
     "How inside is told from outside once the two sides are apart: vote or supernode", set_global_sign,
     [](const Options& o) { return to_string(o.global_sign); }},
    {"manifold-rule", Kind::choice, Group::library, "cheapest|paper",
     "What is relabelled where the surface is no manifold: cheapest or paper", set_manifold_rule,
     [](const Options& o) { return to_string(o.manifold_rule); }},
    {"stable-share", Kind::number, Group::library, "X",
     "Share of all nodes that may still change sign when the solver stops because signs are stable, in (0, 1]",
     set_stable_share, [](const Options& o) { return shortest(o.solver.stable_share); }},
}};

} // namespace

std::span<const OptionEntry> option_table() { return table; }

std::string_view chapter(Group group) {
  switch (group) {
    case Group::known:
      return "What is known beforehand";
    case Group::method:
      return "Method";
    case Group::smoothing:
      return "Results";
    case Group::run:
      return "Running";
    case Group::library:
      return {};
  }
  return {};
}

std::vector<std::string> choices(const OptionEntry& entry) {
  std::vector<std::string> words;
  if (entry.value.find('|') == std::string_view::npos) return words;
  for (std::size_t begin = 0; begin <= entry.value.size();) {
    const std::size_t end = std::min(entry.value.find('|', begin), entry.value.size());
    words.emplace_back(entry.value.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

std::string describe_default(const OptionEntry& entry) {
  const std::string robust = entry.get(Options::of(Preset::robust)), paper = entry.get(Options::of(Preset::paper));
  return robust == paper || entry.name == "preset" ? robust : robust + "; paper: " + paper;
}

void set_option(Options& options, std::string_view name, const std::string& value) {
  std::string dashed(name);
  std::replace(dashed.begin(), dashed.end(), '_', '-');
  std::string names;
  for (const OptionEntry& entry : table) {
    if (entry.name == dashed) return entry.set(options, value);
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw Error(ErrorKind::usage, "options", "there is no option named '" + std::string(name) + "'",
              "use one of " + names);
}

} // namespace eigencrust
