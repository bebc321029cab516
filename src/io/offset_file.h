// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The file beside a result that tells what leads back to the coordinates of the input.
#pragma once

#include <filesystem>
#include <string>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// "1 2.5 -3", with the digits that read back as the same numbers.
std::string three_numbers(const Vec3& v);

/// The content of offset_file(result). \param offset to add to the coordinates of the result
std::string offset_text(const std::filesystem::path& result, const Vec3& offset);

/// Did an earlier run write it? Then it would lead astray beside a result that needs none.
bool is_offset_file(const std::filesystem::path& file);

} // namespace eigencrust::io
