// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <sstream>

#include "command.h"

namespace eigencrust::cli {
namespace {

// A signal handler can reach nothing but a variable with static storage.
volatile std::sig_atomic_t interrupt_count = 0;

void on_interrupt(int signal_number) {
  interrupt_count = interrupt_count + 1;
  if (interrupt_count > 1) {
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
  }
}

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

void catch_interrupts() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

bool interrupted() { return interrupt_count > 0; }

Parsed parse(CLI::App& app, const Arguments& arguments) {
  std::vector<std::string> reversed(arguments.words.rbegin(), arguments.words.rend());
  try {
    app.parse(std::move(reversed));
  } catch (const CLI::CallForHelp& help) {
    return {true, app.exit(help)};
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::usage, "command line", error.what(), "see --help");
  }
  return {};
}

void add_input_options(CLI::App& app, InputOptions& options) {
  app.add_option(
         "INPUT", options.paths,
         "Point clouds (ply e57 las ptx pcd pts npz npy xyz txt asc csv obj off stl); several are several scans")
      ->required();
  app.add_option("--columns", options.columns,
                 "Names of a text file's columns in order, e.g. x,y,z,red,green,blue; - skips one");
  app.add_option("--scan-index", options.scan_index,
                 "Scan number of each point of one file that holds several scans: bytes (.u8) or one number per line");
  app.add_option("--pcd-viewpoint", options.pcd_viewpoint,
                 "VIEWPOINT of PCD files: auto (sensor unless 0 0 0), sensor (its position), pose (also moves the "
                 "points) or none")
      ->check(CLI::IsMember({"auto", "sensor", "pose", "none"}))
      ->capture_default_str();
  app.add_option("--sensor", options.sensor,
                 "x,y,z where the scanner stood for an input, instead of what the file says; repeat for each input")
      ->allow_extra_args(false);
  app.add_option("--sensor-direction", options.sensor_direction,
                 "x,y,z direction from the surface to the scanner, for parallel rays; repeat for each input")
      ->allow_extra_args(false);
  app.add_option("--sensors", options.sensors,
                 "File with a row scan,x,y,z for each scan, or scan,dx,dy,dz under a header; none: ignore all sensors");
}

PointCloud read_inputs(const InputOptions& options, std::vector<InputFile>& files,
                       std::vector<std::vector<std::string>>* notes) {
  const std::vector<Sensor> sensors = sensors_of_inputs(options);
  // What is replaced need not be looked for.
  const ReadOptions read_options{split(options.columns), viewpoint_of(options.pcd_viewpoint),
                                 sensors.empty() && options.sensors.empty()};
  PointCloud cloud;
  for (const std::string& path : options.paths) {
    std::vector<std::string> said;
    PointCloud next = read_point_cloud(path, read_options, &said);
    if (notes != nullptr) notes->push_back(std::move(said));
    if (!sensors.empty()) {
      next.sensors.assign(1, sensors[files.size()]);
      next.sensor_of.assign(next.points.size(), 0);
    }
    files.push_back({path, sha256_of_file(path), next.points.size(), {}, 0});
    if (files.size() == 1)
      cloud = std::move(next);
    else
      append_scan(cloud, std::move(next));
    if (interrupted()) throw Error(ErrorKind::cancelled, "reading", "cancelled", "start again to finish");
  }
  if (!options.scan_index.empty()) {
    if (options.paths.size() > 1)
      fail_usage("--scan-index goes with a single input", "leave it out: several inputs are several scans");
    cloud.scan_index = read_scan_index(options.scan_index, cloud.points.size());
  }
  if (!options.sensors.empty() && options.sensors != "none") read_scan_sensors(options.sensors, cloud);
  note_sensors(cloud, files);
  return cloud;
}

void print_warning(const std::string& text) {
  clear_progress();
  std::fprintf(stderr, "eigencrust: warning: %s\n", text.c_str());
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
                                      : grouped(static_cast<std::uint64_t>(mesh.self_intersections)) + " pairs")
      << "\n";
  return out.str();
}

std::string describe_size(const MeshSummary& mesh) {
  return (mesh.closed() ? "  volume " + rounded(mesh.volume) + ", area " : "  area ") + rounded(mesh.area);
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
  if (mesh.closed() && rooms) return text;
  if (!mesh.closed() && !report.options.trim)
    text += ", " + rounded(100 * (1 - report.unsupported_area)) + " % of it covered by samples";
  if (report.base) text += "; " + rounded(report.base->volume_above_rim) + " above the plane of the rim";
  text += "\n";
  if (report.surroundings.kind == SceneKind::facade)
    text += "  one side: seen from " + to_string(report.surroundings.front) + ", solid behind" +
            (report.options.facade ? "" : " (found from how the samples lie; --facade off if this is wrong)") + "\n";
  return text;
}

} // namespace eigencrust::cli
