#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds everything and runs all tests: format, unit, property, hard clouds, command line, installed package, and
# the unit tests, the hard clouds and random clouds under the address and undefined-behaviour sanitizers; the whole run
# with four threads under the thread sanitizer; the short form of scripts/faults.sh.
# Real scans are looked for in $EIGENCRUST_DATA, else in ../shared/data; tests skip without them.
# The Python package has scripts/test_python.sh.
# Usage: scripts/test.sh [options for ctest], for example scripts/test.sh -R cli
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

started=$SECONDS
step() { printf '\n== %s (after %d s)\n' "$1" $((SECONDS - started)); }

step "packages"
install_packages "${build_packages[@]}" "${test_packages[@]}"

step "sanitizer build"
configure asan build-asan
cmake --build "$repository/build-asan" --parallel "$(job_count)" --target unit_tests hard_tests fuzz_method

step "thread sanitizer"
"$repository/scripts/soak.sh" threads 2000

step "build"
configure test build-test -DEIGENCRUST_SANITIZED_BUILD="$repository/build-asan" -DEIGENCRUST_BUILD_MPI=ON
cmake --build "$repository/build-test" --parallel "$(job_count)"

step "tests"
ctest --test-dir "$repository/build-test" --output-on-failure --no-label-summary --timeout 900 \
  --parallel "$(nproc)" "$@"
