# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Statuses 3 and 5: inputs that cannot be read or used. No file appears.

test_missing_file() {
  local verb
  expect_error 3 missing.ply missing.ply -o mesh.ply
  for verb in info check; do expect_error 3 missing.ply "$verb" missing.ply; done
  tetrahedron >a.off
  expect_error 3 missing.ply compare a.off missing.ply
  expect_error 3 missing.ply compare missing.ply a.off
  expect_error 3 missing.ply render missing.ply -o picture.png
  expect_files a.off
}

test_folder_as_input() {
  mkdir cloud.xyz
  expect_error 3 cloud.xyz cloud.xyz -o mesh.ply
  expect_files cloud.xyz
}

test_empty_file() {
  local name
  for name in cloud.xyz cloud.ply cloud.csv cloud.pts cloud.off cloud.stl cloud.glb cloud.3mf; do
    : >"$name"
    expect_error 3 "$name" "$name" -o mesh.ply
    rm "$name"
  done
  expect_files
}

test_too_few_points() {
  printf '0 0 0\n1 0 0\n0 1 0\n0 0 1\n' >four.xyz
  expect_error 3 "" four.xyz -o mesh.ply
  # Five rows, but four distinct points.
  printf '0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 1\n' >five.xyz
  expect_error 3 "" five.xyz -o mesh.ply
  # Six rows, but four finite points.
  printf '0 0 0\n1 0 0\n0 1 0\n0 0 1\nnan 0 0\n0 inf 0\n' >six.xyz
  expect_error 3 "" six.xyz -o mesh.ply
  printf '1 2 3\n' >one.xyz
  expect_error 3 "" one.xyz -o mesh.ply
  expect_files four.xyz five.xyz six.xyz one.xyz
}

test_coplanar_and_collinear() {
  awk 'BEGIN { for (i = 0; i < 400; ++i) print i % 20, int(i / 20), 3 }' >plane.xyz
  expect_error 3 "coplanar" plane.xyz -o mesh.ply
  awk 'BEGIN { for (i = 0; i < 400; ++i) print i, 2 * i, 3 * i }' >line.xyz
  expect_error 3 "collinear" line.xyz -o mesh.ply
  awk 'BEGIN { for (i = 0; i < 400; ++i) print 1, 2, 3 }' >same.xyz
  expect_error 3 "" same.xyz -o mesh.ply
  expect_files plane.xyz line.xyz same.xyz
}

test_nan_rows_are_left_out() {
  { sphere 500; printf 'nan nan nan\n1 inf 0\n-inf 0 0\n'; } >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --report report.json
  equal nonfinite "$(value report.json /input/nonfinite)" 3
  equal vertices "$(value report.json /mesh/vertices)" 500
  expect 0 check mesh.ply
}

test_duplicates_are_merged() {
  { sphere 500; sphere 500; } >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --report report.json
  equal duplicates "$(value report.json /input/duplicates)" 500
  equal vertices "$(value report.json /mesh/vertices)" 500
}

test_binary_garbage() {
  # Bytes of all values. An STL of 100,000 of them would have to hold 1998.32 triangles.
  local name
  awk 'BEGIN { for (i = 0; i < 100000; ++i) printf "%c", (i * i * 7 + int(i / 11)) % 256 }' >garbage
  for name in cloud.xyz cloud.ply cloud.csv cloud.pts cloud.off cloud.obj cloud.stl cloud.glb cloud.3mf cloud.dat; do
    cp garbage "$name"
    expect_error 3 "$name" "$name" -o mesh.ply
    expect_error 3 "$name" info "$name"
    rm "$name"
  done
  for name in a.ply a.obj a.off a.stl a.glb a.3mf; do
    cp garbage "$name"
    expect_error 3 "$name" check "$name"
    rm "$name"
  done
  expect_files garbage
}

test_text_errors_name_the_line() {
  { sphere 50; printf '1 2 x\n'; sphere 50; } >cloud.xyz
  expect_error 3 "cloud.xyz:51" cloud.xyz -o mesh.ply
  expect_files cloud.xyz
}

test_truncated_ply() {
  sphere 200 >cloud.xyz
  expect 0 cloud.xyz -o whole.ply
  local size
  for size in 3 20 200 1000; do
    head -c "$size" whole.ply >part.ply
    expect_error 3 "part.ply" part.ply -o mesh.ply
    expect_error 3 "part.ply" check part.ply
  done
  expect_files cloud.xyz whole.ply part.ply
}

test_header_that_promises_too_much() {
  # 4 thousand million points in 12 bytes: the promise must not be believed.
  printf 'ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n' >a.ply
  printf 'property float z\nend_header\n123456789012' >>a.ply
  (
    ulimit -v 2000000
    expect_error 3 "a.ply" a.ply -o mesh.ply
  )
  expect_files a.ply
}

test_index_out_of_range() {
  printf 'OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n' >a.off
  expect_error 3 "a.off" check a.off
}

test_one_bad_input_among_several() {
  sphere 200 >a.xyz
  printf 'nothing\n' >b.xyz
  expect_error 3 "b.xyz" a.xyz b.xyz -o mesh.ply
  expect_files a.xyz b.xyz
}

test_scan_index_of_wrong_length() {
  sphere 100 >cloud.xyz
  printf '0\n1\n' >scans.txt
  expect_error 3 "scans.txt" cloud.xyz -o mesh.ply --scan-index scans.txt
  expect_files cloud.xyz scans.txt
}

test_sensors_that_do_not_fit() {
  sphere 100 >cloud.xyz
  printf '0,1,2,3\n1,1,2,3\n' >poses.csv
  expect_error 3 "poses.csv:2" cloud.xyz -o mesh.ply --sensors poses.csv
  expect_error 3 "missing.csv" cloud.xyz -o mesh.ply --sensors missing.csv
  expect_files cloud.xyz poses.csv
}

# Ground in degrees and metres is next to a line: what is found holds a few of its samples.
test_a_scrap_is_no_success() {
  awk 'BEGIN { for (i = 0; i < 55; ++i) for (j = 0; j < 55; ++j)
    printf "%.9f %.9f %.6f\n", 8.4 + 1.4e-3 * i, 49 + 9e-4 * j, 300 + 30 * sin(i / 9) * cos(j / 7) }' >ground.xyz
  expect_error 5 "of 3025 samples lie on the surface that was found" ground.xyz -q -o mesh.ply
  expect_error 5 "of 3025 samples lie on the surface that was found" ground.xyz -q -o mesh.ply --inside-point 8.44,49.02,300
  expect_files ground.xyz
}

test_no_surface() {
  # A tetrahedron around a fifth point: four tetrahedra, and a point known to be outside in each of them.
  printf '0 0 0\n1 0 0\n0 1 0\n0 0 1\n0.2 0.2 0.2\n' >cloud.xyz
  expect_error 5 "outside" cloud.xyz -o mesh.ply --outside-point 0.3,0.3,0.1 --outside-point 0.3,0.1,0.3 \
    --outside-point 0.1,0.3,0.3 --outside-point 0.3,0.3,0.25
  expect_files cloud.xyz
}
