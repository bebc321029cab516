# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Faults of the machine, of files and of users that were found once.

set -m # background jobs get SIGINT only with job control

message_of_one_line() {
  [ "$(wc -l <err)" -eq 1 ] || die "not one line on stderr"
  grep -qE '^eigencrust: error: .+ \(.+\); .+$' err || die "not in the form WHAT (PLACE); REMEDY"
}

# What terminals obey must not come out of a file, in no line.
test_names_are_cleaned() {
  local escape
  escape=$(printf '\033[31mred')
  printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty float %s\nend_header\n0 0 0 1\n' \
    "$escape" >cloud.ply
  expect 0 info cloud.ply
  grep -qF '\u001b[31mred:float32' out || die "the name is not shown"
  expect 0 info cloud.ply --json
  value out /attributes/0/name | grep -qF '[31mred' || die "the name is lost"
  local name
  name=$(printf 'a\033]0;title\007b\nc\302\233d.xyz')
  sphere 300 >"$name"
  expect 0 info "$name"
  expect 0 "$name" -o "$name.ply" --report report.json
  cat out err report.json >all
  expect 3 "$name.missing" -o mesh.ply
  message_of_one_line
  cat err >>all
  ! LC_ALL=C grep -q "$(printf '[\001-\010\013-\037\177]')" all || die "a control character was printed"
  ! LC_ALL=C grep -q "$(printf '\302[\200-\237]')" out || die "a control character of two bytes was printed"
  value report.json /input/files/0/path >/dev/null || die "the report is no JSON"
}

test_loops_of_links_and_long_names() {
  sphere 300 >cloud.xyz
  ln -s b.ply a.ply
  ln -s a.ply b.ply
  local long
  long=$(printf 'n%.0s' {1..300}).ply
  for name in a.ply "$long"; do
    expect_error 2 "" cloud.xyz -o "$name"
    expect_error 2 "" cloud.xyz -o mesh.ply --report "$name"
    expect_error 3 "" "$name" -o mesh.ply
    expect_error 3 "" info "$name"
    expect_error 3 "" check "$name"
    expect_error 2 "" cloud.xyz -o "$name/mesh.ply"
    expect_error 2 "" cloud.xyz -o mesh.ply --dump-stages "$name/x"
  done
  expect_files a.ply b.ply cloud.xyz
}

test_stdout_that_is_closed() {
  sphere 300 >cloud.xyz
  status=0
  "$program" cloud.xyz -o mesh.ply 2>err >&- || status=$?
  equal "status with a mesh and a closed stdout" "$status" 0
  grep -qF 'output files are complete' err || die "not told"
  expect 0 check mesh.ply
  status=0
  "$program" check mesh.ply 2>err >&- || status=$?
  equal "status of results that nobody gets" "$status" 3
  # Closed streams do not lend their numbers to files.
  "$program" cloud.xyz -o other.ply <&- >&- 2>&- || die "closed streams"
  same mesh.ply other.ply
}

test_a_pipe_is_read_once() {
  sphere 3000 >cloud.xyz
  mkfifo pipe.xyz
  cat cloud.xyz >pipe.xyz &
  timeout 60 "$program" pipe.xyz -o mesh.ply --report report.json >out 2>err || die "status $? of a pipe"
  equal sha256 "$(value report.json /input/files/0/sha256)" "$(sha256sum <cloud.xyz | cut -d ' ' -f 1)"
  expect 0 cloud.xyz -o plain.ply
  same mesh.ply plain.ply
  rm pipe.xyz
  mkfifo pipe.ply
  cat mesh.ply >pipe.ply &
  timeout 60 "$program" render pipe.ply -o a.png >out 2>err || die "status $? of a mesh from a pipe"
  sphere 300 | "$program" /dev/stdin -o stdin.ply >out 2>err || die "status $? of stdin"
}

test_the_build_is_not_in_the_program() {
  ! grep -qF "$repository" "$program" || die "$repository is in the program"
}

# quadratic N: N points of the moment curve; each is a neighbour of each other.
quadratic() { awk -v n="$1" 'BEGIN { for (i = 0; i < n; ++i) { t = i / n; printf "%.17g %.17g %.17g\n", t, t * t, t * t * t } }'; }

test_memory_is_watched_while_the_tetrahedra_grow() {
  quadratic 3000 >cloud.xyz
  local threads
  for threads in 1 2; do
    expect_error 4 "many more than usual" cloud.xyz -o mesh.ply --max-memory 60M --threads "$threads" --report r.json
  done
  expect_files cloud.xyz
  quadratic 300 >cloud.xyz
  run cloud.xyz -o mesh.ply --components all --report r.json
  [ "$status" -eq 5 ] || value r.json /warnings | grep -q 'tetrahedra per sample' || die "no warning"
}

# Pulled through itself by smoothing, a small body would come out inside out.
test_smoothing_turns_nothing_over() {
  printf '%s\n' "0 0 0" "2 0 0" "1 2 0" "1 0.7 1" "1 0.7 -1" >cloud.xyz
  local steps
  for steps in 1 2 3 8 50; do
    expect 0 cloud.xyz -o mesh.ply --smooth "$steps" --components all --noise off
    expect 0 check mesh.ply --json
    awk -v v="$(value out /volume)" 'BEGIN { exit !(v > 0) }' || die "volume $(value out /volume) after $steps steps"
  done
  grep -q 'turned inside out' err || expect 0 cloud.xyz -o mesh.ply --smooth 50
}

# wait_for TEXT: until it is in `err`.
wait_for() {
  until grep -q -- "$1" err; do
    kill -0 "$child" 2>/dev/null || return 1
    sleep 0.01
  done
}

test_every_signal_at_every_stage() {
  sphere 30000 >big.xyz
  "$program" big.xyz -o mesh.ply --progress jsonl >out 2>err
  sed -n 's/.*"stage":"\([a-z_]*\)","event":"begin".*/\1/p' err | sort -u >stages
  rm mesh.ply
  local signal stage child tried=0 over=0 k=0
  while read -r stage; do
    # Each stage with two of the signals in turn: all of them at all stages is scripts/faults.sh.
    for signal in $(printf '%s\n' INT TERM HUP QUIT XCPU PIPE INT TERM HUP QUIT XCPU PIPE | tail -n +$((k % 6 + 1)) | head -2); do
      : >err # of the run before
      "$program" big.xyz -o mesh.ply --report report.json --progress jsonl >out 2>err &
      child=$!
      wait_for "\"stage\":\"$stage\",\"event\":\"begin\"" || true
      kill -s "$signal" "$child" 2>/dev/null || true
      status=0
      wait -f "$child" || status=$?
      tried=$((tried + 1))
      case $status in
        0) over=$((over + 1)) && expect_files big.xyz stages mesh.ply report.json && rm mesh.ply report.json ;;
        130) expect_files big.xyz stages ;;
        *) die "status $status after SIG$signal in $stage" ;;
      esac
    done
    k=$((k + 2))
  done <stages
  echo "$tried signals, $over of them after the end"
  [ $((2 * over)) -lt "$tried" ] || die "most signals came too late"
}

test_signals_while_waiting_for_a_pipe() {
  mkfifo pipe.xyz
  local signal child
  for signal in INT HUP; do
    "$program" pipe.xyz -o mesh.ply >out 2>err &
    child=$!
    sleep 0.3 # it is to wait in open()
    kill -s "$signal" "$child"
    status=0
    wait -f "$child" || status=$?
    equal "status after SIG$signal" "$status" 130
    message_of_one_line
  done
  sleep 100 >pipe.xyz &
  local writer=$!
  "$program" pipe.xyz -o mesh.ply >out 2>err &
  child=$!
  sleep 0.3 # now in read()
  kill -s TERM "$child"
  status=0
  wait -f "$child" || status=$?
  kill "$writer"
  equal "status after SIGTERM in read()" "$status" 130
  expect_files pipe.xyz
}

test_nohup_stays() {
  sphere 3000 >cloud.xyz
  (
    trap '' HUP
    : >ready
    exec "$program" cloud.xyz -o mesh.ply >out 2>err
  ) &
  local child=$!
  until [ -e ready ]; do sleep 0.01; done
  kill -s HUP "$child" 2>/dev/null || true
  wait -f "$child" || die "SIGHUP ended what nohup protects"
}

test_files_larger_than_the_limit() {
  sphere 3000 >cloud.xyz
  (
    ulimit -f 8
    run cloud.xyz -o mesh.ply
    [ "$status" -eq 3 ] || exit 1
  ) || die "no status 3 where the file is too large"
  grep -qF 'mesh.ply' err || die "the message does not name the file"
  expect_files cloud.xyz
}

# Killed while writing, a run leaves its temporary; the next one in that folder takes it away, but not one in use.
test_stale_temporaries_go() {
  sphere 300 >cloud.xyz
  : >.mesh.ply.1.2.3.eigencrust-tmp
  : >.other.eigencrust-tmp
  : >.mesh.ply.tmp
  flock -x .other.eigencrust-tmp sleep 100 &
  local holder=$!
  until ! flock -n .other.eigencrust-tmp true; do sleep 0.01; done
  expect 0 cloud.xyz -o mesh.ply
  expect_files .mesh.ply.tmp .other.eigencrust-tmp cloud.xyz mesh.ply
  kill -- -"$holder" 2>/dev/null || kill "$holder"
  wait "$holder" || true
  expect 0 cloud.xyz -o mesh.ply
  expect_files .mesh.ply.tmp cloud.xyz mesh.ply
}

test_mode_of_a_replaced_file() {
  sphere 300 >cloud.xyz
  echo old >mesh.ply
  chmod 6751 mesh.ply
  expect 0 cloud.xyz -o mesh.ply
  equal mode "$(stat -c %a mesh.ply)" 751
  [ "$(id -u)" -eq 0 ] || return 0
  chown 12345:23456 mesh.ply
  expect 0 cloud.xyz -o mesh.ply
  equal owner "$(stat -c %u:%g mesh.ply)" 12345:23456
}

# Neither file appears when one of them cannot be written.
test_mesh_and_report_appear_together() {
  [ -w /dev/full ] || skip "no /dev/full"
  sphere 300 >cloud.xyz
  ln -s /dev/full report.json
  expect_error 3 report.json cloud.xyz -o mesh.ply --report report.json
  expect_files cloud.xyz report.json
}
