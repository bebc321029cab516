# SPDX-License-Identifier: GPL-3.0-or-later
"""To and from pyvista."""

import unittest

import eigencrust
import numpy as np
from support import main_or_skip, sphere


class Conversion(unittest.TestCase):
    def test_mesh(self):
        result = eigencrust.reconstruct(sphere(500), attributes={"heat": np.linspace(0, 1, 500)})
        mesh = result.to_pyvista()
        self.assertTrue(mesh.is_manifold)
        np.testing.assert_array_equal(mesh.points, result.vertices)
        np.testing.assert_array_equal(mesh.faces.reshape(-1, 4)[:, 1:], result.triangles)
        np.testing.assert_array_equal(mesh.point_data["heat"], result.mesh.vertex_attributes["heat"])
        self.assertAlmostEqual(mesh.volume, eigencrust.check(result).volume)

    def test_cloud(self):
        cloud = eigencrust.PointCloud(sphere(50), attributes={"heat": np.linspace(0, 1, 50)})
        made = cloud.to_pyvista()
        np.testing.assert_array_equal(made.points, cloud.points)
        np.testing.assert_array_equal(made.point_data["heat"], cloud.attributes["heat"])

if __name__ == "__main__":
    main_or_skip("pyvista")
