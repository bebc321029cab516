# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# --crop and --thin: what is left out before the work, and that the rows keep their numbers.

test_crop_to_a_box() {
  { printf 'x y z row\n'; { sphere 500; sphere 500 1 5; } | awk '{ print $0, NR - 1 }'; } >cloud.txt
  sphere 500 1 5 >wanted.txt
  expect 0 wanted.txt -o wanted.obj
  local shape
  for shape in 3,-2,-2,7,2,2 7,2,2,3,-2,-2 3,-2,7,2 '3,-2;7,-2;7,2;3,2'; do
    expect 0 cloud.txt -o mesh.obj --crop "$shape"
    grep -q '500 of 1,000 points kept by --crop' out || die "not said for $shape"
    diff <(grep '^[vf]' mesh.obj) <(grep '^[vf]' wanted.obj) >/dev/null || die "another mesh for $shape"
  done
  printf '# corners\n3 -2\n7 -2\n7,2\n3 2\n3 -2\n' >polygon.txt
  expect 0 cloud.txt -o mesh.ply --crop polygon.txt --report report.json
  equal points "$(value report.json /input/points)" 500
  equal "points of the file" "$(value report.json /input/files/0/points)" 1000
  "$probe" rows mesh.ply >rows
  equal columns "$(head -1 rows)" "x y z row source_index"
  tail -n +2 rows | awk '$4 != $5 || $4 < 500 { print; exit 1 }' || die "source_index does not count the file's rows"
  expect 0 info cloud.txt --crop polygon.txt --json
  awk -v x="$(value out /bounds/min/0)" 'BEGIN { exit !(x > 3.9) }' || die "info does not crop"
}

test_crop_to_a_polygon_that_is_not_convex() {
  # The letter L: the corner that it leaves out is empty.
  awk 'BEGIN { for (i = 0; i < 20; ++i) for (j = 0; j < 20; ++j) print i + 0.5, j + 0.5, (i * j) % 3 }' >grid.xyz
  expect 0 info grid.xyz --crop '0,0;20,0;20,10;10,10;10,20;0,20' --json
  equal points "$(value out /points)" 300
}

test_crop_refuses() {
  sphere 300 >cloud.xyz
  printf '0 0\n1 0\n' >two.txt
  printf '0 0\n1 0 3\n0 1\n' >three.txt
  local shape
  for shape in 1,2,3 1,2,3,4,5 '0,0;1,1' '0,0;1,1;x,2' missing.txt two.txt three.txt 1,2,3,nan; do
    expect_error 2 "" cloud.xyz -o mesh.ply --crop "$shape"
  done
  grep -q . err
  expect_error 2 "three.txt:2" cloud.xyz -o mesh.ply --crop three.txt
  for shape in 0 -1 off auto x 1e-300; do expect_error 2 "" cloud.xyz -o mesh.ply --thin "$shape"; done
  expect_files cloud.xyz two.txt three.txt
}

test_thin_keeps_one_point_per_cube() {
  sphere 20000 | shuffled | awk '{ print $1 + 1000, $2, $3 }' >cloud.xyz
  expect 0 outliers cloud.xyz -o thin.xyz --thin 0.1
  grep -v '^#' thin.xyz >rows
  # No two in one cube, and each cube that held a point holds one.
  awk '{ print int($1 * 10 + 100), int($2 * 10 + 100), int($3 * 10 + 100) }' rows | LC_ALL=C sort >cells
  awk '{ print int($1 * 10 + 100), int($2 * 10 + 100), int($3 * 10 + 100) }' cloud.xyz | LC_ALL=C sort -u >wanted
  same cells wanted
  # The same points for any order of the rows.
  shuffled <cloud.xyz | tac >other.xyz
  expect 0 outliers other.xyz -o again.xyz --thin 0.1
  grep -v '^#' again.xyz | LC_ALL=C sort >again
  LC_ALL=C sort rows >rows_sorted
  same again rows_sorted
  expect 0 cloud.xyz -o mesh.ply --thin 2% --report report.json
  grep -qE '[0-9,]+ of 20,000 points kept by --thin' out || die "not said"
  "$probe" rows mesh.ply | tail -n +2 >vertices
  # Vertices are points of the file, at their rows.
  awk 'NR == FNR { at[NR - 1] = $1 " " $2 " " $3; next }
    { split(at[$4], p, " "); for (i = 1; i <= 3; ++i) if (p[i] - $i > 1e-4 || $i - p[i] > 1e-4) exit 1 }' \
    cloud.xyz vertices || die "source_index does not count the file's rows"
}
