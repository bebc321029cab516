// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <mutex>

#include <eigencrust/eigencrust.h>
#include <eigencrust/session.h>

#include "bindings.h"
#include "watch.h"

namespace eigencrust::python {
namespace {

/// A Result in parts, so that who keeps the mesh need not keep the tetrahedra.
struct Outcome {
  explicit Outcome(Result result)
      : mesh(std::make_shared<TriangleMesh>(std::move(result.mesh))),
        report(std::move(result.report)),
        tetrahedralization(std::make_shared<Tetrahedralization>(std::move(result.tetrahedralization))),
        labels(std::move(result.labels)),
        inlier(std::move(result.inlier)),
        confidence(std::move(result.confidence)),
        normals(std::move(result.normals)) {}

  std::shared_ptr<TriangleMesh> mesh;
  Report report;
  std::shared_ptr<Tetrahedralization> tetrahedralization;
  Labels labels;
  std::vector<std::uint8_t> inlier;
  std::vector<float> confidence;
  std::vector<Vec3> normals;
};

std::shared_ptr<Outcome> reconstruct_watched(const PointCloud& cloud, const Options& options,
                                             const py::object& progress, const py::object& cancel,
                                             const py::object& snapshots) {
  Watch watch(progress, cancel, snapshots);
  return watch.run([&] { return std::make_shared<Outcome>(reconstruct(cloud, options, watch)); });
}

/// A Session that two threads cannot use at once.
struct GuardedSession {
  std::unique_ptr<Session> session;
  std::mutex busy;
};

std::shared_ptr<GuardedSession> make_session(const PointCloud& cloud, const Options& options,
                                             const py::object& progress, const py::object& cancel) {
  Watch watch(progress, cancel, py::none());
  auto guarded = std::make_shared<GuardedSession>();
  watch.run([&] { guarded->session = std::make_unique<Session>(cloud, options, watch); });
  return guarded;
}

std::shared_ptr<Outcome> label(GuardedSession& self, const py::object& outside_points, const py::object& inside_points,
                               const py::object& progress, const py::object& cancel) {
  const std::unique_lock lock(self.busy, std::try_to_lock);
  if (!lock)
    throw Error(ErrorKind::usage, "session", "it is at work in another thread", "wait for that, or make two sessions");
  const std::vector<Vec3> outside = to_optional_points(outside_points, "outside_points"),
                          inside = to_optional_points(inside_points, "inside_points");
  Watch watch(progress, cancel, py::none());
  return watch.run([&] { return std::make_shared<Outcome>(self.session->label(outside, inside, watch)); });
}

} // namespace

void bind_reconstruct(py::module_& module) {
  py::class_<Cancellation, std::shared_ptr<Cancellation>>(
      module, "Cancellation", "Stops a run from any thread: pass it as `cancel`, then call cancel().")
      .def(py::init<>())
      .def(
          "cancel", [](Cancellation& self) { self.requested = true; }, "Asks the run to stop at its next check.")
      .def_property_readonly(
          "cancelled", [](const Cancellation& self) { return self.requested.load(); }, "Was it asked for?");

  py::class_<Outcome, std::shared_ptr<Outcome>>(module, "Result", "What a reconstruction gives.")
      .def_readonly("mesh", &Outcome::mesh, "The surface, a Mesh.")
      .def_property_readonly(
          "tetrahedralization",
          [](const Outcome& self) {
            return self.tetrahedralization->tetrahedra.empty() ? nullptr : self.tetrahedralization;
          },
          "The Delaunay tetrahedra; None for the result of a Session, which has them itself.")
      .def_property_readonly(
          "labels", [](const py::object& self) { return view(self.cast<const Outcome&>().labels.raw(), self); },
          "uint8 per tetrahedron: 1 inside, 2 outside")
      .def_property_readonly(
          "inlier", [](const py::object& self) { return view_flags(self.cast<const Outcome&>().inlier, self); },
          "(N,) bool: the row is a sample of the surface; empty without point_results")
      .def_property_readonly(
          "confidence", [](const py::object& self) { return view(self.cast<const Outcome&>().confidence, self); },
          "(N,) float32 in [0, 1], at least 0.5 for inliers; empty without point_results")
      .def_property_readonly(
          "normals", [](const py::object& self) { return view(self.cast<const Outcome&>().normals, self); },
          "(N,3) float64 unit normals that look outward, NaN for outliers; empty without point_results")
      .def_property_readonly(
          "warnings", [](const Outcome& self) { return self.report.warnings; }, "What there is to know before use.")
      .def_property_readonly("broken_guarantees", [](const Outcome& self) { return self.report.broken_guarantees; })
      .def_property_readonly("_report_json", [](const Outcome& self) { return to_json(self.report); });

  module.def("reconstruct", &reconstruct_watched, py::arg("cloud"), py::arg("options"),
             py::arg("progress") = py::none(), py::arg("cancel") = py::none(), py::arg("snapshots") = py::none());

  py::class_<GuardedSession, std::shared_ptr<GuardedSession>>(module, "Session")
      .def(py::init(&make_session), py::arg("cloud"), py::arg("options"), py::arg("progress") = py::none(),
           py::arg("cancel") = py::none())
      .def("label", label, py::arg("outside_points"), py::arg("inside_points"), py::arg("progress") = py::none(),
           py::arg("cancel") = py::none())
      .def_property_readonly("tetrahedralization",
                             [](const std::shared_ptr<GuardedSession>& self) {
                               // Python knows no const; nothing of the class can be changed from there.
                               return std::shared_ptr<Tetrahedralization>(
                                   self, const_cast<Tetrahedralization*>(&self->session->tetrahedralization()));
                             })
      .def_property_readonly("cloud", [](const std::shared_ptr<GuardedSession>& self) {
        return std::shared_ptr<PointCloud>(self, const_cast<PointCloud*>(&self->session->cloud()));
      });
}

} // namespace eigencrust::python
