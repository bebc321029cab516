#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Counts the lines of src and include but for formats and pictures (io, render), and lists what is too long:
# functions over 60 lines, and files over 600 anywhere in the project. A function is what has parameters and a body;
# its length runs from its first line to the closing brace in the same column (the code is formatted).
# Usage: scripts/lines.sh [--by-folder]; fails where something is too long
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

# counted PATHSPEC...: number of lines of the tracked sources
counted() { git ls-files -z -- "$@" | xargs -0 -r cat | wc -l; }

# long_functions FILE...: file:line: how many lines, first line
long_functions() {
  awk -v most=60 '
    FNR == 1 { begin = 0; split("", start) }
    {
      line = $0
      sub(/[ ]*\/\/.*$/, "", line)
      match($0, /^ */)
      indent = RLENGTH
      if (line ~ /^ *$/ || line ~ /^ *#/) { begin = 0; next }
      if (!begin) { begin = FNR; column = indent; head = "" }
      head = head " " line
      if (line ~ /\{$/) {
        is_function = head ~ /\) *(const|noexcept|override|mutable|-> *[^{;=]*|: .*|\{)/ &&
          head !~ /^ *(namespace|struct|class|enum|union|if|else|for|while|switch|do|return|case|try|catch|\}|const auto|auto|std::function)[ ({]/ &&
          head !~ /\[[^]]*\] *(\(|\{)/ && head !~ /= *\{$/
        if (is_function) { start[column] = begin; first[column] = head }
        begin = 0
      } else if (line ~ /^ *\}/) {
        if (indent in start) {
          length_ = FNR - start[indent] + 1
          if (length_ > most) printf "%s:%d: %d lines:%s\n", FILENAME, start[indent], length_, substr(first[indent], 1, 90)
          delete start[indent]
        }
        begin = 0
      } else if (line ~ /[;:>]$/) begin = 0
    }' "$@"
}

pathspec=(':(glob)src/**/*.cpp' ':(glob)src/**/*.h' ':(glob)include/**/*.h' ':!src/io' ':!src/render'
  ':!include/eigencrust/io.h' ':!include/eigencrust/render.h')
if [ "${1:-}" = --by-folder ]; then
  git ls-files -- "${pathspec[@]}" | sed 's|[^/]*$||' | sort -u | while read -r folder; do
    printf '%6d  %s\n' "$(counted "${pathspec[@]:3}" ":(glob)$folder*.cpp" ":(glob)$folder*.h")" "$folder"
  done
fi
printf '%6d  src and include without io and render\n' "$(counted "${pathspec[@]}")"

mapfile -d '' files < <(git ls-files -z -- '*.cpp' '*.h')
functions=$(long_functions "${files[@]}")
long_files=$(wc -l "${files[@]}" | awk '$2 != "total" && $1 > 600 { print $2 ": " $1 " lines" }')
printf 'functions over 60 lines: %d\n' "$(grep -c . <<<"$functions" || true)"
[ -z "$functions" ] || printf '  %s\n' "$functions"
printf 'files over 600 lines: %d\n' "$(grep -c . <<<"$long_files" || true)"
[ -z "$long_files" ] || printf '  %s\n' "$long_files"
[ -z "$functions$long_files" ]
