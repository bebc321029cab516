# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Words of the command line tests. They run in an empty folder; $program is the command.

die() {
  printf 'failed: %s\n' "$1"
  if [ -e out ]; then printf -- '--- stdout\n%s\n--- stderr\n%s\n' "$(head -c 3000 out)" "$(head -c 3000 err)"; fi
  exit 1
}

skip() {
  printf 'skipped: %s\n' "$1"
  exit 77
}

# run ARGUMENTS: the command with its streams in `out` and `err` and its status in $status.
run() {
  status=0
  "$program" "$@" >out 2>err </dev/null || status=$?
}

# expect STATUS ARGUMENTS
expect() {
  local wanted=$1
  shift
  run "$@"
  [ "$status" -eq "$wanted" ] || die "status $status instead of $wanted: eigencrust $*"
}

# expect_error STATUS TEXT ARGUMENTS: one line `eigencrust: error: WHAT (PLACE); REMEDY` with TEXT in it on
# stderr, nothing on stdout.
expect_error() {
  local wanted=$1 text=$2
  shift 2
  expect "$wanted" "$@"
  [ ! -s out ] || die "something on stdout: eigencrust $*"
  [ "$(wc -l <err)" -eq 1 ] || die "not one line on stderr: eigencrust $*"
  grep -qE '^eigencrust: error: .+ \(.+\); .+$' err || die "not in the form WHAT (PLACE); REMEDY: eigencrust $*"
  grep -qF -- "$text" err || die "the message does not say '$text': eigencrust $*"
}

# until_begun STAGE PROCESS: waits for the line in `err` that tells of it, or for the end of the process, which is 1.
until_begun() {
  until grep -q "\"stage\":\"$1\",\"event\":\"begin\"" err; do
    kill -0 "$2" 2>/dev/null || return 1
    sleep 0.01
  done
}

# The folder holds these files and no others, hidden ones included; `out` and `err` do not count.
expect_files() {
  local found wanted
  found=$(find . -mindepth 1 ! -name out ! -name err -printf '%P\n' | LC_ALL=C sort)
  wanted=$(printf '%s\n' "$@" | LC_ALL=C sort)
  [ "$found" = "$wanted" ] || die "files here: $(echo $found); wanted: $*"
}

same() { cmp "$1" "$2" || die "$1 and $2 differ"; }

# equal WHAT FOUND WANTED
equal() { [ "$2" = "$3" ] || die "$1 is '$2' instead of '$3'"; }

# value FILE POINTER: what a JSON file holds at /a/b/0.
value() { "$probe" json "$1" "$2"; }

# sphere N [RADIUS [X]]: x y z of N points on a sphere around (X, 0, 0), along a spiral with the golden angle.
sphere() {
  awk -v n="$1" -v radius="${2:-1}" -v x="${3:-0}" 'BEGIN {
    golden = 3.141592653589793 * (3 - sqrt(5))
    for (i = 0; i < n; ++i) {
      z = 1 - 2 * (i + 0.5) / n; r = sqrt(1 - z * z)
      printf "%.9g %.9g %.9g\n", x + radius * r * cos(i * golden), radius * r * sin(i * golden), radius * z
    }
  }'
}

# shuffled: the lines of the input in another order, the same each time.
shuffled() {
  awk 'BEGIN { srand(7) } { printf "%.9f %s\n", rand(), $0 }' | LC_ALL=C sort | cut -d ' ' -f 2-
}

# triangles OBJ: one line per triangle, its corners' coordinates with the smallest first, sorted.
triangles() {
  awk '$1 == "v" { v[++n] = $2 "," $3 "," $4 }
    $1 == "f" {
      a = v[$2 + 0]; b = v[$3 + 0]; c = v[$4 + 0]
      if (b < a && b < c) { t = a; a = b; b = c; c = t }
      else if (c < a && c < b) { t = c; c = b; b = a; a = t }
      print a, b, c
    }' "$1" | LC_ALL=C sort
}

# A closed tetrahedron, and the same without one side.
tetrahedron() { printf 'OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n'; }
open_tetrahedron() { printf 'OFF\n4 3 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n'; }
