#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Breaks the command in every way that a machine can, and looks at what is left: kills at random instants, signals at
# every stage and while writing, system calls and allocations that fail, limits, a full file system, permissions.
# After each: no half file, no lost file, nothing left after the next run, no crash, a documented status, one clean
# message. Prints a table for docs/guarantees.md; status 1 if anything was found.
# Usage: scripts/faults.sh [short|long] [SEED]    needs build-test (scripts/test.sh, or the preset `test`)
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

length=${1:-short} seed=${2:-1}
case $length in
  short) kills=20 signals_per_stage=1 failing_calls=40 failing_allocations=60 ;;
  long) kills=1000 signals_per_stage=2 failing_calls=500 failing_allocations=1000 ;;
  *) fail "short or long, not '$length'" ;;
esac
RANDOM=$seed
build=${EIGENCRUST_BUILD:-$repository/build-test}
program=$build/eigencrust preload=$build/libfault_preload.so
[ -x "$program" ] || fail "$program is not there; build it first: cmake --preset test && cmake --build --preset test"
if [ ! -f "$preload" ]; then preload=$(find "$build" -name libfault_preload.so | head -1); fi
[ -f "$preload" ] || fail "the library fault_preload is not built"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir run
findings=0
found() {
  findings=$((findings + 1))
  here=$((here + 1))
  printf 'found: %s\n' "$1" >&2
  [ ! -s err ] || sed 's/^/  stderr: /' err | head -3 >&2
}

# Clouds: large enough to be hit at work, small enough for a thousand runs.
sphere() {
  awk -v n="$1" 'BEGIN { srand(7); golden = 3.141592653589793 * (3 - sqrt(5))
    for (i = 0; i < n; ++i) { z = 1 - 2 * (i + 0.5) / n; r = sqrt(1 - z * z) * (1 + 0.01 * rand())
      printf "%.9g %.9g %.9g\n", r * cos(i * golden), r * sin(i * golden), z } }'
}
sphere 6000 >cloud.xyz
sphere 300 >small.xyz
"$program" small.xyz -o old.ply --quiet
"$program" cloud.xyz -o new.ply --quiet --threads 2
"$program" small.xyz -o new_small.ply --quiet
size=$(stat -c %s new.ply)

# fresh: the folder of a run holds an old mesh and an old report.
fresh() {
  rm -rf run
  mkdir run
  cp old.ply run/mesh.ply
  echo '{"old": true}' >run/report.json
}

# whole WANTED: the mesh in its place is the old one or the finished one, and so is the report.
whole() {
  if ! cmp -s run/mesh.ply old.ply && ! cmp -s run/mesh.ply "$1"; then found "$2: the mesh is neither the old one nor the new"; fi
  if ! grep -q '"old": true' run/report.json && ! tail -1 run/report.json | grep -qx '}'; then found "$2: half a report"; fi
}
# nothing_left WHAT: after the next run in the folder there are two files.
nothing_left() {
  "$program" small.xyz -o run/mesh.ply --report run/report.json --quiet --threads 1 || found "$1: the next run fails"
  [ "$(ls -A run | tr '\n' ' ')" = "mesh.ply report.json " ] || found "$1: left over: $(ls -A run | tr '\n' ' ')"
}
# documented STATUS WHAT: a status of docs/guarantees.md with its message.
documented() {
  case $1 in
    0) ;;
    2 | 3 | 4 | 5 | 6 | 130)
      [ "$(grep -cE '^eigencrust: error: |"event":"error"' err)" -ge 1 ] || found "$2: status $1 without a message"
      ! grep -q '(internal)' err || found "$2: an error that is called internal"
      ;;
    *) found "$2: status $1" ;;
  esac
  if [ "$1" -ne 0 ] && [ "$1" -ne 6 ] && ! cmp -s run/mesh.ply old.ply; then found "$2: status $1 with a new mesh"; fi
}
row() { printf '| %s | %d | %d | %d |\n' "$1" "$2" "$(($2 - here))" "$here" | tee -a table >&2; }
printf '| what | tried | survived | faults |\n|---|---|---|---|\n' >table

# run_small LIBRARY-SETTINGS...: one run of the small cloud under the preloaded library; its status in $status.
run_small() {
  status=0
  timeout 60 env "$@" LD_PRELOAD="$preload" "$program" small.xyz -o run/mesh.ply --report run/report.json \
    --threads "${threads:-1}" >out 2>err || status=$?
}

echo "== kills at random instants" >&2
here=0
begin=$(date +%s%N)
"$program" cloud.xyz -o new.ply --quiet --threads 2
took=$((($(date +%s%N) - begin) / 1000))
for ((k = 0; k < kills; ++k)); do
  fresh
  "$program" cloud.xyz -o run/mesh.ply --report run/report.json --quiet --threads 2 >out 2>err &
  child=$!
  wait_us=$(((RANDOM * 32768 + RANDOM) % (took + took / 4)))
  sleep "$((wait_us / 1000000)).$(printf '%06d' $((wait_us % 1000000)))"
  kill -KILL "$child" 2>/dev/null || true
  wait "$child" 2>/dev/null || true
  whole new.ply "kill after $wait_us us"
  nothing_left "kill after $wait_us us"
done
row "SIGKILL at a random instant (seed $seed)" "$kills"

echo "== kills at each system call" >&2
here=0 killed=0
fresh
run_small EIGENCRUST_FAULT_COUNT="$work/counts"
read -r calls allocations <counts
for ((k = 1; k <= calls; ++k)); do
  if [ "$length" = short ] && [ $((k % 4)) -ne 0 ]; then continue; fi
  fresh
  run_small EIGENCRUST_FAULT_CALL="$k" EIGENCRUST_FAULT_SIGNAL=9 2>/dev/null
  whole new_small.ply "kill at call $k"
  nothing_left "kill at call $k"
  killed=$((killed + 1))
done
row "SIGKILL before a system call, each of $calls in turn" "$killed"

echo "== signals at every stage" >&2
here=0 tried=0
"$program" cloud.xyz -o new.ply --progress jsonl --threads 2 >out 2>err
stages=$(sed -n 's/.*"stage":"\([a-z_]*\)","event":"begin".*/\1/p' err | sort -u)
for stage in $stages; do
  for signal in INT TERM HUP QUIT XCPU PIPE; do
    for ((k = 0; k < signals_per_stage; ++k)); do
      fresh
      : >err # of the run before
      "$program" cloud.xyz -o run/mesh.ply --report run/report.json --progress jsonl --threads 2 >out 2>err &
      child=$!
      until grep -q "\"stage\":\"$stage\",\"event\":\"begin\"" err || ! kill -0 "$child" 2>/dev/null; do :; done
      kill -s "$signal" "$child" 2>/dev/null || true
      [ "$k" -eq 0 ] || kill -s "$signal" "$child" 2>/dev/null || true # a second one at once
      status=0
      wait "$child" || status=$?
      documented "$status" "SIG$signal in $stage"
      whole new.ply "SIG$signal in $stage"
      [ "$(ls -A run | tr '\n' ' ')" = "mesh.ply report.json " ] || found "SIG$signal in $stage: left over: $(ls -A run)"
      tried=$((tried + 1))
    done
  done
done
row "INT, TERM, HUP, QUIT, XCPU, PIPE at every stage" "$tried"

echo "== signals at each system call, those of writing among them" >&2
here=0 tried=0
for ((k = 1; k <= calls; ++k)); do
  for signal in 1 2 3 13 15 24; do # HUP INT QUIT PIPE TERM XCPU
    if [ "$length" = short ] && [ $(((k + signal) % 8)) -ne 0 ]; then continue; fi
    fresh
    run_small EIGENCRUST_FAULT_CALL="$k" EIGENCRUST_FAULT_SIGNAL="$signal"
    documented "$status" "signal $signal at call $k"
    whole new_small.ply "signal $signal at call $k"
    [ "$(ls -A run | tr '\n' ' ')" = "mesh.ply report.json " ] || found "signal $signal at call $k: left over"
    tried=$((tried + 1))
  done
done
row "the same before each system call" "$tried"

echo "== system calls that fail" >&2
here=0 tried=0
while [ "$tried" -lt "$failing_calls" ]; do
  for code in 5 28 12 13 4 11; do # EIO ENOSPC ENOMEM EACCES EINTR EAGAIN
    k=$((RANDOM % calls + 1))
    fresh
    run_small EIGENCRUST_FAULT_CALL="$k" EIGENCRUST_FAULT_ERRNO="$code"
    documented "$status" "call $k with error $code"
    whole new_small.ply "call $k with error $code"
    nothing_left "call $k with error $code"
    tried=$((tried + 1))
  done
done
row "the k-th system call fails (EIO ENOSPC ENOMEM EACCES EINTR EAGAIN)" "$tried"

echo "== allocations that fail" >&2
here=0
for ((i = 0; i < failing_allocations; ++i)); do
  # Half of them one by one from both ends, where little happens often; the others anywhere.
  case $((i % 4)) in
    0) k=$((i / 4 + 1)) ;;
    1) k=$((allocations - i / 4)) ;;
    *) k=$(((RANDOM * 32768 + RANDOM) % allocations + 1)) ;;
  esac
  many=$((i % 3 == 0 ? 1 : 1000000))
  fresh
  threads=$((i % 2 + 1)) run_small EIGENCRUST_FAULT_ALLOCATION="$k" EIGENCRUST_FAULT_LENGTH="$many"
  documented "$status" "allocation $k, $many of them, $((i % 2 + 1)) threads"
  whole new_small.ply "allocation $k"
  [ "$(ls -A run | tr '\n' ' ')" = "mesh.ply report.json " ] || found "allocation $k: left over"
done
row "the k-th allocation fails, once or from there on" "$failing_allocations"

echo "== limits" >&2
here=0 tried=0
for kind in "f 1" "f 8" "f $((size / 1024 / 2))" "v 40000" "v 80000" "v 200000" "n 3" "n 4" "n 5" "n 8" "t 1" "u 1"; do
  fresh
  status=0
  # shellcheck disable=SC2086
  (ulimit -S -${kind% *} ${kind#* } && exec timeout 60 "$program" cloud.xyz -o run/mesh.ply --report run/report.json --threads 2) >out 2>err || status=$?
  case $kind in
    v*) [ "$status" -eq 127 ] && status=0 ;; # not even the loader has room
    n*) [ "$status" -eq 127 ] && status=0 ;;
    u*) [ "$status" -ge 125 ] && [ "$status" -ne 130 ] && status=0 ;; # timeout has no process
  esac
  documented "$status" "ulimit -$kind"
  whole new.ply "ulimit -$kind"
  tried=$((tried + 1))
done
row "limits of file size, memory, descriptors, time, processes" "$tried"

echo "== a small full file system, permissions" >&2
here=0 tried=0
if unshare --user --map-root-user --mount true 2>/dev/null; then
  for blocks in 16 40 64 100 200 400; do
    rm -rf run && mkdir run
    export program size blocks
    # shellcheck disable=SC2016
    result=$(unshare --user --map-root-user --mount bash -c '
      mount -t tmpfs -o size=${blocks}k none run && cp old.ply run/mesh.ply 2>/dev/null || exit 0
      echo "{\"old\": true}" >run/report.json
      status=0
      "$program" cloud.xyz -o run/mesh.ply --report run/report.json >out 2>err || status=$?
      if [ "$status" -eq 0 ]; then cmp -s run/mesh.ply new.ply || echo "status 0 without the mesh"
      elif [ "$status" -ne 3 ]; then echo "status $status"
      elif ! cmp -s run/mesh.ply old.ply; then echo "the old mesh is gone"; fi
      [ "$(ls -A run | tr "\n" " ")" = "mesh.ply report.json " ] || echo "left over: $(ls -A run)"')
    [ -z "$result" ] || found "a file system of $blocks kB: $result"
    tried=$((tried + 1))
  done
fi
rm -rf run
fresh
for target in /proc/mesh.ply /sys/mesh.ply /dev/full; do
  status=0
  case $target in *.ply) name=$target ;; *) ln -s "$target" run/full.ply && name=run/full.ply ;; esac
  "$program" small.xyz -o "$name" >out 2>err || status=$?
  [ "$status" -eq 3 ] || found "$target: status $status instead of 3"
  rm -f run/full.ply
  tried=$((tried + 1))
done
row "full file systems, folders that take no file" "$tried"

cat table
printf '\n%s, seed %s, %d faults in %d s\n' "$length" "$seed" "$findings" "$SECONDS"
[ "$findings" -eq 0 ]
