// SPDX-License-Identifier: GPL-3.0-or-later
#include "contest_verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <eigencrust/error.h>

namespace eigencrust::bench {
namespace {

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string length(double value) { return value < 0 ? "" : text("%.2f", value); }

double genus_error(const ContestRun& run, const ContestOutcome& outcome) {
  if (run.figures.pieces < 0) return -1;
  if (run.figures.genus < 0) return 1e9; // a piece has no two sides
  return std::abs(run.figures.genus - static_cast<double>(std::max<std::int64_t>(0, outcome.genus)));
}

std::string ratio(double value, double unit) { return value > 0 && unit > 0 ? text("%.2f", value / unit) : ""; }

using Run = const ContestRun&;
using Outcome = const ContestOutcome&;
template <double ContestFigures::*figure>
double of(Run run, Run, Outcome) {
  return run.figures.*figure;
}
template <double ContestFigures::*figure>
std::string counted(Run run, Run, Outcome) {
  return grouped_digits(run.figures.*figure);
}
template <double ContestFigures::*figure>
std::string measured(Run run, Run, Outcome) {
  return length(run.figures.*figure);
}

double volume_error(Run run, Run, Outcome outcome) {
  if (outcome.volume <= 0 || run.figures.volume <= 0) return -1;
  return std::abs(run.figures.volume - outcome.volume) / outcome.volume;
}

} // namespace

std::string grouped_digits(double value) {
  if (value < 0) return "";
  std::string digits = text("%.0f", value);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
  return digits;
}

const std::vector<ContestColumn>& contest_columns() {
  using F = ContestFigures;
  constexpr double chance = 0.02; // distances are between random points, times differ from run to run
  static const auto nothing = [](Run, Run, Outcome) { return -1.0; };
  static const std::vector<ContestColumn> columns{
      {"triangles", nothing, counted<&F::triangles>},
      {"pieces",
       [](Run r, Run, Outcome o) {
         return r.figures.pieces < 0 ? -1 : std::abs(r.figures.pieces - static_cast<double>(o.components));
       },
       counted<&F::pieces>},
      {"genus", [](Run r, Run, Outcome o) { return genus_error(r, o); },
       [](Run r, Run, Outcome) {
         return r.figures.pieces < 0 ? "" : r.figures.genus < 0 ? "one-sided" : grouped_digits(r.figures.genus);
       }},
      {"boundary edges", of<&F::boundary>, counted<&F::boundary>},
      {"non-manifold", of<&F::nonmanifold>, counted<&F::nonmanifold>},
      {"crossings", of<&F::crossings>, counted<&F::crossings>},
      {"outliers", of<&F::outliers>, counted<&F::outliers>},
      {"missed %", of<&F::missed>,
       [](Run r, Run, Outcome) { return r.figures.missed < 0 ? "" : text("%.1f", 100 * r.figures.missed); }, chance},
      {"to truth", of<&F::to_truth>, measured<&F::to_truth>, chance},
      {"from truth", of<&F::from_truth>, measured<&F::from_truth>, chance},
      {"edges", of<&F::edges>, measured<&F::edges>, chance},
      {"volume %", volume_error,
       [](Run r, Run, Outcome o) {
         return o.volume <= 0 || r.figures.volume <= 0 ? ""
                                                       : text("%+.1f", 100 * (r.figures.volume - o.volume) / o.volume);
       },
       chance},
      {"agree %", nothing,
       [](Run r, Run, Outcome) { return r.figures.agree <= 0 ? "" : text("%.1f", 100 * r.figures.agree); }},
      {"but for turned %", nothing,
       [](Run r, Run, Outcome) {
         return r.figures.agree_but_turned <= 0 ? "" : text("%.1f", 100 * r.figures.agree_but_turned);
       }},
      {"time", [](Run r, Run, Outcome) { return r.note.empty() ? r.seconds : -1; },
       [](Run r, Run ours, Outcome) { return r.note.empty() ? ratio(r.seconds, ours.seconds) : ""; }, chance},
      {"memory", [](Run r, Run, Outcome) { return r.note.empty() ? r.bytes : -1; },
       [](Run r, Run ours, Outcome) { return r.note.empty() ? ratio(r.bytes, ours.bytes) : ""; }, chance}};
  return columns;
}

const ContestRun& our_run(const ContestOutcome& outcome) {
  const auto found = std::ranges::find(outcome.runs, ourselves, &ContestRun::name);
  if (found == outcome.runs.end())
    throw Error(ErrorKind::input, outcome.name, "the outcome lacks this program", "run the case again");
  return *found;
}

bool is_ours(const ContestRun& run) { return run.name.starts_with(ourselves); }

bool wins(const ContestColumn& column, const ContestRun& run, const ContestOutcome& outcome) {
  const ContestRun& ours = our_run(outcome);
  constexpr double scrap = 0.1; // what misses so much more of the samples, or of the truth, is better in nothing
  const ContestFigures &f = run.figures, &of_ours = ours.figures;
  if (is_ours(run) || f.missed > scrap + std::max(0.0, of_ours.missed) ||
      f.missing > scrap + std::max(0.0, of_ours.missing))
    return false;
  const double theirs = column.badness(run, ours, outcome), own = column.badness(ours, ours, outcome);
  return theirs >= 0 && own >= 0 && theirs < (1 - column.margin) * own;
}

std::string fault(const ContestRun& run, const ContestOutcome& outcome, double undisturbed_volume, double margin) {
  constexpr double most_missing = 0.01;
  const ContestFigures& f = run.figures;
  if (!run.note.empty()) return run.note;
  if (f.boundary > 0) return "open";
  if (f.pieces != static_cast<double>(outcome.components)) return grouped_digits(f.pieces) + " pieces";
  if (genus_error(run, outcome) != 0) return "genus " + grouped_digits(f.genus);
  if (f.missing > most_missing) return text("%.0f", 100 * f.missing) + " % missing";
  if (undisturbed_volume > 0 && std::abs(f.volume / undisturbed_volume - 1) > margin)
    return "volume " + text("%+.0f", 100 * (f.volume / undisturbed_volume - 1)) + " %";
  return {};
}

} // namespace eigencrust::bench
