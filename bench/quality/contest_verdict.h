// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Who is better in what, and whether a surface holds.
#pragma once

#include <string>
#include <vector>

#include "contest_runner.h"

namespace eigencrust::bench {

/// 684834 -> "684,834"; negative -> "".
std::string grouped_digits(double value);

/// A column of a table of contestants.
struct ContestColumn {
  std::string title;
  /// What is compared, smaller is better; negative: not known.
  double (*badness)(const ContestRun&, const ContestRun& ours, const ContestOutcome&);
  std::string (*shown)(const ContestRun&, const ContestRun& ours, const ContestOutcome&);
  double margin = 0; ///< by which share it has to be better to count: what is measured by chance
};
const std::vector<ContestColumn>& contest_columns();

/// Is the run better than ours in that column?
bool wins(const ContestColumn& column, const ContestRun& run, const ContestOutcome& outcome);

/// Run of the program as it comes.
const ContestRun& our_run(const ContestOutcome& outcome);
/// Is it this program, with whatever options, that makes the eigencrust?
bool is_ours(const ContestRun& run);

/// What is wrong with a surface: not one closed piece of the true genus, more than 1 % of the truth missing, a volume
/// that differs by more than that share from `undisturbed_volume` (0: not known). Empty: it holds.
std::string fault(const ContestRun& run, const ContestOutcome& outcome, double undisturbed_volume, double margin);

} // namespace eigencrust::bench
