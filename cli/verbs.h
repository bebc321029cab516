// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of verbs, from which the overview, the man page and the completions are made.
#pragma once

#include <array>
#include <span>

#include "command.h"

namespace eigencrust::cli {

struct Verb {
  const char* name;
  const char* arguments; ///< as in the overview
  const char* summary;
  int (*call)(const Arguments&);
  const char* alias_of = nullptr; ///< an old name, not listed
};

std::span<const Verb> all_verbs();
/// null: there is none of that name
const Verb* find_verb(const std::string& name);
/// Hands the options that a verb declares to `describe`, and does nothing else.
void describe_options(const Verb& verb, const std::function<void(const OptionTable&)>& describe);

/// What the command line said, verb included. \return the exit status; errors are thrown
int run_command(const Arguments& all);

struct ExitStatus {
  int status;
  const char* meaning;
};
inline constexpr std::array<ExitStatus, 7> exit_statuses{{{0, "done"},
                                                          {2, "usage"},
                                                          {3, "input unreadable or unusable, output not writable"},
                                                          {4, "memory refused or exhausted"},
                                                          {5, "no surface"},
                                                          {6, "a guarantee was not met"},
                                                          {130, "cancelled"}}};

/// Verbs, examples and exit statuses.
std::string overview();

} // namespace eigencrust::cli
