// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Who is held against whom: this program as it comes, its other methods, and what people use today.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "contest_cases.h"

namespace eigencrust::bench {

/// Where the programs are. One that is not there is said to be not installed.
struct ContestPrograms {
  std::filesystem::path eigencrust, peers; ///< the command; the drivers of CGAL's methods
  std::string python;                      ///< for Open3D and MeshLab
};

struct Contestant {
  std::string name;
  bool peer = false;      ///< another program
  bool says_time = false; ///< prints the seconds that count, without the start of an interpreter
  /// One after another; the last one makes the mesh.
  std::vector<std::vector<std::string>> commands;
  std::string missing; ///< why it cannot be run; empty: it can
};

/// Name of the one that all times and sizes are relative to: the program without options.
inline const char* const ourselves = "eigencrust";
/// Its surface before vertices move and edges are flipped: what surfaces of other methods are compared with.
inline const char* const faces_only = "eigencrust --surface delaunay";

/// Those that the case asks for, ourselves and faces_only first. Meshes go to `mesh`, what is between two commands
/// beside it.
std::vector<Contestant> contestants(const ContestCase& item, const ContestPrograms& programs,
                                    const std::filesystem::path& cloud, const std::filesystem::path& mesh,
                                    unsigned threads);

} // namespace eigencrust::bench
