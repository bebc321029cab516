# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# eigencrust-speed: that it measures and writes, not how fast anything is. Here $program is eigencrust-speed.

# number FILE POINTER: what is there is a number above 0.
number() {
  local found
  found=$(value "$1" "$2") || die "$2 is not in $1"
  awk -v x="$found" 'BEGIN { exit !(x ~ /^[0-9.]+(e[-+]?[0-9]+)?$/ && x > 0) }' || die "$2 is $found, not a number above 0"
}

test_one_small_cloud() {
  expect 0 --clouds sphere --sizes 10000 --runs 1 --threads 1,2 --json speed.json --table speed.md
  [ ! -s out ] || die "something on stdout in spite of files"
  expect_files speed.json speed.md
  equal schema "$(value speed.json /schema)" 1
  equal runs "$(value speed.json /runs)" 1
  equal name "$(value speed.json /cases/0/name)" sphere-10000
  equal points "$(value speed.json /cases/0/points)" 10000
  local key
  for key in /machine/memory_bandwidth/0/bytes_per_second /machine/memory_bandwidth/1/bytes_per_second \
    /cases/0/cgal/seconds/0 /cases/0/cgal/median /cases/0/cgal/tetrahedra /cases/0/cgal/bytes_per_point; do
    number speed.json "$key"
  done
  for key in seconds/0 median ratio user_seconds/0 after_delaunay ratio_after_delaunay peak_memory_bytes \
    bytes_per_point steps/poles steps/tetrahedra stages/0/seconds/0 stages/0/ratio; do
    number speed.json "/cases/0/whole/0/$key"
    number speed.json "/cases/0/whole/1/$key"
  done
  equal threads "$(value speed.json /cases/0/whole/1/threads)" 2
  for key in cgal delaunay rest rest_to_cgal; do # of the first cloud, which is the measure
    equal "growth of $key" "$(value speed.json "/growth/0/$key")" 1.0
  done
  grep -qE '^\| sphere-10000 \| 10000 \| 2 \| [0-9.]+ \| [0-9.]+ \| [0-9.]+ \|' speed.md || die "no row of the cloud"
  grep -qE '^\| delaunay \| [0-9.]+ \| [0-9.]+ \|$' speed.md || die "no row of the Delaunay stage"
  ! grep -q '| nan' speed.md || die "a figure is not a number"
}

test_peak_memory_is_of_the_child() {
  # 4 bytes per point can be no peak of a program that holds the points, 1 GB is no peak for 2,000 of them.
  expect 0 --clouds sphere --sizes 2000 --runs 1 --threads 1 --json speed.json
  awk -v b="$(value speed.json /cases/0/whole/0/peak_memory_bytes)" 'BEGIN { exit !(b > 1e6 && b < 2e8) }' ||
    die "the command's peak is $(value speed.json /cases/0/whole/0/peak_memory_bytes)"
  awk -v b="$(value speed.json /cases/0/cgal/peak_memory_bytes)" 'BEGIN { exit !(b > 1e6 && b < 2e8) }' ||
    die "the peak of CGAL is $(value speed.json /cases/0/cgal/peak_memory_bytes)"
}

test_absent_data_is_skipped_visibly() {
  expect 0 --clouds bunny --data nowhere --table speed.md
  grep -q 'bunny skipped: there is no bunny/bunny_raw.ply' err || die "not said"
  grep -q '| bunny | skipped: there is no bunny/bunny_raw.ply |' speed.md || die "not in the table"
}

test_a_failing_command_is_told() {
  printf '#!/bin/sh\nexit 5\n' >broken
  chmod +x broken
  expect 6 --clouds sphere --sizes 1000 --runs 1 --program broken --table speed.md
  grep -q 'ended with status 5' err || die "the status is not told"
  grep -q '| sphere-1000 | error: ' speed.md || die "not in the table"
}

test_words_that_make_no_sense() {
  expect 2 --clouds teapot
  expect 2 --sizes 10
  expect 2 --threads 0
  expect 2 --runs 0
  expect 2 --program nowhere
}
