#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Holds the program against its other methods and against Open3D, CGAL and MeshLab on the clouds of the 2004 paper's
# figures, raw and simulated scans, and writes a page: FOLDER/quality.md with its pictures and FOLDER/quality.html, one
# file with all of them. Installs what it needs (Debian 12) and builds it. Hours for everything; outcomes are kept in
# FOLDER/work, so a run that was stopped goes on. Clouds of $EIGENCRUST_DATA and $EIGENCRUST_FIELD that are not there are
# skipped, and so are programs that are not installed.
# Usage: scripts/quality.sh [--short] [--cases WORDS] [--no-peers] [--docs] [FOLDER, default quality_out]
#   --short        one small cloud that needs no data: a minute
#   --cases WORDS  cases whose group/name contains one of these words: fig9/,raw/bunny; build/eigencrust-quality --cases
#                  contest --list names them
#   --no-peers     installs and builds nothing of others
#   --docs         writes docs/quality.md and docs/images/quality-*, too
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

cases='' peers=yes docs=no folder=quality_out
while [ $# -gt 0 ]; do
  case $1 in
    --short) cases=clean/bumpy-ball ;;
    --cases)
      [ $# -gt 1 ] || fail "--cases needs words"
      cases=$2
      shift
      ;;
    --no-peers) peers=no ;;
    --docs) docs=yes ;;
    -*) fail "unknown option $1; see the head of this script" ;;
    *) folder=$1 ;;
  esac
  shift
done

folder=$(realpath -m -- "$folder")
targets=(eigencrust eigencrust-quality)
install_packages "${build_packages[@]}" "${tool_packages[@]}"
if [ "$peers" = yes ]; then
  # Without them the page says that they are not installed.
  (install_packages "${peer_packages[@]}") || printf 'skipped: Open3D and MeshLab\n' >&2
  targets+=(eigencrust-peers)
fi
configure release build -DEIGENCRUST_BUILD_TOOLS=ON -DEIGENCRUST_BUILD_BENCH=ON
cmake --build "$repository/build" --parallel "$(job_count)" --target "${targets[@]}"

mkdir -p "$folder"
contest=("$repository/build/eigencrust-quality" --cases contest --contest "$cases" --work "$folder/work")
if [ "$peers" = no ]; then contest+=(--python none --peers none); fi
"${contest[@]}" --table "$folder/quality.md" --pictures "$folder/images" --page "$folder/quality.html"
if [ "$docs" = yes ]; then
  "${contest[@]}" --table "$repository/docs/quality.md" --pictures "$repository/docs/images"
fi
printf 'Wrote %s\n' "$folder/quality.md" "$folder/quality.html"
