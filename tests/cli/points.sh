# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# orient and outliers (once classify): the cloud goes out row by row, with more columns.

# ball: a sphere of 1500 points as a PLY with attributes, old normals among them, a point twice, three outliers, NaN.
ball() {
  {
    printf 'ply\nformat ascii 1.0\nelement vertex 1505\nproperty float x\nproperty float y\nproperty float z\n'
    printf 'property uchar red\nproperty double nx\nproperty float NY\nproperty int row\nend_header\n'
    {
      printf '5 0 0\n'
      sphere 1500
      printf '0 0 6\n0 -7 2\nnan 0 0\n'
      sphere 1500 | awk 'NR == 1'
    } | awk '{ printf "%s %d 0 0 %d\n", $0, NR % 256, NR - 1 }'
  } >ball.ply
}

test_orient_writes_every_row_in_order() {
  ball
  expect 0 orient ball.ply -o out.ply
  [ ! -s err ] || die "something on stderr"
  grep -q '^out.ply: 1,505 points in' out || die "no summary"
  grep -qx '  1,501 inliers, 3 outliers, 1 not finite' out || die "no counts"
  "$probe" rows out.ply >rows
  equal columns "$(head -1 rows)" "x y z red nx ny row nz"
  for wanted in "uchar red" "float nx" "float ny" "float nz" "int row"; do
    sed '/end_header/q' out.ply | grep -aqx "property $wanted" || die "no property $wanted"
  done
  tail -n +2 rows | awk '
    $7 != NR - 1 || $4 != NR % 256 { print "row", NR - 1, "is out of place:", $0; exit 1 }
    { lost = $5 ~ /nan/ && $6 ~ /nan/ && $8 ~ /nan/ }
    (NR == 1 || (NR >= 1502 && NR <= 1504)) != lost { print "row", NR - 1, "is wrong:", $0; exit 1 }
    !lost { d = $1 * $5 + $2 * $6 + $3 * $8; if (d < 0.99 || d > 1.00001) { print "looks", d, $0; exit 1 } }
  ' || die "rows or normals are wrong"
}

test_orient_drops_outliers() {
  ball
  expect 0 orient ball.ply -o out.ply --drop-outliers
  grep -q 'only the inliers are written' out || die "not said"
  "$probe" rows out.ply >rows
  equal rows "$(tail -n +2 rows | wc -l)" 1501
  tail -n +2 rows | awk '$7 != (NR <= 1500 ? NR : 1504) || $5 ~ /nan/ { print; exit 1 }' || die "the wrong rows"
}

test_outliers() {
  ball
  expect 0 outliers ball.ply -o out.ply --report report.json
  "$probe" rows out.ply >rows
  equal columns "$(head -1 rows)" "x y z red nx NY row inlier confidence"
  sed '/end_header/q' out.ply | grep -aqx "property uchar inlier" || die "inlier is no uchar"
  sed '/end_header/q' out.ply | grep -aqx "property float confidence" || die "confidence is no float"
  tail -n +2 rows | awk '
    $7 != NR - 1 { print "row", NR - 1, "is out of place"; exit 1 }
    $8 != !(NR == 1 || (NR >= 1502 && NR <= 1504)) { print "row", NR - 1, "is wrong:", $0; exit 1 }
    $8 != ($9 >= 0.5) || $9 < 0 || $9 > 1 { print "confidence:", $0; exit 1 }
  ' || die "flags or confidence are wrong"
  equal "inliers in the report" "$("$probe" json report.json /stages | grep -o '"inliers":[0-9]*')" '"inliers":1501'
  equal option "$(value report.json /options/point_results)" true
  # Once more: the columns are replaced, not doubled.
  expect 0 classify out.ply -o again.ply # the old name of the verb
  "$probe" rows again.ply >rows2
  same rows rows2
}

test_text_clouds_go_out_too() {
  { sphere 800; printf '9 9 9\n'; } >cloud.xyz
  local name
  for name in out.xyz out.csv out.txt out.asc; do
    expect 0 orient cloud.xyz -o "$name"
    grep -v '^[#x]' "$name" | tr ',' ' ' >lines
    equal "rows of $name" "$(wc -l <lines)" 801
    tail -1 lines | grep -q 'nan.*nan.*nan' || die "the outlier of $name has a normal"
    grep -v '^[#x]' "$name" | tr ',' ' ' | head -800 | cut -d ' ' -f 1-3 >found
    sphere 800 | paste -d ' ' - found | awk '$1 - $4 > 1e-9 || $2 - $5 > 1e-9 || $3 - $6 > 1e-9 { exit 1 }' ||
      die "the points of $name moved"
  done
}

test_several_scans_keep_their_numbers() {
  { printf 'x y z row\n'; sphere 900 | awk '{ print $0, NR - 1 }'; } >a.txt
  { printf 'x y z row\n'; sphere 900 1.2 5 | awk '{ print $0, 899 + NR }'; } >b.txt
  expect 0 outliers a.txt b.txt -o out.ply
  "$probe" rows out.ply >rows
  equal columns "$(head -1 rows)" "x y z row inlier confidence scan_index"
  tail -n +2 rows | awk '$4 != NR - 1 || $7 != (NR > 900) || $5 != 1 { print; exit 1 }' || die "rows are wrong"
}

test_options_of_reconstruct_hold() {
  { sphere 2000; sphere 500 0.3 5; } >cloud.xyz
  expect 0 outliers cloud.xyz -o out.csv --components largest --threads 2 --preset paper -q
  if [ -s out ] || [ -s err ]; then die "not quiet"; fi
  equal inliers "$(grep -v '^x' out.csv | awk -F , '$4 == 1' | wc -l)" 2000
  expect 0 outliers cloud.xyz -o out.csv --components all
  equal inliers "$(grep -v '^x' out.csv | awk -F , '$4 == 1' | wc -l)" 2500
}

test_points_and_threads() {
  sphere 20000 | awk 'NR % 9 == 0 { print $1 * 1.4, $2 * 1.3, $3 * 1.2; next } { print }' >cloud.xyz
  expect 0 orient cloud.xyz -o one.ply --threads 1
  expect 0 orient cloud.xyz -o two.ply --threads 2
  same one.ply two.ply
}

test_points_refuse_what_cannot_be_written() {
  sphere 300 >cloud.xyz
  local verb
  for verb in orient outliers; do
    expect_error 2 "out.stl" "$verb" cloud.xyz -o out.stl
    expect_error 2 "out.docx" "$verb" missing.xyz -o out.docx
    expect_error 2 "output" "$verb" cloud.xyz
    expect_error 2 "input" "$verb" cloud.xyz -o cloud.xyz
    expect_error 2 "nowhere" "$verb" cloud.xyz -o nowhere/out.ply
    expect_error 2 "" "$verb" cloud.xyz -o out.ply --preset none
    expect_error 2 "" "$verb" cloud.xyz -o out.ply --smooth 3
    expect_error 3 "missing.xyz" "$verb" missing.xyz -o out.ply
  done
  expect_error 2 "" outliers cloud.xyz -o out.ply --drop-outliers
  printf '0 0 0\n1 0 0\n0 1 0\n0 0 1\n0.2 0.2 0.2\n' >five.xyz
  expect_error 5 "outside" orient five.xyz -o out.ply --outside-point 0.3,0.3,0.1 --outside-point 0.3,0.1,0.3 \
    --outside-point 0.1,0.3,0.3 --outside-point 0.3,0.3,0.25
  expect_files cloud.xyz five.xyz
}

test_failed_write_of_points_leaves_the_old_file() {
  sphere 2000 >cloud.xyz
  local name
  for name in out.ply out.xyz; do
    echo "the old cloud" >"$name"
    (
      trap '' XFSZ
      ulimit -f 8
      run orient cloud.xyz -o "$name"
      [ "$status" -eq 3 ] || exit 1
    ) || die "status $status of a failed write of $name"
    equal "$name" "$(cat "$name")" "the old cloud"
    expect_files cloud.xyz "$name"
    rm "$name"
  done
}

test_every_format_of_clouds() {
  ball
  expect 0 orient ball.ply -o wanted.ply
  "$probe" rows wanted.ply >wanted
  local name
  # NaN rows have no place in LAS; the columns may stand in another order.
  expect 0 orient ball.ply -o out.pcd
  expect 0 info out.pcd --json
  equal points "$(value out /points)" 1505
  expect 0 orient ball.ply -o out.las
  grep -q 'LAS has no room for points that are not finite: 1 row left out' err || die "not told"
  expect 0 info out.las --json
  equal points "$(value out /points)" 1504
  grep -q '"name": "row"' out || die "no extra bytes"
  for name in out.pcd out.las out.obj; do
    [ "$name" != out.obj ] || expect 0 orient ball.ply -o out.obj
    # Through the program again, as text.
    expect 0 outliers "$name" -o "$name.csv"
    grep -v '^x' "$name.csv" | cut -d , -f 1-3 | tr , ' ' | grep -v nan >found
    tail -n +2 wanted | cut -d ' ' -f 1-3 | grep -v nan | paste -d ' ' - found |
      awk '$1 - $4 > 1e-4 || $4 - $1 > 1e-4 || $2 - $5 > 1e-4 || $5 - $2 > 1e-4 || $3 - $6 > 1e-4 || $6 - $3 > 1e-4 {
        print; exit 1 }' || die "the points of $name moved"
  done
  equal "normals of the OBJ" "$(grep -c '^vn ' out.obj)" 1505
}

test_keep_inliers_or_outliers() {
  ball
  local verb
  for verb in orient outliers; do
    expect 0 "$verb" ball.ply -o in.csv --keep inliers
    grep -q 'only the inliers are written' out || die "not said"
    equal inliers "$(tail -n +2 in.csv | wc -l)" 1501
    expect 0 "$verb" ball.ply -o not.csv --keep outliers
    equal outliers "$(tail -n +2 not.csv | cut -d , -f 1-3 | tr '\n' ' ')" "5,0,0 0,0,6 0,-7,2 "
    expect_error 2 "" "$verb" ball.ply -o out.ply --keep all
  done
  expect 0 outliers ball.ply -o in.obj --keep inliers
  equal vertices "$(grep -c '^v ' in.obj)" 1501
}
