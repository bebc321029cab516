// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace eigencrust::bench {

std::optional<double> Figures::find(std::string_view name) const {
  const auto found = std::find_if(values_.begin(), values_.end(), [&](const auto& v) { return v.first == name; });
  return found == values_.end() ? std::nullopt : std::optional(found->second);
}

bool Requirement::met(const Figures& figures) const {
  const std::optional<double> value = figures.find(figure);
  if (!value) return false;
  switch (relation) { // false for NaN
    case Relation::equal:
      return *value == bound;
    case Relation::at_most:
      return *value <= bound;
    case Relation::at_least:
      return *value >= bound;
  }
  return false;
}

std::string describe(const Requirement& requirement) {
  const char* sign = requirement.relation == Relation::equal     ? " = "
                     : requirement.relation == Relation::at_most ? " <= "
                                                                 : " >= ";
  return requirement.figure + sign + short_number(requirement.bound);
}

std::vector<std::string> missed(const std::vector<Requirement>& requirements, const Figures& figures) {
  std::vector<std::string> list;
  for (const Requirement& r : requirements) {
    if (r.met(figures)) continue;
    const std::optional<double> value = figures.find(r.figure);
    list.push_back(describe(r) + (value ? " (is " + short_number(*value) + ")" : " (not measured)"));
  }
  return list;
}

std::string short_number(double value) {
  const bool whole = std::isfinite(value) && std::fabs(value) < 1e15 && value == std::round(value);
  char text[64];
  std::snprintf(text, sizeof text, whole ? "%.0f" : "%.4g", value);
  return text;
}

} // namespace eigencrust::bench
