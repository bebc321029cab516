// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The yardstick: CGAL's sequential Delaunay triangulation of the same file.
#pragma once

#include <filesystem>
#include <string>

namespace eigencrust::bench {

/// Reads a cloud and triangulates its finite points (Delaunay_triangulation_3 over
/// Exact_predicates_inexact_constructions_kernel, inserted as one range, so that CGAL sorts them spatially).
/// \return JSON: points, vertices, tetrahedra, and seconds of the insertion alone. \throws Error{input}
std::string time_cgal(const std::filesystem::path& cloud);

} // namespace eigencrust::bench
