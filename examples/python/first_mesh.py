# SPDX-License-Identifier: GPL-3.0-or-later
"""A first mesh: a scan in, a closed mesh and a picture out.

Usage: first_mesh.py SCAN MESH PICTURE.png
"""

import logging
import sys

import eigencrust

logging.basicConfig(format="%(levelname)s %(message)s")  # shows what eigencrust warns of

scan, mesh_file, picture_file = sys.argv[1:4]
cloud = eigencrust.read_point_cloud(scan)
result = eigencrust.reconstruct(cloud, progress=lambda stage, fraction: print(f"{stage}: {fraction:.0%}", end="  \r"))

summary = eigencrust.check(result)
print(f"\n{len(cloud):,} points, {summary.triangles:,} triangles")
print(f"closed: {summary.closed}, manifold: {summary.manifold}, genus {summary.genus}, volume {summary.volume:.4g}")
eigencrust.write_mesh(mesh_file, result)
eigencrust.write_png(picture_file, eigencrust.render([cloud, result], up="z", azimuth=-60, width=600, height=450))
