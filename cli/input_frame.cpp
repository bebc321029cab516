// SPDX-License-Identifier: GPL-3.0-or-later
// Units, scales and the shift of the inputs.
#include <array>
#include <cmath>
#include <cstdlib>

#include "command.h"

namespace eigencrust::cli {
namespace {

struct Unit {
  const char* name;
  double metres;
};
/// Inch and foot are those of the International Yard and Pound Agreement of 1959.
constexpr std::array<Unit, 8> units = {
    {{"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2}, {"dm", 1e-1}, {"m", 1}, {"km", 1e3}, {"in", 0.0254}, {"ft", 0.3048}}};

[[noreturn]] void fail(const std::string& cause, const std::string& remedy) {
  throw Error(ErrorKind::usage, "command line", cause, remedy);
}

double parse_scale(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value) || !(value > 0))
    fail("'" + text + "' is no scale", "give a number above 0, for example --scale 0.001");
  return value;
}

} // namespace

double parse_unit(const std::string& text) {
  std::string names;
  for (const Unit& unit : units) {
    if (text == unit.name) return unit.metres;
    names += std::string(names.empty() ? "" : ", ") + unit.name;
  }
  fail("'" + text + "' is no unit", "the units are " + names + "; any other length in metres goes with --scale");
}

void add_frame_options(OptionTable& app, InputOptions& options) {
  app.begin_chapter("Reading");
  app.add_option("--unit", options.unit,
                 "Unit of the inputs (um mm cm dm m km in ft): they are turned into metres; once for all, or for each "
                 "input in order")
      ->type_name("UNIT");
  app.add_option("--scale", options.scale,
                 "Factor for the coordinates of the inputs; once for all, or for each input in order")
      ->type_name("X");
  app.add_option("--shift", options.shift,
                 "x,y,z that is added to the coordinates, after the scale, e.g. -512000,-5412000,0; lengths and places "
                 "of other options are then those of the result")
      ->type_name("X,Y,Z");
}

double scale_of_input(const InputOptions& options, std::size_t input) {
  if (!options.unit.empty() && !options.scale.empty())
    fail("--unit and --scale exclude one another", "a unit is a scale, too: --scale 0.001 is --unit mm");
  const std::vector<std::string>& given = options.unit.empty() ? options.scale : options.unit;
  if (given.empty()) return 1;
  if (given.size() != 1 && given.size() != options.paths.size())
    fail("there are " + std::to_string(given.size()) + " units or scales for " + std::to_string(options.paths.size()) +
             " inputs",
         "give one for all, or one for each input in order");
  const std::string& text = given[given.size() == 1 ? 0 : input];
  return options.unit.empty() ? parse_scale(text) : parse_unit(text);
}

Vec3 shift_of_inputs(const InputOptions& options) {
  if (options.shift.empty()) return {};
  const Vec3 shift = parse_point(options.shift);
  if (!is_finite(shift)) fail("the shift '" + options.shift + "' is not finite", "give three finite numbers x,y,z");
  return shift;
}

double metres_of_result(const InputOptions& options) { return options.unit.empty() ? 0 : 1; }

std::vector<std::string> frame_comments(const InputOptions& options) {
  std::string text;
  for (const std::string& unit : options.unit) text += " " + unit;
  if (!text.empty()) return {"metres, from inputs in" + text};
  for (const std::string& scale : options.scale) text += " " + scale;
  return text.empty() ? std::vector<std::string>() : std::vector<std::string>{"scale" + text};
}

} // namespace eigencrust::cli
