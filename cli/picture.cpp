// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "standard_streams.h"

namespace eigencrust::cli {
namespace {

Image arranged(const std::vector<Image>& pictures, std::size_t objects, std::size_t views) {
  std::vector<Image> rows;
  if (objects == 1) {
    const std::size_t columns = views <= 3 ? views : (views + 1) / 2;
    for (std::size_t i = 0; i < views; i += columns) {
      std::vector<Image> row(pictures.begin() + static_cast<std::ptrdiff_t>(i),
                             pictures.begin() + static_cast<std::ptrdiff_t>(std::min(views, i + columns)));
      Image blank = row.front();
      std::fill(blank.rgb.begin(), blank.rgb.end(), std::uint8_t{255});
      row.resize(columns, blank);
      rows.push_back(beside(row));
    }
    return stacked(rows);
  }
  for (std::size_t v = 0; v < views; ++v) {
    std::vector<Image> row;
    for (std::size_t i = 0; i < objects; ++i) row.push_back(pictures[i * views + v]);
    rows.push_back(beside(row));
  }
  return stacked(rows);
}

} // namespace

void check_picture(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".png" && !is_standard_output(path))
    throw Error(ErrorKind::usage, path, "pictures are written as PNG only", "end the name in .png");
  if (!is_standard_output(path)) require_writable(path);
}

void write_picture(const std::string& path, const std::vector<Image>& pictures, std::size_t objects,
                   std::size_t views) {
  write_png(is_standard_output(path) ? "/dev/stdout" : path, arranged(pictures, objects, views));
}

} // namespace eigencrust::cli
