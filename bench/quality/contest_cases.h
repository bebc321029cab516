// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The clouds on which this program is held against other methods: those of the figures of the 2004 paper, raw and
/// simulated scans, and what people bring.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <eigencrust/render.h>

#include "scene.h"
#include "sources.h"

namespace eigencrust::bench {

/// Cases that are shown together.
struct ContestGroup {
  std::string name, title;
  std::string text;         ///< what the paper shows, and what stands in for data that is not to be had
  bool sweep = false;       ///< the cases are one cloud, more and more disturbed: what breaks when
  double volume_margin = 0; ///< of a sweep: by which share of the undisturbed volume a surface that holds may differ
};
const std::vector<ContestGroup>& contest_groups();

struct ContestCase {
  std::string group, name, description;
  std::vector<std::string> files; ///< as of Sources; without them the case is skipped
  /// Null: the cloud is the file `as_it_is`, with all its columns.
  std::function<Scene(Sources&)> make;
  std::filesystem::path as_it_is;
  std::optional<std::int64_t> genus; ///< of the object; none: that of the made scene, of a file not known
  RenderOptions view;
  bool crusts = true, peers = false, curves = false, pictures = true;
  /// Contestants whose surfaces are also put side by side in one picture; "cloud" is the cloud.
  std::vector<std::string> panel{};
};

/// Every case, in the order of the page: small ones first within a group.
std::vector<ContestCase> contest_cases();

/// Those of which "group/name" contains one of the words separated by commas; all without any.
/// \throws Error{usage} when a word fits none
std::vector<ContestCase> select_contest_cases(const std::string& words);

} // namespace eigencrust::bench
