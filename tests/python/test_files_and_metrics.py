# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers, writers, measures, pictures, and how things show themselves."""

import base64
import logging
import pathlib
import pickle
import re
import struct
import tempfile
import unittest

import eigencrust
import numpy as np
from support import TEAPOT, sphere

TETRAHEDRON = (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_clouds(self):
        cloud = eigencrust.PointCloud(sphere(50), attributes={"tag": np.arange(50), "heat": np.linspace(0, 1, 50)})
        for name in ("cloud.ply", "cloud.csv", "cloud.xyz"):
            path = self.folder / name
            self.assertTrue(eigencrust.can_write_point_cloud(path))
            eigencrust.write_point_cloud(path, cloud, coordinates="float64" if name.endswith("ply") else "auto")
            columns = ["x", "y", "z", "tag", "heat"] if name.endswith("xyz") else []
            again = eigencrust.read_point_cloud(str(path), columns=columns)
            np.testing.assert_array_equal(again.points, cloud.points)
            np.testing.assert_array_equal(again.attributes["tag"], np.arange(50))
        self.assertEqual(again.attributes["heat"].shape, (50,))
        np.save(self.folder / "points.npy", sphere(9))
        np.testing.assert_array_equal(eigencrust.read_point_cloud(self.folder / "points.npy").points, sphere(9))
        with self.assertRaises(eigencrust.UsageError):
            eigencrust.read_point_cloud(TEAPOT, pcd_viewpoint="somewhere")
        with self.assertRaises(eigencrust.InputError):
            eigencrust.write_point_cloud(self.folder / "cloud.unknown", cloud)

    def test_meshes(self):
        mesh = eigencrust.Mesh(*TETRAHEDRON, vertex_attributes={"k": range(4)}, triangle_attributes={"t": range(4)})
        for name in ("mesh.ply", "mesh.obj", "mesh.off", "mesh.stl", "mesh.glb", "mesh.3mf"):
            path = self.folder / name
            self.assertTrue(eigencrust.can_write_mesh(path))
            with self.assertLogs("eigencrust") if name != "mesh.ply" else self.assertNoLogs("eigencrust"):
                eigencrust.write_mesh(path, mesh)
            again = eigencrust.read_mesh(path)
            self.assertEqual(eigencrust.check(again).volume, eigencrust.check(mesh).volume)
        again = eigencrust.read_mesh(self.folder / "mesh.ply")
        np.testing.assert_array_equal(again.vertex_attributes["k"], range(4))
        np.testing.assert_array_equal(again.triangle_attributes["t"], range(4))
        self.assertEqual(len(eigencrust.sha256_of_file(self.folder / "mesh.ply")), 64)
        self.assertFalse(eigencrust.can_write_mesh("mesh.xyz"))
        with self.assertRaises(eigencrust.UsageError):
            eigencrust.write_mesh(self.folder / "mesh.ply", mesh, coordinates="float16")
        copy = pickle.loads(pickle.dumps(again))
        np.testing.assert_array_equal(copy.triangles, again.triangles)
        np.testing.assert_array_equal(copy.vertex_attributes["k"], range(4))

    def test_units_and_shifts(self):
        mesh = eigencrust.Mesh(*TETRAHEDRON)
        eigencrust.write_mesh(self.folder / "mm.3mf", mesh, metres=0.001)
        again, metres = eigencrust.read_mesh_and_unit(self.folder / "mm.3mf")
        self.assertEqual((metres, eigencrust.check(again).volume), (0.001, eigencrust.check(mesh).volume))
        self.assertEqual(eigencrust.measure(self.folder / "mm.3mf").metres, 0.001)
        eigencrust.write_mesh(self.folder / "mm.glb", mesh, metres=0.001)
        again, metres = eigencrust.read_mesh_and_unit(self.folder / "mm.glb")
        self.assertAlmostEqual(metres * again.vertices.max(), 0.001, places=9)
        eigencrust.write_mesh(self.folder / "no_extension", mesh, format="off", shift=(1, 2, 3))
        self.assertTrue((self.folder / "no_extension").read_bytes().startswith(b"OFF"))
        eigencrust.write_mesh(self.folder / "shifted.stl", mesh, shift=(100, 0, 0))
        self.assertIn("100", (self.folder / "shifted.stl.offset.txt").read_text())
        eigencrust.write_point_cloud(self.folder / "cloud.ply", sphere(20), shift=(0, 0, 7), format="ply")
        moved = eigencrust.read_point_cloud(self.folder / "cloud.ply", scale=1000, shift=(1, 0, 0))
        np.testing.assert_allclose(moved.points, 1000 * sphere(20) + (1, 0, 0), atol=1e-3)
        for wrong in (dict(metres=-1), dict(metres=np.inf), dict(shift=(0, 0, np.nan)), dict(format="doc")):
            with self.subTest(wrong), self.assertRaises(eigencrust.Error):
                eigencrust.write_mesh(self.folder / "wrong.ply", mesh, **wrong)
        for wrong in (dict(scale=0), dict(scale=np.nan), dict(shift=(0, np.inf, 0))):
            with self.subTest(wrong), self.assertRaises(eigencrust.UsageError):
                eigencrust.read_point_cloud(self.folder / "cloud.ply", **wrong)

    def test_range_images(self):
        # The same from an array with columns named row and column as from a file: the grid tells neighbours.
        row, column = np.divmod(np.arange(900), 30)
        points = np.stack([column, row, 3.0 * (column > 14)], axis=1)
        grid = {"row": row, "column": column}
        eigencrust.write_point_cloud(self.folder / "frame.ply", eigencrust.PointCloud(points, attributes=grid))
        from_file = eigencrust.reconstruct(eigencrust.read_point_cloud(self.folder / "frame.ply"), trim=True, facade="+z")
        from_array = eigencrust.reconstruct(points, attributes=grid, trim=True, facade="+z")
        np.testing.assert_array_equal(from_array.triangles, from_file.triangles)

    def test_broken_files(self):
        path = self.folder / "broken.ply"
        path.write_text("ply\nformat ascii 1.0\nelement vertex many\n")
        for call in (eigencrust.read_point_cloud, eigencrust.read_mesh, eigencrust.info):
            with self.assertRaises(eigencrust.InputError) as caught:
                call(path)
            self.assertIn("broken.ply", caught.exception.stage)

    def test_scans(self):
        joined = eigencrust.join_scans([sphere(10), eigencrust.PointCloud(sphere(5), sensors=(0, 0, 9))])
        np.testing.assert_array_equal(joined.scan_index, [0] * 10 + [1] * 5)
        self.assertEqual(len(joined.sensors), 1)
        with self.assertRaises(eigencrust.UsageError):
            eigencrust.join_scans([])
        (self.folder / "index.txt").write_text("".join(f"{k}\n" for k in joined.scan_index))
        np.testing.assert_array_equal(eigencrust.read_scan_index(self.folder / "index.txt", 15), joined.scan_index)
        (self.folder / "sensors.csv").write_text("0,1,2,3\n1,4,5,6\n")
        seen = eigencrust.read_scan_sensors(self.folder / "sensors.csv", joined)
        self.assertEqual([s.place for s in seen.sensors], [(1, 2, 3), (4, 5, 6)])
        self.assertEqual(len(joined.sensors), 1)  # the one passed is left alone

    def test_info(self):
        for figures in (eigencrust.info(TEAPOT), eigencrust.info(eigencrust.read_point_cloud(TEAPOT))):
            self.assertEqual(figures["points"], 83219)
            self.assertGreater(figures["spacing"], 0)
            self.assertIsNone(figures["unusable"])
            self.assertGreater(figures["sensor_count"], 1)
        flat = eigencrust.info([[0, 0, 0], [1, 0, 0], [np.nan, 0, 0]])
        self.assertEqual((flat["points"], flat["nonfinite"]), (3, 1))
        self.assertIn("points", flat["unusable"])

    def test_notes_are_logged(self):
        np.savez(self.folder / "scan.npz", points=sphere(9), other=np.zeros(4))
        with self.assertLogs("eigencrust", logging.INFO) as caught:
            cloud = eigencrust.read_point_cloud(self.folder / "scan.npz")
        self.assertEqual(len(cloud), 9)
        self.assertIn("other", caught.output[0])
        self.assertIn("left out", caught.output[0])


class Measures(unittest.TestCase):
    def test_check(self):
        summary = eigencrust.check(TETRAHEDRON)
        self.assertTrue(summary.closed and summary.manifold and summary.oriented)
        self.assertAlmostEqual(summary.volume, 1 / 6)
        self.assertEqual((summary.euler, summary.genus, summary.components), (2, 0, 1))
        self.assertEqual(summary.component_list[0].triangles, 4)
        self.assertEqual(summary.bounds, ((0, 0, 0), (1, 1, 1)))
        self.assertIn("closed", repr(summary))
        for name in dir(summary):
            getattr(summary, name)  # every figure can be read
        opened = eigencrust.check((TETRAHEDRON[0], TETRAHEDRON[1][:3]), self_intersections=False)
        self.assertFalse(opened.closed)
        self.assertIsNone(opened.self_intersections)
        self.assertEqual((opened.boundary_edges, opened.boundary_loops), (3, 1))

    def test_measure(self):
        found = eigencrust.measure(TETRAHEDRON, metres=0.001)
        self.assertAlmostEqual(found.smallest_angle, 45)
        self.assertAlmostEqual(found.largest_angle, 90)
        self.assertAlmostEqual(found.longest_edge, np.sqrt(2))
        self.assertEqual((found.shortest_edge, found.metres), (1, 0.001))
        self.assertTrue(found.summary.closed)
        self.assertIn("printable", repr(found))
        self.assertEqual((found.as_dict()["unit_metres"], found.as_dict()["boundary_edges"]), (0.001, 0))
        # A plate 1 x 1 x 0.1: its thickness, and where.
        corners = np.array([[x, y, z] for z in (0, 0.1) for y in (0, 1) for x in (0, 1)], float)
        quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        plate = (corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
        found = eigencrust.measure(plate, metres=0.01)
        self.assertAlmostEqual(found.thinnest_wall, 0.1)
        self.assertEqual(len(found.thinnest_place), 3)
        self.assertEqual(found.wall_rays, 12)
        self.assertIn("1 mm", found.printability)
        self.assertIsNone(eigencrust.measure(plate, walls=False).thinnest_wall)
        opened = eigencrust.measure((TETRAHEDRON[0], TETRAHEDRON[1][:3]))
        self.assertIn("not printable", opened.printability)
        self.assertIsNone(opened.thinnest_place)
        with self.assertRaises(eigencrust.UsageError):
            eigencrust.measure(TETRAHEDRON, metres=-1)

    def test_compare(self):
        small = eigencrust.reconstruct(sphere(2000)).mesh
        large = eigencrust.reconstruct(sphere(2000, radius=1.1)).mesh
        c = eigencrust.compare(small, large, samples=5000)
        self.assertAlmostEqual(c.to_reference.mean, 0.1, delta=0.01)
        self.assertAlmostEqual(c.from_reference.max, 0.1, delta=0.02)
        self.assertAlmostEqual(c.hausdorff, 0.1, delta=0.02)
        self.assertAlmostEqual(c.volume_iou, 1 / 1.331, delta=0.02)
        self.assertGreater(c.oriented_normal_consistency, 0.95)
        self.assertEqual(c.f_score, 0)
        self.assertAlmostEqual(eigencrust.volume_iou(small, large), 1 / 1.331, delta=0.02)
        again = eigencrust.compare(small, large, samples=5000)
        self.assertEqual(c.to_reference.mean, again.to_reference.mean)

    def test_distances(self):
        queries = np.array([[0, 0, -2.0], [0.2, 0.2, 0], [np.nan, 0, 0]])
        found = eigencrust.distances_to_surface(queries, TETRAHEDRON)
        np.testing.assert_allclose(found, [2, 0, np.nan], atol=1e-12)
        np.testing.assert_allclose(eigencrust.distances_to_points(queries[:2], [[0, 0, 0], [0.2, 0.2, 1]]), [2, np.hypot(0.2, 0.2)])
        tree = eigencrust.TriangleTree(eigencrust.Mesh(*TETRAHEDRON))
        distance, place, triangle = tree.nearest(queries)
        np.testing.assert_allclose(distance, found)
        np.testing.assert_allclose(place[0], [0, 0, 0], atol=1e-12)
        self.assertEqual(triangle[2], eigencrust.stages.NONE)
        hit, which = tree.first_hit([[0.1, 0.1, -1], [5, 5, 5]], [[0, 0, 2], [0, 0, 1]])
        np.testing.assert_allclose(hit, [0.5, np.nan])
        self.assertEqual(list(which), [0, eigencrust.stages.NONE])
        with self.assertRaises(eigencrust.InputError):
            tree.first_hit([[0, 0, 0]], [[0, 0, 1], [0, 0, 1]])
        statistics = eigencrust.summarize([1, 2, 3, np.nan])
        self.assertEqual((statistics.count, statistics.mean, statistics.median, statistics.max), (3, 2, 2, 3))

    def test_samples(self):
        points, triangles = eigencrust.sample_surface(TETRAHEDRON, 1000, seed=3)
        self.assertEqual((points.shape, triangles.shape), ((1000, 3), (1000,)))
        self.assertLess(eigencrust.distances_to_surface(points, TETRAHEDRON).max(), 1e-12)
        self.assertEqual(set(triangles), {0, 1, 2, 3})

    def test_pieces(self):
        two = eigencrust.Mesh(
            np.concatenate([TETRAHEDRON[0], TETRAHEDRON[0] + 5]), np.concatenate([TETRAHEDRON[1], np.add(TETRAHEDRON[1], 4)])
        )
        np.testing.assert_array_equal(two.triangle_components(), [0] * 4 + [1] * 4)
        soup = eigencrust.Mesh(TETRAHEDRON[0][np.ravel(TETRAHEDRON[1])], np.arange(12).reshape(4, 3))
        merged = soup.merge_equal_vertices()
        self.assertEqual(len(merged.vertices), 4)
        self.assertTrue(eigencrust.check(merged, merge_equal_vertices=False).closed)
        self.assertFalse(eigencrust.check(soup, merge_equal_vertices=False).closed)

    def test_forecast(self):
        small, large = eigencrust.forecast(1000), eigencrust.forecast(10**6)
        self.assertGreater(large.memory_bytes, small.memory_bytes)
        self.assertEqual(eigencrust.forecast(np.zeros((1000, 3))).memory_bytes, small.memory_bytes)
        self.assertIn("MB", repr(large))
        with self.assertRaises(eigencrust.UsageError):
            eigencrust.forecast(-1)


class Pictures(unittest.TestCase):
    def test_render(self):
        mesh = eigencrust.Mesh(*TETRAHEDRON)
        picture = eigencrust.render(mesh, width=64, height=48, up="z", background=(0, 0, 255))
        self.assertEqual((picture.shape, picture.dtype), ((48, 64, 3), np.uint8))
        blue = (picture == (0, 0, 255)).all(axis=2)
        self.assertTrue(0.1 < blue.mean() < 0.95)
        side_by_side = eigencrust.render([mesh, sphere(200)], width=64, height=48)
        self.assertEqual(side_by_side.shape, (48, 128, 3))
        front = eigencrust.render(mesh, width=64, height=48, up="z", view="front", frame="all", background=(0, 0, 255))
        self.assertFalse((front == picture).all())
        for wrong in (dict(width=1), dict(up="w"), dict(unknown=3), dict(view="beside"), dict(frame="some")):
            with self.assertRaises(eigencrust.UsageError):
                eigencrust.render(mesh, **wrong)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "picture.png"
            eigencrust.write_png(path, picture)
            self.assertEqual(path.read_bytes(), eigencrust.encode_png(picture))
        with self.assertRaises(eigencrust.InputError):
            eigencrust.encode_png(np.zeros((4, 4), np.uint8))

    def test_notebooks_show_a_picture(self):
        result = eigencrust.reconstruct(sphere(300))
        for thing, word in ((result, "genus 0"), (result.mesh, "triangles"), (eigencrust.PointCloud(sphere(99)), "99 points")):
            shown = thing._repr_html_()
            self.assertIn(word, shown)
            self.assertIn(word, repr(thing))
            png = base64.b64decode(re.search(r"data:image/png;base64,([^\"]+)", shown).group(1))
            self.assertTrue(png.startswith(b"\x89PNG"))
            self.assertEqual(struct.unpack(">II", png[16:24]), (480, 360))
        self.assertIn("no picture", eigencrust.PointCloud([[np.nan] * 3], nonfinite="skip")._repr_html_())


if __name__ == "__main__":
    unittest.main(verbosity=2)
