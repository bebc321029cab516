#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Feeds the readers with damaged files (libFuzzer, with the address and undefined-behaviour sanitizers).
# Seeds are those in fuzz/seeds and the real files in $EIGENCRUST_DATA/formats, else ../shared/data/formats,
# where there are any.
# Inputs that fail are left in build-fuzz/found. Usage: scripts/fuzz.sh [SECONDS per format, 5 by default] [FORMAT...]
#
# scripts/fuzz.sh method [COUNT] [FIRST_SEED] sends random clouds with random options through the method instead, under
# the same sanitizers, and looks at each mesh; a seed that fails is printed, build-asan/fuzz_method show SEED shows it.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

if [ "${1:-}" = method ]; then
  install_packages "${build_packages[@]}" "${test_packages[@]}"
  configure asan build-asan
  cmake --build "$repository/build-asan" --parallel "$(job_count)" --target fuzz_method
  exec "$repository/build-asan/fuzz_method" "${3:-1}" "${2:-1000}"
fi

seconds=${1:-5}
case $seconds in '' | *[!0-9]*) fail "SECONDS is a whole number, not '$seconds'" ;; esac
formats=("${@:2}")
[ ${#formats[@]} -gt 0 ] || formats=(e57 las npz npy ptx pcd pts ply obj off stl glb 3mf xyz csv vis images.bin images.txt
  sensors.csv index.txt)

install_packages "${build_packages[@]}" "${fuzz_packages[@]}"
cmake -S "$repository" -B "$repository/build-fuzz" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" \
  -DEIGENCRUST_BUILD_TESTS=OFF -DEIGENCRUST_BUILD_TOOLS=OFF -DEIGENCRUST_BUILD_FUZZERS=ON
cmake --build "$repository/build-fuzz" --parallel "$(job_count)" --target fuzz_read_cloud fuzz_read_sensors

data=${EIGENCRUST_DATA:-$repository/../shared/data}
found=$repository/build-fuzz/found
mkdir -p "$found"
status=0
for format in "${formats[@]}"; do
  corpus=$repository/build-fuzz/corpus/$format
  mkdir -p "$corpus"
  # Large seeds would slow the fuzzer down and teach it nothing that small ones do not.
  for seeds in "$repository/fuzz/seeds/$format" "$data/formats/$format"; do
    [ ! -d "$seeds" ] || find "$seeds" -type f -size -64k -exec cp --no-preserve=mode -t "$corpus" {} +
  done
  case $format in
    vis | images.* | sensors.csv | index.txt) fuzzer=fuzz_read_sensors ;;
    *) fuzzer=fuzz_read_cloud ;;
  esac
  printf '== %s, %s s\n' "$format" "$seconds"
  EIGENCRUST_FUZZ_FORMAT=$format "$repository/build-fuzz/$fuzzer" -max_total_time="$seconds" -timeout=10 \
    -rss_limit_mb=2048 -malloc_limit_mb=1024 -max_len=65536 -print_final_stats=1 -verbosity=0 -print_funcs=0 \
    -artifact_prefix="$found/$format-" "$corpus" 2>&1 | grep -vE '^(INFO|#|"|stat::(new|slowest|average))' || status=1
done
[ "$status" -eq 0 ] || fail "a reader failed; the inputs are in $found"
