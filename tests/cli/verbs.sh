# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# info, check, compare, render, demo.

test_check_accepts_a_closed_mesh() {
  tetrahedron >a.off
  expect 0 check a.off
  grep -q 'closed: yes, manifold: yes, oriented: yes' out || die "not accepted"
  expect 0 check a.off --json
  equal vertices "$(value out /vertices)" 4
  equal triangles "$(value out /triangles)" 4
  equal euler "$(value out /euler)" 2
  awk -v v="$(value out /volume)" 'BEGIN { exit !(v > 0.16666 && v < 0.16667) }' || die "the volume is not 1/6"
}

test_check_refuses_an_open_mesh() {
  open_tetrahedron >a.off
  expect 6 check a.off
  grep -q 'closed: no (3 boundary edges, 1 rim)' out || die "boundary edges not told"
  [ ! -s err ] || die "a finding is no error message"
  expect 6 check a.off --json
  equal "boundary edges" "$(value out /boundary_edges)" 3
}

test_check_refuses_wrong_orientation() {
  tetrahedron | sed 's/^3 0 2 1$/3 0 1 2/' >a.off
  expect 6 check a.off --json
  equal "inconsistent edges" "$(value out /inconsistent_edges)" 3
}

test_check_refuses_a_bow_tie() {
  # Two tetrahedra that share one vertex: closed, but the vertex has two fans.
  printf 'OFF\n7 8 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 0 0\n0 -1 0\n0 0 -1\n' >a.off
  printf '3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n3 0 4 5\n3 0 6 4\n3 4 6 5\n3 0 5 6\n' >>a.off
  expect 6 check a.off --json
  equal "boundary edges" "$(value out /boundary_edges)" 0
  equal "vertices with two fans" "$(value out /nonmanifold_vertices)" 1
}

test_check_finds_self_intersections() {
  # Two tetrahedra, the second shifted into the first. That is reported, not refused.
  printf 'OFF\n8 8 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0.2 0.2 0.2\n1.2 0.2 0.2\n0.2 1.2 0.2\n0.2 0.2 1.2\n' >a.off
  printf '3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n3 4 6 5\n3 4 5 7\n3 5 6 7\n3 4 7 6\n' >>a.off
  expect 0 check a.off --json
  [ "$(value out /self_intersections)" -gt 0 ] || die "none found"
  expect 0 check a.off --json --no-self-intersections
  equal "not counted" "$(value out /self_intersections)" null
}

test_info() {
  { sphere 300; printf '0 0 1e3\n0 0 1e3\nnan 0 0\n'; } >cloud.xyz
  expect 0 info cloud.xyz
  grep -q '303 points' out || die "no count"
  expect 0 info cloud.xyz --json
  equal points "$(value out /points)" 303
  equal distinct "$(value out /distinct)" 301
  equal duplicates "$(value out /duplicates)" 1
  equal nonfinite "$(value out /nonfinite)" 1
  equal "largest z" "$(value out /bounds/max/2)" 1000.0
  [ ! -s err ] || die "something on stderr"
}

test_info_of_too_few_points() {
  # No surface can be made of them, but what is in the file can be told.
  printf '0 0 0\n1 0 0\n0 2 0\n0 2 0\nnan 0 0\n' >few.xyz
  expect 0 info few.xyz
  [ ! -s err ] || die "something on stderr"
  grep -qF 'few.xyz: 5 points' out || die "no count"
  grep -qF 'no surface can be made of it: only 3 distinct finite points' out || die "does not say why"
  expect 0 info few.xyz --json
  equal distinct "$(value out /distinct)" 3
  equal duplicates "$(value out /duplicates)" 1
  equal nonfinite "$(value out /nonfinite)" 1
  equal "largest y" "$(value out /bounds/max/1)" 2.0
  equal spacing "$(value out /spacing)" null
  printf 'nan 0 0\n' >none.xyz
  expect 0 info none.xyz
  grep -qF 'no surface can be made of it: no finite point' out || die "does not say why"
  expect 0 info none.xyz --json
  equal bounds "$(value out /bounds)" null
  sphere 300 >cloud.xyz
  expect 0 info cloud.xyz --json
  equal unusable "$(value out /unusable)" null
}

test_info_forecasts() {
  sphere 300 >a.xyz
  sphere 3000 2 >b.xyz
  expect 0 info a.xyz b.xyz
  grep -qE 'a.xyz: 300 points, forecast [0-9.]+ MB, about [0-9.]+ s$' out || die "no forecast of the first"
  grep -qE 'forecast of reconstruct: [0-9.]+ MB, about [0-9.]+ s \(.* per point\)' out || die "no forecast of all"
  expect 0 info a.xyz b.xyz --json
  local a b all
  a=$(value out /files/0/forecast/memory_bytes) b=$(value out /files/1/forecast/memory_bytes)
  all=$(value out /forecast/memory_bytes)
  if [ "$a" -ge "$b" ] || [ "$b" -ge "$all" ]; then die "forecasts $a, $b and $all"; fi
}

test_info_tells_of_sensors() {
  { printf 'FIELDS x y z\nVIEWPOINT 4320978.25 2 3 1 0 0 0\nPOINTS 300\nDATA ascii\n'; sphere 300; } >a.pcd
  { printf '300\n1\n0 0 9\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 9 1\n'; sphere 300; } >b.ptx
  sphere 300 >c.xyz
  expect 0 info a.pcd b.ptx c.xyz
  grep -qF 'VIEWPOINT (4320978.25, 2, 3) read as the sensor' out || die "does not say how VIEWPOINT was read"
  grep -qF 'sensors: 2 at (4320978.25, 2, 3), (0, 0, 9); 300 points without' out || die "no sensors"
  expect 0 info a.pcd b.ptx c.xyz --json
  equal sensors "$(value out /sensor_count)" 2
  equal "place of the second" "$(value out /sensors/1/position/2)" 9.0
  equal "points of the second" "$(value out /sensors/1/points)" 300
  equal "points without" "$(value out /points_without_sensor)" 300
  expect 0 info a.pcd --pcd-viewpoint pose --json
  awk -v x="$(value out /bounds/min/0)" 'BEGIN { exit !(x > 4320976 && x < 4320978) }' || die "the points were not moved"
  expect 0 info a.pcd --pcd-viewpoint none
  grep -qF 'sensors: none known' out || die "sensors in spite of none"
  expect_error 2 "--pcd-viewpoint" info a.pcd --pcd-viewpoint maybe
}

test_info_tells_of_sensors_by_options() {
  sphere 300 >a.xyz
  sphere 300 2 >b.xyz
  expect 0 info a.xyz --sensor 1,2,3.25
  grep -qF 'sensors: 1 at (1, 2, 3.25)' out || die "no position"
  expect 0 info a.xyz b.xyz --sensor-direction 0,3,4 --sensor-direction=-1,0,0
  grep -qF 'sensors: 2 at infinity along (0, 0.6, 0.8), infinity along (-1, 0, 0)' out || die "no directions"
  # By scans: the files in order, or the scan index.
  printf 'scan,x,y,z\n1,7,8,9\n' >poses.csv
  expect 0 info a.xyz b.xyz --sensors poses.csv
  grep -qF 'sensors: 1 at (7, 8, 9); 300 points without' out || die "no poses"
  awk 'BEGIN { for (i = 0; i < 300; ++i) print (i < 100 ? 0 : 1) }' >scans.txt
  printf 'dx dy dz\n0 0 2\n0 0 -2\n' >directions.csv
  expect 0 info a.xyz --scan-index scans.txt --sensors directions.csv --json
  equal sensors "$(value out /sensor_count)" 2
  equal "points of the second" "$(value out /sensors/1/points)" 200
  equal "direction of the second" "$(value out /sensors/1/direction/2)" -1.0
  # What the file holds is replaced, or left out.
  { printf '# x y z sx sy sz\n'; sphere 300 | sed 's/$/ 1 2 3/'; } >c.xyz
  expect 0 info c.xyz
  grep -qF "sx sy sz read as the sensor's position" out || die "does not say that the columns were read"
  grep -qF 'sensors: 1 at (1, 2, 3)' out || die "no columns"
  expect 0 info c.xyz --sensor 4,5,6
  grep -qF 'sensors: 1 at (4, 5, 6)' out || die "not replaced"
  expect 0 info c.xyz --sensors none
  grep -qF 'sensors: none known' out || die "sensors in spite of none"
  expect 0 c.xyz -o mesh.ply --sensors none
  expect 0 orient c.xyz -o cloud.ply
  expect 0 info cloud.ply
  grep -qF 'sensors: 1 at (1, 2, 3)' out || die "the columns were not written"
}

test_compare_with_itself() {
  sphere 1000 >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply
  expect 0 compare mesh.ply mesh.ply --json --samples 5000
  local key
  for key in /hausdorff /to_reference/max /from_reference/max; do
    awk -v d="$(value out $key)" 'BEGIN { exit !(d < 1e-6) }' || die "$key is not zero"
  done
  for key in /f_score /normal_consistency /volume_iou; do
    awk -v d="$(value out $key)" 'BEGIN { exit !(d > 0.999 && d <= 1.000001) }' || die "$key is not one"
  done
}

test_compare_of_two_spheres() {
  sphere 3000 >a.xyz
  sphere 3000 1.1 >b.xyz
  expect 0 a.xyz -o a.ply
  expect 0 b.xyz -o b.ply
  expect 0 compare a.ply b.ply --json --samples 5000
  # Concentric spheres of radii 1 and 1.1: 0.1 apart everywhere, volumes as 1 to 1.331.
  awk -v d="$(value out /to_reference/mean)" 'BEGIN { exit !(d > 0.095 && d < 0.105) }' || die "not 0.1 apart"
  awk -v d="$(value out /volume_iou)" 'BEGIN { exit !(d > 0.745 && d < 0.758) }' || die "volume IoU is not 1/1.331"
}

# big_endian FILE OFFSET: four bytes as a number.
big_endian() {
  od -A n -t u1 -j "$2" -N 4 "$1" | awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4 }'
}

test_render() {
  tetrahedron >a.off
  sphere 300 >cloud.xyz
  local input
  for input in a.off cloud.xyz; do
    expect 0 render "$input" -o picture.png --width 161 --height 97
    equal signature "$(od -A n -t x1 -N 8 picture.png | tr -d ' ')" 89504e470d0a1a0a
    equal width "$(big_endian picture.png 16)" 161
    equal height "$(big_endian picture.png 20)" 97
    [ "$(wc -c <picture.png)" -gt 400 ] || die "the picture is empty"
    rm picture.png
  done
  if [ -s out ] || [ -s err ]; then die "render says something"; fi
}

test_render_shares_one_frame() {
  # The second object is ten times smaller: in the picture, too, unless it has a frame of its own.
  tetrahedron >a.off
  tetrahedron | sed -E '3,6s/1/0.1/g' >b.off
  expect 0 render a.off b.off -o both.png --width 100 --height 80
  equal width "$(big_endian both.png 16)" 200
  expect 0 render a.off b.off -o own.png --width 100 --height 80 --own-frame
  expect 0 render a.off a.off -o same.png --width 100 --height 80
  same own.png same.png
  ! cmp -s both.png own.png || die "the frame is not shared"
}

test_render_frames_the_bulk() {
  # One stray point a thousand radii away must not make the ball a dot.
  sphere 2000 >ball.xyz
  { cat ball.xyz; echo '1000 0 0'; } >stray.xyz
  expect 0 render ball.xyz -o ball.png --width 100 --height 100
  expect 0 render stray.xyz -o bulk.png --width 100 --height 100
  expect 0 render stray.xyz -o all.png --width 100 --height 100 --frame all
  local ball bulk all
  ball=$(wc -c <ball.png) bulk=$(wc -c <bulk.png) all=$(wc -c <all.png)
  [ $((10 * bulk)) -gt $((9 * ball)) ] || die "the ball is small: $bulk bytes instead of $ball"
  [ $((3 * all)) -lt "$ball" ] || die "everything was framed, but the ball is large"
}

test_render_views() {
  printf 'v 0 0 0\nv 3 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' >a.obj
  expect 0 render a.obj -o four.png --view front,right --view top --view corner --width 80 --height 60
  equal width "$(big_endian four.png 16)" 160
  equal height "$(big_endian four.png 20)" 120
  expect 0 render a.obj -o three.png --view front,right,top --width 80 --height 60
  equal width "$(big_endian three.png 16)" 240
  expect 0 render a.obj a.obj -o rows.png --view front,back --width 80 --height 60
  equal width "$(big_endian rows.png 16)" 160
  equal height "$(big_endian rows.png 20)" 120
  expect 0 render a.obj -o front.png --view front --width 80 --height 60
  expect 0 render a.obj -o angles.png --azimuth 0 --elevation 0 --width 80 --height 60
  same front.png angles.png
  expect_error 2 "is no view" render a.obj -o picture.png --view above
}

test_render_refuses_sizes() {
  tetrahedron >a.off
  local options
  for options in "--width 0" "--height 0" "--width -5" "--zoom 0" "--up q"; do
    # shellcheck disable=SC2086
    expect_error 2 "" render a.off -o picture.png $options
  done
  expect_files a.off
}

test_demo_works_from_any_folder() {
  mkdir "somewhere else"
  cd "somewhere else"
  expect 0 demo -o demo
  [ ! -s err ] || die "something on stderr"
  expect_files demo demo/teapot.ply demo/teapot.json demo/teapot.png
  expect 0 check demo/teapot.ply
  value demo/teapot.json /mesh/genus >/dev/null || die "no report"
}

test_demo_refuses_a_file_as_folder() {
  echo "in the way" >demo
  expect_error 3 "demo" demo -o demo
  equal "the file" "$(cat demo)" "in the way"
}
