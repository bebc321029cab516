# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# docs/parameters.md and --help name the same options and defaults.

# options VERB: `--name default` per line. The default stands behind `=` or in [brackets] at the end.
options() {
  "$program" "$1" --help | awk '
    function flush() { if (name != "") print name, standard; name = ""; standard = "" }
    /^  -/ { flush()
      for (i = 1; i <= NF; ++i) if (match($i, /--[a-z][a-z-]*/)) { name = substr($i, RSTART, RLENGTH); break }
      if (match($0, /=[^ ]+ /)) standard = substr($0, RSTART + 1, RLENGTH - 2) }
    match($0, /\[[^\]]*\]$/) { standard = substr($0, RSTART + 1, RLENGTH - 2); sub(/;.*/, "", standard) }
    END { flush() }'
}

test_every_option_is_in_the_docs() {
  local page=$repository/docs/parameters.md name standard
  [ -f "$page" ] || skip "docs/parameters.md is not written yet"
  options reconstruct >options
  [ "$(wc -l <options)" -ge 15 ] || die "only $(wc -l <options) options in --help"
  while read -r name standard; do
    case $name in --help) continue ;; esac
    grep -qE -- "$name([^a-z-]|\$)" "$page" || die "$name is not in docs/parameters.md"
    [ -n "$standard" ] || continue
    grep -E -- "$name([^a-z-]|\$)" "$page" | grep -qF -- "$standard" ||
      die "docs/parameters.md does not give $standard as the default of $name"
  done <options
}

test_every_option_of_the_docs_exists() {
  local page=$repository/docs/parameters.md name verb
  [ -f "$page" ] || skip "docs/parameters.md is not written yet"
  for verb in reconstruct info check compare render demo; do "$program" "$verb" --help; done >help
  for name in $(grep -oE -- '--[a-z][a-z-]*' "$page" | sort -u); do
    grep -qE -- "$name([^a-z-]|\$)" help || die "docs/parameters.md speaks of $name, which no verb knows"
  done
}
