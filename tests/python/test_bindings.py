# SPDX-License-Identifier: GPL-3.0-or-later
"""Every binding is called: the package is asked what it has, and each of that must be in the tables below."""

import inspect
import pathlib
import tempfile
import unittest

import eigencrust
import numpy as np
from eigencrust import _core, stages
from support import sphere


def public(thing):
    return {name for name in vars(thing) if not name.startswith("_")}


def functions(module, names):
    return {name for name in names if inspect.isroutine(getattr(module, name))}


def classes(*modules):
    """Classes of the extension by name."""
    return {name: thing for module in modules for name, thing in vars(module).items() if inspect.isclass(thing)}


def members(cls):
    """Names of methods, and of what can be read."""
    methods = {name for name in public(cls) if callable(inspect.getattr_static(cls, name))}
    return methods, public(cls) - methods


class Everything(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder = pathlib.Path(folder.name)
        cls.points = points = sphere(400)
        cls.cloud = cloud = eigencrust.PointCloud(points, sensors=9 * points, scan_index=np.zeros(400, int))
        cls.result = result = eigencrust.reconstruct(cloud, point_results=True)
        cls.mesh = result.mesh
        (folder / "index.txt").write_text("0\n" * 400)
        (folder / "sensors.csv").write_text("0,1,2,3\n")
        eigencrust.write_mesh(folder / "mesh.ply", result)
        eigencrust.write_point_cloud(folder / "cloud.ply", cloud)
        s = cls.stage = {}
        s["samples"] = samples = stages.prepare_samples(cloud)
        s["tets"] = tets = stages.tetrahedralize(samples)
        s["stars"] = stars = stages.vertex_stars(tets)
        s["known"] = known = stages.known_labels(tets, stars)
        s["lines"] = lines = stages.sight_lines(cloud, samples, tets, np.zeros(400))
        s["crossings"] = stages.sight_crossings(tets, stars, lines, known)
        s["seen"] = stages.line_of_sight(tets, stars, lines, s["crossings"], known)
        s["poles"] = poles = stages.find_poles(tets, stars)
        s["graph"] = graph = stages.pole_graph(tets, stars, poles, known)
        s["partition"] = stages.partition_poles(graph)
        s["first"] = stages.label_poles(tets, poles, graph, s["partition"], known)
        s["rest"] = stages.tetrahedron_graph(tets, s["first"].labels)
        s["second"] = stages.partition_tetrahedra(s["rest"], "harmonic")
        s["settled"] = stages.label_tetrahedra(tets, s["rest"], s["second"], s["first"].labels)
        s["manifold"], s["counts"] = stages.make_manifold(tets, stars, poles, known, s["settled"])
        s["surface"] = stages.extract_surface(tets, s["manifold"].labels)

    def test_functions_of_the_package(self):
        e, cloud, mesh, points, folder = eigencrust, self.cloud, self.mesh, self.points, self.folder
        calls = {
            "can_write_mesh": lambda: e.can_write_mesh("a.ply") and e.can_write_mesh("a", format="obj"),
            "can_write_point_cloud": lambda: e.can_write_point_cloud("a.las"),
            "check": lambda: e.check(mesh).closed,
            "compare": lambda: e.compare(mesh, mesh, samples=100).f_score == 1,
            "distances_to_points": lambda: e.distances_to_points(points, points).max() == 0,
            "distances_to_surface": lambda: e.distances_to_surface(points, mesh).max() < 1e-9,
            "encode_png": lambda: e.encode_png(np.zeros((4, 4, 3), np.uint8)).startswith(b"\x89PNG"),
            "forecast": lambda: e.forecast(cloud).memory_bytes > 0,
            "info": lambda: e.info(cloud)["points"] == 400,
            "join_scans": lambda: len(e.join_scans([cloud, points])) == 800,
            "length_in_words": lambda: e.length_in_words(0.4, 0.001) == "0.4 mm",
            "measure": lambda: "printable" in e.measure(mesh).printability,
            "option_table": lambda: len(e.option_table()) > 20,
            "orient": lambda: (e.orient(cloud) * points).sum(axis=1).min() > 0.9,
            "outliers": lambda: e.outliers(cloud).inlier.all(),
            "read_mesh": lambda: len(e.read_mesh(folder / "mesh.ply").triangles) == len(mesh.triangles),
            "read_mesh_and_unit": lambda: e.read_mesh_and_unit(folder / "mesh.ply")[1] is None,
            "read_point_cloud": lambda: len(e.read_point_cloud(folder / "cloud.ply")) == 400,
            "read_scan_index": lambda: len(e.read_scan_index(folder / "index.txt", 400)) == 400,
            "read_scan_sensors": lambda: e.read_scan_sensors(folder / "sensors.csv", cloud).sensors[0].place == (1, 2, 3),
            "reconstruct": lambda: e.reconstruct(cloud).triangles.shape == mesh.triangles.shape,
            "render": lambda: e.render(mesh, width=32, height=32).shape == (32, 32, 3),
            "sample_surface": lambda: e.sample_surface(mesh, 10)[0].shape == (10, 3),
            "sha256_of_file": lambda: len(e.sha256_of_file(folder / "mesh.ply")) == 64,
            "summarize": lambda: e.summarize([1, 3]).mean == 2,
            "volume_iou": lambda: e.volume_iou(mesh, mesh) == 1,
            "write_mesh": lambda: e.write_mesh(folder / "again.ply", mesh) is None,
            "write_png": lambda: e.write_png(folder / "a.png", np.zeros((4, 4, 3), np.uint8)) is None,
            "write_point_cloud": lambda: e.write_point_cloud(folder / "again.csv", cloud) is None,
        }
        self.assertEqual(set(calls), functions(eigencrust, eigencrust.__all__))
        for name, call in calls.items():
            with self.subTest(name):
                self.assertTrue(call())

    def test_functions_of_the_extension(self):
        # What the package does not hand on under its own name, its functions call.
        handed_on = {"option_table", "reconstruct", "compare", "measure", "volume_iou", "summarize", "sample_surface"}
        handed_on |= functions(_core, public(_core)) & functions(eigencrust, eigencrust.__all__)
        others = {
            "validate": lambda: _core.validate(self.mesh, True, True, 0).closed,
            "info_json": lambda: _core.info_json(self.cloud, 0).startswith("{"),
            "memory_warning": lambda: isinstance(_core.memory_warning(self.cloud), str),
        }
        self.assertEqual(functions(_core, public(_core)), handed_on | set(others))
        for name, call in others.items():
            self.assertTrue(call(), name)

    def test_stages(self):
        s, t = self.stage, self.stage["tets"]
        questionable = stages.questionable_tetrahedra(t, np.full(400, 0.01))
        calls = {
            "median_spacing": lambda: stages.median_spacing(s["samples"], self.cloud) > 0,
            "resolve_grid_spacing": lambda: stages.resolve_grid_spacing("0.5", s["samples"], self.cloud) == 0.5,
            "questionable_tetrahedra": lambda: questionable.shape == (len(t),),
            "unlabel_questionable": lambda: stages.unlabel_questionable(t, questionable, s["known"], s["first"].labels)[1] >= 0,
            "supernodes_agree": lambda: not stages.supernodes_agree(s["second"]),
            "smooth": lambda: stages.smooth(s["surface"].mesh, "taubin", 2).vertices.shape == s["surface"].mesh.vertices.shape,
        }
        in_set_up = (
            "prepare_samples tetrahedralize vertex_stars known_labels sight_lines sight_crossings line_of_sight find_poles "
            "pole_graph partition_poles label_poles tetrahedron_graph partition_tetrahedra label_tetrahedra make_manifold "
            "extract_surface"
        )
        self.assertEqual(set(calls) | set(in_set_up.split()), functions(stages, stages.__all__))
        for name, call in calls.items():
            with self.subTest(name):
                self.assertTrue(call())
        self.assertTrue(eigencrust.check(s["surface"]).manifold)

    def test_members_of_every_class(self):
        s, mesh = self.stage, self.mesh
        summary, comparison = eigencrust.check(mesh), eigencrust.compare(mesh, mesh, samples=100)
        options = _core.Options()
        objects = {
            "Cancellation": (_core.Cancellation(), {"cancel": ()}),
            "Comparison": (comparison, {}),
            "ComponentSummary": (summary.component_list[0], {}),
            "DistanceStatistics": (comparison.to_reference, {}),
            "ManifoldCounts": (s["counts"], {}),
            "Mesh": (mesh, {"merge_equal_vertices": (), "triangle_components": ()}),
            "MeshMeasures": (eigencrust.measure(mesh), {"as_dict": ()}),
            "MeshSummary": (summary, {"as_dict": ()}),
            "Options": (options, {"set": ("noise", "off"), "get": ("noise",), "check": (), "add_points": ("outside-point", (0, 0, 5))}),
            "Partition": (s["partition"], {}),
            "PointCloud": (self.cloud, {}),
            "PoleGraph": (s["graph"], {}),
            "PoleLabels": (s["first"], {}),
            "Poles": (s["poles"], {}),
            "Result": (self.result, {}),
            "Samples": (s["samples"], {}),
            "Session": (eigencrust.Session(self.cloud)._session, {"label": (None, None)}),
            "SightCrossings": (s["crossings"], {}),
            "SightLabels": (s["seen"], {}),
            "SightLines": (s["lines"], {}),
            "SignedGraph": (s["graph"].graph, {}),
            "Surface": (s["surface"], {}),
            "Tetrahedralization": (s["tets"], {}),
            "TetrahedronGraph": (s["rest"], {}),
            "TetrahedronLabels": (s["settled"], {}),
            "TriangleTree": (eigencrust.TriangleTree(mesh), {"nearest": (self.points,), "first_hit": ([[0, 0, 0]], [[0, 0, 1]])}),
            "VertexStars": (s["stars"], {}),
        }
        found = classes(_core, _core.stages)
        self.assertEqual(set(objects), set(found))
        for name, cls in found.items():
            thing, calls = objects[name]
            self.assertIsInstance(thing, cls)
            methods, readable = members(cls)
            # To other packages: test_open3d.py, test_trimesh.py, test_pyvista.py.
            self.assertEqual({m for m in methods if not m.startswith("to_")}, set(calls), name)
            for method, arguments in calls.items():
                getattr(thing, method)(*arguments)
            for attribute in readable:
                getattr(thing, attribute)

    def test_every_option(self):
        # As text and under its own name; the defaults change nothing.
        given = {option.name: option.default for option in eigencrust.option_table() if option.kind not in ("points", "bytes")}
        given = {name: value == "on" if value in ("on", "off") and name in self.flags() else value for name, value in given.items()}
        self.assertGreater(len(given), 20)
        np.testing.assert_array_equal(eigencrust.reconstruct(self.cloud, **given).triangles, self.mesh.triangles)

    @staticmethod
    def flags():
        return {option.name for option in eigencrust.option_table() if option.kind == "flag"}

    def test_fewer_and_regular_triangles(self):
        few = eigencrust.reconstruct(self.cloud, triangles=200)
        self.assertLessEqual(len(few.triangles), 200)
        self.assertTrue(eigencrust.check(few).closed)
        self.assertEqual(few.report["simplified"]["after"]["triangles"], len(few.triangles))
        near = eigencrust.reconstruct(self.cloud, max_error="2%")
        self.assertLess(len(near.triangles), len(self.mesh.triangles))
        regular = eigencrust.measure(eigencrust.reconstruct(self.cloud, edge=0.3))
        self.assertAlmostEqual(regular.median_edge, 0.3, delta=0.1)
        self.assertTrue(regular.summary.closed)


if __name__ == "__main__":
    unittest.main(verbosity=2)
