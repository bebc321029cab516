// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The compression of binary_compressed PCD files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace eigencrust::io {

/// Most bytes that one compressed byte can stand for: three bytes copy 264.
constexpr std::size_t lzf_largest_ratio = 88;

/// Unpacks an LZF stream (M. Lehmann's LibLZF format). A control byte c below 32 is followed by c + 1
/// bytes as they are. Any other c copies bytes that came before: (c >> 5) + 2 of them, if c >> 5 is 7 that
/// many more as the next byte says, from ((c & 31) << 8) + last byte + 1 bytes back, perhaps overlapping.
/// \param size the exact size of the result
/// \param bad gets the offset of the control byte that asks for the impossible
/// \return false when the stream is damaged or does not yield `size` bytes
bool lzf_unpack(std::string_view packed, std::size_t size, std::string& result, std::size_t& bad);

} // namespace eigencrust::io
