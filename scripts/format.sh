#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Formats all C++ files. Usage: scripts/format.sh [--check] (changes nothing, fails where something would change)
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

version=$(clang-format --version 2>/dev/null | grep -oE 'version [0-9]+' || true)
if [ "$version" != "version 14" ]; then
  # Other versions disagree in details. 77 tells ctest that the test was skipped.
  printf 'format.sh: clang-format 14 is needed, found %s\n' "${version:-none}" >&2
  exit 77
fi
mapfile -d '' files < <(find include src cli python tools bench tests fuzz \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z)
if [ "${1:-}" = --check ]; then
  clang-format --dry-run --Werror "${files[@]}"
else
  clang-format -i "${files[@]}"
fi
