#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the viewer that `--report page.html` needs, one file, and puts it beside the built command. Needs npm (Debian's
# package, or Node.js from 18 on) and a network. Usage: scripts/viewer.sh [build folder], build unless another is named
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

folder=$(realpath -m -- "${1:-$repository/build}")
command -v npm >/dev/null || fail "npm is missing; install Debian's package npm"
mkdir -p "$folder/viewer"
# Packages lie in the build folder: the source tree stays as it is.
cp -r "$repository/viewer/." "$folder/viewer"
(cd "$folder/viewer" && npm ci --omit=dev --no-audit --no-fund --loglevel=error && node build.mjs "$folder/viewer.html.new")
mv "$folder/viewer.html.new" "$folder/viewer.html"
printf 'Built %s\n' "$folder/viewer.html"
