#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Long runs in one process: does memory grow, do threads disturb one another?
# Usage: scripts/soak.sh memory [RUNS] | threads [POINTS] | all [RUNS] [POINTS]
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

what=${1:-all} runs=1000 points=20000
case $what in
  memory) runs=${2:-$runs} ;;
  threads) points=${2:-$points} ;;
  all) runs=${2:-$runs} points=${3:-$points} ;;
  *) fail "memory, threads or all, not '$what'" ;;
esac
install_packages "${build_packages[@]}" "${test_packages[@]}"

if [ "$what" != threads ]; then
  configure test build-test
  cmake --build "$repository/build-test" --parallel "$(job_count)" --target soak
  "$repository/build-test/soak" memory "$runs" 2000
fi
if [ "$what" != memory ]; then
  configure tsan build-tsan -DEIGENCRUST_BUILD_BENCH=OFF
  cmake --build "$repository/build-tsan" --parallel "$(job_count)" --target soak
  export TSAN_OPTIONS="suppressions=$repository/tests/faults/tsan.supp halt_on_error=1 second_deadlock_stack=1"
  # Silence means something only where a race is seen.
  ! "$repository/build-tsan/soak" race >/dev/null 2>&1 || fail "the thread sanitizer does not see a race"
  # More than the machine may have: oneTBB gives no more workers than cores, so the races that matter need two.
  "$repository/build-tsan/soak" threads "$points"
fi
