# SPDX-License-Identifier: GPL-3.0-or-later
"""To and from trimesh."""

import unittest

import eigencrust
import numpy as np
from support import main_or_skip, sphere


class Conversion(unittest.TestCase):
    def test_mesh(self):
        result = eigencrust.reconstruct(sphere(500), attributes={"heat": np.linspace(0, 1, 500)})
        mesh = result.to_trimesh()
        self.assertTrue(mesh.is_watertight and mesh.is_winding_consistent)
        np.testing.assert_array_equal(mesh.vertices, result.vertices)
        np.testing.assert_array_equal(mesh.faces, result.triangles)
        np.testing.assert_array_equal(mesh.vertex_attributes["heat"], result.mesh.vertex_attributes["heat"])
        self.assertAlmostEqual(mesh.volume, eigencrust.check(mesh).volume)

if __name__ == "__main__":
    main_or_skip("trimesh")
