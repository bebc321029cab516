#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the packages that are missing (Debian 12) and leaves the command at build/eigencrust.
# Works from any folder. Usage: scripts/build.sh [options for CMake]
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

install_packages "${build_packages[@]}"
configure release build "$@"
cmake --build "$repository/build" --parallel "$(job_count)"
printf 'Built %s\n' "$repository/build/eigencrust"
