#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes examples/teapot_scan.ply again, byte for byte.
# Usage: examples/make_teapot_scan.sh [FOLDER OF eigencrust-scan, default build] [OUTPUT]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=${1:-$here/../build}
output=${2:-$here/teapot_scan.ply}

# Four stations around, three from above, two from below the horizon, and two close-ups of the spout,
# whose lip is thin. At these angles no ray gets through the gap between lid and rim to the ends of
# spout and handle inside the body. tests/unit/teapot_scan_test.cpp repeats these options: change both.
"$build/eigencrust-scan" "$here/teapot_patches.txt" -o "$output" \
  --sensor 6,2.5,5.5:3.1,0,2.4:11:84 --sensor 6,-2.5,5.5:3.1,0,2.4:11:84 \
  --ring 10:4:45 --ring 45:2:90 --ring 45:1:180 --ring -25:2:90 --distance 3 --resolution 240 --subdivisions 64 \
  --noise 0.002 --outliers 0.002 --max-incidence 75 --drop-back-faces --seed 1975
