// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/scan_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <eigencrust/io.h>

#include "io/attributes.h"
#include "io/text.h"

namespace eigencrust {
namespace {

const Attribute* find(const PointCloud& cloud, std::initializer_list<const char*> names) {
  for (const char* name : names)
    for (const Attribute& attribute : cloud.attributes)
      if (!attribute.is_list && io::equal_ignoring_case(attribute.name, name)) return &attribute;
  return nullptr;
}

/// One number of a cell; no_index where there is none.
std::uint32_t place_in(const Attribute& attribute, std::size_t row) {
  const double value = attribute_value(attribute, row);
  return value >= 0 && value < no_index && value == std::floor(value) ? static_cast<std::uint32_t>(value) : no_index;
}

/// None where it is a single row or column or its cells do not fit 32 bits.
ScanGrid make_size(std::uint64_t columns, std::uint64_t rows) {
  if (columns < 2 || rows < 2 || columns >= no_index || rows >= no_index || columns * rows >= no_index) return {};
  return {static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows)};
}

/// Two points in one cell: these numbers are no places in a grid.
bool shares_a_cell(const ScanGrids& grids, const PointCloud& cloud) {
  std::vector<std::uint64_t> used;
  used.reserve(grids.cell.size());
  for (std::size_t i = 0; i < grids.cell.size(); ++i)
    if (grids.cell[i] != no_index)
      used.push_back(std::uint64_t{cloud.scan_index.empty() ? 0 : cloud.scan_index[i]} << 32 | grids.cell[i]);
  std::sort(used.begin(), used.end());
  return std::adjacent_find(used.begin(), used.end()) != used.end();
}

} // namespace

std::optional<ScanGrids> find_grids(const PointCloud& cloud) {
  const Attribute* row = find(cloud, {"row", "rowIndex"});
  const Attribute* column = find(cloud, {"column", "columnIndex", "col"});
  if (row == nullptr || column == nullptr || cloud.points.empty()) return std::nullopt;
  const std::uint32_t last =
      cloud.scan_index.empty() ? 0 : *std::max_element(cloud.scan_index.begin(), cloud.scan_index.end());
  constexpr std::uint32_t most_scans = 1 << 20; // scan numbers may be any; grids are for those who count them
  if (last >= most_scans) return std::nullopt;
  const auto scan_of = [&](std::size_t i) { return cloud.scan_index.empty() ? 0 : cloud.scan_index[i]; };
  std::vector<std::array<std::uint64_t, 2>> reach(last + 1, {0, 0});
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::uint32_t r = place_in(*row, i), c = place_in(*column, i);
    if (r == no_index || c == no_index) continue;
    auto& [columns, rows] = reach[scan_of(i)];
    columns = std::max(columns, std::uint64_t{c} + 1);
    rows = std::max(rows, std::uint64_t{r} + 1);
  }
  ScanGrids grids;
  for (const auto& [columns, rows] : reach) grids.sizes.push_back(make_size(columns, rows));
  if (std::all_of(grids.sizes.begin(), grids.sizes.end(), [](const ScanGrid& s) { return s == ScanGrid{}; }))
    return std::nullopt;
  grids.cell.assign(cloud.points.size(), no_index);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::uint32_t r = place_in(*row, i), c = place_in(*column, i), columns = grids.sizes[scan_of(i)].columns;
    if (r != no_index && c != no_index && columns > 0) grids.cell[i] = r * columns + c;
  }
  if (shares_a_cell(grids, cloud)) return std::nullopt;
  return grids;
}

void io::add_grid_columns(PointCloud& cloud, std::span<const std::uint32_t> rows,
                          std::span<const std::uint32_t> columns) {
  UniqueNames unique;
  for (const Attribute& attribute : cloud.attributes) unique(attribute.name);
  cloud.attributes.push_back(make_attribute(unique("row"), rows));
  cloud.attributes.push_back(make_attribute(unique("column"), columns));
}

void io::add_grid_columns(PointCloud& cloud, std::span<const std::uint64_t> cells, std::uint64_t columns) {
  std::vector<std::uint32_t> row, column;
  row.reserve(cells.size());
  column.reserve(cells.size());
  for (const std::uint64_t cell : cells) {
    row.push_back(static_cast<std::uint32_t>(cell / columns));
    column.push_back(static_cast<std::uint32_t>(cell % columns));
  }
  add_grid_columns(cloud, row, column);
}

} // namespace eigencrust
