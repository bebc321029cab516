// SPDX-License-Identifier: GPL-3.0-or-later
#include "data_folder.h"

#include <cstdlib>
#include <ostream>

#include <eigencrust/io.h>

namespace eigencrust::bench {

namespace {

std::string folder_of(const char* variable, const char* otherwise) {
  const char* folder = std::getenv(variable);
  return folder != nullptr && *folder != '\0' ? folder : otherwise;
}

} // namespace

std::string default_data_folder() { return folder_of("EIGENCRUST_DATA", EIGENCRUST_SOURCE_DIR "/../shared/data"); }

std::string default_field_folder() { return folder_of("EIGENCRUST_FIELD", EIGENCRUST_SOURCE_DIR "/../shared/field"); }

void write_text(const std::string& path, const std::string& text) {
  if (!path.empty()) write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

} // namespace eigencrust::bench
