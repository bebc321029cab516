// SPDX-License-Identifier: GPL-3.0-or-later
#include "speed_table.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace eigencrust::bench {
namespace {

std::string text_of(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string row_of(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + cell + " |";
  return row + "\n";
}

/// The first column is text, the others are numbers.
std::string head_of(const std::vector<std::string>& cells) {
  std::string rule = "|---|";
  for (std::size_t i = 1; i < cells.size(); ++i) rule += "---:|";
  return row_of(cells) + rule + "\n";
}

std::string count_of(std::size_t count, const char* one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string about(const Machine& machine, unsigned runs) {
  std::ostringstream text;
  text << machine.processor << ", " << count_of(machine.processors, "processor") << ". Memory bandwidth (triad):";
  for (const auto& [threads, rate] : machine.bandwidth)
    text << (threads == machine.bandwidth.front().first ? " " : ", ") << text_of("%.1f", rate / 1e9) << " GB/s on "
         << count_of(threads, "thread");
  text << ". Medians of " << count_of(runs, "run") << ".\n";
  return text.str();
}

std::string table_of_clouds(const std::vector<SpeedOutcome>& outcomes) {
  const std::vector<std::string> head{"cloud",
                                      "points",
                                      "threads",
                                      "CGAL s",
                                      "whole s",
                                      "whole / CGAL",
                                      "after Delaunay / CGAL",
                                      "bytes per point",
                                      "CGAL bytes per point",
                                      "steps, poles",
                                      "steps, tetrahedra"};
  std::string table = head_of(head);
  for (const SpeedOutcome& o : outcomes) {
    for (const WholeTimes& w : o.measured() ? o.whole : std::vector<WholeTimes>{})
      table +=
          row_of({o.item.name, std::to_string(o.points), std::to_string(w.threads),
                  text_of("%.2f", median(o.cgal.seconds)), text_of("%.2f", median(w.seconds)),
                  text_of("%.2f", o.ratio(median(w.seconds))), text_of("%.2f", o.ratio(w.seconds_after_delaunay())),
                  text_of("%.0f", o.per_point(static_cast<double>(w.peak_memory_bytes))),
                  text_of("%.0f", o.per_point(static_cast<double>(o.cgal.peak_memory_bytes))),
                  std::to_string(w.pole_steps), std::to_string(w.tetrahedron_steps)});
    if (o.measured()) continue;
    std::vector<std::string> cells{o.item.name, o.error.empty() ? "skipped: " + o.skipped : "error: " + o.error};
    cells.resize(head.size());
    table += row_of(cells);
  }
  return table;
}

std::string table_of_stages(const std::vector<SpeedOutcome>& outcomes) {
  std::vector<std::string> names, head{"stage"};
  for (const SpeedOutcome& o : outcomes)
    for (const WholeTimes& w : o.whole) {
      if (!o.measured()) continue;
      head.push_back(o.item.name + ", " + std::to_string(w.threads));
      for (const auto& [name, times] : w.stages) // a stage that only some clouds have comes where these have it
        if (std::find(names.begin(), names.end(), name) == names.end())
          names.insert(std::find(names.begin(), names.end(), "other"), name);
    }
  std::string table = head_of(head);
  for (const std::string& name : names) {
    std::vector<std::string> cells{name};
    for (const SpeedOutcome& o : outcomes)
      for (const WholeTimes& w : o.whole)
        if (o.measured()) cells.push_back(text_of("%.3f", o.ratio(w.stage_seconds(name))));
    table += row_of(cells);
  }
  return table;
}

std::string table_of_growth(const std::vector<Growth>& growth) {
  std::string table = head_of({"cloud", "threads", "CGAL", "own Delaunay", "rest", "rest / CGAL"});
  for (const Growth& g : growth)
    table += row_of({g.name, std::to_string(g.threads), text_of("%.2f", g.cgal), text_of("%.2f", g.delaunay),
                     text_of("%.2f", g.rest), text_of("%.2f", g.rest_to_cgal())});
  return table;
}

} // namespace

std::string to_markdown(const std::vector<SpeedOutcome>& outcomes, const Machine& machine, unsigned runs) {
  std::string text = "# Speed\n\n" + about(machine, runs);
  text +=
      "\nCGAL: the sequential Delaunay triangulation of the same points in the same run, insertion alone. Whole: the\n"
      "command with default options, from the start of its process to its end. After Delaunay: all stages behind that\n"
      "one, without writing. Bytes per point: largest resident memory of the process.\n\n" +
      table_of_clouds(outcomes);
  text +=
      "\n## Stages\n\nSeconds in seconds of CGAL's triangulation; cloud and threads in the head. `other`: starting,\n"
      "reading, hashing and writing.\n\n" +
      table_of_stages(outcomes);
  const std::vector<Growth> growth = growth_of(outcomes);
  if (growth.size() > 1)
    text +=
        "\n## Growth\n\nSeconds per point of the generated clouds, those of the first row being 1. Rest: the whole "
        "without\n"
        "the Delaunay stage; in the last column the triangulation's own growth is taken out.\n\n" +
        table_of_growth(growth);
  return text;
}

} // namespace eigencrust::bench
