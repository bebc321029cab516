// SPDX-License-Identifier: GPL-3.0-or-later
// The ASCII grid of ESRI: six lines of words, then heights, the northernmost row first (ArcGIS documentation, "Esri
// ASCII raster format").
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "io/formats.h"
#include "io/row_format.h"
#include "io/scan_grid.h"

namespace eigencrust::io {
namespace {

constexpr const char* grid_header_help =
    "begin the grid with the lines ncols, nrows, xllcorner (or xllcenter), yllcorner (or yllcenter), cellsize, "
    "NODATA_value";

struct GridHeader {
  std::uint64_t columns = 0, rows = 0;
  std::optional<double> x, y, no_data; ///< of the middle of the cell at the lower left
  double dx = 0, dy = 0;
  bool x_is_corner = true, y_is_corner = true;
};

/// Takes the next height off the front; tables that became grids have commas or semicolons between them.
std::string_view next_height_word(std::string_view& text) {
  constexpr std::string_view separators = " \t\r,;";
  text.remove_prefix(std::min(text.find_first_not_of(separators), text.size()));
  const std::string_view word = text.substr(0, std::min(text.find_first_of(separators), text.size()));
  text.remove_prefix(word.size());
  return word;
}

class EsriGridReader {
 public:
  EsriGridReader(const FileContent& file, ReadNotes& notes) : lines_(file), notes_(notes) {}

  PointCloud read() {
    read_header();
    // A height takes a digit and a blank.
    if (header_.columns == 0 || header_.rows > (lines_.file().bytes().size() / 2 + 1) / header_.columns)
      lines_.fail("the file is too short for the " + plural(header_.rows, "row") + " of " +
                      plural(header_.columns, "height") + " of the header",
                  "correct ncols and nrows, or fetch the file again if it is cut off");
    for (std::uint64_t i = 0; i < header_.columns * header_.rows; ++i) add(i, next_height(i));
    add_grid_columns(cloud_, cells_, header_.columns);
    if (empty_ > 0) notes_.notes.push_back(plural(empty_, "cell") + " without data left out");
    notes_.notes.push_back("read as an ESRI grid of " + std::to_string(header_.columns) + " x " +
                           std::to_string(header_.rows) + " heights, at the middles of the cells");
    return std::move(cloud_);
  }

 private:
  void read_header() {
    while (lines_.next_filled()) {
      std::string_view rest = lines_.line();
      double value = 0;
      std::string_view height = lines_.line();
      height = next_height_word(height);
      if (parse(height, value) || is_missing(height)) break; // the first row of heights
      const std::string word = lower_case(next_word(rest));
      if (!parse(trim(rest), value) || !std::isfinite(value))
        lines_.fail("no number behind " + shown(word), grid_header_help);
      take(word, value);
    }
    if (header_.rows == 0 || header_.columns == 0 || !header_.x || !header_.y || !(header_.dx > 0) || !(header_.dy > 0))
      lines_.fail("the header of the grid is not complete", grid_header_help);
    rest_ = lines_.line();
    if (header_.x_is_corner) *header_.x += header_.dx / 2;
    if (header_.y_is_corner) *header_.y += header_.dy / 2;
  }

  void take(const std::string& word, double value) {
    const auto count = [&](std::uint64_t& n) {
      if (!(value >= 1 && value < 0x1p32 && value == std::floor(value)))
        lines_.fail(word + " is no whole number", grid_header_help);
      n = static_cast<std::uint64_t>(value);
    };
    if (word == "ncols") {
      count(header_.columns);
    } else if (word == "nrows") {
      count(header_.rows);
    } else if (word == "xllcorner" || word == "xllcenter") {
      header_.x = value;
      header_.x_is_corner = word == "xllcorner";
    } else if (word == "yllcorner" || word == "yllcenter") {
      header_.y = value;
      header_.y_is_corner = word == "yllcorner";
    } else if (word == "cellsize") {
      header_.dx = header_.dy = value;
    } else if (word == "dx") {
      header_.dx = value;
    } else if (word == "dy") {
      header_.dy = value;
    } else if (word == "nodata_value" || word == "nodata") {
      header_.no_data = value;
    } else {
      lines_.fail("unknown line " + shown(word) + " in the header of the grid", grid_header_help);
    }
  }

  double next_height(std::uint64_t i) {
    std::string_view word = next_height_word(rest_);
    while (word.empty()) {
      if (!lines_.next_filled())
        lines_.fail("the header promises " + plural(header_.columns * header_.rows, "height") + ", but only " +
                        std::to_string(i) + " follow",
                    "correct ncols and nrows, or fetch the file again if it is cut off");
      rest_ = lines_.line();
      word = next_height_word(rest_);
    }
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!parse(word, value) && !is_missing(word)) lines_.fail(shown(word) + " is no height", "correct it");
    return value;
  }

  void add(std::uint64_t cell, double height) {
    if (std::isnan(height) || (header_.no_data && height == *header_.no_data)) {
      ++empty_;
      return;
    }
    const std::uint64_t row = cell / header_.columns, column = cell % header_.columns;
    cloud_.points.push_back({*header_.x + header_.dx * static_cast<double>(column),
                             *header_.y + header_.dy * static_cast<double>(header_.rows - 1 - row), height});
    cells_.push_back(cell);
  }

  LineScanner lines_;
  ReadNotes& notes_;
  GridHeader header_;
  PointCloud cloud_;
  std::vector<std::uint64_t> cells_;
  std::string_view rest_;
  std::uint64_t empty_ = 0;
};

} // namespace

PointCloud read_esri_grid(const FileContent& file, ReadNotes& notes) { return EsriGridReader(file, notes).read(); }

bool looks_like_esri_grid(const FileContent& file) {
  LineScanner lines(file);
  if (!lines.next_filled() || lines.line().size() > 200) return false;
  std::string_view rest = lines.line();
  const std::string word = lower_case(next_word(rest));
  double number = 0;
  return (word == "ncols" || word == "nrows") && parse(trim(rest), number);
}

} // namespace eigencrust::io
