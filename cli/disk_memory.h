// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Out of core: large arrays lie in files of a folder, which the system keeps in memory as far as there is room
/// (docs/decisions/0047).
#pragma once

#include <cstdint>
#include <string>

namespace eigencrust::cli {

/// From now on arrays of a megabyte and more, of all threads, lie in files of `folder`, which have no name there and go
/// with the process. Once for a process; later calls do nothing. Where no such file can be had memory is exhausted
/// (std::bad_alloc).
/// \param resident bytes that the process may hold in memory
/// \throws Error{usage} where the folder cannot hold such files
void lend_disk(const std::string& folder, std::uint64_t resident);

/// Whether files of this folder take memory, as of a tmpfs.
bool lies_in_memory(const std::string& folder);

/// Bytes that lend_disk() has lent at one time at most.
std::uint64_t peak_of_lent_disk();

/// What there is to say where memory ended, or the disk that was lent. Allocates nothing.
const char* memory_is_exhausted();

} // namespace eigencrust::cli
