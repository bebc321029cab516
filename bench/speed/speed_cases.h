// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The clouds that are timed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace eigencrust::bench {

struct SpeedCase {
  std::string name;
  std::string file;                 ///< of the data folder; empty: generated
  std::size_t generated_points = 0; ///< of a noisy bumpy sphere
};

/// The real clouds, then a noisy bumpy sphere of each size: "sphere-10000".
/// \param patterns names contain one of them (each may be a comma list); all cases without any
/// \throws Error{usage} when a pattern fits no case
std::vector<SpeedCase> speed_cases(const std::vector<std::size_t>& sizes, const std::vector<std::string>& patterns);

/// Writes `count` random samples of the bumpy sphere, each coordinate moved by a normal deviate of half their
/// median spacing. The same bytes every time. \throws Error{input}
void write_noisy_sphere(std::size_t count, const std::filesystem::path& path);

} // namespace eigencrust::bench
