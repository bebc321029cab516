// SPDX-License-Identifier: GPL-3.0-or-later
#include "page.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <eigencrust/error.h>

#include "bundled.h"

namespace eigencrust::cli {

bool is_page(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".html" || ending == ".htm";
}

std::string read_viewer(const std::string& page) {
  const auto place = find_bundled("viewer.html");
  std::ifstream file;
  if (place) file.open(*place, std::ios::binary);
  if (!file.is_open())
    throw Error(ErrorKind::usage, page, "pages need viewer.html, which was not built with this program",
                "build it with scripts/viewer.sh, which needs npm and a network once, or end the name in .json");
  return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace eigencrust::cli
