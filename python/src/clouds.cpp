// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/validate.h>

#include "bindings.h"
#include "evidence/sensor_rows.h"

namespace eigencrust::python {
namespace {

[[noreturn]] void fail_sensors(const std::string& cause) {
  throw Error(ErrorKind::input, "sensors", cause,
              "give one place (3,), a place per point (N,3), or a place per scan (K,3) together with scan_index");
}

/// One place or direction for all points, one per scan, or one per point. Rows that are not finite say: none is known.
void set_sensors(PointCloud& cloud, const py::object& places, bool are_directions) {
  const char* what = are_directions ? "sensor_directions" : "sensors";
  std::vector<Vec3> rows = to_optional_points(places, what);
  if (are_directions)
    for (Vec3& row : rows) {
      const double length = norm(row);
      if (is_finite(row) && !(length > 0))
        throw Error(ErrorKind::input, what, "a direction has no length", "give the direction from surface to scanner");
      row = (1 / length) * row;
    }
  std::uint32_t scans = 1;
  for (const std::uint32_t scan : cloud.scan_index) scans = std::max(scans, scan + 1);
  const std::size_t n = cloud.points.size();
  if (rows.size() == n) {
    set_sensor_rows(cloud, rows);
  } else if (rows.size() == 1 || (!cloud.scan_index.empty() && rows.size() == scans)) {
    std::vector<Vec3> of_rows(n, rows[0]);
    if (rows.size() > 1)
      for (std::size_t i = 0; i < n; ++i) of_rows[i] = rows[cloud.scan_index[i]];
    set_sensor_rows(cloud, of_rows);
  } else {
    fail_sensors("there are " + std::to_string(rows.size()) + " places for " + std::to_string(n) + " points" +
                 (cloud.scan_index.empty() ? "" : " and " + std::to_string(scans) + " scans"));
  }
  for (Sensor& sensor : cloud.sensors) sensor.at_infinity = are_directions;
}

void check_finite(const std::vector<Vec3>& points, const std::string& nonfinite) {
  if (nonfinite == "skip") return;
  if (nonfinite != "raise")
    throw Error(ErrorKind::usage, "nonfinite", "'" + nonfinite + "' is no way to treat rows that are not finite",
                "use raise or skip");
  std::size_t count = 0, first = 0;
  for (std::size_t i = points.size(); i-- > 0;)
    if (!is_finite(points[i])) {
      ++count;
      first = i;
    }
  if (count > 0)
    throw Error(ErrorKind::input, "points",
                std::to_string(count) + (count == 1 ? " row is" : " rows are") + " NaN or infinite, the first is row " +
                    std::to_string(first),
                "leave them out, points[numpy.isfinite(points).all(axis=1)], or pass nonfinite='skip', which keeps "
                "the numbers of the rows");
}

std::shared_ptr<PointCloud> make_cloud(const py::object& points, const py::object& sensors,
                                       const py::object& sensor_directions, const py::object& scan_index,
                                       const py::object& attributes, const std::string& nonfinite) {
  auto cloud = std::make_shared<PointCloud>();
  cloud->points = to_points(points, "points");
  check_finite(cloud->points, nonfinite);
  const std::size_t n = cloud->points.size();
  if (!scan_index.is_none()) cloud->scan_index = to_indices(scan_index, "scan_index", n, no_index - 1);
  cloud->attributes = to_attributes(attributes, n, "points");
  // As readers do: columns that number the rows and columns of a range image tell which points are beside which.
  if (std::optional<ScanGrids> grids = find_grids(*cloud)) {
    cloud->grids = std::move(grids->sizes);
    cloud->cell = std::move(grids->cell);
  }
  if (!sensors.is_none() && !sensor_directions.is_none())
    fail_sensors("sensors and sensor_directions exclude one another");
  if (!sensors.is_none()) set_sensors(*cloud, sensors, false);
  if (!sensor_directions.is_none()) set_sensors(*cloud, sensor_directions, true);
  return cloud;
}

std::shared_ptr<TriangleMesh> make_mesh(const py::object& vertices, const py::object& triangles,
                                        const py::object& vertex_attributes, const py::object& triangle_attributes) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = to_points(vertices, "vertices");
  const auto corners = py::module_::import("eigencrust._arrays")
                           .attr("as_triangles")(triangles, mesh->vertices.size())
                           .cast<py::array_t<std::uint32_t>>();
  const auto rows = corners.unchecked<2>();
  mesh->triangles.resize(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i)
    for (py::ssize_t k = 0; k < 3; ++k)
      mesh->triangles[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = rows(i, k);
  mesh->vertex_attributes = to_attributes(vertex_attributes, mesh->vertices.size(), "vertices");
  mesh->triangle_attributes = to_attributes(triangle_attributes, mesh->triangles.size(), "triangles");
  return mesh;
}

template <class Owner, class Member>
auto viewed(Member Owner::*member) {
  return [member](const py::object& self) { return view(self.cast<const Owner&>().*member, self); };
}

py::list sensors_of(const PointCloud& cloud) {
  py::list sensors;
  const py::object make = py::module_::import("eigencrust._arrays").attr("Sensor");
  for (const Sensor& s : cloud.sensors)
    sensors.append(make(py::make_tuple(s.place.x, s.place.y, s.place.z), s.at_infinity));
  return sensors;
}

} // namespace

std::shared_ptr<PointCloud> to_cloud(const py::object& points) {
  if (py::isinstance<PointCloud>(points)) return points.cast<std::shared_ptr<PointCloud>>();
  return make_cloud(points, py::none(), py::none(), py::none(), py::none(), "raise");
}

void bind_clouds(py::module_& module) {
  py::class_<PointCloud, std::shared_ptr<PointCloud>>(module, "PointCloud",
                                                      "Points in the order of their rows, with what is known of them.")
      .def(py::init(&make_cloud), py::arg("points"), py::kw_only(), py::arg("sensors") = py::none(),
           py::arg("sensor_directions") = py::none(), py::arg("scan_index") = py::none(),
           py::arg("attributes") = py::none(), py::arg("nonfinite") = "raise")
      .def("__len__", [](const PointCloud& cloud) { return cloud.points.size(); })
      .def_property_readonly("points", viewed(&PointCloud::points), "(N,3) float64")
      .def_property_readonly("attributes", viewed(&PointCloud::attributes), "Columns by name, each of N rows.")
      .def_property_readonly("scan_index", viewed(&PointCloud::scan_index), "(N,) uint32; empty: one scan")
      .def_property_readonly("sensor_of", viewed(&PointCloud::sensor_of),
                             "(N,) uint32, a number in `sensors`, 2^32-1 for none; empty: none is known")
      .def_property_readonly("sensors", sensors_of, "Where the scanners stood.")
      .def("_as_mesh", [](const PointCloud& cloud) { // for pictures
        auto mesh = std::make_shared<TriangleMesh>();
        mesh->vertices = cloud.points;
        mesh->vertex_attributes = cloud.attributes;
        return mesh;
      });

  py::class_<TriangleMesh, std::shared_ptr<TriangleMesh>>(
      module, "Mesh",
      "Indexed triangles, counter-clockwise seen from outside. Arrays are views that cannot be written.")
      .def(py::init(&make_mesh), py::arg("vertices"), py::arg("triangles"), py::kw_only(),
           py::arg("vertex_attributes") = py::none(), py::arg("triangle_attributes") = py::none())
      .def_property_readonly("vertices", viewed(&TriangleMesh::vertices), "(V,3) float64")
      .def_property_readonly("triangles", viewed(&TriangleMesh::triangles), "(T,3) uint32")
      .def_property_readonly("vertex_attributes", viewed(&TriangleMesh::vertex_attributes),
                             "Columns by name, each of V rows.")
      .def_property_readonly("triangle_attributes", viewed(&TriangleMesh::triangle_attributes),
                             "Columns by name, each of T rows.")
      .def(
          "merge_equal_vertices",
          [](const TriangleMesh& mesh) { return std::make_shared<TriangleMesh>(merge_equal_vertices(mesh)); },
          py::call_guard<py::gil_scoped_release>(), "The mesh with vertices of equal coordinates made one.")
      .def(
          "triangle_components",
          [](const TriangleMesh& mesh, unsigned threads) { return own(triangle_components(mesh, threads)); },
          py::arg("threads") = 0, "(T,) number of the piece that each triangle belongs to.");
}

} // namespace eigencrust::python
