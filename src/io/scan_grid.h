// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Grids of scanners and depth cameras; find_grids() of io.h reads them.
#pragma once

#include <cstdint>
#include <span>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// Adds the attributes row and column. \param cells row * columns + column of each point
/// \param columns of the grid, at least 1
void add_grid_columns(PointCloud& cloud, std::span<const std::uint64_t> cells, std::uint64_t columns);
/// The same where rows and columns are known one by one. Attributes of these names get a suffix.
void add_grid_columns(PointCloud& cloud, std::span<const std::uint32_t> rows, std::span<const std::uint32_t> columns);

} // namespace eigencrust::io
