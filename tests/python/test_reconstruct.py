# SPDX-License-Identifier: GPL-3.0-or-later
"""Reconstruction: the same as the command, options, masks, warnings, memory, cancelling."""

import gc
import inspect
import logging
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import eigencrust
import numpy as np
from support import COMMAND, TEAPOT, resident_bytes, sphere, sphere_with_outliers


class SameAsTheCommand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.by_command = pathlib.Path(cls.folder.name) / "command.ply"
        subprocess.run([COMMAND, TEAPOT, "-o", cls.by_command, "--quiet"], check=True)
        cls.cloud = eigencrust.read_point_cloud(TEAPOT)
        cls.result = eigencrust.reconstruct(cls.cloud)

    def test_same_triangles(self):
        mesh = eigencrust.read_mesh(self.by_command)
        self.assertGreater(len(mesh.triangles), 100_000)
        np.testing.assert_array_equal(self.result.triangles, mesh.triangles)

    def test_same_file(self):
        by_python = pathlib.Path(self.folder.name) / "python.ply"
        comment = f"made by eigencrust {eigencrust.__version__}"
        eigencrust.write_mesh(by_python, self.result, comments=[comment])
        self.assertEqual(by_python.read_bytes(), self.by_command.read_bytes())

    def test_points_alone_give_the_same_as_the_command_without_sensors(self):
        without = pathlib.Path(self.folder.name) / "without.ply"
        subprocess.run([COMMAND, TEAPOT, "-o", without, "--quiet", "--sensors", "none"], check=True)
        from_array = eigencrust.reconstruct(np.array(self.cloud.points))
        np.testing.assert_array_equal(from_array.triangles, eigencrust.read_mesh(without).triangles)

    def test_report_and_checks(self):
        report = self.result.report
        self.assertEqual(report["input"]["points"], len(self.cloud))
        summary = eigencrust.check(self.result)
        self.assertTrue(summary.closed and summary.manifold and summary.oriented)
        self.assertEqual((summary.genus, summary.components, summary.self_intersections), (1, 1, 0))
        self.assertEqual(summary.triangles, report["mesh"]["triangles"])
        self.assertEqual(summary.as_dict()["volume"], report["mesh"]["volume"])
        samples = self.cloud.points[self.result.mesh.vertex_attributes["source_index"]]
        moved = np.linalg.norm(self.result.vertices - samples, axis=1)
        self.assertAlmostEqual(moved.max(), report["moved"]["max"])
        self.assertEqual(np.count_nonzero(moved), report["moved"]["vertices"])
        unmoved = eigencrust.reconstruct(self.cloud, surface="samples")
        source = unmoved.mesh.vertex_attributes["source_index"]  # triangles may be others (docs/guarantees.md)
        np.testing.assert_array_equal(unmoved.vertices, self.cloud.points[source])

    def test_attributes_travel(self):
        points = np.array(self.cloud.points)
        tag = np.arange(len(points))
        mesh = eigencrust.reconstruct(points, attributes={"tag": tag}).mesh
        np.testing.assert_array_equal(mesh.vertex_attributes["tag"], mesh.vertex_attributes["source_index"])


class Options(unittest.TestCase):
    def test_table(self):
        table = {option.name: option for option in eigencrust.option_table()}
        self.assertEqual(table["preset"].default, "robust")
        self.assertEqual((table["max_steps"].default, table["max_steps"].paper_default), ("60", "300"))
        help_text = subprocess.run([COMMAND, "reconstruct", "--help-all"], capture_output=True, text=True, check=True).stdout
        joined = " ".join(help_text.split())
        for name in ("noise", "grid_spacing", "components", "smoothing", "threads"):
            self.assertIn("--" + name.replace("_", "-"), help_text)
            self.assertIn(" ".join(table[name].help.split()), joined)

    def test_docstring(self):
        text = inspect.getdoc(eigencrust.reconstruct)
        for option in eigencrust.option_table():
            self.assertIn(f"{option.name}: ", text)
            self.assertIn(option.default, text)
        self.assertIn("[60; paper: 300]", text)
        self.assertNotIn("OPTIONS", text)

    def test_values(self):
        points = sphere(400)
        options = eigencrust.reconstruct(
            points,
            preset="paper",
            noise="2%",
            grid_spacing=0.25,
            tolerance=1e-7,
            max_steps=250,
            manifold=False,
            components=3,
            outside_point=[(5, 0, 0), (0, 5, 0)],
            inside_point=(0, 0, 0),
            crossing_depth=0.5,
            facade="off",
            trim=None,
            smooth=np.int64(2),
            smoothing="taubin",
            threads=1,
            max_memory="4G",
            manifold_rule="cheapest",
        ).report["options"]
        expected = dict(
            preset="paper", noise="2%", grid_spacing="0.25", tolerance=1e-7, max_steps=250, manifold=False,
            components="3", outside_points=[[5, 0, 0], [0, 5, 0]], inside_points=[[0, 0, 0]], crossing_depth=0.5,
            facade="off", trim=False, smooth=2, smoothing="taubin", threads=1, max_memory=4_000_000_000,
            manifold_rule="cheapest", second_stage="eigenvector",
        )  # fmt: skip
        self.assertEqual({name: options[name] for name in expected}, expected)

    def test_wrong_values(self):
        points = sphere(100)
        for wrong, word in (
            (dict(nois=1), "did you mean noise?"),
            (dict(quite_something_else=1), "option_table"),
            (dict(noise="loud"), "auto, off"),
            (dict(noise=-1), "auto, off"),
            (dict(noise=True), "noise"),
            (dict(manifold="yes"), "True or False"),
            (dict(manifold=1), "True or False"),
            (dict(smooth=1.5), "smooth"),
            (dict(smooth=-1), "whole number"),
            (dict(smooth=10**6), "1000"),
            (dict(components=0), "positive"),
            (dict(tolerance=float("nan")), "tolerance"),
            (dict(preset="best"), "robust, paper"),
            (dict(threads=[1]), "threads"),
            (dict(max_memory="much"), "much"),
        ):
            with self.subTest(wrong), self.assertRaises(eigencrust.UsageError) as caught:
                eigencrust.reconstruct(points, **wrong)
            self.assertIn(word, str(caught.exception))
        with self.assertRaises(eigencrust.InputError):
            eigencrust.reconstruct(points, outside_point=(1, 2))

    def test_threads_change_nothing(self):
        points, _ = sphere_with_outliers()
        one, all_of_them = eigencrust.reconstruct(points, threads=1), eigencrust.reconstruct(points)
        np.testing.assert_array_equal(one.triangles, all_of_them.triangles)

    def test_memory_limit(self):
        with self.assertRaises(eigencrust.MemoryLimitError) as caught:
            eigencrust.reconstruct(sphere(1000), max_memory=1000)
        self.assertIsInstance(caught.exception, MemoryError)


class Points(unittest.TestCase):
    def test_masks_and_normals_in_the_order_of_the_rows(self):
        points, is_stray = sphere_with_outliers()
        found = eigencrust.outliers(points)
        self.assertEqual((found.inlier.dtype, found.confidence.dtype), (np.bool_, np.float32))
        self.assertEqual(found.inlier.shape, (len(points),))
        np.testing.assert_array_equal(found.outlier, ~found.inlier)
        np.testing.assert_array_equal(found.outlier, is_stray)
        self.assertTrue((found.confidence[found.inlier] >= 0.5).all())
        self.assertIn("points", repr(found))
        normals = eigencrust.orient(points)
        self.assertEqual(normals.shape, points.shape)
        np.testing.assert_array_equal(np.isnan(normals[:, 0]), is_stray)
        self.assertGreater((normals[~is_stray] * points[~is_stray]).sum(axis=1).min(), 0.95)

    def test_results_without_them_are_empty(self):
        result = eigencrust.reconstruct(sphere(200))
        self.assertEqual((len(result.inlier), len(result.confidence), len(result.normals)), (0, 0, 0))

    def test_sensors_matter(self):
        # A point in the middle of a sphere seen from outside is no part of it; the lines of sight are counted.
        result = eigencrust.reconstruct(sphere(500), sensors=(0, 0, 9))
        self.assertEqual(result.report["sight_lines"], 500)


class Session(unittest.TestCase):
    def test_named_points(self):
        # A hollow ball: the wall between two spheres, until the inner space is named.
        points = np.concatenate([sphere(3000), sphere(1000, radius=0.5)])
        session = eigencrust.Session(points)
        plain = session.label()
        named = session.label(outside_points=(0, 0, 0))
        solid = session.label(inside_points=[(0, 0, 0)])
        volume = {"hollow": 4 / 3 * np.pi * (1 - 0.125), "solid": 4 / 3 * np.pi}
        self.assertAlmostEqual(eigencrust.check(named).volume, volume["hollow"], delta=0.1)
        self.assertAlmostEqual(eigencrust.check(solid).volume, volume["solid"], delta=0.1)
        again = session.label()
        np.testing.assert_array_equal(plain.triangles, again.triangles)
        self.assertIsNone(plain.tetrahedralization)
        self.assertEqual(len(plain.labels), len(session.tetrahedralization))
        self.assertEqual(len(session.cloud), len(points))
        with self.assertRaises(eigencrust.InputError):
            session.label(outside_points=(0, 0))
        with self.assertRaises(eigencrust.UsageError):
            session.label(outside_points=(0, 0, 0), inside_points=(0, 0, 0))

    def test_cancel(self):
        with self.assertRaises(eigencrust.Cancelled):
            eigencrust.Session(sphere(500), progress=lambda stage, fraction: False)
        session = eigencrust.Session(sphere(500))
        with self.assertRaises(eigencrust.Cancelled):
            session.label(progress=lambda stage, fraction: False)
        self.assertTrue(eigencrust.check(session.label()).closed)


class Watching(unittest.TestCase):
    def test_progress(self):
        seen = []
        eigencrust.reconstruct(sphere(3000), progress=lambda stage, fraction: seen.append((stage, fraction)))
        stages = [stage for stage, _ in seen]
        self.assertIn("delaunay", stages)
        self.assertGreater(len(set(stages)), 8)
        self.assertTrue(all(0 <= fraction <= 1 for _, fraction in seen))
        self.assertEqual(threading.get_ident(), threading.main_thread().ident)

    def test_snapshots(self):
        seen = {}
        eigencrust.reconstruct(sphere(500), snapshots=lambda stage, mesh: seen.update({stage: len(mesh.vertices)}))
        self.assertGreater(len(seen), 2)
        self.assertTrue(all(count > 0 for count in seen.values()))

    def test_false_cancels(self):
        calls = []

        def stop(stage, fraction):
            calls.append(stage)
            return len(calls) < 3

        with self.assertRaises(eigencrust.Cancelled) as caught:
            eigencrust.reconstruct(sphere(1000), progress=stop)
        self.assertEqual(len(calls), 3)
        self.assertEqual(caught.exception.status, 130)

    def test_exceptions_pass_through(self):
        class Mine(Exception):
            pass

        def fail(stage, fraction):
            raise Mine(stage)

        for watched in (dict(progress=fail), dict(snapshots=fail)):
            with self.assertRaises(Mine):
                eigencrust.reconstruct(sphere(500), **watched)
        with self.assertRaises(TypeError):
            eigencrust.reconstruct(sphere(500), progress=lambda: None)

    def test_cancel_from_another_thread(self):
        points = np.random.default_rng(1).normal(size=(300_000, 3))
        points /= np.linalg.norm(points, axis=1)[:, None]
        points *= 1 + 0.002 * np.random.default_rng(2).normal(size=(len(points), 1))
        delays = []
        for wait in (0.2, 1.0, 2.0):
            token = eigencrust.Cancellation()
            asked = []

            def ask(token=token, wait=wait, asked=asked):
                time.sleep(wait)
                asked.append(time.monotonic())
                token.cancel()

            thread = threading.Thread(target=ask)
            thread.start()
            try:
                with self.assertRaises(eigencrust.Cancelled):
                    eigencrust.reconstruct(points, cancel=token)
                delays.append(time.monotonic() - asked[0])
            finally:
                thread.join()
            self.assertTrue(token.cancelled)
        # No test asserts a time; how long it took is shown for people to read.
        print("seconds from cancel() to the exception:", ", ".join(f"{delay:.3f}" for delay in delays))

    def test_a_cancelled_token_stops_at_once(self):
        token = eigencrust.Cancellation()
        token.cancel()
        with self.assertRaises(eigencrust.Cancelled):
            eigencrust.reconstruct(sphere(500), cancel=token)

    def test_other_threads_run_meanwhile(self):
        counts = [0]
        done = threading.Event()

        def count():
            while not done.is_set():
                counts[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        before = counts[0]
        eigencrust.reconstruct(sphere(30_000))
        meanwhile = counts[0] - before
        done.set()
        thread.join()
        self.assertGreater(meanwhile, 20)

    def test_several_at_once(self):
        points = [sphere(2000, radius=r) for r in (1, 2, 3, 4)]
        results = [None] * 4

        def work(i):
            results[i] = eigencrust.reconstruct(points[i])

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for i, result in enumerate(results):
            np.testing.assert_array_equal(result.triangles, eigencrust.reconstruct(points[i]).triangles)

    def test_ctrl_c(self):
        # Of a program that was started in the background the signal is ignored from the start.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        points = np.random.default_rng(1).normal(size=(200_000, 3))
        timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                eigencrust.reconstruct(points)
                time.sleep(5)  # where the run was quicker than the signal
        finally:
            timer.join()

    def test_warnings_are_logged(self):
        with self.assertLogs("eigencrust", logging.WARNING) as caught:
            eigencrust.reconstruct(sphere(300), smoothing="taubin")
        self.assertIn("smoothing has no effect", caught.output[0])
        points = sphere(300)
        points[5] = np.nan
        with self.assertLogs("eigencrust", logging.WARNING) as caught:
            result = eigencrust.reconstruct(points, nonfinite="skip")
        said = [record.getMessage() for record in caught.records]
        self.assertEqual(said, ["1 row that is NaN or infinite was left out", *result.warnings])


class Ownership(unittest.TestCase):
    def test_views_keep_their_owner_alive(self):
        result = eigencrust.reconstruct(sphere(2000), point_results=True)
        expected = [np.array(a) for a in (result.vertices, result.triangles, result.normals, result.labels)]
        views = [result.vertices, result.triangles, result.normals, result.labels]
        attribute = result.mesh.vertex_attributes["source_index"]
        source = np.array(attribute)
        tetrahedra = result.tetrahedralization.tetrahedra
        del result
        gc.collect()
        filler = [np.full(len(v), 7.0) for v in views for _ in range(20)]  # takes memory that was freed
        for view, values in zip(views, expected):
            np.testing.assert_array_equal(view, values)
        np.testing.assert_array_equal(attribute, source)
        self.assertTrue((tetrahedra[:, 0] < 2008).all())
        self.assertEqual(len(filler), 80)

    def test_views_share_memory_and_cannot_be_written(self):
        result = eigencrust.reconstruct(sphere(500))
        self.assertTrue(np.shares_memory(result.vertices, result.mesh.vertices))
        self.assertIsNotNone(result.vertices.base)
        for view in (result.vertices, result.triangles, result.labels, result.mesh.vertex_attributes["source_index"]):
            with self.assertRaises(ValueError):
                view[0] = 0
        cloud = eigencrust.PointCloud(sphere(10))
        self.assertTrue(np.shares_memory(cloud.points, cloud.points))

    def test_200_reconstructions_leak_nothing(self):
        points, _ = sphere_with_outliers(1000, 20)
        def once():
            result = eigencrust.reconstruct(points, attributes={"a": points[:, 0]}, point_results=True)
            result.mesh.vertex_attributes, result.report, result.normals
            try:
                eigencrust.reconstruct(points, progress=lambda stage, fraction: stage != "energy")
            except eigencrust.Cancelled:
                pass
            try:
                eigencrust.reconstruct(points[:, :2])
            except eigencrust.InputError:
                pass

        def rounds(count):
            for _ in range(count):
                once()
            gc.collect()
            return resident_bytes(), len(gc.get_objects())

        rounds(20)
        first, objects = rounds(20)
        last, objects_after = rounds(180)
        # One mesh of it has 0.1 MB, one run takes 2 MB: 180 times that would be seen.
        self.assertLess(last - first, 4_000_000)
        self.assertLess(objects_after - objects, 500)


if __name__ == "__main__":
    unittest.main(verbosity=2)
