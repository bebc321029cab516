// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs a program and measures what it cost.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace eigencrust::bench {

struct ChildRun {
  double wall_seconds = 0; ///< from before the fork to the end of the child
  double user_seconds = 0, system_seconds = 0;
  std::uint64_t peak_memory_bytes = 0; ///< largest resident set
  std::string output;                  ///< what it wrote to stdout
  bool stopped = false;                ///< it took longer than it was given
};

struct ChildLimits {
  double seconds = 0;           ///< wall time after which the child is killed; 0: no limit
  double processor_seconds = 0; ///< the same of its processor time, in whole seconds
  std::uint64_t bytes = 0;      ///< of its address space; 0: no limit
};

/// Runs command[0] with these arguments; stderr is passed through. The peak of a child counts what it shares
/// with this process before it becomes another program, so this process must stay small itself.
/// \throws Error{guarantee} unless it ends with status 0 or is stopped
ChildRun run_child(const std::vector<std::string>& command, const ChildLimits& limits = {});

} // namespace eigencrust::bench
