# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes in: every kind of array that is points, and a clear error for all that is none."""

import math
import pickle
import unittest

import eigencrust
import numpy as np
from support import peak_bytes, resident_bytes, sphere


class Accepted(unittest.TestCase):
    def same(self, points, expected):
        found = eigencrust.PointCloud(points).points
        self.assertEqual(found.dtype, np.float64)
        np.testing.assert_array_equal(found, expected)

    def test_any_layout(self):
        points = sphere(100)
        self.same(points, points)
        self.same(np.asfortranarray(points), points)
        self.same(points[::-1], points[::-1])
        self.same(points[::3, ::-1], points[::3, ::-1])
        wide = np.zeros((100, 8))
        wide[:, 2:5] = points
        self.same(wide[:, 2:5], points)
        self.same(np.broadcast_to(points[0], (7, 3)), np.tile(points[0], (7, 1)))
        packed = np.zeros(100, dtype=[("flag", "u1"), ("xyz", "<f8", 3)])  # rows that are not aligned
        packed["xyz"] = points
        self.same(packed["xyz"], points)

    def test_any_number_type(self):
        points = sphere(50)
        self.same(points.astype(np.float32), points.astype(np.float32).astype(float))
        self.same(points.astype(np.float32)[::2, ::-1], points.astype(np.float32)[::2, ::-1].astype(float))
        self.same(points.astype(">f8"), points)
        self.same(points.astype(">f4"), points.astype(np.float32).astype(float))
        self.same(points.astype(np.float16), points.astype(np.float16).astype(float))
        whole = np.arange(30).reshape(10, 3)
        for kind in (np.int8, np.uint16, np.int32, np.int64, np.uint64):
            self.same(whole.astype(kind), whole)

    def test_lists(self):
        self.same([[0, 0, 1], [2, 3, 4.5]], [[0, 0, 1], [2, 3, 4.5]])
        self.same([(1, 2, 3)] * 4, [(1, 2, 3)] * 4)
        self.same(tuple(map(tuple, sphere(9))), sphere(9))

    def test_a_list_gives_the_same_mesh(self):
        points = sphere(300)
        from_list = eigencrust.reconstruct(points.tolist())
        from_strides = eigencrust.reconstruct(np.asfortranarray(points))
        np.testing.assert_array_equal(from_list.triangles, from_strides.triangles)
        np.testing.assert_array_equal(from_list.vertices, from_strides.vertices)

    def test_the_input_is_left_alone(self):
        points = sphere(300)
        points.flags.writeable = False
        before = points.copy()
        eigencrust.reconstruct(points)
        np.testing.assert_array_equal(points, before)

    def test_a_million_points_cross_with_one_copy(self):
        n = 1_000_000
        one_copy = n * 3 * 8
        for points in (
            np.random.default_rng(1).random((n, 3)),
            np.random.default_rng(1).random((n, 3), dtype=np.float32),
            np.random.default_rng(1).random((3, n)).T,
            np.random.default_rng(1).random((2 * n, 5))[::2, 1:4],
        ):
            before = resident_bytes()
            cloud, peak = peak_bytes(lambda points=points: eigencrust.PointCloud(points))
            view = cloud.points
            self.assertLess(peak, 1.1 * one_copy)
            self.assertLess(resident_bytes() - before, 1.1 * one_copy)
            self.assertGreater(peak, 0.5 * one_copy)  # else nothing was measured
            print(f"{points.dtype}, strides {points.strides}: {peak / one_copy:.3f} copies at the peak")
            np.testing.assert_array_equal(view[::100_000], points[::100_000])
            del cloud, view

    def test_sensors(self):
        points = sphere(40)
        one = eigencrust.PointCloud(points, sensors=(0, 0, 5))
        self.assertEqual(one.sensors, [eigencrust.Sensor((0, 0, 5), False)])
        np.testing.assert_array_equal(one.sensor_of, np.zeros(40))
        places = np.repeat([[5.0, 0, 0], [0, 5, 0]], 20, axis=0)
        places[3] = math.nan
        each = eigencrust.PointCloud(points, sensors=places)
        self.assertEqual([s.place for s in each.sensors], [(5, 0, 0), (0, 5, 0)])
        self.assertEqual(each.sensor_of[3], eigencrust.stages.NONE)
        np.testing.assert_array_equal(np.delete(each.sensor_of, 3), np.delete(np.repeat([0, 1], 20), 3))
        scans = np.repeat([1, 0], 20)
        by_scan = eigencrust.PointCloud(points, sensors=[[5.0, 0, 0], [0, 5, 0]], scan_index=scans)
        self.assertEqual([by_scan.sensors[k].place for k in by_scan.sensor_of[[0, 39]]], [(0, 5, 0), (5, 0, 0)])
        np.testing.assert_array_equal(by_scan.scan_index, scans)
        far = eigencrust.PointCloud(points, sensor_directions=[0, 0, 4])
        self.assertEqual(far.sensors, [eigencrust.Sensor((0, 0, 1), True)])

    def test_attributes(self):
        n = 20
        columns = {
            "small": np.arange(n, dtype=np.int8),
            "wide": np.arange(n) - 3,
            "unsigned": np.arange(n, dtype=np.uint64) + 2**31,
            "huge": np.arange(n) * 2**40,
            "flag": np.arange(n) % 2 == 0,
            "real": np.linspace(0, 1, n),
            "strided": np.arange(2 * n, dtype=np.float32)[::2],
            "swapped": np.arange(n, dtype=">u2"),
            "list": list(range(n)),
        }
        found = eigencrust.PointCloud(sphere(n), attributes=columns).attributes
        self.assertEqual(list(found), list(columns))
        types = dict(small="i1", wide="i4", unsigned="u4", huge="f8", flag="u1", real="f8", strided="f4", swapped="u2")
        for name, values in columns.items():
            np.testing.assert_array_equal(found[name], values)
            if name in types:
                self.assertEqual(found[name].dtype, np.dtype(types[name]), name)

    def test_columns_of_lists(self):
        column = eigencrust.ListColumn(np.array([1.5, 2.5, 3.5]), [0, 2, 2, 3])
        cloud = eigencrust.PointCloud(sphere(3), attributes={"echoes": column})
        np.testing.assert_array_equal(cloud.attributes["echoes"].values, column.values)
        np.testing.assert_array_equal(cloud.attributes["echoes"].offsets, column.offsets)


class Refused(unittest.TestCase):
    def refused(self, call, *words, kind=eigencrust.InputError):
        with self.assertRaises(kind) as caught:
            call()
        error = caught.exception
        for word in words:
            self.assertIn(word, str(error))
        self.assertTrue(error.stage and error.cause and error.remedy)
        self.assertEqual(str(error), f"{error.cause} ({error.stage}); {error.remedy}")
        self.assertIsInstance(error, eigencrust.Error)
        return error

    def test_shapes(self):
        for call in (eigencrust.reconstruct, eigencrust.orient, eigencrust.outliers, eigencrust.Session, eigencrust.info):
            self.refused(lambda: call(np.zeros((5, 2))), "(5, 2)", "(N, 3)", "points")
        self.refused(lambda: eigencrust.reconstruct(np.zeros(9)), "(9,)")
        self.refused(lambda: eigencrust.reconstruct(np.zeros((3, 100))), "transpose")
        self.refused(lambda: eigencrust.reconstruct(np.zeros((100, 6))), "[:, :3]")
        self.refused(lambda: eigencrust.reconstruct(np.zeros((4, 3, 3))), "(4, 3, 3)")
        self.refused(lambda: eigencrust.reconstruct(3.0), "()")
        self.refused(lambda: eigencrust.reconstruct([[1, 2, 3], [1, 2]]), "rows of equal length")

    def test_empty(self):
        for empty in ([], np.zeros((0, 3)), np.zeros((0,)), [[]]):
            self.refused(lambda empty=empty: eigencrust.reconstruct(empty), "empty")

    def test_number_types(self):
        points = sphere(20)
        for wrong in (
            points.astype(complex),
            points > 0,
            points.astype(str),
            points.astype(object),
            np.zeros((5, 3), "datetime64[s]"),
        ):
            self.refused(lambda wrong=wrong: eigencrust.reconstruct(wrong), str(wrong.dtype), "float64")
        if np.dtype(np.longdouble).itemsize > 8:
            self.refused(lambda: eigencrust.reconstruct(points.astype(np.longdouble)), "float64")
        self.refused(lambda: eigencrust.reconstruct(np.full((9, 3), 2**60)), "2^53")
        self.refused(lambda: eigencrust.reconstruct(np.ma.masked_greater(points, 0.5)), "masked", "numpy.nan")
        self.refused(lambda: eigencrust.reconstruct(None), "points")
        self.refused(lambda: eigencrust.reconstruct("scan.ply"), "points")

    def test_not_finite(self):
        points = sphere(500)
        points[17, 1] = math.nan
        points[99] = math.inf
        for call in (eigencrust.reconstruct, eigencrust.orient, eigencrust.outliers, eigencrust.Session):
            self.refused(lambda: call(points), "2 rows are NaN or infinite", "row 17", "nonfinite='skip'")
        self.refused(lambda: eigencrust.reconstruct(points, nonfinite="drop"), "raise or skip", kind=eigencrust.UsageError)
        self.refused(lambda: eigencrust.reconstruct(np.full((50, 3), math.nan), nonfinite="skip"))
        found = eigencrust.outliers(points, nonfinite="skip")
        self.assertEqual(len(found.inlier), 500)
        self.assertFalse(found.inlier[17] or found.inlier[99])
        self.assertEqual(found.inlier.sum(), 498)

    def test_too_few_or_flat(self):
        self.refused(lambda: eigencrust.reconstruct(sphere(3)))
        flat = np.random.default_rng(1).random((50, 3))
        flat[:, 2] = 1
        self.refused(lambda: eigencrust.reconstruct(flat), "coplanar")

    def test_sensors(self):
        points = sphere(30)
        for wrong in (np.zeros((7, 3)), np.zeros((30, 2)), np.zeros(4), [], "here"):
            self.refused(lambda wrong=wrong: eigencrust.reconstruct(points, sensors=wrong), "sensors")
        self.refused(lambda: eigencrust.reconstruct(points, sensors=(0, 0, 1), sensor_directions=(0, 0, 1)), "exclude")
        self.refused(lambda: eigencrust.reconstruct(points, sensor_directions=(0, 0, 0)), "no length")
        for wrong in (np.zeros(7, int), np.full(30, -1), np.zeros(30), np.zeros((30, 1), int)):
            self.refused(lambda wrong=wrong: eigencrust.reconstruct(points, scan_index=wrong), "scan_index")

    def test_attributes(self):
        points = sphere(30)
        for wrong in (np.zeros(29), np.zeros((30, 3)), np.zeros(30, complex), ["a"] * 30):
            self.refused(lambda wrong=wrong: eigencrust.reconstruct(points, attributes={"odd": wrong}), "odd")
        self.refused(lambda: eigencrust.reconstruct(points, attributes=[1, 2]), "dict")
        bad = eigencrust.ListColumn(np.zeros(3), [0, 5, 3])
        self.refused(lambda: eigencrust.PointCloud(sphere(2), attributes={"bad": bad}), "offsets")
        cloud = eigencrust.PointCloud(points)
        self.refused(
            lambda: eigencrust.reconstruct(cloud, attributes={"a": np.zeros(30)}), "attributes", kind=eigencrust.UsageError
        )

    def test_meshes(self):
        vertices = sphere(4)
        for wrong in ([[0, 1, 4]], [[0, 1, -1]], [[0, 1]], [0, 1, 2], [[0.0, 1, 2]]):
            self.refused(lambda wrong=wrong: eigencrust.Mesh(vertices, wrong), "triangle")
        self.refused(lambda: eigencrust.check(42), "mesh")
        self.refused(lambda: eigencrust.check("no such file.ply"), "no such file.ply")
        self.refused(lambda: eigencrust.render([]), kind=eigencrust.UsageError)

    def test_errors_travel(self):
        error = self.refused(lambda: eigencrust.reconstruct(np.zeros((5, 2))))
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((type(again), str(again), again.remedy), (type(error), str(error), error.remedy))
        self.assertIsInstance(error, ValueError)


if __name__ == "__main__":
    unittest.main(verbosity=2)
