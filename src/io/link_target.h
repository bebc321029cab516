// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where a file really lies.
#pragma once

#include <filesystem>

namespace eigencrust::io {

/// The file that symbolic links lead to; it need not exist.
inline std::filesystem::path follow_links(std::filesystem::path path) {
  for (int steps = 0; steps < 40; ++steps) { // as many as Linux follows
    std::error_code error;
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    if (error) return path;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return path;
}

} // namespace eigencrust::io
