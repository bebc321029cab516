// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <atomic>
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
  app.add_option("INPUT", options.paths,
                 "Point clouds (ply e57 ptx pcd pts xyz txt asc csv obj off stl); several are several scans")
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
}

PointCloud read_inputs(const InputOptions& options, std::vector<InputFile>& files,
                       std::vector<std::vector<std::string>>* notes) {
  const ReadOptions read_options{split(options.columns), viewpoint_of(options.pcd_viewpoint)};
  PointCloud cloud;
  for (const std::string& path : options.paths) {
    std::vector<std::string> said;
    PointCloud next = read_point_cloud(path, read_options, &said);
    if (notes != nullptr) notes->push_back(std::move(said));
    files.push_back({path, sha256_of_file(path), next.points.size()});
    if (files.size() == 1)
      cloud = std::move(next);
    else
      append_scan(cloud, std::move(next));
    if (interrupted()) throw Error(ErrorKind::cancelled, "reading", "cancelled", "start again to finish");
  }
  if (!options.scan_index.empty()) {
    if (options.paths.size() > 1)
      throw Error(ErrorKind::usage, "command line", "--scan-index goes with a single input",
                  "leave it out: several inputs are several scans");
    cloud.scan_index = read_scan_index(options.scan_index, cloud.points.size());
  }
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

std::string describe(const MeshSummary& mesh) {
  const auto count = [](std::uint64_t n, const char* one, const char* many) {
    return grouped(n) + " " + (n == 1 ? one : many);
  };
  std::ostringstream out;
  out << "  " << count(mesh.vertices, "vertex", "vertices") << ", " << count(mesh.triangles, "triangle", "triangles")
      << ", " << count(mesh.components, "component", "components") << ", genus " << mesh.genus << "\n";
  out << "  closed: "
      << (mesh.closed() ? "yes" : "no (" + count(mesh.boundary_edges, "boundary edge", "boundary edges") + ")");
  out << ", manifold: "
      << (mesh.manifold() ? "yes"
                          : "no (" + count(mesh.nonmanifold_edges, "edge", "edges") + ", " +
                                count(mesh.nonmanifold_vertices, "vertex", "vertices") + ")");
  out << ", oriented: "
      << (mesh.oriented() ? (mesh.volume >= 0 ? "yes" : "yes, inward")
                          : "no (" + count(mesh.inconsistent_edges, "edge", "edges") + ")")
      << "\n";
  if (mesh.degenerate_triangles > 0) out << "  degenerate triangles: " << grouped(mesh.degenerate_triangles) << "\n";
  out << "  self-intersections: "
      << (mesh.self_intersections < 0 ? "not counted"
                                      : grouped(static_cast<std::uint64_t>(mesh.self_intersections)) + " pairs")
      << "\n";
  out << "  volume " << rounded(mesh.volume) << ", area " << rounded(mesh.area) << "\n";
  return out.str();
}

} // namespace eigencrust::cli
