# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# --temp-dir and --resume: a run that was ended goes on with the tetrahedra that it had.

# ended_run: one that is killed once it has its tetrahedra; $kept is where it left them.
ended_run() {
  sphere 60000 >big.xyz
  local attempt child
  for attempt in 1 2 3 4 5; do
    "$program" big.xyz -o mesh.ply --temp-dir kept --progress jsonl >out 2>err &
    child=$!
    until_begun stars "$child" || true
    kill -s KILL "$child" 2>/dev/null || true
    wait "$child" 2>/dev/null || true
    if [ ! -e mesh.ply ]; then break; fi
    echo "attempt $attempt: the run was over before the signal came"
    rm -f mesh.ply
  done
  kept=$(echo kept/*)
  [ -s "$kept" ] || die "nothing was kept"
  "$program" big.xyz -o whole.ply -q
}

expect_resumed() {
  expect 0 big.xyz -o mesh.ply --temp-dir kept --resume --report report.json
  same whole.ply mesh.ply
  grep -q '"resumed": 1' report.json || die "the tetrahedra were made anew"
  [ -z "$(ls -A kept)" ] || die "something is kept although the result is there"
}

expect_made_anew() {
  expect 0 big.xyz -o mesh.ply --temp-dir kept --resume --report report.json
  same whole.ply mesh.ply
  ! grep -q '"resumed"' report.json || die "they were used"
}

test_resume_goes_on_with_the_tetrahedra() {
  ended_run
  expect_resumed
}

test_resume_does_not_trust_damaged_tetrahedra() {
  ended_run
  cp "$kept" good
  local size
  size=$(stat -c %s good)
  for place in 30 90 $((size / 2)) $((size - 1)); do
    cp good "$kept"
    printf 'x' | dd of="$kept" bs=1 seek="$place" conv=notrunc status=none
    cmp -s good "$kept" && continue
    expect_made_anew
    grep -q 'is damaged or of another version' err || die "no warning of byte $place"
  done
  for size in 0 50 100000; do
    head -c "$size" good >"$kept"
    expect_made_anew
    grep -q 'is damaged or of another version' err || die "no warning of $size bytes"
  done
  cp good "$kept"
  expect_resumed
}

test_resume_keeps_clouds_apart() {
  ended_run
  sphere 3000 >small.xyz
  expect 0 small.xyz -o small.ply --temp-dir kept --resume
  [ -s "$kept" ] || die "another cloud's tetrahedra are gone"
  expect_resumed
}

test_resume_that_finds_nothing_makes_all() {
  sphere 3000 >big.xyz
  expect 0 big.xyz -o whole.ply
  expect_made_anew
}

test_temp_dir_that_cannot_be_used() {
  sphere 3000 >cloud.xyz
  expect_error 2 "add --temp-dir" cloud.xyz -o mesh.ply --resume
  expect_error 2 "the folder cannot be created" cloud.xyz -o mesh.ply --temp-dir cloud.xyz
  expect_files cloud.xyz
}

test_temp_dir_that_is_full() {
  [ "$(id -u)" -eq 0 ] && mkdir kept && mount -t tmpfs -o size=64k tmpfs kept 2>err || skip "only root mounts a small disk"
  sphere 3000 >cloud.xyz
  run cloud.xyz -o mesh.ply --temp-dir kept
  local left
  left=$(ls -A kept)
  umount kept
  equal status "$status" 0
  equal "what is left on the full disk" "$left" ""
  grep -q 'the tetrahedra could not be kept: .*No space left' err || die "no warning"
}
