// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the names of columns mean, as programs write them: "X [m]", "Points:0", "Easting".
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace eigencrust::io {

/// The columns of x, y and z, or nothing. Plain names count for more than longer ones, these for more than
/// Easting, Northing and Height.
std::optional<std::array<std::size_t, 3>> find_axes(std::span<const std::string> names);

/// Does one of the names speak of degrees of longitude or latitude?
bool names_degrees(std::span<const std::string> names);

/// Names to type behind --columns: x, y and z for the first three columns of numbers from `first` on, - for words.
/// \param names of the columns, or empty; those behind z are repeated where they can be typed
std::string columns_to_type(std::span<const std::string> names, const std::vector<bool>& numeric, std::size_t first);

} // namespace eigencrust::io
