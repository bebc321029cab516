# SPDX-License-Identifier: GPL-3.0-or-later
"""Relabelling with a named point: is the room in a hollow ball part of the solid or not? The points cannot tell.

Usage: relabel.py MESH
"""

import sys

import eigencrust
import numpy as np


def sphere(count, radius):
    z = 1 - 2 * (np.arange(count) + 0.5) / count
    angle = np.arange(count) * np.pi * (3 - np.sqrt(5))
    r = np.sqrt(1 - z * z)
    return radius * np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


points = np.concatenate([sphere(3000, 1), sphere(1000, 0.5)])
session = eigencrust.Session(points)  # the expensive half, once
solid = session.label(inside_points=(0, 0, 0))
hollow = session.label(outside_points=(0, 0, 0))
print("middle inside:  volume", eigencrust.check(solid).volume)
print("middle outside: volume", eigencrust.check(hollow).volume)
eigencrust.write_mesh(sys.argv[1], hollow)
