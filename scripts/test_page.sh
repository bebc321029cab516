#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the viewer, makes the pages of the bundled scan and, where $EIGENCRUST_DATA has it, of the raw bunny, and looks
# at them in headless Chromium: no error, no blank picture, every switch changes it, the cut works. Apart from
# scripts/test.sh, for it needs npm, a network and Debian's package chromium. Leaves pictures to look at.
# Usage: scripts/test_page.sh [build folder] [folder for pages and pictures]
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

build=$(realpath -m -- "${1:-$repository/build}")
shown=$(realpath -m -- "${2:-$build/pages}")
[ -x "$build/eigencrust" ] || fail "there is no $build/eigencrust; run scripts/build.sh first"
install_packages chromium
"$repository/scripts/viewer.sh" "$build"
(cd "$build/viewer" && npm ci --no-audit --no-fund --loglevel=error)
mkdir -p "$shown"

status=0
look() { node "$build/viewer/test/page.mjs" "$shown/$1.html" "$shown" || status=1; }
"$build/eigencrust" "$repository/examples/teapot_scan.ply" -o "$shown/teapot.ply" --report "$shown/teapot.html"
look teapot
bunny=${EIGENCRUST_DATA:-}/bunny
if [ -f "$bunny/bunny_raw.ply" ]; then
  "$build/eigencrust" "$bunny/bunny_raw.ply" --scan-index "$bunny/scan_index.u8" -o "$shown/bunny.ply" \
    --report "$shown/bunny.html"
  look bunny
else
  echo 'skipped: no bunny/bunny_raw.ply in $EIGENCRUST_DATA'
fi
printf 'Pages and pictures: %s\n' "$shown"
exit $status
