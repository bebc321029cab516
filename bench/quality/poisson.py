#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Screened Poisson (Kazhdan and Hoppe 2013) as Open3D has it, on a cloud whose true normals are known.

poisson.py CLOUD.ply PREFIX DEPTH...: normals are those of the 30 nearest points (PCA), each turned to the side of the
true one; writes PREFIX-DEPTH.ply for each depth. Ends with 77 where Open3D is not installed.
"""
import sys

try:
    import numpy
    import open3d
except ImportError:
    sys.exit(77)


def main(cloud_file, prefix, depths):
    cloud = open3d.io.read_point_cloud(cloud_file)
    true_normals = numpy.asarray(cloud.normals).copy()
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(30))
    normals = numpy.asarray(cloud.normals).copy()
    normals[(normals * true_normals).sum(axis=1) < 0] *= -1
    cloud.normals = open3d.utility.Vector3dVector(normals)
    for depth in depths:
        # One thread: with more the result differs from run to run.
        mesh, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(cloud, depth=int(depth), n_threads=1)
        open3d.io.write_triangle_mesh(f"{prefix}-{depth}.ply", mesh)


main(sys.argv[1], sys.argv[2], sys.argv[3:])
