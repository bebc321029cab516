#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the README's picture from the bundled scan: docs/images/teapot.png.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root"
build/eigencrust examples/teapot_scan.ply -o "$work/teapot.ply" --quiet
build/eigencrust render examples/teapot_scan.ply "$work/teapot.ply" -o docs/images/teapot.png \
  --width 700 --height 500 --up z --azimuth -60 --point-size 1.5
