# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Files as people have them: what is read, what is told, and that typing what a message says works.

# typed: the words behind --columns in the last message.
typed() { grep -oE -- '--columns [^ ;:)]+' err | head -1 | cut -d ' ' -f 2; }

# table SEPARATOR: rows "number x y z word" of a sphere at far coordinates.
table() {
  sphere 400 10 | awk -v s="$1" '{ printf "%d%s%.3f%s%.3f%s%.3f%sTREE TOP\n", 1000 + NR, s, $1 + 512000, s, $2 + 5412000, s, $3 + 340, s }'
}

test_words_are_left_out_with_one_warning_per_column() {
  { echo 'Name,X,Y,Z,Code'; table ,; } >survey.csv
  expect 0 survey.csv -o mesh.ply --report report.json
  equal warnings "$(cat err)" "eigencrust: warning: survey.csv: column 'Code' left out: 'TREE TOP' (line 2) is no number"
  equal reported "$(value report.json /warnings/0)" "survey.csv: column 'Code' left out: 'TREE TOP' (line 2) is no number"
  expect 0 info survey.csv --json
  equal warned "$(value out /files/0/warnings/0)" "column 'Code' left out: 'TREE TOP' (line 2) is no number"
  equal column "$(value out /attributes/0/name)" "Name"
}

test_messages_name_the_columns_to_type() {
  local name
  table ';' | cut -d ';' -f 1-4 >numbered.txt                         # the first column counts
  { echo 'a;b;c;d'; table ';' | cut -d ';' -f 1-4; } >named.txt        # names that say nothing
  table ';' | awk -F ';' '{ print "P" $1, $2, $3, $4 }' >words.txt      # words first
  awk 'BEGIN { for (i = 0; i < 30; ++i) for (k = 0; k < 20; ++k) printf "%d %d %.4f %.4f %.4f 1 2 3\n", i, k, cos(i) + 5, sin(k), sin(i + k) }' >grid.xyz
  for name in numbered.txt words.txt grid.xyz; do
    expect_error 3 "--columns" "$name" -o mesh.ply
    expect 0 info "$name" --columns "$(typed)" --json
  done
  expect 0 info numbered.txt --columns x,y,z # who insists is told
  grep -qF "column 1, x by --columns, counts" out err || die "the numbers of the points are not told"
  expect_error 3 "--columns a,x,y,z" named.txt -o mesh.ply
  expect 0 info named.txt --columns "$(typed)" --json
  equal z "$(value out /bounds/max/2 | cut -c 1-3)" 349
  expect_error 3 "rows and columns of a grid" info grid.xyz
  expect 0 info grid.xyz --columns "$(typed)"
  grep -q "grid of 20 columns and 30 rows" out || die "the grid is not told"
  expect_files grid.xyz named.txt numbered.txt words.txt
}

test_no_data_is_left_out_with_a_count() {
  { sphere 500; printf '0 0.1 -9999\n0 0.2 -9999\n'; } >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --report report.json
  grep -qF "warning: cloud.xyz: 2 points without data left out: z = -9999" err || die "no count"
  equal points "$(value report.json /input/points)" 500
}

test_units_and_scales() {
  sphere 300 1000 >mm.xyz
  sphere 300 1 >m.xyz
  expect 0 info mm.xyz m.xyz
  grep -qF "mm.xyz is 1000 times as large as m.xyz: if one is in millimetres and one in metres, type --unit mm --unit m" out || die "not told"
  expect 0 info --unit mm --unit m mm.xyz m.xyz --json
  equal warnings "$(value out /warnings)" "[]"
  equal size "$(value out /bounds/max/2 | cut -c 1-5)" 0.996
  expect 0 info --scale 0.001 mm.xyz --json
  equal size "$(value out /bounds/max/2 | cut -c 1-5)" 0.996
  expect 0 mm.xyz -o mesh.ply --unit mm
  grep -aq '^comment metres, from inputs in mm$' mesh.ply || die "the unit is not written"
  expect_error 2 "the units are um, mm" info --unit parsec m.xyz
  expect_error 2 "a unit is a scale" info --unit mm --scale 2 m.xyz
  expect_error 2 "no scale" info --scale -1 m.xyz
  expect_error 2 "2 units or scales for 1 inputs" info --unit mm --unit m m.xyz
}

test_shift_is_kept() {
  sphere 500 | awk '{ printf "%.6f %.6f %.6f\n", $1 + 512000, $2 + 5412000, $3 + 300 }' >far.xyz
  expect 0 far.xyz -o mesh.ply --shift -512000,-5412000,-300
  grep -aq '^comment shift -512000 -5412000 -300$' mesh.ply || die "no comment"
  grep -aq '^property float x$' mesh.ply || die "the coordinates still need 64 bits"
  expect 0 check mesh.ply --json
  expect 0 far.xyz -o mesh.stl --shift -512000,-5412000,-300
  equal offset "$(tail -1 mesh.stl.offset.txt)" "512000 5412000 300"
  expect 0 far.xyz -o mesh.stl # STL's own offset
  equal offset "$(tail -1 mesh.stl.offset.txt | cut -d ' ' -f 3 | cut -c 1-3)" 300
  expect_error 2 "three numbers x,y,z" far.xyz -o mesh.ply --shift 1,2
  cp far.xyz far.stl.offset.txt
  expect_error 2 "the output would overwrite an input" far.stl.offset.txt -o far.stl --shift 1,2,3
  rm far.stl.offset.txt
  rm mesh.ply mesh.stl mesh.stl.offset.txt
  expect_files far.xyz
}

test_units_of_several_jobs() {
  sphere 300 >m.xyz
  awk '{ print 1000 * $1, 1000 * $2, 1000 * $3 }' m.xyz >mm.xyz
  expect 0 --each m.xyz mm.xyz -o 'mesh_{}.ply' --unit m --unit mm
  expect 0 compare mesh_m.ply mesh_mm.ply
  expect_error 2 "3 units or scales for 2 inputs" --each m.xyz mm.xyz -o 'mesh_{}.ply' --unit m --unit m --unit mm
}

test_info_draws_what_it_found() {
  sphere 3000 | awk '{ print $1, $2, $3, int(127 + 12 * $1), 20, 200 }' >ball.xyz
  expect 0 info ball.xyz --render ball.png
  equal signature "$(head -c 4 ball.png | tail -c 3)" PNG
  equal width "$(od -An -tu1 -j18 -N2 ball.png | awk '{ print 256 * $1 + $2 }')" 1600
  expect_error 2 "end the name in .png" info ball.xyz --render ball.jpg
  expect_error 2 "standard output is for the figures" info ball.xyz --render -
  expect_error 2 "the output would overwrite an input" info ball.xyz --render ball.xyz
}

test_bounds_tell_minimum_from_maximum() {
  sphere 300 | awk '{ printf "%.6f %.6f %.6f\n", $1 + 512000, $2 + 5412000, $3 + 300 }' >far.xyz
  sphere 300 >near.xyz
  expect 0 info far.xyz near.xyz
  grep -qE 'bounds \(5119[0-9.]+, 54119[0-9.]+, 299[0-9.]*\) to \(51200[0-9.]+, 541200[0-9.]+, 300' out || die "too few digits"
  equal lines "$(grep -c bounds out)" 3 # of each file, and of all
  grep -q "^warning: far.xyz does not overlap any other input" out || die "the gap is not told"
}

test_degrees_and_32_bits_are_told() {
  sphere 900 | awk '{ printf "%.9f %.9f %.3f\n", 8.4 + $1 / 72000, 49 + $2 / 111000, 345 + $3 }' >lonlat.xyz
  expect 0 info lonlat.xyz
  grep -q "warning: x and y look like degrees" out || die "degrees are not told"
  sphere 4000 11 | awk '{ printf "%.3f %.1f %.3f\n", $1, int(2 * ($2 + 5480200)) / 2, $3 }' >steps.xyz
  expect 0 info steps.xyz
  grep -qE "warning: y takes only 4[0-9] values, steps of 0.5: exported in 32 bits" out || die "steps are not told"
}

test_grids_of_heights() {
  { printf 'ncols 30\nnrows 30\nxllcorner 432100\nyllcorner 5480200\ncellsize 1\nNODATA_value -9999\n'
    awk 'BEGIN { for (i = 0; i < 30; ++i) { for (k = 0; k < 30; ++k) printf "%.2f ", i == 3 ? -9999 : 345 + sin(i / 4) * cos(k / 5); print "" } }'; } >heights.asc
  expect 0 info heights.asc
  grep -q "870 points" out && grep -q "30 cells without data left out" out || die "cells"
  tail -n +7 heights.asc | grep -v 9999 >matrix.txt
  expect_error 3 "a matrix of 30 x 29 heights is no list of points" info matrix.txt
  # Typing the lines that the message names.
  { printf 'ncols 30\nnrows 29\nxllcorner 0\nyllcorner 0\ncellsize 1\n'; cat matrix.txt; } >again.asc
  expect 0 info again.asc
  grep -q "870 points" out || die "the lines of the message do not help"
}

# Mistakes with files: each is answered with one line that names the remedy.
#   text to expect | arguments
mistakes() {
  cat <<'END'
check the name and the permissions|missing.ply -o mesh.ply
name a file|folder -o mesh.ply
use a file with a row of numbers|empty.xyz -o mesh.ply
this is a gzip archive|packed.xyz.gz -o mesh.ply
save the table as CSV|book.xlsx -o mesh.ply
git lfs pull|pointer.ply -o mesh.ply
download the file itself|page.las -o mesh.ply
this is a picture (PNG)|depth.png -o mesh.ply
convert the file to ply|unknown.bin -o mesh.ply
--columns -,x,y,z|words.csv -o mesh.ply
--columns x,y,z|names.csv -o mesh.ply
project the points to metres|degrees.csv -o mesh.ply
no column is named 'z'|good.xyz -o mesh.ply --columns x,y
more than one column is named 'x'|good.xyz -o mesh.ply --columns x,x,y,z
cut off|short.ply -o mesh.ply
good.xyz:3|broken.good.xyz -o mesh.ply
give exactly one number for each point|good.xyz -o mesh.ply --scan-index short.idx
write rows scan,x,y,z|good.xyz -o mesh.ply --sensors words.csv
the units are|good.xyz -o mesh.ply --unit miles
use a ply, obj, off, stl, glb or 3mf file|check good.xyz
end it in .ply|good.xyz -o mesh.docx
END
}

test_mistakes_with_files_are_answered_with_a_remedy() {
  mkdir folder
  : >empty.xyz
  printf '\037\213\010\000' >packed.xyz.gz
  printf 'PK\003\004aaaaaaaaaaaaaaaaaaaaaaaaaa[Content_Types].xml' >book.xlsx
  echo 'version https://git-lfs.github.com/spec/v1' >pointer.ply
  echo '<!DOCTYPE html><html></html>' >page.las
  printf '\211PNG\r\n' >depth.png
  head -c 500 /dev/zero >unknown.bin
  printf 'P1,1,2,3\nP2,4,5,6\nP3,7,8,9\n' >words.csv
  printf 'u,v,w\n1,2,3\n4,5,6\n' >names.csv
  printf 'lon,lat,h\n8.4,49,345\n8.5,49,346\n' >degrees.csv
  sphere 100 >good.xyz
  printf 'ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n' >short.ply
  { head -2 good.xyz; echo '1 2 x'; tail -5 good.xyz; } >broken.good.xyz
  echo 0 >short.idx
  local text arguments
  while IFS='|' read -r text arguments; do
    run $arguments
    [ "$status" -eq 2 ] || [ "$status" -eq 3 ] || die "status $status: eigencrust $arguments"
    [ "$(wc -l <err)" -eq 1 ] || die "not one line: eigencrust $arguments"
    grep -qF -- "$text" err || die "the message does not say '$text': eigencrust $arguments"
    [ ! -e mesh.ply ] || die "a mesh: eigencrust $arguments"
  done < <(mistakes)
}
