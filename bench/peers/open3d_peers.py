#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reconstructions of Open3D, with parameters that follow the distance of the points.

open3d_peers.py METHOD CLOUD.ply MESH.ply: METHOD is poisson (normals estimated and oriented here), poisson-oriented (those
of the file), ball-pivoting or alpha-shape. Prints the processor seconds from reading to writing, without the start of Python. Ends
with 77 where Open3D is not installed.
"""
import math
import os
import sys
import time

# Threads that wait for work must not burn the processors of a busy machine, nor count as work.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

try:
    import numpy
    import open3d
except ImportError:
    sys.exit(77)

NEIGHBOURS = 30  # of Open3D's examples, for normals and their orientation


def spacing_of(cloud):
    return float(numpy.mean(cloud.compute_nearest_neighbor_distance()))


def estimate_normals(cloud):
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(NEIGHBOURS))
    cloud.orient_normals_consistent_tangent_plane(NEIGHBOURS)


def poisson(cloud):
    # Cells about as wide as the points are apart; deeper than 10 takes minutes.
    depth = math.ceil(math.log2(1.1 * max(cloud.get_max_bound() - cloud.get_min_bound()) / spacing_of(cloud)))
    depth = min(max(depth, 7), 10)
    # One thread: with more the result differs from run to run, and they hinder each other on a busy machine.
    return open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(cloud, depth=depth, n_threads=1)[0]


def ball_pivoting(cloud):
    estimate_normals(cloud)
    radii = open3d.utility.DoubleVector([spacing_of(cloud) * factor for factor in (1.5, 2.25, 3.0)])
    return open3d.geometry.TriangleMesh.create_from_point_cloud_ball_pivoting(cloud, radii)


def alpha_shape(cloud):
    return open3d.geometry.TriangleMesh.create_from_point_cloud_alpha_shape(cloud, 3 * spacing_of(cloud))


def main(method, cloud_file, mesh_file):
    start = time.process_time()
    open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)
    cloud = open3d.io.read_point_cloud(cloud_file)
    if method == "poisson":
        estimate_normals(cloud)
        mesh = poisson(cloud)
    elif method == "poisson-oriented":
        mesh = poisson(cloud)
    elif method == "ball-pivoting":
        mesh = ball_pivoting(cloud)
    else:
        mesh = alpha_shape(cloud)
    open3d.io.write_triangle_mesh(mesh_file, mesh)
    print(time.process_time() - start)


main(*sys.argv[1:4])
