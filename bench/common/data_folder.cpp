// SPDX-License-Identifier: GPL-3.0-or-later
#include "data_folder.h"

#include <cstdlib>
#include <ostream>

#include <eigencrust/io.h>

namespace eigencrust::bench {

std::string default_data_folder() {
  const char* folder = std::getenv("EIGENCRUST_DATA");
  return folder != nullptr && *folder != '\0' ? folder : EIGENCRUST_SOURCE_DIR "/../shared/data";
}

void write_text(const std::string& path, const std::string& text) {
  if (!path.empty()) write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

} // namespace eigencrust::bench
