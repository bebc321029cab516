// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Files that come with the program.
#pragma once

#include <filesystem>
#include <optional>

namespace eigencrust::cli {

/// Where a file that belongs to the program is: that of an installed one, else that beside the one that was built.
std::optional<std::filesystem::path> find_bundled(const std::filesystem::path& name);

} // namespace eigencrust::cli
