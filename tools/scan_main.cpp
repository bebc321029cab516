// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// eigencrust-scan: a mesh in, the cloud a range scanner would have made of it out.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "command.h"
#include "virtual_scanner.h"

namespace {

using namespace eigencrust;
using namespace eigencrust::tools;

constexpr const char* about =
    "Scans a mesh with virtual range scanners and writes the cloud, with the position of the sensor at\n"
    "each point (sx sy sz), the number of the scan (scan) and the range (range).\n"
    "\n"
    "Examples:\n"
    "  eigencrust-scan bunny.ply -o cloud.ply\n"
    "  eigencrust-scan horse.ply -o cloud.ply --ring 20:6 --ring 60:3 --noise 0.1% --outliers 0.01\n"
    "  eigencrust-scan part.stl -o cloud.ply --sensor 3,0,1 --sensor -3,0,1 --max-incidence 75\n"
    "\n"
    "A length is a number in the unit of the mesh, or N% of its bounding box's diagonal.";

struct Settings {
  std::string input, output;
  std::uint32_t subdivisions = 64;
  // sensors
  std::vector<std::string> sensors, rings;
  std::uint32_t spread = 0, resolution = 200;
  double distance = 3, field_of_view = 0;
  std::string look_at, up = "0,0,1", parallel;
  // errors
  std::string noise = "0", isotropic_noise = "0", quantize = "0", outlier_kind = "box";
  ScanOptions scan;
  // output
  bool doubles = false, quiet = false;
};

void add_sensor_options(CLI::App& app, Settings& s) {
  const char* group = "Sensors (default: --sensors 8)";
  app.add_option("--sensor", s.sensors,
                 "X,Y,Z[:TARGET[:DEGREES[:RAYS]]]: a sensor there, with its own target X,Y,Z, field of view and rays "
                 "across for a "
                 "close-up; repeatable")
      ->allow_extra_args(false)
      ->group(group);
  app.add_option(
         "--ring", s.rings,
         "ELEVATION:COUNT[:AZIMUTH]: COUNT sensors at that many degrees above the horizon, the first at AZIMUTH "
         "(default 0); repeatable")
      ->allow_extra_args(false)
      ->group(group);
  app.add_option("--sensors", s.spread, "COUNT sensors spread evenly over a sphere")
      ->check(CLI::Range(1, 65536))
      ->group(group);
  app.add_option("--distance", s.distance, "of --ring and --sensors from the target, in radii of the object, above 1")
      ->capture_default_str()
      ->group(group);
  app.add_option("--look-at", s.look_at, "target X,Y,Z (default: centre of the bounding box)")->group(group);
  app.add_option("--up", s.up, "upward direction X,Y,Z")->capture_default_str()->group(group);
  app.add_option("--resolution", s.resolution, "rays across and down each sensor's view")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str()
      ->group(group);
  app.add_option("--field-of-view", s.field_of_view, "degrees across (default: the whole object just fits)")
      ->check(CLI::Range(0.0, 180.0))
      ->group(group);
  app.add_option("--parallel", s.parallel, "LENGTH: parallel rays that far apart instead of a pinhole")->group(group);
}

void add_error_options(CLI::App& app, Settings& s) {
  const char* group = "Measurement";
  app.add_option("--noise", s.noise, "LENGTH: standard deviation of the range")->capture_default_str()->group(group);
  app.add_option("--isotropic-noise", s.isotropic_noise, "LENGTH: standard deviation of each coordinate")
      ->capture_default_str()
      ->group(group);
  app.add_option("--quantize", s.quantize, "LENGTH: round ranges to multiples of it")
      ->capture_default_str()
      ->group(group);
  app.add_option("--max-incidence", s.scan.max_incidence, "degrees from the normal beyond which nothing returns, to 90")
      ->capture_default_str()
      ->group(group);
  app.add_option("--dropout", s.scan.dropout, "fraction of returns lost, 0 to 1")->capture_default_str()->group(group);
  app.add_flag("--drop-back-faces", s.scan.drop_back_faces,
               "no return where a ray first meets the inner side of the surface (for sheets without thickness)")
      ->group(group);
  app.add_option("--outliers", s.scan.outlier_fraction, "fraction of returns replaced by outliers, 0 to 1")
      ->capture_default_str()
      ->group(group);
  app.add_option("--outlier-kind", s.outlier_kind, "box: anywhere around the object; ray: before the surface")
      ->check(CLI::IsMember({"box", "ray"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--outlier-box", s.scan.outlier_box, "size of that box in bounding boxes")
      ->capture_default_str()
      ->group(group);
  app.add_option("--seed", s.scan.seed, "of all random numbers")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group(group);
}

void add_options(CLI::App& app, Settings& s) {
  app.add_option("INPUT", s.input, "mesh (ply, obj, off, stl, glb, 3mf) or Bézier patches (txt, bpt)")->required();
  app.add_option("-o,--output", s.output, "cloud to write (ply, xyz, txt, asc, csv)")->required();
  app.add_option("--subdivisions", s.subdivisions, "of each patch, 1 to 1024")->capture_default_str();
  app.add_option("--threads", s.scan.threads, "0: all cores; the result is the same for any number")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_flag("--truth", s.scan.truth, "add surface_distance and outlier to each point");
  app.add_flag("--double", s.doubles, "write coordinates as float64 instead of float32");
  app.add_flag("--quiet", s.quiet, "no summary on stderr");
  add_sensor_options(app, s);
  add_error_options(app, s);
}

std::vector<Vec3> directions(const Settings& s, const Vec3& up) {
  std::vector<Vec3> result;
  for (const std::string& text : s.rings) {
    const std::vector<double> v = parse_numbers(text, ':', 2, 3, "--ring");
    if (!(v[1] >= 1 && v[1] <= 65536 && v[1] == std::floor(v[1])))
      throw Error(ErrorKind::usage, "--ring", "'" + text + "' has no whole count from 1 to 65536",
                  "give ELEVATION:COUNT");
    const auto ring = ring_directions(static_cast<std::uint32_t>(v[1]), v[0], v.size() > 2 ? v[2] : 0, up);
    result.insert(result.end(), ring.begin(), ring.end());
  }
  const std::uint32_t spread = s.spread == 0 && s.rings.empty() && s.sensors.empty() ? 8 : s.spread;
  const auto sphere = fibonacci_directions(spread, up);
  result.insert(result.end(), sphere.begin(), sphere.end());
  return result;
}

/// A sensor with a view of its own, "TARGET[:DEGREES[:RAYS]]".
tools::Sensor close_up(const Vec3& position, const std::string& view, const Vec3& up, const Settings& s) {
  const std::size_t colon = view.find(':');
  tools::Sensor sensor{.position = position, .target = parse_vector(view.substr(0, colon), "--sensor"), .up = up};
  sensor.columns = sensor.rows = s.resolution;
  if (s.field_of_view > 0) sensor.field_of_view = s.field_of_view;
  if (colon == std::string::npos) return sensor;
  const std::vector<double> v = parse_numbers(view.substr(colon + 1), ':', 1, 2, "--sensor");
  sensor.field_of_view = v[0];
  if (v.size() < 2) return sensor;
  if (!(v[1] >= 1 && v[1] <= 65536 && v[1] == std::floor(v[1])))
    throw Error(ErrorKind::usage, "--sensor", "'" + view + "' has no whole number of rays from 1 to 65536",
                "give X,Y,Z:TARGET:DEGREES:RAYS");
  sensor.columns = sensor.rows = static_cast<std::uint32_t>(v[1]);
  return sensor;
}

std::vector<tools::Sensor> make_sensors(const Settings& s, const Box3& box) {
  const Vec3 up = parse_vector(s.up, "--up");
  const Vec3 target = s.look_at.empty() ? box.centre() : parse_vector(s.look_at, "--look-at");
  const double radius = 0.5 * box.diagonal() + distance(target, box.centre());
  const double spacing = s.parallel.empty() ? 0 : parse_length(s.parallel, box.diagonal(), "--parallel");
  std::vector<tools::Sensor> sensors;
  const auto add = [&](const Vec3& direction, double distance) {
    if (!s.parallel.empty())
      sensors.push_back(aim_parallel(target, direction, radius, distance, spacing, up));
    else if (s.field_of_view > 0)
      sensors.push_back({.position = target + distance * direction,
                         .target = target,
                         .up = up,
                         .columns = s.resolution,
                         .rows = s.resolution,
                         .field_of_view = s.field_of_view});
    else
      sensors.push_back(aim_pinhole(target, direction, radius, distance, s.resolution, up));
  };
  for (const std::string& text : s.sensors) {
    const std::size_t colon = text.find(':');
    const Vec3 position = parse_vector(text.substr(0, colon), "--sensor");
    if (colon != std::string::npos) {
      sensors.push_back(close_up(position, text.substr(colon + 1), up, s));
      continue;
    }
    const double length = distance(position, target);
    if (!(length > 0))
      throw Error(ErrorKind::usage, "--sensor", "a sensor stands on its target", "move it or --look-at");
    add((1 / length) * (position - target), length);
  }
  for (const Vec3& direction : directions(s, up)) add(direction, s.distance * radius);
  return sensors;
}

void run(Settings& s) {
  if (!can_write_point_cloud(s.output))
    throw Error(ErrorKind::usage, s.output, "no cloud format of that extension can be written", "use .ply");
  const TriangleMesh mesh = read_surface(s.input, s.subdivisions);
  Box3 box;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) box.add(mesh.vertices[v]);
  if (box.empty()) throw Error(ErrorKind::input, s.input, "there are no triangles to scan", "give a mesh, not a cloud");
  s.scan.range_noise = parse_length(s.noise, box.diagonal(), "--noise");
  s.scan.isotropic_noise = parse_length(s.isotropic_noise, box.diagonal(), "--isotropic-noise");
  s.scan.range_quantum = parse_length(s.quantize, box.diagonal(), "--quantize");
  s.scan.outliers = s.outlier_kind == "ray" ? OutlierKind::ray : OutlierKind::box;

  const std::vector<tools::Sensor> sensors = make_sensors(s, box);
  PointCloud cloud = scan(mesh, sensors, s.scan);
  if (cloud.points.empty())
    throw Error(ErrorKind::input, s.input, "no ray came back from the surface",
                "check --sensor, --look-at, --max-incidence and the orientation of the mesh");
  cloud.scan_index.clear(); // the attribute "scan" says the same, and files hold attributes
  WriteOptions write;
  write.coordinates = s.doubles ? CoordinateType::float64 : CoordinateType::float32;
  const WriteResult written = write_point_cloud(s.output, cloud, write);
  for (const std::string& warning : written.warnings) std::cerr << "eigencrust-scan: warning: " << warning << "\n";
  if (!s.quiet)
    std::cerr << "eigencrust-scan: " << cloud.points.size() << " points from " << sensors.size() << " sensors, noise "
              << s.scan.range_noise << ", seed " << s.scan.seed << "\n";
}

} // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app(about, "eigencrust-scan");
  add_options(app, settings);
  return run_command(app, argc, argv, [&] { run(settings); });
}
