// SPDX-License-Identifier: GPL-3.0-or-later
// Leica's PTX: gridded scans one after another. Each begins with the number of columns, the number of
// rows, the scanner's position, its three axes and a 4 x 4 matrix for row vectors (the translation is its
// last row), one per line; then columns x rows lines x y z intensity [red green blue] in the scanner's
// own frame, 0 0 0 where nothing came back.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/formats.h"
#include "io/point_table.h"
#include "io/pose.h"
#include "io/scan_grid.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr const char* ptx_header_help =
    "a PTX scan begins with the lines columns, rows, position, three axes, four rows of the matrix";
constexpr const char* count_remedy =
    "correct the numbers of columns and rows, or fetch the file again if it is cut off";

/// p -> (p 1) matrix
struct Matrix {
  std::array<Vec3, 3> rows;
  Vec3 translation;

  [[nodiscard]] Vec3 move(const Vec3& p) const { return p.x * rows[0] + p.y * rows[1] + p.z * rows[2] + translation; }
  [[nodiscard]] bool is_identity() const { return rows == Pose{}.rows && translation == Vec3{}; }
};

struct Scan {
  std::uint64_t points = 0; ///< columns x rows, as the header claims
  std::uint64_t rows = 0;   ///< the rows of a column follow one another
  Vec3 position;
  Matrix matrix;
  std::size_t end = 0; ///< rows of the table up to here
};

std::uint64_t read_count(LineScanner& lines, const char* what) {
  std::uint64_t count = 0;
  if (!lines.next_filled()) lines.fail(std::string("the file ends before the number of ") + what, ptx_header_help);
  if (!parse(lines.line(), count))
    lines.fail(shown(lines.line()) + " where the number of " + what + " of a scan is expected",
               "correct the numbers of columns and rows of the scan before, or of this one");
  return count;
}

template <std::size_t n>
std::array<double, n> read_numbers(LineScanner& lines, Fields& fields, const char* what) {
  if (!lines.next_filled()) lines.fail(std::string("the file ends before ") + what + " of a scan", ptx_header_help);
  split_fields(lines.line(), fields);
  std::array<double, n> numbers{};
  bool good = fields.size() == n;
  for (std::size_t i = 0; good && i < n; ++i) good = parse(fields[i], numbers[i]) && std::isfinite(numbers[i]);
  if (!good) lines.fail(shown(lines.line()) + " where " + what + " of a scan is expected", ptx_header_help);
  return numbers;
}

Scan read_header(LineScanner& lines, Fields& fields) {
  Scan scan;
  const std::uint64_t columns = read_count(lines, "columns"), rows = read_count(lines, "rows");
  if (rows != 0 && columns > std::numeric_limits<std::uint64_t>::max() / rows)
    lines.fail("the scan has too many columns and rows", count_remedy);
  scan.points = columns * rows;
  scan.rows = rows;
  const auto position = read_numbers<3>(lines, fields, "the position");
  scan.position = {position[0], position[1], position[2]};
  // The axes repeat what the matrix says.
  for (int axis = 0; axis < 3; ++axis) read_numbers<3>(lines, fields, "an axis");
  for (std::size_t row = 0; row < 4; ++row) {
    const auto m = read_numbers<4>(lines, fields, "a row of the matrix");
    (row < 3 ? scan.matrix.rows[row] : scan.matrix.translation) = {m[0], m[1], m[2]};
    if (m[3] != (row < 3 ? 0.0 : 1.0))
      lines.fail("the last column of the matrix is not 0 0 0 1", "write the translation into the last row");
  }
  return scan;
}

/// x y z intensity [red green blue]; some programs leave the intensity out.
void set_layout(PointTable& table, std::size_t count, const LineScanner& lines) {
  if (count == table.fields()) return;
  std::vector<std::string> names = {"x", "y", "z"};
  if (count == 4 || count == 7) names.emplace_back("intensity");
  if (count == 6 || count == 7) names.insert(names.end(), {"red", "green", "blue"});
  if (names.size() != count)
    lines.fail("the row has " + plural(count, "field"), "write x y z intensity [red green blue]");
  table.set_layout(names, lines);
}

/// Row and column in its grid of each point.
struct GridPlaces {
  std::vector<std::uint32_t> row, column;
};

/// \return the number of empty returns, which are left out
std::uint64_t read_rows(LineScanner& lines, Fields& fields, const Scan& scan, PointTable& table, GridPlaces& places) {
  std::uint64_t empty = 0;
  for (std::uint64_t i = 0; i < scan.points; ++i) {
    const bool there = lines.next_filled();
    if (there) split_fields(lines.line(), fields);
    if (!there || fields.size() == 1)
      lines.fail("the scan has " + plural(scan.points, "point") + " by its columns and rows, but only " +
                     std::to_string(i) + " follow",
                 count_remedy);
    set_layout(table, fields.size(), lines);
    check_decimal_commas(lines);
    table.add_row(fields, lines);
    if (table.last_point() != Vec3{}) {
      places.row.push_back(static_cast<std::uint32_t>(i % scan.rows));
      places.column.push_back(static_cast<std::uint32_t>(i / scan.rows));
      continue;
    }
    table.drop_last_row();
    ++empty;
  }
  return empty;
}

/// Moves the points into the common frame and says who saw them.
void place_scans(PointCloud& cloud, const std::vector<Scan>& scans, std::vector<std::string>& notes) {
  cloud.sensor_of.reserve(cloud.points.size());
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const Scan& scan = scans[s];
    const std::string name = "scan " + std::to_string(s + 1);
    Box3 box;
    for (std::size_t i = cloud.sensor_of.size(); i < scan.end; ++i) {
      if (!scan.matrix.is_identity()) cloud.points[i] = scan.matrix.move(cloud.points[i]);
      if (is_finite(cloud.points[i])) box.add(cloud.points[i]);
    }
    const Vec3& place = scan.matrix.translation;
    // Converters of coordinates from elsewhere (UTM, say) write the identity too; no scanner looks this far.
    constexpr double farthest = 30; // in diagonals of what was seen
    const bool known =
        !scan.matrix.is_identity() || box.empty() || distance(place, box.centre()) <= farthest * box.diagonal();
    if (known)
      cloud.sensors.push_back({place, false});
    else
      notes.push_back(name +
                      ": the scanner's position is taken as unknown: there is no transformation, and the "
                      "points are far from the origin");
    if (distance(scan.position, place) > 1e-3 * (1 + norm(place)))
      notes.push_back(name + ": the scanner's position differs from the translation of the matrix, which is used");
    const auto sensor = known ? static_cast<std::uint32_t>(cloud.sensors.size() - 1) : PointCloud::no_sensor;
    cloud.sensor_of.resize(scan.end, sensor);
  }
  if (cloud.sensors.empty()) cloud.sensor_of = {};
}

} // namespace

PointCloud read_ptx(const FileContent& file, ReadNotes& notes) {
  LineScanner lines(file);
  Fields fields;
  PointTable table;
  std::vector<Scan> scans;
  GridPlaces places;
  std::uint64_t empty = 0;
  for (LineScanner next = lines; next.next_filled(); next = lines) {
    scans.push_back(read_header(lines, fields));
    empty += read_rows(lines, fields, scans.back(), table, places);
    scans.back().end = table.rows();
  }
  if (scans.empty()) file.fail("the file holds no scan", ptx_header_help);
  PointCloud cloud = table.finish(true, notes);
  if (empty > 0) notes.notes.push_back(plural(empty, "empty return") + " (0 0 0) left out");
  place_scans(cloud, scans, notes.notes);
  add_grid_columns(cloud, places.row, places.column);
  if (scans.size() > 1)
    for (std::size_t s = 0; s < scans.size(); ++s) cloud.scan_index.resize(scans[s].end, static_cast<std::uint32_t>(s));
  return cloud;
}

bool looks_like_ptx(const FileContent& file) {
  constexpr std::array<std::size_t, 10> fields_per_line = {1, 1, 3, 3, 3, 3, 4, 4, 4, 4};
  LineScanner lines(file);
  Fields fields;
  for (std::size_t line = 0; line < fields_per_line.size(); ++line) {
    if (!lines.next_filled() || lines.line().size() > 1000) return false;
    split_fields(lines.line(), fields);
    if (fields.size() != fields_per_line[line]) return false;
    double number = 0;
    for (const std::string_view field : fields)
      if (!parse(field, number)) return false;
    if (line >= 6 && number != (line == 9 ? 1.0 : 0.0)) return false;
  }
  return true;
}

} // namespace eigencrust::io
