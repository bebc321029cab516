#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reconstructions of MeshLab's server, which wants a display: one in memory.

meshlab_peers.py METHOD CLOUD.ply MESH.ply EIGENCRUST: METHOD is poisson or ball-pivoting. EIGENCRUST, the command, tells
how close the points are. Prints the processor seconds of the server and its display.
"""
import math
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile

NEIGHBOURS = 30  # for normals, as Open3D's get them


def best_depth(eigencrust, cloud):
    """Cells about as wide as the points are apart; deeper than 10 takes minutes. As for Open3D's Poisson."""
    said = subprocess.run([eigencrust, "info", cloud], capture_output=True, text=True, check=True).stdout
    low, high = (
        [float(x) for x in corner.split(",")] for corner in re.search(r"bounds \((.*?)\) to \((.*?)\)", said).groups()
    )
    spacing = float(re.search(r"spacing \(.*?\) (\S+)", said).group(1))
    side = max(b - a for a, b in zip(low, high))
    return min(max(math.ceil(math.log2(1.1 * side / spacing)), 7), 10)


def step(name, *parameters):
    """One filter; MeshLab wants all of its parameters, those left at its defaults too."""
    lines = "".join(
        f'  <Param name="{key}" type="Rich{kind}" {value}/>\n' for key, kind, value in parameters
    )
    return f' <filter name="{name}">\n{lines} </filter>\n'


def number(key, value):
    kind = "Bool" if isinstance(value, bool) else "Int" if isinstance(value, int) else "Float"
    return key, kind, f'value="{str(value).lower()}"'


def poisson(eigencrust, cloud):
    return step(
        "Compute normals for point sets",
        number("K", NEIGHBOURS), number("smoothIter", 0), number("flipFlag", False),
        ("viewPos", "Point3f", 'x="0" y="0" z="0"'),
    ) + step(
        "Surface Reconstruction: Screened Poisson",
        number("visibleLayer", False), number("depth", best_depth(eigencrust, cloud)), number("fullDepth", 5),
        number("cgDepth", 0), number("scale", 1.1), number("samplesPerNode", 1.5), number("pointWeight", 4.0),
        number("iters", 8), number("confidence", False), number("preClean", False),
    )


def ball_pivoting():
    return step(
        "Surface Reconstruction: Ball Pivoting",
        ("BallRadius", "AbsPerc", 'value="0" min="0" max="1"'),  # 0: MeshLab chooses
        number("Clustering", 20.0), number("CreaseThr", 90.0), number("DeleteFaces", False),
    )


def main(method, cloud, mesh, eigencrust):
    steps = poisson(eigencrust, cloud) if method == "poisson" else ball_pivoting()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.NamedTemporaryFile("w", suffix=".mlx") as script:
        script.write(f"<!DOCTYPE FilterScript>\n<FilterScript>\n{steps}</FilterScript>\n")
        script.flush()
        command = ["xvfb-run", "-a", "meshlabserver", "-i", cloud, "-o", mesh, "-s", script.name]
        # Threads that wait for work must not burn the processors of a busy machine, nor count as work.
        environment = {**os.environ, "OMP_WAIT_POLICY": "passive"}
        ended = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    if ended.returncode == 128 + signal.SIGXCPU:
        os.kill(os.getpid(), signal.SIGXCPU)  # as the server was: it took longer than it was given
    ended.check_returncode()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)


main(*sys.argv[1:5])
