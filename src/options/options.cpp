// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/options.h>

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <eigencrust/error.h>

#include "options/values.h"

namespace eigencrust {
namespace {

template <class Value, std::size_t n>
using Names = std::array<std::pair<Value, const char*>, n>;

constexpr Names<Preset, 2> presets{{{Preset::robust, "robust"}, {Preset::paper, "paper"}}};
constexpr Names<Method, 6> methods{{{Method::eigencrust, "eigencrust"},
                                    {Method::powercrust, "powercrust"},
                                    {Method::spectral_powercrust, "spectral-powercrust"},
                                    {Method::tight_cocone, "tight-cocone"},
                                    {Method::robust_cocone, "robust-cocone"},
                                    {Method::spectral_cocone, "spectral-cocone"}}};
constexpr Names<Weights, 2> weights_names{{{Weights::evidence, "evidence"}, {Weights::paper, "paper"}}};
constexpr Names<Eigensolver, 2> eigensolvers{
    {{Eigensolver::multigrid, "multigrid"}, {Eigensolver::lanczos, "lanczos"}}};
constexpr Names<SecondStage, 3> second_stages{
    {{SecondStage::cut, "cut"}, {SecondStage::harmonic, "harmonic"}, {SecondStage::eigenvector, "eigenvector"}}};
constexpr Names<Questionable, 3> questionables{
    {{Questionable::before, "before"}, {Questionable::after, "after"}, {Questionable::never, "never"}}};
constexpr Names<GlobalSign, 2> global_signs{{{GlobalSign::vote, "vote"}, {GlobalSign::supernode, "supernode"}}};
constexpr Names<ManifoldRule, 2> manifold_rules{{{ManifoldRule::cheapest, "cheapest"}, {ManifoldRule::paper, "paper"}}};
constexpr Names<SurfaceKind, 4> surface_kinds{{{SurfaceKind::automatic, "auto"},
                                               {SurfaceKind::samples, "samples"},
                                               {SurfaceKind::fitted, "fitted"},
                                               {SurfaceKind::delaunay, "delaunay"}}};
constexpr Names<Smoothing, 2> smoothings{{{Smoothing::laplacian, "laplacian"}, {Smoothing::taubin, "taubin"}}};
constexpr Names<Axis, 6> axes{{{Axis::plus_x, "+x"},
                               {Axis::minus_x, "-x"},
                               {Axis::plus_y, "+y"},
                               {Axis::minus_y, "-y"},
                               {Axis::plus_z, "+z"},
                               {Axis::minus_z, "-z"}}};

constexpr Names<SceneKind, 3> scene_kinds{
    {{SceneKind::body, "body"}, {SceneKind::interior, "interior"}, {SceneKind::facade, "facade"}}};

template <class Value, std::size_t n>
std::string name_of(const Names<Value, n>& names, Value value) {
  for (const auto& [v, name] : names)
    if (v == value) return name;
  return "?";
}

template <class Value, std::size_t n>
Value parse(const Names<Value, n>& names, const std::string& what, const std::string& text) {
  std::string accepted;
  for (const auto& [v, name] : names) {
    if (text == name) return v;
    accepted += (accepted.empty() ? "" : ", ") + std::string(name);
  }
  reject_value(what, text, "one of " + accepted);
}

} // namespace

std::optional<double> LengthChoice::given(double diagonal) const {
  if (kind == Kind::automatic) return std::nullopt;
  return kind == Kind::off ? 0 : kind == Kind::percent ? value / 100 * diagonal : value;
}

double SurfaceLength::resolve(double diagonal, double sigma) const {
  switch (kind) {
    case Kind::off:
      return 0;
    case Kind::length:
      return value;
    case Kind::percent:
      return value / 100 * diagonal;
    case Kind::sigma:
      return value * sigma;
  }
  return 0;
}

Options Options::of(Preset preset) {
  Options options;
  options.preset = preset;
  if (preset == Preset::paper) {
    options.solver.stop_on_stable_signs = false;
    options.solver.tolerance = 1e-6;
    options.solver.max_steps = 300;
    options.second_stage = SecondStage::eigenvector;
    options.questionable = Questionable::after;
    options.global_sign = GlobalSign::supernode;
    options.weights = Weights::paper;
    options.manifold_rule = ManifoldRule::paper;
    options.components.kind = KeepComponents::Kind::all;
    options.surface = SurfaceKind::delaunay;
  }
  return options;
}

std::string to_string(Preset value) { return name_of(presets, value); }
std::string to_string(Method value) { return name_of(methods, value); }
std::string to_string(Weights value) { return name_of(weights_names, value); }
std::string to_string(Eigensolver value) { return name_of(eigensolvers, value); }
std::string to_string(SecondStage value) { return name_of(second_stages, value); }
std::string to_string(Questionable value) { return name_of(questionables, value); }
std::string to_string(GlobalSign value) { return name_of(global_signs, value); }
std::string to_string(ManifoldRule value) { return name_of(manifold_rules, value); }
std::string to_string(SurfaceKind value) { return name_of(surface_kinds, value); }
std::string to_string(Smoothing value) { return name_of(smoothings, value); }
std::string to_string(SceneKind value) { return name_of(scene_kinds, value); }
std::string to_string(Axis value) { return name_of(axes, value); }

std::string to_string(const LengthChoice& value) {
  switch (value.kind) {
    case LengthChoice::Kind::automatic:
      return "auto";
    case LengthChoice::Kind::off:
      return "off";
    case LengthChoice::Kind::length:
      return shortest(value.value);
    case LengthChoice::Kind::percent:
      return shortest(value.value) + "%";
  }
  return "?";
}

std::string to_string(const SurfaceLength& value) {
  switch (value.kind) {
    case SurfaceLength::Kind::off:
      return "off";
    case SurfaceLength::Kind::length:
      return shortest(value.value);
    case SurfaceLength::Kind::percent:
      return shortest(value.value) + "%";
    case SurfaceLength::Kind::sigma:
      return shortest(value.value) + " sigma";
  }
  return "?";
}

std::string to_string(const KeepComponents& value) {
  switch (value.kind) {
    case KeepComponents::Kind::supported:
      return "supported";
    case KeepComponents::Kind::all:
      return "all";
    case KeepComponents::Kind::largest:
      return "largest";
    case KeepComponents::Kind::count:
      return std::to_string(value.count);
  }
  return "?";
}

Preset parse_preset(const std::string& text) { return parse(presets, "preset", text); }
Method parse_method(const std::string& text) { return parse(methods, "method", text); }
Weights parse_weights(const std::string& text) { return parse(weights_names, "kind of weights", text); }
Eigensolver parse_eigensolver(const std::string& text) { return parse(eigensolvers, "eigensolver", text); }
SecondStage parse_second_stage(const std::string& text) { return parse(second_stages, "second stage", text); }
Questionable parse_questionable(const std::string& text) {
  return parse(questionables, "time for questionable poles", text);
}
SurfaceKind parse_surface_kind(const std::string& text) { return parse(surface_kinds, "kind of surface", text); }
Smoothing parse_smoothing(const std::string& text) { return parse(smoothings, "smoothing method", text); }
Axis parse_axis(const std::string& text) { return parse(axes, "axis", text); }

LengthChoice parse_length_choice(const std::string& what, const std::string& text) {
  if (text == "auto") return {LengthChoice::Kind::automatic, 0};
  if (text == "off") return {LengthChoice::Kind::off, 0};
  const bool percent = !text.empty() && text.back() == '%';
  const auto value = number_in(percent ? std::string_view(text).substr(0, text.size() - 1) : std::string_view(text));
  if (!value || *value <= 0) reject_value(what, text, "auto, off, a positive length or N%");
  return {percent ? LengthChoice::Kind::percent : LengthChoice::Kind::length, *value};
}

SurfaceLength parse_surface_length(const std::string& what, const std::string& text) {
  using Kind = SurfaceLength::Kind;
  if (text == "off") return {};
  std::string_view number = text;
  Kind kind = Kind::length;
  for (const auto& [unit, unit_kind] : {std::pair{"%", Kind::percent}, std::pair{"sigma", Kind::sigma}})
    if (number.ends_with(unit)) {
      kind = unit_kind;
      number.remove_suffix(std::string_view(unit).size());
      while (number.ends_with(' ')) number.remove_suffix(1);
      break;
    }
  const auto value = number_in(number);
  if (!value || *value <= 0) reject_value(what, text, "off, a positive length, N% or 'N sigma'");
  return {kind, *value};
}

KeepComponents parse_components(const std::string& text) {
  if (text == "supported") return {KeepComponents::Kind::supported, 1};
  if (text == "all") return {KeepComponents::Kind::all, 1};
  if (text == "largest") return {KeepComponents::Kind::largest, 1};
  const auto count = count_in(text);
  if (!count || *count == 0) reject_value("choice of components", text, "supported, all, largest or a positive number");
  return {KeepComponents::Kind::count, *count};
}

std::optional<double> parse_crossing_depth(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const auto value = number_in(text);
  if (!value || *value < 0) reject_value("crossing depth", text, "auto or a length, 0 or more");
  return value;
}

Vec3 parse_point(const std::string& text) {
  std::array<double, 3> value{};
  std::size_t begin = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t end = i < 2 ? text.find(',', begin) : text.size();
    const auto v =
        end == std::string::npos ? std::nullopt : number_in(std::string_view(text).substr(begin, end - begin));
    if (!v) reject_value("point", text, "three numbers x,y,z");
    value[i] = *v;
    begin = end + 1;
  }
  return {value[0], value[1], value[2]};
}

void check_options(const Options& options) {
  const auto require = [](bool fine, const char* cause, const char* remedy) {
    if (!fine) throw Error(ErrorKind::usage, "options", cause, remedy);
  };
  for (const LengthChoice& length : {options.grid_spacing, options.noise}) {
    const bool is_given = length.kind == LengthChoice::Kind::length || length.kind == LengthChoice::Kind::percent;
    require(!is_given || (length.value > 0 && std::isfinite(length.value)),
            "the grid spacing or the noise is not positive", "give a positive length or percentage");
  }
  for (const SurfaceLength& length : {options.max_error, options.edge})
    require(length.kind == SurfaceLength::Kind::off || (length.value > 0 && std::isfinite(length.value)),
            "the largest error or the length of edges is not positive", "give a positive length or percentage");
  const bool fewer = options.triangles > 0 || options.max_error.kind != SurfaceLength::Kind::off;
  const bool others = fewer || options.edge.kind != SurfaceLength::Kind::off;
  require(!fewer || options.edge.kind == SurfaceLength::Kind::off,
          "--edge says how large triangles are, so that --triangles and --max-error cannot", "give one or the other");
  require(!others || options.manifold, "only manifolds are simplified and remeshed", "leave out --no-manifold");
  require(options.components.kind != KeepComponents::Kind::count || options.components.count > 0,
          "no component is to be kept", "keep at least one");
  require(options.solver.tolerance > 0 && options.solver.tolerance < 1, "the solver's tolerance is not in (0, 1)",
          "use 1e-6");
  require(options.solver.stable_share > 0 && options.solver.stable_share <= 1, "the stable share is not in (0, 1]",
          "use 2e-4");
  require(options.solver.max_steps >= 1, "the solver may take no step", "allow at least one");
  require(!options.crossing_depth || (*options.crossing_depth >= 0 && std::isfinite(*options.crossing_depth)),
          "the crossing depth is negative", "give a length, 0 or more");
  require(!options.base || !options.trim, "--base closes what --trim opens", "leave out one of them");
  const bool by_crust = options.method != Method::eigencrust && options.method != Method::spectral_cocone;
  require(!by_crust || (!options.facade && !options.point_results),
          "façades, normals and outliers are found by eigencrust only", "leave out --method");
  const bool of_poles = options.method == Method::powercrust || options.method == Method::spectral_powercrust;
  require(!by_crust || (!options.base && !options.trim), "crusts are closed, and have no rim for --base or --trim",
          "leave out --method");
  require(!of_poles || options.surface != SurfaceKind::fitted,
          "the vertices of a power crust are no samples, and are not fitted", "leave out --surface");
  require(!by_crust || !others, "crusts are no manifolds, and are neither simplified nor remeshed",
          "leave out --method");
  require(options.smooth <= 1000, "more than 1000 smoothing steps", "use fewer");
  require(options.threads <= 1024, "more than 1024 threads", "use fewer");
  for (const auto* points : {&options.outside_points, &options.inside_points})
    for (const Vec3& p : *points)
      require(is_finite(p), "a point named inside or outside is not finite", "give finite numbers");
}

} // namespace eigencrust
