// SPDX-License-Identifier: GPL-3.0-or-later
#include "table.h"

#include <algorithm>
#include <array>
#include <functional>

namespace eigencrust::bench {
namespace {

struct GroupText {
  const char *group, *title;
};
constexpr std::array<GroupText, 9> groups{{{"outliers", "Vertices of clean meshes among outliers"},
                                           {"bumpy", "Noise and outliers around a surface known by formula"},
                                           {"bunny", "The raw bunny, more noise, displaced scans"},
                                           {"raw", "Other raw scans"},
                                           {"missing", "Caps cut off"},
                                           {"bodies", "Two bodies, a cavity, a thin sheet"},
                                           {"density", "Uneven density"},
                                           {"noise", "Noise alone"},
                                           {"field", "Parts, thin walls and what else people bring"}}};

/// A column that shows one figure of each run.
struct Column {
  const char *title, *figure;
  double factor;
};
constexpr std::array<Column, 9> columns{{{"components", "components", 1},
                                         {"genus", "genus", 1},
                                         {"kept %", "true_samples_kept", 100},
                                         {"mean", "to_truth_mean", 1},
                                         {"95 %", "to_truth_q95", 1},
                                         {"Hausdorff", "hausdorff", 1},
                                         {"far %", "far_vertices", 100},
                                         {"volume %", "volume_error", 100},
                                         {"wrong deep", "wrong_deep_tetrahedra", 1}}};
/// Figures of single cases, named in the last column but one.
constexpr std::array<const char*, 20> further{"patch_area",
                                              "patch_q95_of_diagonal",
                                              "within_tolerance_of_reference",
                                              "reference_within_tolerance",
                                              "tip_1",
                                              "tip_2",
                                              "model_mean",
                                              "model_q99",
                                              "model_max",
                                              "model_from_q99",
                                              "model_from_max",
                                              "wrong_deep_share",
                                              "area_error",
                                              "sharp_edges_kept",
                                              "clean_rows_kept",
                                              "flat_caps",
                                              "volume_iou",
                                              "faces_scanner",
                                              "warns_of_noise",
                                              "warns_of_filling"};

/// Appends `part` to a list.
void join(std::string& list, const char* separator, const std::string& part) {
  if (!list.empty()) list += separator;
  list += part;
}

/// As code in Markdown.
std::string quoted(std::string text) { return text.insert(0, 1, '`') += '`'; }

/// What `of` says of each run, side by side; once when all say the same and it is nothing.
std::string side_by_side(const Outcome& outcome, const std::function<std::string(const Run&)>& of) {
  std::string text;
  bool any = false;
  for (const Run& run : outcome.runs) {
    const std::string one = of(run);
    any = any || !one.empty();
    join(text, " / ", one.empty() ? std::string("–") : one);
  }
  return any ? text : "";
}

std::string three_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) >= 1000 ? "%.0f" : "%.3g", value);
  return text;
}

std::string verdict(const Outcome& outcome, const Run& run) {
  if (!run.excused.empty()) return "excused: " + run.excused;
  if (!run.error.empty()) return "error: " + run.error;
  if (run.missed.empty()) return outcome.item.requirements.empty() ? "none set" : "met";
  std::string text;
  for (const std::string& m : run.missed) join(text, ", ", m);
  return "missed: " + text;
}

/// Text that cannot end a cell or a line.
std::string cell(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '|') safe += '\\';
    safe += c == '\n' ? ' ' : c;
  }
  return safe;
}

std::string row_of(const Outcome& outcome) {
  std::string row = "| " + cell(outcome.item.name) + " | ";
  if (!outcome.skipped.empty()) {
    for (std::size_t i = 0; i < columns.size() + 3; ++i) row += "| ";
    return row + "skipped: " + cell(outcome.skipped) + " |\n";
  }
  row += std::to_string(outcome.points) + " | ";
  for (const Column& c : columns)
    row += side_by_side(outcome,
                        [&](const Run& run) {
                          const auto value = run.figures.find(c.figure);
                          return value ? three_digits(*value * c.factor) : std::string();
                        }) +
           " | ";
  row += side_by_side(
             outcome,
             [](const Run& run) { return run.time_ratio() > 0 ? three_digits(run.time_ratio()) : std::string(); }) +
         " | ";
  std::string more;
  for (const char* figure : further) {
    const std::string values = side_by_side(outcome, [&](const Run& run) {
      const auto value = run.figures.find(figure);
      return value ? three_digits(*value) : std::string();
    });
    if (!values.empty()) join(more, "; ", std::string(figure) + " " + values);
  }
  row += more + " | ";
  std::string verdicts;
  for (const Run& run : outcome.runs) join(verdicts, " / ", cell(verdict(outcome, run)));
  return row + verdicts + " |\n";
}

std::string requirements_of(const Outcome& outcome) {
  std::string text;
  for (const Requirement& r : outcome.item.requirements) join(text, ", ", describe(r));
  if (!outcome.item.excuse.empty()) text += "; or words on why not (" + outcome.item.excuse + ")";
  return text.empty() ? "none set" : text;
}

/// Cases that ask the same are listed together.
std::string requirement_list(const std::vector<const Outcome*>& outcomes) {
  std::vector<std::pair<std::string, std::string>> lines; // requirement, names
  for (const Outcome* o : outcomes) {
    const std::string text = requirements_of(*o);
    const auto found = std::find_if(lines.begin(), lines.end(), [&](const auto& l) { return l.first == text; });
    if (found == lines.end())
      lines.emplace_back(text, quoted(o->item.name));
    else
      join(found->second, " ", quoted(o->item.name));
  }
  std::string list;
  for (const auto& [text, names] : lines) list += "- " + text + ": " + names + "\n";
  return list;
}

std::string group_table(const char* title, const std::vector<const Outcome*>& outcomes) {
  std::string text =
      "\n## " + std::string(title) + "\n\nMust show:\n\n" + requirement_list(outcomes) + "\n| case | points |";
  for (const Column& c : columns) text += std::string(" ") + c.title + " |";
  text += " time | further figures | requirement |\n|---|---:|";
  for (std::size_t i = 0; i < columns.size() + 1; ++i) text += "---:|";
  text += "---|---|\n";
  for (const Outcome* o : outcomes) text += row_of(*o);
  return text;
}

std::string introduction(const std::vector<Outcome>& outcomes, const std::vector<Preset>& presets,
                         const std::string& selection) {
  std::string command = "eigencrust-robustness", names;
  for (const Preset p : presets) {
    command += " --preset " + to_string(p);
    join(names, " / ", quoted(to_string(p)));
  }
  if (!selection.empty()) command += " " + selection;
  std::string counts;
  for (std::size_t i = 0; i < presets.size(); ++i) {
    std::size_t run = 0, met = 0;
    for (const Outcome& o : outcomes) {
      if (!o.skipped.empty() || o.item.requirements.empty()) continue;
      ++run;
      met += o.runs[i].good();
    }
    join(counts, ", ",
         quoted(to_string(presets[i])) + " meets its requirement in " + std::to_string(met) + " of " +
             std::to_string(run) + " cases");
  }
  return "# Robustness\n\n"
         "Generated; to make it again:\n\n    " +
         command +
         " --json FILE --table docs/robustness.md\n\n"
         "The same seeds give the same clouds: the JSON holds a fingerprint of each, every figure and every option.\n\n"
         "Summary: " +
         counts +
         ".\n\n"
         "Cells show " +
         names +
         ". Lengths are in spacings: the median distance of a true sample to its nearest\n"
         "other one before noise. *components* and *genus* are of the result, the genus summed over as many of the\n"
         "largest components as the truth has; *kept*: share of the true samples that are vertices of the surface;\n"
         "*mean*, *95 %*: distance from the surface to the truth; *Hausdorff*: the greatest distance either way;\n"
         "*far*: vertices more than 2 spacings from the truth; *volume*: error; *wrong deep*: tetrahedra with the\n"
         "wrong label among those whose circumcentre is in the box and more than 3 spacings from the surface;\n"
         "*time*: of the whole run, the Delaunay stage of the same run being 1. Of the bunny the truth is what the\n"
         "preset `robust` makes of the scan without added noise. Figures named tip and model are millimetres.\n";
}

} // namespace

std::string to_markdown(const std::vector<Outcome>& outcomes, const std::vector<Preset>& presets,
                        const std::string& selection) {
  std::string text = introduction(outcomes, presets, selection);
  for (const auto& [group, title] : groups) {
    std::vector<const Outcome*> members;
    for (const Outcome& o : outcomes)
      if (o.item.group == group) members.push_back(&o);
    if (!members.empty()) text += group_table(title, members);
  }
  return text;
}

} // namespace eigencrust::bench
