# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Status 4: memory refused or exhausted. No file appears.

test_limit_below_the_forecast() {
  sphere 3000 >cloud.xyz
  local verb
  for verb in reconstruct orient outliers; do
    expect_error 4 "the limit of 1.0 MB" "$verb" cloud.xyz -o out.ply --max-memory 1M --report report.json
  done
  expect_error 4 "3000 points" cloud.xyz -o out.ply --max-memory 1000000
  grep -qF 'raise --max-memory to ' err || die "no remedy"
  # Before the work: no stage begins but reading.
  expect 4 cloud.xyz -o out.ply --max-memory 1M --progress jsonl
  ! grep '"stage"' err | grep -qv '"stage":"reading"' || die "a stage began"
  expect_files cloud.xyz
}

test_limit_above_the_forecast() {
  sphere 3000 >cloud.xyz
  expect 0 cloud.xyz -o plain.ply
  expect 0 cloud.xyz -o mesh.ply --max-memory 1G --report report.json
  [ ! -s err ] || die "a warning"
  same mesh.ply plain.ply
  equal "limit in the report" "$(value report.json /options/max_memory)" 1000000000
}

test_limit_is_what_info_forecasts() {
  sphere 3000 >cloud.xyz
  expect 0 info cloud.xyz --json
  local forecast
  forecast=$(value out /forecast/memory_bytes)
  expect 0 cloud.xyz -o mesh.ply --max-memory "$forecast"
  rm mesh.ply
  expect_error 4 "exceeds" cloud.xyz -o mesh.ply --max-memory $((forecast - 1))
  expect_files cloud.xyz
}

# kind NAME: 20,000 rows or so of a kind of cloud.
kind() {
  awk -v kind="$1" 'function deviate() { return sqrt(-2 * log(1 - rand())) * cos(6.283185307179586 * rand()) }
    BEGIN {
      srand(5); golden = 3.141592653589793 * (3 - sqrt(5)); n = 20000
      if (kind == "columns") print "x y z a b c d e f g h"
      if (kind == "sensors") print "x y z sx sy sz"
      for (i = 0; i < n; ++i) {
        k = kind == "repeated" ? i % 12000 : i
        w = 1 - 2 * (k + 0.5) / n; r = sqrt(1 - w * w)
        x = r * cos(k * golden); y = r * sin(k * golden); z = w
        if (kind == "noisy") { x += 0.012 * deviate(); y += 0.012 * deviate(); z += 0.012 * deviate() }
        if (kind == "thick") { x += 0.05 * deviate(); y += 0.05 * deviate(); z += 0.05 * deviate() }
        if ((kind == "outliers" && i % 3 == 0) || kind == "volume") { x = 3 * rand() - 1.5; y = 3 * rand() - 1.5; z = 3 * rand() - 1.5 }
        if (kind == "terrain") { x = i % 160; y = int(i / 160); z = 5 * sin(x / 19) * cos(y / 13) }
        if (kind == "layers") { x *= 1 + 0.01 * (i % 4); y *= 1 + 0.01 * (i % 4) }
        printf "%.7g %.7g %.7g", x, y, z
        if (kind == "columns") printf " %d 2 3 4 5 6 7 8", i
        if (kind == "sensors") printf " %.7g %.7g %.7g", 3 * x, 3 * y, 3 * z
        printf "\n"
      }
    }'
}

# Within a quarter of the program's own peak, which is the same whatever else the machine does.
test_forecast_is_near_the_truth() {
  local name forecast peak
  for name in sphere noisy thick outliers volume terrain repeated layers columns sensors; do
    kind "$name" >cloud.txt
    expect 0 info cloud.txt --json
    forecast=$(value out /forecast/memory_bytes)
    expect 0 cloud.txt -o mesh.ply --report report.json
    peak=$(value report.json /peak_memory_bytes)
    echo "$name: forecast $forecast, peak $peak"
    awk -v f="$forecast" -v p="$peak" 'BEGIN { exit !(f > 0.75 * p && f < 1.25 * p) }' ||
      die "$name: a forecast of $forecast for $peak"
  done
}

# within KILOBYTES ARGUMENTS: as run, with that much address space; $status is 99 if not even --version runs in it.
within() {
  local limit=$1
  shift
  status=0
  (
    ulimit -v "$limit"
    "$program" --version >out 2>err || exit 99
    "$program" "$@" >out 2>err </dev/null
  ) || status=$?
}

# The address space grows step by step: wherever memory ends, it is told and nothing is left over.
test_memory_that_is_exhausted() {
  sphere 20000 | shuffled >cloud.xyz
  echo "the old mesh" >mesh.ply
  cp mesh.ply old
  local limit exhausted=0
  for limit in 16000 18000 20000 22000 25000 28000 31000 34000 37000; do
    within "$limit" cloud.xyz -o mesh.ply --threads 1 --report report.json
    case $status in
      99) continue ;;
      0) break ;;
      4) ;;
      *) die "status $status with $limit kB" ;;
    esac
    [ ! -s out ] || die "something on stdout with $limit kB"
    [ "$(wc -l <err)" -eq 1 ] || die "not one line on stderr with $limit kB"
    grep -qE '^eigencrust: error: .*memory.* \(.+\); .+$' err || die "memory is not told with $limit kB"
    same mesh.ply old
    expect_files cloud.xyz mesh.ply old
    exhausted=$((exhausted + 1))
  done
  [ "$exhausted" -ge 3 ] || skip "the limits do not fit this machine: only $exhausted runs had too little"
}

test_memory_that_is_exhausted_on_threads() {
  sphere 20000 | shuffled >cloud.xyz
  local limit
  for limit in 24000 34000 44000 54000; do
    within "$limit" cloud.xyz -o mesh.ply --threads 4
    case $status in 0 | 4 | 99) ;; *) die "status $status with $limit kB" ;; esac
    [ "$status" -ne 4 ] || expect_files cloud.xyz
    rm -f mesh.ply
  done
}

# peak REPORT: largest resident memory.
peak() { value "$1" /peak_memory_bytes; }

# The bytes are those of a run in memory, for any threads; the files have no names and go with the process.
test_the_disk_takes_what_exceeds_the_limit() {
  sphere 100000 | shuffled >cloud.xyz
  expect 0 cloud.xyz -o plain.ply --report plain.json
  local threads
  for threads in 1 3; do
    expect 0 cloud.xyz -o mesh.ply --report report.json --max-memory 60M --temp-dir disk --threads "$threads"
    [ ! -s err ] || grep -q 'lies in memory itself' err || die "a warning: $(cat err)"
    grep -qE ' MB and [0-9.]+ MB on disk$' out || die "no word of the disk"
    same plain.ply mesh.ply
    equal "limit in the report" "$(value report.json /options/max_memory)" 60000000
    awk -v peak="$(peak report.json)" -v plain="$(peak plain.json)" 'BEGIN { exit !(peak < 0.85 * plain) }' ||
      die "$(peak report.json) bytes in memory, $(peak plain.json) without a limit"
    [ "$(value report.json /peak_disk_bytes)" -gt 40000000 ] || die "hardly anything on the disk"
    [ -z "$(ls -A disk)" ] || die "left on the disk: $(ls -A disk)"
  done
  equal "on disk without a limit" "$(value plain.json /peak_disk_bytes)" 0
  expect 0 cloud.xyz -o small.ply --report report.json --max-memory 1G --temp-dir disk
  equal "on disk below the limit" "$(value report.json /peak_disk_bytes)" 0
  expect 0 outliers cloud.xyz -o plain_points.ply
  expect 0 outliers cloud.xyz -o points.ply --max-memory 60M --temp-dir disk
  same plain_points.ply points.ply
}

test_the_limit_is_too_low_for_any_disk() {
  sphere 100000 >cloud.xyz
  expect_error 4 "exceeds 10 MB too far" cloud.xyz -o mesh.ply --max-memory 10M --temp-dir disk
  grep -qF 'raise --max-memory to 15 MB' err || die "no remedy: $(cat err)"
  rmdir disk
  expect_files cloud.xyz
}

test_the_disk_is_full() {
  sphere 100000 >cloud.xyz
  (
    ulimit -f 512 # of 1024 bytes: no array fits
    run cloud.xyz -o mesh.ply --max-memory 60M --temp-dir disk
    [ "$status" -eq 4 ] || exit 1
  ) || die "no status 4 where the disk takes no array: $(cat err)"
  [ "$(wc -l <err)" -eq 1 ] || die "not one line: $(cat err)"
  grep -qF 'could not be put on the disk: File too large (--temp-dir); free some space' err || die "not told: $(cat err)"
  rmdir disk
  expect_files cloud.xyz
}

test_the_disk_is_too_small() {
  sphere 100000 >cloud.xyz
  unshare --user --map-root-user --mount true 2>/dev/null || skip "nothing may be mounted here"
  mkdir disk
  export program
  # shellcheck disable=SC2016
  unshare --user --map-root-user --mount bash -c 'mount -t tmpfs -o size=50m none disk &&
    { "$program" cloud.xyz -o mesh.ply --max-memory 60M --temp-dir disk 2>err || echo $? >status; }'
  equal status "$(cat status)" 4
  grep -qE 'exceeds the 5[0-9] MB free on its disk \(disk\); name another folder' err || die "not told: $(cat err)"
  # shellcheck disable=SC2016
  unshare --user --map-root-user --mount bash -c 'mount -t tmpfs -o size=500m none disk &&
    "$program" cloud.xyz -o mesh.ply --max-memory 60M --temp-dir disk 2>err >out'
  grep -qF 'disk lies in memory itself (tmpfs)' err || die "not told: $(cat err)"
}
