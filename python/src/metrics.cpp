// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/metrics.h>

#include <pybind11/stl.h>

#include <eigencrust/error.h>
#include <eigencrust/measures.h>
#include <eigencrust/memory_forecast.h>
#include <eigencrust/report.h>
#include <eigencrust/threads.h>
#include <eigencrust/validate.h>

#include "bindings.h"
#include "parallel/threads.h"

namespace eigencrust::python {
namespace {

py::tuple as_tuple(const Vec3& v) { return py::make_tuple(v.x, v.y, v.z); }

void bind_summary(py::module_& module) {
  using S = MeshSummary;
  py::class_<ComponentSummary>(module, "ComponentSummary", "A set of triangles joined along edges.")
      .def_readonly("vertices", &ComponentSummary::vertices)
      .def_readonly("triangles", &ComponentSummary::triangles)
      .def_readonly("euler", &ComponentSummary::euler)
      .def_readonly("genus", &ComponentSummary::genus, "-1 where it is not orientable");
  py::class_<S>(module, "MeshSummary", "What a mesh is. Vertices of equal coordinates count as one.")
      .def_property_readonly("closed", &S::closed, "Every edge has more than one triangle, and there are triangles.")
      .def_property_readonly("manifold", &S::manifold, "No edge has more than two triangles, each vertex has one fan.")
      .def_property_readonly("oriented", &S::oriented, "Neighbours run along their edge in opposite directions.")
      .def_readonly("vertices", &S::vertices)
      .def_readonly("triangles", &S::triangles)
      .def_readonly("unreferenced_vertices", &S::unreferenced_vertices)
      .def_readonly("boundary_edges", &S::boundary_edges)
      .def_readonly("boundary_loops", &S::boundary_loops)
      .def_readonly("nonmanifold_edges", &S::nonmanifold_edges)
      .def_readonly("nonmanifold_vertices", &S::nonmanifold_vertices)
      .def_readonly("inconsistent_edges", &S::inconsistent_edges)
      .def_readonly("degenerate_triangles", &S::degenerate_triangles)
      .def_property_readonly(
          "self_intersections",
          [](const S& s) { return s.self_intersections < 0 ? py::object(py::none()) : py::int_(s.self_intersections); },
          "Pairs of triangles that intersect; None: not counted")
      .def_readonly("all_self_intersections", &S::all_self_intersections,
                    "False: there are at least as many as self_intersections says.")
      .def_readonly("components", &S::components)
      .def_readonly("euler", &S::euler)
      .def_readonly("genus", &S::genus, "Sum over the components; -1 if one is not orientable.")
      .def_readonly("volume", &S::volume, "Signed; positive: triangles look outward.")
      .def_readonly("area", &S::area)
      .def_property_readonly("bounds",
                             [](const S& s) { return py::make_tuple(as_tuple(s.bounds.min), as_tuple(s.bounds.max)); })
      .def_readonly("component_list", &S::component_list, "Largest first.")
      .def_property_readonly("_json", [](const S& s) { return to_json(s); });
  module.def(
      "validate",
      [](const TriangleMesh& mesh, bool self_intersections, bool merge_equal_vertices, unsigned threads) {
        return validate(mesh, {self_intersections, merge_equal_vertices, threads});
      },
      py::call_guard<py::gil_scoped_release>());
}

/// The measures of a mesh with what they belong to.
struct Measured {
  MeshSummary summary;
  MeshMeasures measures;
  double metres = 0;
};

Measured measured(const TriangleMesh& mesh, double metres, bool self_intersections, bool walls, unsigned threads) {
  if (!(metres >= 0) || !std::isfinite(metres))
    throw Error(ErrorKind::usage, "metres", "it is no length", "give the length of the unit in metres, 0.001 for mm");
  Measured m{.summary = validate(mesh, {.self_intersections = self_intersections, .threads = threads}),
             .measures = {},
             .metres = metres};
  m.measures = measure(mesh, m.summary, {.most_rays = walls ? MeasureOptions{}.most_rays : 0u, .threads = threads});
  return m;
}

void bind_measures(py::module_& module) {
  using M = Measured;
  const auto figure = [](auto member) { return [member](const M& m) { return m.measures.*member; }; };
  py::class_<M>(module, "MeshMeasures", "How regular triangles are, how thick the body is, and if it can be printed.")
      .def_property_readonly("smallest_angle", figure(&MeshMeasures::smallest_angle), "Of a triangle, degrees.")
      .def_property_readonly("largest_angle", figure(&MeshMeasures::largest_angle), "Of a triangle, degrees.")
      .def_property_readonly("worst_aspect", figure(&MeshMeasures::worst_aspect),
                             "Longest side over the diameter of the inscribed circle, 1 for equal sides.")
      .def_property_readonly("shortest_edge", figure(&MeshMeasures::shortest_edge), "In the unit of the mesh.")
      .def_property_readonly("median_edge", figure(&MeshMeasures::median_edge), "In the unit of the mesh.")
      .def_property_readonly("longest_edge", figure(&MeshMeasures::longest_edge), "In the unit of the mesh.")
      .def_property_readonly("thinnest_wall", figure(&MeshMeasures::thinnest_wall),
                             "Thickness that no triangle of the thinnest wall exceeds; None: not closed, or no wall.")
      .def_property_readonly(
          "thinnest_place",
          [](const M& m) {
            return m.measures.thinnest_wall ? py::object(as_tuple(m.measures.thinnest_place)) : py::none();
          },
          "Middle of a triangle of that wall, (x, y, z); None without one.")
      .def_property_readonly("wall_rays", figure(&MeshMeasures::wall_rays), "How many triangles looked for a wall.")
      .def_readonly("summary", &M::summary, "What check() says of the mesh.")
      .def_readonly("metres", &M::metres, "Length of the mesh's unit in metres; 0: not known.")
      .def_property_readonly(
          "printability", [](const M& m) { return printability(m.summary, m.measures, m.metres); },
          "Can the body be printed? In words, with what is in the way.")
      .def_property_readonly("_json", [](const M& m) { return to_json(m.summary, m.measures, m.metres); });
  module.def("measure", &measured, py::call_guard<py::gil_scoped_release>());
  module.def("length_in_words", &length_in_words, py::arg("length"), py::arg("metres"),
             "\"0.4 mm\", \"1.2 m\" of a length in a unit of so many metres; 0: no unit is known.");
}

void bind_comparison(py::module_& module) {
  using D = DistanceStatistics;
  py::class_<D>(module, "DistanceStatistics", "Summary of a set of distances, in the unit of the coordinates.")
      .def_readonly("count", &D::count)
      .def_readonly("mean", &D::mean)
      .def_readonly("rms", &D::rms)
      .def_readonly("median", &D::median)
      .def_readonly("q90", &D::q90)
      .def_readonly("q95", &D::q95)
      .def_readonly("q99", &D::q99)
      .def_readonly("max", &D::max);
  using C = Comparison;
  py::class_<C>(module, "Comparison", "How far a mesh is from a reference.")
      .def_readonly("to_reference", &C::to_reference)
      .def_readonly("from_reference", &C::from_reference)
      .def_readonly("hausdorff", &C::hausdorff, "The larger of the two maxima.")
      .def_readonly("threshold", &C::threshold, "Of the F-score.")
      .def_readonly("precision", &C::precision)
      .def_readonly("recall", &C::recall)
      .def_readonly("f_score", &C::f_score)
      .def_readonly("normal_consistency", &C::normal_consistency)
      .def_readonly("oriented_normal_consistency", &C::oriented_normal_consistency)
      .def_property_readonly(
          "volume_iou", [](const C& c) { return c.volume_iou < 0 ? py::object(py::none()) : py::float_(c.volume_iou); },
          "None unless both are closed");
  module.def(
      "compare",
      [](const TriangleMesh& mesh, const TriangleMesh& reference, std::size_t samples, std::uint64_t seed,
         double threshold, unsigned threads) {
        return compare(mesh, reference, CompareOptions{samples, seed, threshold, threads});
      },
      py::call_guard<py::gil_scoped_release>());
  module.def(
      "volume_iou",
      [](const TriangleMesh& a, const TriangleMesh& b, std::uint32_t columns, unsigned threads) {
        return volume_iou(a, b, columns, threads);
      },
      py::call_guard<py::gil_scoped_release>());
}

/// A tree with the mesh it was made of.
struct Tree {
  TriangleTree tree;
  Threads threads;

  Tree(const TriangleMesh& mesh, unsigned count) : tree(mesh), threads(count) {}
};

py::tuple nearest(const Tree& self, const py::object& points) {
  const std::vector<Vec3> queries = to_points(points, "points");
  const std::size_t n = queries.size();
  std::vector<double> distances(n, std::numeric_limits<double>::quiet_NaN());
  std::vector<Vec3> places(n, {distances[0], distances[0], distances[0]});
  std::vector<std::uint32_t> triangles(n, no_index);
  {
    const py::gil_scoped_release unlocked;
    for_each_index(
        self.threads, n,
        [&](std::size_t i) {
          if (!is_finite(queries[i])) return;
          const TriangleTree::Nearest found = self.tree.nearest(queries[i]);
          distances[i] = found.distance;
          places[i] = found.point;
          triangles[i] = found.triangle;
        },
        costly_block);
  }
  return py::make_tuple(own(std::move(distances)), own(std::move(places)), own(std::move(triangles)));
}

py::tuple first_hit(const Tree& self, const py::object& origins, const py::object& directions) {
  const std::vector<Vec3> from = to_points(origins, "origins"), along = to_points(directions, "directions");
  if (from.size() != along.size())
    throw Error(ErrorKind::input, "directions",
                "there are " + std::to_string(along.size()) + " for " + std::to_string(from.size()) + " origins",
                "give one direction for each origin");
  std::vector<double> distances(from.size());
  std::vector<std::uint32_t> triangles(from.size(), no_index);
  {
    const py::gil_scoped_release unlocked;
    for_each_index(
        self.threads, from.size(),
        [&](std::size_t i) {
          const bool fine = is_finite(from[i]) && is_finite(along[i]);
          const TriangleTree::Hit hit = fine ? self.tree.first_hit(from[i], along[i]) : TriangleTree::Hit{};
          distances[i] = hit.valid() ? hit.distance : std::numeric_limits<double>::quiet_NaN();
          if (hit.valid()) triangles[i] = hit.triangle;
        },
        costly_block);
  }
  return py::make_tuple(own(std::move(distances)), own(std::move(triangles)));
}

void bind_distances(py::module_& module) {
  py::class_<Tree>(module, "TriangleTree", "Nearest points and rays on a mesh.")
      .def(py::init<const TriangleMesh&, unsigned>(), py::arg("mesh"), py::arg("threads") = 0)
      .def("nearest", nearest, py::arg("points"),
           "Of each point: distance (N,), nearest point (N,3) and triangle (N,). NaN and 2^32-1 for rows not finite.")
      .def("first_hit", first_hit, py::arg("origins"), py::arg("directions"),
           "Of each ray: distance in units of the direction's length (N,), NaN for none, and triangle (N,).");
  module.def("distances_to_surface", [](const py::object& points, const TriangleMesh& mesh, unsigned threads) {
    const std::vector<Vec3> queries = to_points(points, "points");
    std::vector<double> distances;
    {
      const py::gil_scoped_release unlocked;
      distances = distances_to_surface(queries, mesh, threads);
    }
    return own(std::move(distances));
  });
  module.def("distances_to_points", [](const py::object& points, const py::object& targets, unsigned threads) {
    const std::vector<Vec3> queries = to_points(points, "points"), others = to_points(targets, "targets");
    std::vector<double> distances;
    {
      const py::gil_scoped_release unlocked;
      distances = distances_to_points(queries, others, threads);
    }
    return own(std::move(distances));
  });
  module.def("sample_surface", [](const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> triangles;
    std::vector<Vec3> points;
    {
      const py::gil_scoped_release unlocked;
      points = sample_surface(mesh, count, seed, &triangles);
    }
    return py::make_tuple(own(std::move(points)), own(std::move(triangles)));
  });
  module.def("summarize", [](std::vector<double> distances) { return summarize(std::move(distances)); });
}

} // namespace

void bind_metrics(py::module_& module) {
  bind_summary(module);
  bind_measures(module);
  bind_comparison(module);
  bind_distances(module);
  module.def(
      "info_json", [](const PointCloud& cloud, unsigned threads) { return info_json(cloud, threads); },
      py::call_guard<py::gil_scoped_release>());
  module.def("forecast", [](std::uint64_t points) {
    const Forecast f = forecast(points);
    return py::make_tuple(f.memory_bytes, f.seconds);
  });
  module.def("memory_warning",
             [](const PointCloud& cloud) { return memory_warning(forecast(cloud), available_memory_bytes()); });
}

} // namespace eigencrust::python
