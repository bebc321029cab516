#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the packages that are missing (Debian 12) and leaves the command at build/eigencrust. That is all it builds;
# with --all the virtual scanner, the teapot and the benchmarks as well.
# Works from any folder. Usage: scripts/build.sh [--all] [options for CMake]
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

others=OFF
if [ "${1:-}" = --all ]; then
  others=ON
  shift
  build_packages+=("${tool_packages[@]}")
fi
install_packages "${build_packages[@]}"
configure release build -DEIGENCRUST_BUILD_TOOLS=$others -DEIGENCRUST_BUILD_BENCH=$others "$@"
cmake --build "$repository/build" --parallel "$(job_count)"
printf 'Built %s\n' "$repository/build/eigencrust"
