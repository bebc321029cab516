# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the Python package share."""

import ctypes
import os
import pathlib
import unittest

import numpy as np

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
COMMAND = os.environ.get("EIGENCRUST_COMMAND", "eigencrust")
TEAPOT = REPOSITORY / "examples" / "teapot_scan.ply"


def sphere(n=2000, radius=1.0, centre=(0, 0, 0)):
    """Points on a sphere along a spiral with the golden angle."""
    z = 1 - 2 * (np.arange(n) + 0.5) / n
    angle = np.arange(n) * np.pi * (3 - np.sqrt(5))
    r = np.sqrt(1 - z * z)
    return radius * np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1) + np.asarray(centre)


def sphere_with_outliers(n=3000, outliers=60, seed=1):
    """The sphere in a shuffled order among stray points, and which rows those are."""
    random = np.random.default_rng(seed)
    stray = random.uniform(-2, 2, (outliers, 3))
    stray = stray[np.abs(np.linalg.norm(stray, axis=1) - 1) > 0.3]
    points = np.concatenate([sphere(n), stray])
    is_stray = np.arange(len(points)) >= n
    order = random.permutation(len(points))
    return points[order], is_stray[order]


def resident_bytes():
    """Memory of this process that is in use now; what was freed is given back first."""
    getattr(ctypes.CDLL(None), "malloc_trim", lambda _: None)(0)
    return status_bytes("VmRSS")


def peak_bytes(work):
    """What work() returns, and the most memory that was in use meanwhile beyond what was before."""
    before = resident_bytes()
    try:
        with open("/proc/self/clear_refs", "w", encoding="ascii") as file:
            file.write("5")  # the peak is measured from here on, see proc(5)
    except OSError as error:
        raise unittest.SkipTest("the peak of memory cannot be reset here") from error
    made = work()
    return made, status_bytes("VmHWM") - before


def status_bytes(field):
    """A figure of memory of this process."""
    try:
        with open("/proc/self/status", encoding="ascii") as file:
            for line in file:
                if line.startswith(field + ":"):
                    return 1024 * int(line.split()[1])
    except OSError:
        pass
    raise unittest.SkipTest("no /proc/self/status here")


def main_or_skip(module):
    """Runs the tests of a file that needs a package which may be absent; 77 tells ctest that it was skipped."""
    try:
        __import__(module)
    except ImportError:
        print(f"skipped: {module} is not installed")
        raise SystemExit(77) from None
    unittest.main(verbosity=2)
