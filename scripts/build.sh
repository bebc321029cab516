#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the packages that are missing (Debian 12) and leaves the command at build/eigencrust. That is all it builds;
# with --all the virtual scanner, the teapot and the benchmarks as well, with --mpi eigencrust-mpi, for several machines.
# Works from any folder. Usage: scripts/build.sh [--all] [--mpi] [options for CMake]
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

others=OFF mpi=OFF
while :; do
  case ${1:-} in
    --all) others=ON build_packages+=("${tool_packages[@]}") ;;
    --mpi) mpi=ON build_packages+=("${mpi_packages[@]}") ;;
    *) break ;;
  esac
  shift
done
install_packages "${build_packages[@]}"
configure release build -DEIGENCRUST_BUILD_TOOLS=$others -DEIGENCRUST_BUILD_BENCH=$others -DEIGENCRUST_BUILD_MPI=$mpi "$@"
cmake --build "$repository/build" --parallel "$(job_count)"
printf 'Built %s\n' "$repository/build/eigencrust"
