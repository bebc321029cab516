# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the Python package with CMake, the library inside the extension. Version and files are CMake's."""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


def version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(eigencrust VERSION ([0-9.]+)", text).group(1)


class BuildWithCMake(build_ext):
    """Configures, builds the target of the package, and installs its component where setuptools wants it."""

    def run(self):
        build = pathlib.Path(self.build_temp).resolve()
        package = pathlib.Path(self.get_ext_fullpath("eigencrust._core")).resolve().parent
        options = [
            "-DCMAKE_BUILD_TYPE=Release",
            "-DBUILD_SHARED_LIBS=OFF",
            "-DEIGENCRUST_BUILD_PYTHON=ON",
            "-DEIGENCRUST_BUILD_TESTS=OFF",
            "-DEIGENCRUST_BUILD_TOOLS=OFF",
            "-DEIGENCRUST_BUILD_BENCH=OFF",
            "-DEIGENCRUST_BUILD_COMMAND=OFF",
            "-DEIGENCRUST_PYTHON_INSTALL_DIR=.",
            f"-DPython3_EXECUTABLE={sys.executable}",
        ]
        options += os.environ.get("CMAKE_ARGS", "").split()
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "-S", ROOT, "-B", build, *options], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "eigencrust_python_package", "-j", jobs], check=True)
        subprocess.run(
            ["cmake", "--install", build, "--component", "python", "--strip", "--prefix", package.parent], check=True
        )


setup(
    version=version(),
    packages=["eigencrust"],
    package_dir={"": "python"},
    package_data={"eigencrust": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("eigencrust._core", sources=[])],
    cmdclass={"build_ext": BuildWithCMake},
    zip_safe=False,
)
