// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the checkout lies. One source file alone is compiled with its path, so that a compiler cache
/// serves every other test in any checkout.
#pragma once

#include <filesystem>

namespace eigencrust {

/// The folder of the project's sources.
std::filesystem::path source_folder();

} // namespace eigencrust
