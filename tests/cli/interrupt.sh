# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Statuses 130 and 4: cancelled, or out of memory. No file is left.

set -m # background jobs get SIGINT only with job control

stages_begun() { grep -c '"event":"begin"' err || true; }

# interrupt_at STAGE [SIGNAL]: sends it when the stage has begun; $status and $begun_after, how many stages began after
# the signal, tell the rest. The run stands still while they are counted, so that nothing hangs on how busy the machine
# is.
interrupt_at() {
  local stage=$1 signal=${2:-INT} attempt begun child stopped
  stopped=$((128 + $(kill -l STOP)))
  for attempt in 1 2 3 4 5; do
    "$program" big.xyz -o mesh.ply --report report.json --progress jsonl >out 2>err &
    child=$!
    until_begun "$stage" "$child" || true
    kill -s STOP "$child" 2>/dev/null || true
    begun=$(stages_begun)
    kill -s "$signal" "$child" 2>/dev/null || true
    kill -s CONT "$child" 2>/dev/null || true
    status=0
    wait -f "$child" || status=$?
    # On a busy machine bash hears of the standing still only now.
    while [ "$status" -eq "$stopped" ]; do
      status=0
      wait -f "$child" || status=$?
    done
    begun_after=$(($(stages_begun) - begun))
    if [ "$status" -ne 0 ]; then return; fi
    echo "attempt $attempt: the run was over before the signal came"
    rm -f mesh.ply report.json
  done
  die "the run was always over before the signal came in '$stage'"
}

# No further stage begins but one that another thread was about to.
expect_prompt_end() {
  echo "$1: $begun_after stages began after the signal"
  equal "status after a signal in $1" "$status" 130
  [ "$begun_after" -le 1 ] || die "$begun_after stages began after the signal in $1"
  grep -qE '^\{"event":"error","text":".+ \(.+\); .+"\}$' err || die "no message after a signal in $1"
  expect_files big.xyz
}

test_interrupt_in_delaunay() {
  sphere 300000 >big.xyz
  interrupt_at delaunay
  expect_prompt_end delaunay
}

test_interrupt_in_pole_graph() {
  sphere 300000 >big.xyz
  interrupt_at pole_graph
  expect_prompt_end pole_graph
}

test_interrupt_in_partition() {
  sphere 300000 >big.xyz
  interrupt_at partition_poles
  expect_prompt_end partition_poles
}

test_interrupt_in_the_energy() {
  sphere 300000 >big.xyz
  interrupt_at energy
  expect_prompt_end energy
}

test_interrupt_in_validation() {
  sphere 300000 >big.xyz
  interrupt_at validate
  expect_prompt_end validate
}

test_interrupt_while_reading() {
  sphere 300000 >big.xyz
  cp big.xyz whole
  for _ in 1 2 3 4 5 6; do cat whole; done >big.xyz
  rm whole
  "$program" big.xyz -o mesh.ply --progress jsonl >out 2>err &
  local child=$! read=0
  while [ "$read" -lt 5000000 ]; do # of the cloud: what is read to start with is less
    read=$(sed -n 's/^rchar: //p' "/proc/$child/io" 2>/dev/null) || break
    sleep 0.01
  done
  kill -s INT "$child" || die "the run was over before it had read"
  status=0
  wait "$child" || status=$?
  begun_after=$(stages_begun)
  expect_prompt_end reading
}

test_terminate() {
  sphere 300000 >big.xyz
  interrupt_at delaunay TERM
  [ "$status" -eq 130 ] || [ "$status" -eq 143 ] || die "status $status after SIGTERM"
  expect_files big.xyz
}

test_interrupt_leaves_the_old_mesh() {
  sphere 300000 >big.xyz
  echo "the old mesh" >mesh.ply
  interrupt_at delaunay
  equal status "$status" 130
  equal "the mesh" "$(cat mesh.ply)" "the old mesh"
  expect_files big.xyz mesh.ply
}

# Whatever the limit, the run ends with a mesh or with status 4, never with a crash.
test_out_of_memory() {
  sphere 100000 >cloud.xyz
  local limit refused=0 done=0
  for limit in 60000 68000 76000 84000 92000 100000 130000 4000000; do
    (
      ulimit -v "$limit"
      run cloud.xyz -o mesh.ply --threads 2
      exit "$status"
    ) && status=0 || status=$?
    case $status in
      0)
        done=$((done + 1))
        expect_files cloud.xyz mesh.ply
        rm mesh.ply
        ;;
      4)
        refused=$((refused + 1))
        grep -qE '^eigencrust: error: .+ \(.+\); .+$' err || die "no message with $limit kB"
        expect_files cloud.xyz
        ;;
      *) die "status $status with $limit kB of memory" ;;
    esac
  done
  echo "refused $refused times, done $done times"
  [ "$refused" -ge 2 ] || die "memory was never short"
  [ "$done" -ge 1 ] || die "memory was always short"
}
