#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds with shared libraries and the Python module, and makes build-package/eigencrust_VERSION_ARCHITECTURE.deb. Where
# npm is there, with the viewer that --report page.html needs. The same commit gives the same bytes in any folder.
# Usage: scripts/package.sh [options for CMake]; then apt install ./build-package/eigencrust_*.deb
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

install_packages "${build_packages[@]}" "${python_packages[@]}" dpkg-dev file
# The time of the last change, not of the build, so that the same source gives the same bytes.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -C "$repository" log -1 --format=%ct 2>/dev/null || echo 0)}
export SOURCE_DATE_EPOCH
# Before CMake looks which files there are: the licence of what is in the viewer goes into the package with it.
rm -f "$repository/build-package/viewer.html"
if ! command -v npm >/dev/null; then
  printf 'package.sh: npm is missing: the package will be without the viewer, and --report page.html will say so\n' >&2
elif ! "$repository/scripts/viewer.sh" "$repository/build-package"; then
  printf 'package.sh: the viewer was not built: the package will be without it, and --report page.html will say so\n' >&2
fi
configure package build-package "$@"
cmake --build "$repository/build-package" --parallel "$(job_count)"
(cd "$repository/build-package" && rm -f eigencrust_*.deb && cpack -G DEB --config CPackConfig.cmake)
ls -l "$repository"/build-package/eigencrust_*.deb
