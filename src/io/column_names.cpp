// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/column_names.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "io/text.h"

namespace eigencrust::io {
namespace {

using Words = std::vector<std::string>;

/// Without what stands in brackets, which is a unit: "X Location (mm)" -> x location.
std::string without_units(std::string_view name) {
  std::string result;
  int depth = 0;
  for (const char c : name) {
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (depth == 0) result += c;
    if (c == ')' || c == ']' || c == '}') depth = std::max(0, depth - 1);
  }
  return lower_case(trim(result));
}

Words words_of(std::string_view name) {
  Words words;
  std::string word;
  for (const char c : without_units(name)) {
    const bool separates =
        is_blank(c) || c == '_' || c == '-' || c == ':' || c == '.' || c == '/' || c == '"' || c == '\'';
    if (!separates) word += c;
    if (separates && !word.empty()) words.push_back(std::exchange(word, {}));
  }
  if (!word.empty()) words.push_back(std::move(word));
  return words;
}

/// Words that say "coordinate" and nothing else, and units.
bool says_nothing(const std::string& word) {
  constexpr std::array<std::string_view, 26> words = {
      "coordinate", "coordinates", "coord", "coords", "location", "loc", "position",  "pos",  "point",
      "points",     "pt",          "xyz",   "world",  "global",   "utm", "cartesian", "val",  "value",
      "m",          "mm",          "cm",    "km",     "ft",       "in",  "inch",      "meter"};
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The axis that the name speaks of, 0 to 2, or -1. \param cost words beside the axis' own letter
int axis_of(const std::string& name, std::size_t& cost) {
  const Words words = words_of(name);
  int axis = -1;
  bool is_point = false;
  cost = words.size();
  for (const std::string& word : words) {
    int found = -1;
    for (const char letter : {'x', 'y', 'z'}) {
      const bool before = word.size() > 1 && word.front() == letter && says_nothing(word.substr(1));
      const bool behind = word.size() > 2 && word.back() == letter && says_nothing(word.substr(0, word.size() - 1));
      if ((word.size() == 1 && word.front() == letter) || before || behind) found = letter - 'x';
    }
    if (found >= 0 && axis >= 0) return -1;
    if (found >= 0) axis = found;
    if (found < 0 && says_nothing(word)) is_point = true;
    const bool is_number =
        &word == &words.back() && words.size() > 1 && word.size() == 1 && word[0] >= '0' && word[0] <= '2';
    if (found < 0 && !says_nothing(word) && !is_number) return -1;
    if (is_number && axis < 0 && is_point) return word[0] - '0';
  }
  return axis;
}

/// Easting, northing and height, as surveyors say.
int survey_axis_of(const std::string& name) {
  constexpr std::array<std::string_view, 5> east = {"easting", "east", "e", "rechtswert", "ostwert"};
  constexpr std::array<std::string_view, 5> north = {"northing", "north", "n", "hochwert", "nordwert"};
  constexpr std::array<std::string_view, 10> up = {"height", "elevation", "elev",  "altitude", "alt",
                                                   "h",      "z",         "hoehe", "höhe",     "up"};
  const Words words = words_of(name);
  int axis = -1;
  const auto has = [](const auto& list, const std::string& word) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  for (const std::string& word : words) {
    const int found = has(east, word) ? 0 : has(north, word) ? 1 : has(up, word) ? 2 : -1;
    if (found >= 0 && axis >= 0) return -1;
    if (found < 0 && !says_nothing(word)) return -1;
    axis = std::max(axis, found);
  }
  return axis;
}

/// A word that can be typed as a part of --columns and means nothing there.
bool can_be_typed(const std::string& name) {
  constexpr std::string_view others = "_.:+/()[]%#";
  std::size_t cost = 0;
  return !name.empty() && name != "-" && axis_of(name, cost) < 0 && std::all_of(name.begin(), name.end(), [&](char c) {
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || others.find(c) < 4;
  });
}

} // namespace

std::optional<std::array<std::size_t, 3>> find_axes(std::span<const std::string> names) {
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::array<std::size_t, 3> found{none, none, none}, cost{none, none, none};
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::size_t words = 0;
    const int axis = axis_of(names[i], words);
    if (axis < 0) continue;
    // "x" beside "X (m)": the plain one.
    const std::size_t price =
        2 * words + (equal_ignoring_case(names[i], std::string(1, static_cast<char>('x' + axis))) ? 0 : 1);
    const auto k = static_cast<std::size_t>(axis);
    if (price < cost[k]) {
      cost[k] = price;
      found[k] = i;
    }
  }
  const auto complete = [&] { return std::find(found.begin(), found.end(), none) == found.end(); };
  if (complete()) return found;
  found = {none, none, none};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int axis = survey_axis_of(names[i]);
    if (axis >= 0 && found[static_cast<std::size_t>(axis)] == none) found[static_cast<std::size_t>(axis)] = i;
  }
  if (complete()) return found;
  return std::nullopt;
}

bool names_degrees(std::span<const std::string> names) {
  return std::any_of(names.begin(), names.end(), [](const std::string& name) {
    const std::string lower = lower_case(name);
    for (const char* word : {"longitude", "latitude", "lon", "lat", "lng"})
      if (lower == word || lower.starts_with(std::string(word) + " ") || lower.starts_with(std::string(word) + "_") ||
          lower.starts_with(std::string(word) + "("))
        return true;
    return false;
  });
}

std::string columns_to_type(std::span<const std::string> names, const std::vector<bool>& numeric, std::size_t first) {
  constexpr std::size_t most_repeated = 16; // more would be hard to read
  std::string result;
  std::size_t axes = 0;
  for (std::size_t i = 0; i < numeric.size(); ++i) {
    const bool is_axis = i >= first && numeric[i] && axes < 3;
    if (axes == 3 && (names.empty() || i >= most_repeated)) break;
    result += i > 0 ? "," : "";
    if (is_axis)
      result += static_cast<char>('x' + axes++);
    else
      result += numeric[i] && i < names.size() && can_be_typed(names[i]) ? names[i] : "-";
  }
  return result;
}

} // namespace eigencrust::io
