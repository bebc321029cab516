// SPDX-License-Identifier: GPL-3.0-or-later
#include "bundled.h"

namespace eigencrust::cli {

std::optional<std::filesystem::path> find_bundled(const std::filesystem::path& name) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  for (const char* place : {EIGENCRUST_DATA_INSTALLED, "."}) {
    const fs::path file = (program.parent_path() / place / name).lexically_normal();
    if (fs::is_regular_file(file, ignored)) return file;
  }
  return std::nullopt;
}

} // namespace eigencrust::cli
