// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The checksum of E57 pages.
#pragma once

#include <cstdint>
#include <string_view>

namespace eigencrust::io {

/// CRC-32C (Castagnoli): polynomial 0x1EDC6F41, bits reflected, start and end inverted (RFC 3720, B.4).
std::uint32_t crc32c(std::string_view bytes);

} // namespace eigencrust::io
