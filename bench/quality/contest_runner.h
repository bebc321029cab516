// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the contestants of a case one after another on the same cloud, and keeps what came of it.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "contest_cases.h"
#include "contest_scene.h"
#include "contestants.h"

namespace eigencrust::bench {

struct ContestRun {
  std::string name;
  bool peer = false;
  std::string note;              ///< why there is no surface; empty: there is one
  double seconds = 0, bytes = 0; ///< of processors, which depends less on what else the machine does; peak
  ContestFigures figures;
  std::string picture; ///< file in the folder of the case; empty: none
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ContestRun, name, peer, note, seconds, bytes, figures, picture)

struct ContestOutcome {
  std::string group, name, description;
  std::size_t points = 0;
  std::int64_t genus = -1; ///< true one; -1: not known
  std::uint32_t components = 1;
  double volume = 0; ///< true one; 0: not known
  std::vector<ContestRun> runs;
  std::string curves;             ///< SVG file in the folder of the case; empty: none
  std::vector<std::string> panel; ///< what panel.png there shows, from the left; empty: there is none
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ContestOutcome, group, name, description, points, genus, components, volume, runs,
                                   curves, panel)

struct ContestSettings {
  ContestPrograms programs;
  std::vector<std::string> itself; ///< this program with its options for data, for steps in processes of their own
  std::filesystem::path work;      ///< a folder per case
  unsigned threads = 0;
  bool keep_meshes = false;
};

/// \param tell of each contestant as soon as it is done
/// \throws Error when the cloud cannot be made or this program itself fails
ContestOutcome run_contest(const ContestCase& item, const ContestSettings& settings,
                           const std::function<void(const ContestRun&)>& tell);

/// Where a case's files are.
std::filesystem::path contest_folder(const ContestCase& item, const std::filesystem::path& work);

} // namespace eigencrust::bench
