# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# docs/parameters.md and --help-all name the same options and defaults.

# options VERB: `--name|default|default of the preset paper` per line; empty where --help-all gives none. Defaults
# stand at the end as [robust] or [robust; paper: other].
options() {
  "$program" "$1" --help-all | awk '
    function flush() { if (name != "") print name "|" standard "|" paper; name = standard = paper = "" }
    /^  -/ {
      flush()
      match($0, /--[a-z][a-z-]*/)
      name = substr($0, RSTART, RLENGTH)
    }
    match($0, /\[[^\]]*\]$/) {
      standard = paper = substr($0, RSTART + 1, RLENGTH - 2)
      if (sub(/;.*/, "", standard)) sub(/.*paper: /, "", paper)
    }
    END { flush() }'
}

# rows PAGE: the same of the table `| option | default | paper | ...`, without the marks of the text.
rows() {
  awk -F ' *[|] *' '/^\| `-/ { gsub(/`/, ""); print $2 "|" $3 "|" $4 }' "$1"
}

test_every_option_is_in_the_docs() {
  local page=$repository/docs/parameters.md name standard paper row found
  [ -f "$page" ] || skip "docs/parameters.md is not here"
  { options reconstruct; options orient; options outliers; } | grep -v '^--help' | sort -u >options
  rows "$page" >rows
  [ "$(wc -l <options)" -ge 15 ] || die "only $(wc -l <options) options in --help"
  while IFS='|' read -r name standard paper; do
    row=$(grep -E -- "$name([^a-z-]|\$)" rows) || die "$name has no row in docs/parameters.md"
    found=$(echo "$row" | cut -d '|' -f 2)
    [ -z "$standard" ] || equal "the default of $name in docs/parameters.md" "$found" "$standard"
    found=$(echo "$row" | cut -d '|' -f 3)
    [ -z "$paper" ] || equal "the default of $name for the preset paper in docs/parameters.md" "${found:-$paper}" "$paper"
  done <options
}

# Not only rows: any --word of the page.
test_every_option_of_the_docs_exists() {
  local page=$repository/docs/parameters.md name verb
  [ -f "$page" ] || skip "docs/parameters.md is not here"
  for verb in reconstruct orient outliers info check compare render demo rerun; do
    "$program" "$verb" --help-all
  done >help
  for name in $(grep -oE -- '--[a-z][a-z-]*' "$page" | sort -u); do
    grep -qE -- "$name([^a-z-]|\$)" help || die "docs/parameters.md speaks of $name, which no verb knows"
  done
}
