// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <sstream>

#include "command.h"
#include "selection.h"
#include "standard_streams.h"

namespace eigencrust::cli {
namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::string part;
  for (const char c : text) {
    if (c == ',' || c == ' ') {
      if (!part.empty()) parts.push_back(std::move(part));
      part.clear();
    } else {
      part += c;
    }
  }
  if (!part.empty()) parts.push_back(std::move(part));
  return parts;
}

PcdViewpoint viewpoint_of(const std::string& name) {
  if (name == "sensor") return PcdViewpoint::sensor;
  if (name == "pose") return PcdViewpoint::pose;
  return name == "none" ? PcdViewpoint::none : PcdViewpoint::automatic;
}

[[noreturn]] void fail_usage(const std::string& cause, const std::string& remedy) {
  throw Error(ErrorKind::usage, "command line", cause, remedy);
}

/// One sensor per input, or none. \throws Error{usage}
std::vector<Sensor> sensors_of_inputs(const InputOptions& options) {
  const bool has_places = !options.sensor.empty(), has_directions = !options.sensor_direction.empty();
  if (has_places + has_directions + !options.sensors.empty() > 1)
    fail_usage("--sensor, --sensor-direction and --sensors exclude one another",
               "name all sensors in one way; a file for --sensors may hold them all");
  std::vector<Sensor> sensors;
  for (const std::string& text : has_directions ? options.sensor_direction : options.sensor) {
    Vec3 place = parse_point(text);
    if (has_directions) {
      const double length = norm(place);
      if (!(length > 0) || !std::isfinite(length))
        fail_usage("the direction '" + text + "' has no length", "give the direction from the surface to the scanner");
      place = (1 / length) * place;
    }
    if (!is_finite(place)) fail_usage("the sensor '" + text + "' is not finite", "give three finite numbers x,y,z");
    sensors.push_back({place, has_directions});
  }
  if (!sensors.empty() && sensors.size() != options.paths.size())
    fail_usage("the sensors named, " + std::to_string(sensors.size()) + ", are not as many as the inputs, " +
                   std::to_string(options.paths.size()),
               "name one for each input, in order");
  return sensors;
}

/// Writes down for each file which sensors saw its points; the files' points follow one another in the cloud.
void note_sensors(const PointCloud& cloud, std::vector<InputFile>& files) {
  if (cloud.sensor_of.empty()) return;
  std::size_t row = 0;
  for (InputFile& file : files) {
    std::vector<std::uint8_t> seen(cloud.sensors.size(), 0);
    for (const std::size_t end = row + file.points; row < end; ++row) {
      if (cloud.sensor_of[row] == PointCloud::no_sensor) continue;
      seen[cloud.sensor_of[row]] = 1;
      ++file.points_with_sensor;
    }
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (seen[i]) file.sensors.push_back(cloud.sensors[i]);
  }
}

} // namespace

void add_input_options(OptionTable& app, InputOptions& options) {
  app.begin_chapter("Reading");
  app.add_option("INPUT", options.paths,
                 "Point clouds (ply e57 las ptx pcd pts npz npy xyz txt asc csv obj off stl glb 3mf); several are "
                 "several scans; "
                 "- is standard input")
      ->required()
      ->type_name(file_to_read);
  app.add_option("--columns", options.columns,
                 "Names of a text file's columns in order, e.g. x,y,z,red,green,blue; - skips one")
      ->type_name("LIST");
  app.add_option("--crop", options.crop,
                 "Keep what lies in a box, x,y,z,x,y,z or x,y,x,y, or in a polygon, x,y;x,y;x,y or a file of rows x y")
      ->type_name(shape_or_file);
  app.add_option("--thin", options.thin,
                 "Keep one point of each cube with this edge: a length, or N% of the box's diagonal")
      ->type_name("L");
  app.add_option("--scan-index", options.scan_index,
                 "Scan number of each point of one file that holds several scans: bytes (.u8) or one number per line")
      ->type_name(file_to_read);
  app.add_option("--pcd-viewpoint", options.pcd_viewpoint,
                 "VIEWPOINT of PCD files: auto (sensor unless 0 0 0), sensor (its position), pose (also moves the "
                 "points) or none")
      ->one_of({"auto", "sensor", "pose", "none"})
      ->capture_default_str();
  app.begin_chapter("What is known beforehand");
  app.add_option("--sensor", options.sensor,
                 "x,y,z where the scanner stood for an input, instead of what the file says; repeat for each input")
      ->type_name("X,Y,Z");
  app.add_option("--sensor-direction", options.sensor_direction,
                 "x,y,z direction from the surface to the scanner, for parallel rays; repeat for each input")
      ->type_name("X,Y,Z");
  app.add_option("--sensors", options.sensors,
                 "File with a row scan,x,y,z for each scan, or scan,dx,dy,dz under a header; none: ignore all sensors")
      ->type_name(file_to_read);
  add_frame_options(app, options);
}

namespace {

Box3 bounds_of(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points)
    if (is_finite(p)) box.add(p);
  return box;
}

/// As they are read or, through a pipe, as they were read.
PointCloud read_input(const std::string& path, const ReadOptions& options, ReadReport& report) {
  const ReadableFile file(path);
  return file.reading([&] {
    ReadNotes said;
    std::string sha256;
    PointCloud cloud = read_point_cloud(file.path(), options, &said, &sha256);
    report.notes.push_back(std::move(said));
    report.files.push_back({path, std::move(sha256), cloud.points.size(), {}, 0});
    report.bounds.push_back(bounds_of(cloud.points));
    return cloud;
  });
}

/// \throws Error{usage}
LengthChoice parse_thinning(const std::string& text) {
  const LengthChoice length = parse_length_choice("edge for --thin", text);
  if (length.kind == LengthChoice::Kind::automatic || length.kind == LengthChoice::Kind::off)
    fail_usage("--thin takes no " + text, "give a length or N%");
  return length;
}

double thinning_edge(const LengthChoice& length, const PointCloud& cloud) {
  const double edge = *length.given(bounds_of(cloud.points).diagonal());
  if (!(edge > 0)) fail_usage("the points are all in one place: a share of their box is no length", "leave out --thin");
  return edge;
}

/// Keeps some rows, and notes which of the files' rows these are.
void select(PointCloud& cloud, const std::vector<std::uint32_t>& kept, ReadReport& report) {
  if (report.rows.empty()) {
    report.rows = kept;
  } else {
    std::vector<std::uint32_t> rows;
    for (const std::uint32_t i : kept) rows.push_back(report.rows[i]);
    report.rows = std::move(rows);
  }
  keep_rows(cloud, kept);
}

void crop_and_thin(PointCloud& cloud, const std::optional<Crop>& crop, const std::optional<LengthChoice>& thin,
                   ReadReport& report) {
  report.rows_read = cloud.points.size();
  if (crop) select(cloud, rows_within(cloud.points, *crop), report);
  if (crop && cloud.points.empty())
    throw Error(ErrorKind::input, "--crop", "none of the " + grouped(report.rows_read) + " points lies in it",
                "compare it with the bounds that eigencrust info shows");
  if (thin) select(cloud, thinned_rows(cloud.points, thinning_edge(*thin, cloud)), report);
}

} // namespace

PointCloud read_inputs(const InputOptions& options, ReadReport& report, const std::function<void(double)>& progress) {
  const std::vector<Sensor> sensors = sensors_of_inputs(options);
  const std::optional<Crop> crop = options.crop.empty() ? std::nullopt : std::optional(parse_crop(options.crop));
  const std::optional<LengthChoice> thin =
      options.thin.empty() ? std::nullopt : std::optional(parse_thinning(options.thin));
  // What is replaced need not be looked for.
  ReadOptions read_options{split(options.columns), viewpoint_of(options.pcd_viewpoint),
                           sensors.empty() && options.sensors.empty()};
  read_options.shift = shift_of_inputs(options);
  for (std::size_t i = 0; i < options.paths.size(); ++i) scale_of_input(options, i); // refused before anything is read
  PointCloud cloud;
  std::vector<Extent> extents;
  for (std::size_t i = 0; i < options.paths.size(); ++i) {
    read_options.scale = scale_of_input(options, i);
    PointCloud next = read_input(options.paths[i], read_options, report);
    if (!sensors.empty()) {
      next.sensors.assign(1, sensors[i]);
      next.sensor_of.assign(next.points.size(), 0);
    }
    if (options.paths.size() > 1) extents.push_back(extent_of(next.points));
    if (i == 0)
      cloud = std::move(next);
    else
      append_scan(cloud, std::move(next));
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(options.paths.size()));
    if (interrupted()) throw Error(ErrorKind::cancelled, "reading", "cancelled", "start again to finish");
  }
  report.together = compare_extents(options.paths, extents);
  if (!options.scan_index.empty()) {
    if (options.paths.size() > 1)
      fail_usage("--scan-index goes with a single input", "leave it out: several inputs are several scans");
    cloud.scan_index = read_scan_index(options.scan_index, cloud.points.size());
    cloud.grids.clear(); // they were those of other scans
    cloud.cell.clear();
  }
  if (!options.sensors.empty() && options.sensors != "none") read_scan_sensors(options.sensors, cloud);
  note_sensors(cloud, report.files);
  crop_and_thin(cloud, crop, thin, report);
  return cloud;
}

std::string grouped(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
  return digits;
}

std::string rounded(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.4g", value);
  return buffer.data();
}

std::string show_point(const Vec3& point, double extent) {
  const double largest = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  int digits = 4;
  if (extent > 0 && largest > extent) digits += static_cast<int>(std::ceil(std::log10(largest / extent)));
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), "(%.*g, %.*g, %.*g)", std::min(digits, 17), point.x, std::min(digits, 17),
                point.y, std::min(digits, 17), point.z);
  return text.data();
}

namespace {

std::string count_of(std::uint64_t n, const char* one, const char* many) {
  return grouped(n) + " " + (n == 1 ? one : many);
}

/// Counts and guarantees. \param side what to call a mesh whose normals look inward
std::string describe_shape(const MeshSummary& mesh, const std::string& side) {
  std::ostringstream out;
  out << "  " << count_of(mesh.vertices, "vertex", "vertices") << ", "
      << count_of(mesh.triangles, "triangle", "triangles") << ", "
      << count_of(mesh.components, "component", "components") << ", genus " << mesh.genus << "\n";
  out << "  closed: "
      << (mesh.closed()
              ? "yes"
              : "no (" + count_of(mesh.boundary_edges, "boundary edge", "boundary edges") +
                    (mesh.boundary_loops > 0 ? ", " + count_of(mesh.boundary_loops, "rim", "rims") : "") + ")");
  out << ", manifold: "
      << (mesh.manifold() ? "yes"
                          : "no (" + count_of(mesh.nonmanifold_edges, "edge", "edges") + ", " +
                                count_of(mesh.nonmanifold_vertices, "vertex", "vertices") + ")");
  out << ", oriented: "
      << (mesh.oriented() ? (mesh.closed() && mesh.volume < 0 ? "yes, " + side : "yes")
                          : "no (" + count_of(mesh.inconsistent_edges, "edge", "edges") + ")")
      << "\n";
  if (mesh.degenerate_triangles > 0) out << "  degenerate triangles: " << grouped(mesh.degenerate_triangles) << "\n";
  out << "  self-intersections: "
      << (mesh.self_intersections < 0 ? "not counted"
                                      : (mesh.all_self_intersections ? "" : "at least ") +
                                            grouped(static_cast<std::uint64_t>(mesh.self_intersections)) + " pairs")
      << "\n";
  return out.str();
}

std::string describe_size(const MeshSummary& mesh) {
  return (mesh.closed() ? "  volume " + rounded(mesh.volume) + ", area " : "  area ") + rounded(mesh.area);
}

std::string describe_moved(const Report& report) {
  if (!report.moved) return {};
  std::ostringstream out;
  if (report.moved->vertices > 0 || report.moved->strays == 0)
    out << "  " << grouped(report.moved->vertices) << " vertices moved from their samples: median "
        << rounded(report.moved->median) << ", 99 % below " << rounded(report.moved->q99) << "\n";
  if (report.moved->strays > 0)
    out << "  " << count_of(report.moved->strays, "stray point", "stray points")
        << " evened out where samples are missing\n";
  return out.str();
}

std::string describe_bridged(const Report& report) {
  const BridgedReport& bridged = report.bridged;
  if (bridged.places == 0 || report.options.trim) return {};
  // As many digits as it takes to find the place.
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(bridged.widest))), 0, 12);
  std::ostringstream at;
  at << std::fixed << std::setprecision(digits) << bridged.at.x << "," << bridged.at.y << "," << bridged.at.z;
  return "  " + count_of(bridged.places, "place", "places") + " without samples bridged, " +
         (bridged.places == 1 ? "" : "the largest ") + rounded(bridged.widest) + " wide, at " + at.str() + "\n";
}

std::string describe_simplified(const Report& report) {
  if (!report.simplified) return {};
  const SimplifiedReport& s = *report.simplified;
  std::ostringstream out;
  const double mean = (s.deviation.to_full.mean + s.deviation.from_full.mean) / 2;
  out << "  " << (s.shape ? "remeshed" : "simplified") << " from " << grouped(s.triangles_before)
      << " triangles: off by " << rounded(mean) << " on average, " << rounded(s.deviation.max()) << " at most";
  if (s.shape) out << "; smallest angle " << rounded(s.shape->least_angle) << " degrees";
  out << "\n";
  return out.str();
}

} // namespace

std::string describe(const MeshSummary& mesh) { return describe_shape(mesh, "inward") + describe_size(mesh) + "\n"; }

std::string describe(const Report& report) {
  const MeshSummary& mesh = report.mesh;
  const bool rooms = report.surroundings.kind == SceneKind::interior;
  std::string text = describe_shape(mesh, rooms ? "to the scanners" : "inward");
  if (mesh.closed() && rooms)
    text += "  interior: free space of " + rounded(-mesh.volume) + ", walls of " + rounded(mesh.area) + "\n";
  else
    text += describe_size(mesh);
  if (mesh.closed() && rooms)
    return text + describe_bridged(report) + describe_moved(report) + describe_simplified(report);
  if (!mesh.closed()) // what is left after trimming is covered
    text += ", " + (report.options.trim ? "all" : rounded(100 * (1 - report.unsupported_area)) + " %") +
            " of it covered by samples";
  if (report.base) text += "; " + rounded(report.base->volume_above_rim) + " above the plane of the rim";
  text += "\n";
  text += describe_bridged(report) + describe_moved(report) + describe_simplified(report);
  if (report.surroundings.kind == SceneKind::facade)
    text += "  one side: seen from " + to_string(report.surroundings.front) + ", solid behind" +
            (report.options.facade
                 ? ""
                 : " (found from how the samples lie; --facade -z if it was seen from below, --facade off if "
                   "it is a body)") +
            "\n";
  return text;
}

} // namespace eigencrust::cli
