// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of cases: what the cloud is, what the result must show.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <eigencrust/eigencrust.h>
#include <eigencrust/render.h>

#include "figures.h"
#include "scene.h"
#include "sources.h"

namespace eigencrust::bench {

struct Case {
  std::string group, name, description;
  /// Without them the case is skipped; "field/NAME" is NAME in the folder of field data, others are of the data
  /// folder.
  std::vector<std::string> files;
  bool large = false; ///< 100,000 points or more: left out by --quick
  std::uint64_t seed = 1;
  std::function<Scene(Sources&, std::uint64_t seed)> make;
  std::function<void(Options&)> how;     ///< options beside the preset's; may be null
  std::vector<Requirement> requirements; ///< none: the figures are for information
  /// Where the method may say why it cannot: an error whose text holds this word will do instead of the
  /// requirements, and so will a warning, if at least a hundredth of the samples is in the surface.
  std::string excuse;
  /// Figures beyond measure(); may be null.
  std::function<void(const Scene&, const Result&, Sources&, Figures&)> measure_more;
  RenderOptions view; ///< for a picture of the result
};

/// Every case, in the order of the table.
std::vector<Case> all_cases();

/// The cases of which "group/name" contains one of the patterns (each may be a comma list); all without any.
/// \throws Error{usage} when a pattern fits no case
std::vector<Case> select_cases(std::vector<Case> cases, const std::vector<std::string>& patterns, bool quick);

// Shorthands for the tables below.

inline Requirement equals(std::string figure, double bound) { return {std::move(figure), Relation::equal, bound}; }
inline Requirement at_most(std::string figure, double bound) { return {std::move(figure), Relation::at_most, bound}; }
inline Requirement at_least(std::string figure, double bound) { return {std::move(figure), Relation::at_least, bound}; }

/// How the meshes of the data folder are looked at.
RenderOptions view_of(const std::string& file);

void add_outlier_cases(std::vector<Case>& cases); ///< vertices of clean meshes among outliers
void add_bumpy_cases(std::vector<Case>& cases);   ///< noise and outliers where the truth is a formula
void add_missing_cases(std::vector<Case>& cases); ///< caps cut off
void add_body_cases(std::vector<Case>& cases);    ///< two bodies, a cavity, a thin sheet
void add_density_cases(std::vector<Case>& cases); ///< samples close here, far apart there
void add_noise_cases(std::vector<Case>& cases);   ///< noise alone, in all directions and along the rays
void add_bunny_cases(std::vector<Case>& cases);   ///< the raw bunny, with more noise and scans moved apart
void add_raw_cases(std::vector<Case>& cases);     ///< other raw scans
/// Of the group `field`, still without measures and requirements.
Case field_case(std::string name, std::string description, std::function<Scene(Sources&, std::uint64_t)> make);
void add_field_cases(std::vector<Case>& cases);      ///< parts, thin walls and what else people bring
void add_open_field_cases(std::vector<Case>& cases); ///< rooms, buildings, ground, streets
void add_real_field_cases(std::vector<Case>& cases); ///< the same with files of theirs

} // namespace eigencrust::bench
