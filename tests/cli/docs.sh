# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# What the pages say is what the program does: options, defaults, exit statuses, versions, commands, links.

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

# promises PAGE: `promise|test test ...` of the table under the heading; marks are taken off.
promises() {
  awk -F ' *[|] *' '/^## / { on = $0 ~ /Which test holds which promise/ }
    on && /^\|/ && !/^\|-/ && $2 != "promise" { print $2 "|" $3 }' "$1"
}

# is_there NAME: Suite.Name of GoogleTest, cli.group.case, or a file of the project.
is_there() {
  case $1 in
    cli.*)
      local group=${1#cli.}
      grep -qx "test_${group#*.}() {" "$repository/tests/cli/${group%%.*}.sh"
      ;;
    */*) [ -f "$repository/$1" ] ;;
    *.*) grep -rqE "^TEST(_F|_P)?\\(${1%%.*}, ${1#*.}\\)" "$repository/tests" --include='*.cpp' ;;
    *) return 1 ;;
  esac
}

test_every_promise_has_its_test() {
  local page=$repository/docs/guarantees.md promise tests test count=0
  promises "$page" >promises
  [ "$(wc -l <promises)" -ge 30 ] || die "only $(wc -l <promises) promises"
  while IFS='|' read -r promise tests; do
    [ -n "$tests" ] || die "'$promise' has no test"
    # shellcheck disable=SC2001
    for test in $(echo "$tests" | tr -d '`'); do
      is_there "$test" || die "'$promise': there is no test $test"
      count=$((count + 1))
    done
  done <promises
  echo "$count tests of $(wc -l <promises) promises"
  # The check itself sees what is missing.
  ! is_there Shells.NoSuchTest && ! is_there cli.faults.no_such_test && ! is_there fuzz/none.cpp || die "is_there() is blind"
}

# Not only rows of the table: any --word of the pages, but on lines about other programs.
test_every_option_of_the_docs_exists() {
  local page name verb count=0
  [ -d "$repository/docs" ] || skip "docs is not here"
  for verb in reconstruct orient outliers info check compare render demo rerun; do
    "$program" "$verb" --help-all
  done >help
  for page in README.md docs/{parameters,formats,report,guarantees,algorithm,crusts,python}.md docs/walkthroughs/*.md; do
    for name in $(cd "$repository" && grep -vE 'pip |cmake |venv |scripts/' $page | { grep -oE -- '--[a-z][a-z-]*' || true; } | sort -u); do
      grep -qE -- "$name([^a-z-]|\$)" help || die "$page speaks of $name, which no verb knows"
      count=$((count + 1))
    done
  done
  [ "$count" -ge 100 ] || die "only $count options were found"
}

# statuses FILE START: the numbers of exit statuses in a file from a line on that matches, up to an empty line.
statuses() {
  awk -v start="$2" '$0 ~ start { on = 1 } on && /^$/ { exit } on' "$1" | grep -oE "$3" | grep -oE '[0-9]+' | tr '\n' ' '
}

test_exit_statuses_agree() {
  [ -d "$repository/docs" ] || skip "docs is not here"
  "$program" --help >help
  local wanted errors
  wanted=$(statuses help '^Exit status' '(: |; )[0-9]+ ')
  errors=${wanted#0 }
  equal "the statuses of --help" "$wanted" "0 2 3 4 5 6 130 "
  equal "docs/guarantees.md" "$(statuses "$repository/docs/guarantees.md" '^\| exit status' '^\| [0-9]+')" "$wanted"
  equal "eigencrust_c.h" "$(statuses "$repository/include/eigencrust_c.h" '^typedef enum eigencrust_status' '= [0-9]+')" "$wanted"
  equal "error.h" "$(statuses "$repository/include/eigencrust/error.h" '^enum class ErrorKind' '= [0-9]+')" "$errors"
  equal "docs/python.md" "$(statuses "$repository/docs/python.md" '^\| exception' '` \| [0-9]+')" "$errors"
}

test_versions_agree() {
  [ -f "$repository/CHANGELOG.md" ] || skip "CHANGELOG.md is not here"
  local version
  version=$("$program" --version)
  version=${version#eigencrust }
  equal CITATION.cff "$(sed -n 's/^version: //p' "$repository/CITATION.cff")" "$version"
  equal "the newest version of CHANGELOG.md" "$(sed -n 's/^## \[\([0-9.]*\)\].*/\1/p' "$repository/CHANGELOG.md" | head -n 1)" "$version"
  equal "what docs/development.md asks for" \
    "$(sed -n 's/^find_package(eigencrust \([0-9.]*\).*/\1/p' "$repository/docs/development.md")" "${version%.*}"
  "$program" man >page
  head -n 2 page | grep -qF "eigencrust $version" || die "the manual page is of another version"
}

# Times and memory are those of the machine.
measured_away() { sed -E 's/ in [0-9.]+ m?s, [0-9.]+ MB$//'; }

test_readme_shows_what_the_demo_prints() {
  [ -f "$repository/README.md" ] || skip "README.md is not here"
  awk '/^<!-- output of the demo -->/ { on = 1; next } on && /^```$/ { if (++fences == 2) exit; next } on' \
    "$repository/README.md" | measured_away >wanted
  [ "$(wc -l <wanted)" -ge 6 ] || die "README.md does not show what the demo prints"
  expect 0 demo
  # The scan is named as the program finds it.
  sed -E 's|[^ ]*/?examples/teapot_scan.ply|examples/teapot_scan.ply|' out | measured_away >found
  diff wanted found || die "README.md shows something else"
}

# The commands of the README as they stand there, on the bundled scan, thinned.
test_readme_commands_run() {
  [ -f "$repository/README.md" ] || skip "README.md is not here"
  local name
  expect 0 outliers "$repository/examples/teapot_scan.ply" -o scan.ply --thin 0.04
  for name in left right top; do cp scan.ply $name.ply; done
  grep -oE '^    build/eigencrust [a-z].*' "$repository/README.md" | sed 's/ *#.*//; s/^ *//' | grep -v ' demo$' >commands
  [ "$(wc -l <commands)" -ge 9 ] || die "only $(wc -l <commands) commands in README.md"
  mkdir build
  ln -s "$program" build/eigencrust
  [ -e "$(dirname -- "$program")/viewer.html" ] || sed -i '/page\.html/d' commands # scripts/viewer.sh was not called
  sed -i '/compare/i cp mesh.ply truth.ply' commands
  bash -e commands >out 2>err </dev/null || die "a command of README.md failed"
}

# walk PAGE: all commands of the walkthrough, as they stand there, on the bundled scan, thinned.
walk() {
  local page=$repository/docs/walkthroughs/$1.md
  [ -f "$page" ] || skip "docs/walkthroughs is not here"
  expect 0 outliers "$repository/examples/teapot_scan.ply" -o scan.ply --thin 0.04
  awk '/^```sh$/ { on = 1; next } /^```$/ { on = 0 } on' "$page" >commands
  [ "$(grep -c '^eigencrust ' commands)" -ge "$2" ] || die "fewer than $2 commands in $page"
  mkdir bin
  ln -s "$program" bin/eigencrust
  PATH=$PWD/bin:$PATH bash -e -o pipefail commands >out 2>err </dev/null || die "a command of $page failed"
}

test_walkthrough_heritage() { walk heritage 6; }
test_walkthrough_print() { walk print 5; }
test_walkthrough_research() { walk research 8; }
test_walkthrough_embedding() { walk embedding 2; }

test_walkthrough_robotics() {
  walk robotics 4
  tail -n 1 progress.jsonl | grep -q '"status": *0' || die "the last line of the progress is no end"
  grep -q '^element face' piped.ply || die "no mesh came through the pipe"
}

test_walkthrough_survey() {
  walk survey 3
  grep -q '; 135.6 above the plane of the rim' out || die "the pile has another volume than the page says"
}

# Relative links of all pages lead to files.
test_links_lead_somewhere() {
  local page target count=0
  [ -d "$repository/docs" ] || skip "docs is not here"
  while IFS= read -r page; do
    while IFS= read -r target; do
      target=${target%%#*}
      case $target in '' | *://* | mailto:*) continue ;; esac
      [ -e "$(dirname "$page")/$target" ] || die "$page leads to $target, which is not there"
      count=$((count + 1))
    done < <(sed 's/`[^`]*`//g' "$page" | { grep -oE '\]\([^)]+\)' || true; } | sed 's/^](//; s/)$//')
  done < <(find "$repository" -maxdepth 3 -name '*.md' -not -path '*/build*' -not -path '*/node_modules/*')
  [ "$count" -ge 40 ] || die "only $count links were found"
  echo "$count links"
}
