# SPDX-License-Identifier: GPL-3.0-or-later
"""To and from Open3D, and the example scripts that use it."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import eigencrust
import numpy as np
from support import REPOSITORY, TEAPOT, main_or_skip, sphere

EXAMPLES = REPOSITORY / "examples" / "python"


class Open3D(unittest.TestCase):
    def test_mesh(self):
        points = sphere(500)
        shade = np.arange(500) % 256
        attributes = {"red": shade.astype(np.uint8), "green": shade.astype(np.uint8), "blue": np.zeros(500, np.uint8)}
        result = eigencrust.reconstruct(points, attributes=attributes)
        mesh = result.to_open3d()
        self.assertTrue(mesh.is_watertight() and mesh.is_edge_manifold() and mesh.is_orientable())
        np.testing.assert_array_equal(np.asarray(mesh.vertices), result.vertices)
        np.testing.assert_array_equal(np.asarray(mesh.triangles), result.triangles)
        red = shade[result.mesh.vertex_attributes["source_index"]] / 255
        np.testing.assert_allclose(np.asarray(mesh.vertex_colors)[:, 0], red)
        self.assertAlmostEqual(mesh.get_volume(), eigencrust.check(mesh).volume)
        self.assertEqual(eigencrust.compare(mesh, result, samples=100).to_reference.max < 1e-12, True)

    def test_cloud(self):
        normals = sphere(50)
        cloud = eigencrust.PointCloud(sphere(50), attributes=dict(zip(("nx", "ny", "nz"), normals.T)))
        made = cloud.to_open3d()
        np.testing.assert_array_equal(np.asarray(made.points), cloud.points)
        np.testing.assert_allclose(np.asarray(made.normals), normals)
        self.assertFalse(made.has_colors())
        again = eigencrust.PointCloud(np.asarray(made.points))
        np.testing.assert_array_equal(again.points, cloud.points)


class Examples(unittest.TestCase):
    def run_example(self, name, *arguments):
        run = subprocess.run(
            [sys.executable, EXAMPLES / name, *map(str, arguments)], capture_output=True, text=True, check=False
        )
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return run.stdout

    def test_all_are_run(self):
        named = {"first_mesh.py", "normals_for_poisson.py", "outlier_filter.py", "relabel.py"}
        self.assertEqual({path.name for path in EXAMPLES.glob("*.py")}, named)

    def test_first_mesh(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = pathlib.Path(folder) / "mesh.ply"
            said = self.run_example("first_mesh.py", TEAPOT, mesh, mesh.with_suffix(".png"))
            self.assertIn("closed: True", said)
            self.assertTrue(eigencrust.check(mesh).closed)
            self.assertTrue(mesh.with_suffix(".png").read_bytes().startswith(b"\x89PNG"))

    def test_normals_for_poisson(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = pathlib.Path(folder) / "poisson.ply"
            self.run_example("normals_for_poisson.py", TEAPOT, mesh)
            ours = eigencrust.reconstruct(eigencrust.read_point_cloud(TEAPOT))
            comparison = eigencrust.compare(mesh, ours, samples=5000)
            # Normals that looked the wrong way somewhere would leave sheets far from the teapot.
            self.assertGreater(comparison.precision, 0.9)

    def test_outlier_filter(self):
        with tempfile.TemporaryDirectory() as folder:
            cloud = pathlib.Path(folder) / "clean.ply"
            said = self.run_example("outlier_filter.py", TEAPOT, cloud)
            kept = eigencrust.read_point_cloud(cloud)
            self.assertLess(len(kept), 83219)
            self.assertGreater(len(kept), 80000)
            self.assertIn("kept", said)

    def test_relabel(self):
        with tempfile.TemporaryDirectory() as folder:
            said = self.run_example("relabel.py", pathlib.Path(folder) / "shell.ply")
            solid, hollow = (float(line.split()[-1]) for line in said.splitlines() if "volume" in line)
            self.assertAlmostEqual(solid, 4 / 3 * np.pi, delta=0.1)
            self.assertAlmostEqual(hollow, 4 / 3 * np.pi * (1 - 0.125), delta=0.1)


if __name__ == "__main__":
    main_or_skip("open3d")
