#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the Python package beside the command and runs its tests; apart from scripts/test.sh, whose time it would exceed.
# Usage: scripts/test_python.sh [options for ctest]
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

install_packages "${build_packages[@]}" "${test_packages[@]}" "${python_packages[@]}" "${python_test_packages[@]}"
configure test build-python -DEIGENCRUST_BUILD_PYTHON=ON
cmake --build "$repository/build-python" --parallel "$(job_count)" --target eigencrust_cli eigencrust_python_package
ctest --test-dir "$repository/build-python" --output-on-failure --no-label-summary --timeout 900 \
  --parallel "$(nproc)" -L python "$@"
