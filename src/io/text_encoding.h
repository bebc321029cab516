// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Text in 16 bits per character, as Excel ("Unicode text") and PowerShell write it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace eigencrust::io {

/// The text in UTF-8 where the bytes are UTF-16 with a byte order mark, or UTF-16 of plain letters without one;
/// nothing where they are anything else.
std::optional<std::string> decode_utf16(std::string_view bytes);

} // namespace eigencrust::io
