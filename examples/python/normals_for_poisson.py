# SPDX-License-Identifier: GPL-3.0-or-later
"""Outward normals for a program that needs them: here Open3D's Poisson reconstruction.

Usage: normals_for_poisson.py SCAN MESH
"""

import sys

import eigencrust
import numpy as np
import open3d

scan, mesh_file = sys.argv[1:3]
cloud = eigencrust.read_point_cloud(scan)
normals = eigencrust.orient(cloud)  # NaN for outliers, which Poisson should not see
inliers = ~np.isnan(normals[:, 0])

oriented = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(cloud.points[inliers]))
oriented.normals = open3d.utility.Vector3dVector(normals[inliers])
mesh, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(oriented, depth=7)
print(f"{inliers.sum():,} of {len(cloud):,} points have a normal; Poisson made {len(mesh.triangles):,} triangles")
eigencrust.write_mesh(mesh_file, mesh)
