// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a contest shows beside figures.
#pragma once

#include <filesystem>
#include <string>

#include <eigencrust/page.h>

#include "contest_cases.h"

namespace eigencrust::bench {

/// Meshes, or clouds, side by side as PNG, each framed by itself. \param files separated by commas
void draw_contest(const ContestCase& item, const std::string& files, const std::filesystem::path& picture);

/// The sorted components of the two vectors of the preset `paper`, as in figures 1, 5, 6 and 8 of the paper.
void draw_curves(const std::filesystem::path& cloud, const std::filesystem::path& picture, unsigned threads);

/// The same as SVG; both curves from their least to their greatest value, zero as a line.
std::string curves_svg(const SortedValues& first, const SortedValues& second);

} // namespace eigencrust::bench
