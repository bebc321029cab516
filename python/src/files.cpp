// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "bindings.h"

namespace eigencrust::python {
namespace {

namespace fs = std::filesystem;

/// \throws Error{usage} naming the accepted words
template <class Value, std::size_t n>
Value choice(const std::array<std::pair<const char*, Value>, n>& words, const char* what, const std::string& text) {
  std::string accepted;
  for (const auto& [word, value] : words) {
    if (text == word) return value;
    accepted += std::string(accepted.empty() ? "" : ", ") + word;
  }
  throw Error(ErrorKind::usage, what, "'" + text + "' is not known", "use one of " + accepted);
}

/// \throws Error{usage}
Vec3 finite(const std::array<double, 3>& v, const char* what) {
  const Vec3 vector{v[0], v[1], v[2]};
  if (!is_finite(vector)) throw Error(ErrorKind::usage, what, "it is not finite", "give three numbers");
  return vector;
}

constexpr std::array<std::pair<const char*, PcdViewpoint>, 4> viewpoints{{{"auto", PcdViewpoint::automatic},
                                                                          {"sensor", PcdViewpoint::sensor},
                                                                          {"pose", PcdViewpoint::pose},
                                                                          {"none", PcdViewpoint::none}}};
constexpr std::array<std::pair<const char*, CoordinateType>, 3> coordinate_types{
    {{"auto", CoordinateType::automatic}, {"float32", CoordinateType::float32}, {"float64", CoordinateType::float64}}};

/// The cloud, what its reader understood, and its warnings.
std::tuple<std::shared_ptr<PointCloud>, std::vector<std::string>, std::vector<std::string>> read_cloud(
    const fs::path& path, std::vector<std::string> columns, const std::string& pcd_viewpoint, bool sensors,
    double scale, const std::array<double, 3>& shift) {
  if (!(scale > 0) || !std::isfinite(scale))
    throw Error(ErrorKind::usage, "scale", "it is not positive", "give how much longer each length becomes");
  const ReadOptions options{.columns = std::move(columns),
                            .pcd_viewpoint = choice(viewpoints, "pcd_viewpoint", pcd_viewpoint),
                            .sensors = sensors,
                            .scale = scale,
                            .shift = finite(shift, "shift")};
  ReadNotes notes;
  const py::gil_scoped_release unlocked;
  auto cloud = std::make_shared<PointCloud>(read_point_cloud(path, options, &notes));
  return {std::move(cloud), std::move(notes.notes), std::move(notes.warnings)};
}

WriteOptions write_options(const std::string& coordinates, double spacing, std::vector<std::string> comments,
                           std::string format, const std::array<double, 3>& shift, double metres) {
  if (!(metres >= 0) || !std::isfinite(metres))
    throw Error(ErrorKind::usage, "metres", "it is no length", "give the length of the unit in metres, 0.001 for mm");
  return {.coordinates = choice(coordinate_types, "coordinates", coordinates),
          .spacing = spacing,
          .comments = std::move(comments),
          .format = std::move(format),
          .shift = finite(shift, "shift"),
          .metres = metres};
}

/// (mesh, length of its unit in metres or 0, what there is to say)
std::tuple<std::shared_ptr<TriangleMesh>, double, std::vector<std::string>> read_mesh_file(const fs::path& path) {
  const py::gil_scoped_release unlocked;
  MeshNotes notes;
  auto mesh = std::make_shared<TriangleMesh>(read_mesh(path, &notes));
  return {std::move(mesh), notes.metres, std::move(notes.notes)};
}

} // namespace

void bind_files(py::module_& module) {
  module.def("read_point_cloud", &read_cloud);
  module.def("read_mesh", &read_mesh_file);
  module.def("write_mesh", [](const fs::path& path, const TriangleMesh& mesh, const std::string& coordinates,
                              double spacing, std::vector<std::string> comments, std::string format,
                              const std::array<double, 3>& shift, double metres) {
    const WriteOptions options =
        write_options(coordinates, spacing, std::move(comments), std::move(format), shift, metres);
    const py::gil_scoped_release unlocked;
    return write_mesh(path, mesh, options).warnings;
  });
  module.def("write_point_cloud", [](const fs::path& path, const PointCloud& cloud, const std::string& coordinates,
                                     double spacing, std::vector<std::string> comments, std::string format,
                                     const std::array<double, 3>& shift) {
    const WriteOptions options = write_options(coordinates, spacing, std::move(comments), std::move(format), shift, 0);
    const py::gil_scoped_release unlocked;
    return write_point_cloud(path, cloud, options).warnings;
  });
  module.def("join_scans", [](const std::vector<std::shared_ptr<PointCloud>>& scans) {
    const py::gil_scoped_release unlocked;
    auto cloud = std::make_shared<PointCloud>();
    for (std::size_t i = 0; i < scans.size(); ++i)
      if (i == 0)
        *cloud = *scans[i];
      else
        append_scan(*cloud, *scans[i]);
    return cloud;
  });
  module.def("read_scan_index",
             [](const fs::path& path, std::size_t points) { return own(read_scan_index(path, points)); });
  module.def("read_scan_sensors", [](const fs::path& path, const PointCloud& cloud) {
    auto seen = std::make_shared<PointCloud>(cloud);
    read_scan_sensors(path, *seen);
    return seen;
  });
  module.def("can_write_mesh", &can_write_mesh, py::arg("path"), py::arg("format") = "",
             "Is there a writer for this file's extension, or for the format if one is named?");
  module.def("can_write_point_cloud", &can_write_point_cloud, py::arg("path"), py::arg("format") = "",
             "Is there a writer of clouds for this file's extension, or for the format if one is named?");
  module.def("sha256_of_file", &sha256_of_file, py::call_guard<py::gil_scoped_release>());
}

} // namespace eigencrust::python
