# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# What a run gives: the same bytes for any number of threads, attributes, scans, the report.

test_threads_do_not_matter() {
  sphere 20000 >cloud.xyz
  local threads
  expect 0 cloud.xyz -o one.ply --threads 1
  for threads in 0 2 3 7; do
    expect 0 cloud.xyz -o many.ply --threads "$threads"
    same one.ply many.ply
  done
}

test_threads_do_not_matter_on_a_noisy_scan() {
  local scan=$repository/examples/teapot_scan.ply
  expect 0 "$scan" -o one.ply --threads 1
  expect 0 "$scan" -o two.ply --threads 2
  same one.ply two.ply
}

test_order_of_rows_does_not_matter() {
  # With an inner sphere there is something to decide.
  { sphere 3000; sphere 1000 0.4; } >cloud.xyz
  shuffled <cloud.xyz >other.xyz
  if cmp -s cloud.xyz other.xyz; then die "the rows were not shuffled"; fi
  expect 0 cloud.xyz -o cloud.obj
  expect 0 other.xyz -o other.obj
  triangles cloud.obj >a
  triangles other.obj >b
  [ "$(wc -l <a)" -gt 5000 ] || die "hardly any triangles"
  same a b
}

# Every vertex carries the values of its row, under their names and types.
test_attributes_survive() {
  {
    printf 'ply\nformat ascii 1.0\nelement vertex 500\nproperty float x\nproperty float y\nproperty float z\n'
    printf 'property uchar red\nproperty ushort label\nproperty double time\nproperty int row\nend_header\n'
    sphere 500 | awk '{ printf "%s %d %d %.17g %d\n", $0, NR % 256, 60000 + NR, NR / 7 + 1e6, NR - 1 }'
  } >cloud.ply
  expect 0 cloud.ply -o mesh.ply
  local wanted
  for wanted in "uchar red" "ushort label" "double time" "int row" "uint source_index"; do
    sed '/end_header/q' mesh.ply | grep -aqx "property $wanted" || die "no property $wanted"
  done
  "$probe" rows mesh.ply >rows
  equal columns "$(head -1 rows)" "x y z red label time row source_index"
  equal rows "$(tail -n +2 rows | wc -l)" 500
  # red, label and time follow from row; row and source_index agree.
  tail -n +2 rows | awk '{
      n = $7 + 1
      if ($4 != n % 256 || $5 != 60000 + n || $8 != $7) { print "row", n, "differs:", $0; exit 1 }
      d = $6 - n / 7 - 1e6
      if (d > 1e-9 || d < -1e-9) { print "time of row", n, "differs:", $0; exit 1 }
    }' || die "attributes do not belong to their vertices"
  # The vertex is the point of that row.
  tail -n +2 rows | sort -n -k 8 | cut -d ' ' -f 1-3 >found
  sphere 500 | paste -d ' ' - found | awk '{
      for (i = 1; i <= 3; ++i) if ($i - $(i + 3) > 1e-7 || $(i + 3) - $i > 1e-7) { print "row", NR, $0; exit 1 }
    }' || die "a vertex is not its point"
}

test_columns_of_a_text_file() {
  sphere 500 | awk '{ print NR - 1, $3, $2, $1, 7 }' >cloud.txt
  expect 0 cloud.txt -o mesh.ply --columns row,z,y,x,-
  "$probe" rows mesh.ply >rows
  equal columns "$(head -1 rows)" "x y z row source_index"
  tail -n +2 rows | awk '$4 != $5 { exit 1 }' || die "row is not the row"
}

# source_index counts over all files, scan_index tells the file.
test_several_inputs() {
  { printf 'x y z row\n'; sphere 500 | awk '{ print $0, NR - 1 }'; } >a.txt
  { printf 'x y z row\n'; sphere 300 1 5 | awk '{ print $0, 499 + NR }'; } >b.txt
  expect 0 a.txt b.txt -o mesh.ply --report report.json --components all --grid-spacing off
  equal points "$(value report.json /input/points)" 800
  equal "points of b" "$(value report.json /input/files/1/points)" 300
  "$probe" rows mesh.ply >rows
  equal columns "$(head -1 rows)" "x y z row source_index scan_index"
  tail -n +2 rows | awk '$4 != $5 { exit 1 }' || die "source_index does not count over all files"
  tail -n +2 rows | awk '$6 != ($5 >= 500) { exit 1 }' || die "scan_index is not the number of the file"
  equal "vertices of a" "$(tail -n +2 rows | awk '$5 < 500' | wc -l)" 500
  equal "vertices of b" "$(tail -n +2 rows | awk '$5 >= 500' | wc -l)" 300
  expect 0 check mesh.ply --json
  equal components "$(value out /components)" 2
  expect 0 info a.txt b.txt --json
  equal scans "$(value out /scans)" 2
}

test_attribute_of_one_file_only() {
  { printf 'x y z heat\n'; sphere 300 | awk '{ print $0, 5 }'; } >a.txt
  sphere 300 1 5 >b.txt
  expect 0 a.txt b.txt -o mesh.ply --components all
  "$probe" rows mesh.ply >rows
  equal columns "$(head -1 rows)" "x y z heat source_index scan_index"
  tail -n +2 rows | awk '($5 < 300) != ($4 == 5) { exit 1 }' || die "heat is in the wrong rows"
}

test_report_holds_what_is_promised() {
  sphere 1000 >cloud.xyz
  expect 0 reconstruct cloud.xyz -o mesh.ply --report report.json --smooth 2
  local key
  for key in /schema /version /command/0 /input/files/0/path /input/files/0/sha256 /input/files/0/points \
    /input/files/0/sensor /input/points /input/duplicates /input/nonfinite /input/spacing /input/bounds/min/2 \
    /options/preset /options/grid_spacing /options/second_stage /options/eigensolver /options/questionable \
    /options/manifold /options/components /options/smooth /options/smoothing /options/threads \
    /stages/0/name /stages/0/seconds /stages/0/peak_memory_bytes \
    /partitions/0/stage /partitions/0/nodes /partitions/0/edges /partitions/0/eigenvalue /partitions/0/residual \
    /partitions/0/iterations /partitions/0/sign_changes /partitions/0/status \
    /mesh/vertices /mesh/triangles /mesh/boundary_edges /mesh/nonmanifold_edges /mesh/nonmanifold_vertices \
    /mesh/inconsistent_edges /mesh/degenerate_triangles /mesh/self_intersections /mesh/components /mesh/genus \
    /mesh/euler /mesh/volume /mesh/area /mesh/component_list/0/triangles \
    /grid_spacing /dropped_components /undecided_nodes /seconds /peak_memory_bytes /peak_disk_bytes /warnings; do
    value report.json "$key" >/dev/null || die "the report lacks $key"
  done
  equal schema "$(value report.json /schema)" 1
  equal smooth "$(value report.json /options/smooth)" 2
  equal sha256 "$(value report.json /input/files/0/sha256)" "$(sha256sum cloud.xyz | cut -d ' ' -f 1)"
  equal command "$(value report.json /command/1)" reconstruct
  equal version "eigencrust $(value report.json /version)" "$("$program" --version)"
}

# The samples of a sphere, 0.08 apart, with normal noise of 0.04.
noisy_sphere() {
  sphere 2000 | awk 'BEGIN { srand(3) }
    function normal() { return sqrt(-2 * log(1 - rand())) * cos(6.283185307 * rand()) }
    { printf "%.9g %.9g %.9g\n", $1 + 0.04 * normal(), $2 + 0.04 * normal(), $3 + 0.04 * normal() }'
}

# error OBJ: mean distance of its vertices from the unit sphere.
error_of() {
  awk '$1 == "v" { d = sqrt($2 * $2 + $3 * $3 + $4 * $4) - 1; sum += d < 0 ? -d : d; ++n } END { print sum / n }' "$1"
}

test_noise_moves_vertices_and_that_is_told() {
  noisy_sphere >cloud.xyz
  expect 0 cloud.xyz -o fitted.obj --report report.json
  grep -qE 'vertices moved from their samples: median 0\.0[0-9]+, 99 % below 0\.[0-9]+' out || die "not told: $(cat out)"
  equal surface "$(value report.json /options/surface)" auto
  local vertices
  vertices=$(value report.json /mesh/vertices)
  equal "the vertices moved" "$(value report.json /moved/vertices)" "$vertices"
  equal crossings "$(value report.json /mesh/self_intersections)" 0
  expect 0 cloud.xyz -o samples.obj --report report.json --surface samples
  grep -q 'moved' out && die "told without reason"
  equal moved "$(value report.json /moved)" null
  equal vertices "$(value report.json /mesh/vertices)" "$vertices"
  awk -v fitted="$(error_of fitted.obj)" -v samples="$(error_of samples.obj)" 'BEGIN { exit !(fitted < 0.3 * samples) }' ||
    die "the error is $(error_of fitted.obj) and was $(error_of samples.obj)"
}

test_without_noise_vertices_are_the_samples() {
  sphere 2000 >cloud.xyz
  expect 0 cloud.xyz -o auto.ply --report report.json
  equal moved "$(value report.json /moved)" null
  expect 0 cloud.xyz -o samples.ply --surface samples
  same auto.ply samples.ply
  expect 0 cloud.xyz -o fitted.ply --surface fitted
  same fitted.ply samples.ply
  noisy_sphere >cloud.xyz
  expect 0 cloud.xyz -o fitted.ply --surface fitted --noise off
  grep -q 'vertices moved' out || die "fitted moves nothing"
}

test_holes_in_the_data_are_told_of() {
  sphere 4000 >all.xyz
  expect 0 all.xyz -o mesh.ply --report report.json
  ! grep -q bridged out || die "nothing is missing: $(cat out)"
  equal places "$(value report.json /bridged/places)" 0
  awk '$3 < 0.8 { printf "%.6f %s %s\n", $1 + 4000000, $2, $3 }' all.xyz >open.xyz
  expect 0 open.xyz -o mesh.ply --report report.json
  grep -qE '^  1 place without samples bridged, 1\.[0-9]+ wide, at (4000000|3999999\.9|4000000\.0)' out || die "not told: $(cat out)"
  equal places "$(value report.json /bridged/places)" 1
  expect 0 open.xyz -o mesh.ply --trim
  ! grep -q bridged out || die "told of what was left out"
}

test_report_agrees_with_check() {
  { sphere 2000; sphere 500 0.3 5; } >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --report report.json --components all
  expect 0 check mesh.ply --json
  local key
  for key in vertices triangles components genus euler boundary_edges self_intersections; do
    equal "$key" "$(value out "/$key")" "$(value report.json "/mesh/$key")"
  done
}

test_components() {
  { sphere 2000; sphere 500 0.3 5; } >cloud.xyz
  expect 0 cloud.xyz -o all.ply --components all --report report.json
  equal all "$(value report.json /mesh/components)" 2
  expect 0 cloud.xyz -o one.ply --components largest --report report.json
  equal largest "$(value report.json /mesh/components)" 1
  expect 0 cloud.xyz -o one.ply --components 1 --report report.json
  equal 1 "$(value report.json /mesh/components)" 1
  equal vertices "$(value report.json /mesh/vertices)" 2000
  equal dropped "$(value report.json /dropped_components/0/vertices)" 500
}

test_presets() {
  sphere 1000 >cloud.xyz
  local preset
  for preset in robust paper; do
    expect 0 cloud.xyz -o "$preset.ply" --preset "$preset" --report "$preset.json"
    equal preset "$(value "$preset.json" /options/preset)" "$preset"
    expect 0 check "$preset.ply"
  done
  equal "second stage" "$(value paper.json /options/second_stage)" eigenvector
  equal "second stage" "$(value robust.json /options/second_stage)" cut
  # A preset is a start; options go before it.
  expect 0 cloud.xyz -o mesh.ply --preset paper --second-stage harmonic --report report.json
  equal "second stage" "$(value report.json /options/second_stage)" harmonic
}

test_report_names_the_sensors_of_each_file() {
  sphere 400 >a.xyz
  awk '{ print $1 + 5, $2, $3 }' a.xyz >b.xyz
  echo '1,5,0,9' >poses.csv
  expect 0 a.xyz b.xyz -o mesh.ply --report report.json --sensors poses.csv
  equal "sensor of the first" "$(value report.json /input/files/0/sensor)" null
  equal "points of the second" "$(value report.json /input/files/1/sensor/points)" 400
  equal "place of the second" "$(value report.json /input/files/1/sensor/places/0/position/2)" 9.0
}

test_facade_stays_open() {
  awk 'BEGIN { for (i = 0; i < 1600; ++i) { x = i % 40; y = int(i / 40); print x, y, 2 * sin(x / 5) * cos(y / 6) } }' \
    >wall.xyz
  expect 0 wall.xyz -o wall.ply --facade +z
  expect 6 check wall.ply --json
  equal manifold "$(value out /nonmanifold_edges)$(value out /nonmanifold_vertices)" 00
  [ "$(value out /boundary_edges)" -gt 0 ] || die "no boundary"
}

test_trim_keeps_what_was_seen() {
  awk 'BEGIN { for (i = 0; i < 1600; ++i) { x = i % 40; y = int(i / 40); print x, 2 * sin(x / 5) * cos(y / 6), y } }' \
    >wall.xyz
  expect 0 wall.xyz -o closed.ply --sensor 20,60,20 --report report.json
  grep -q 'was bridged without data' err || die "no warning"
  grep -q 'one-sided scan' out || die "does not say that it is one-sided"
  equal facade "$(value report.json /options/facade)" auto
  expect 0 wall.xyz -o open.ply --sensor 20,60,20 --trim --report report.json
  if grep -q 'was bridged without data' err; then die "warned in vain"; fi
  [ "$(value report.json /mesh/boundary_loops)" -gt 0 ] || die "no boundary"
  [ "$(value report.json /mesh/vertices)" -gt 1500 ] || die "too much is gone"
  expect 0 wall.xyz -o off.ply --sensor 20,60,20 --facade off --report report.json
  equal "one-sided" "$(value report.json /one_sided)" null
}

test_ground_has_rims_and_no_volume() {
  awk 'BEGIN { for (i = 0; i < 1600; ++i) { x = i % 40; y = int(i / 40); print x, y, 2 * sin(x / 5) * cos(y / 6) } }' \
    >ground.xyz
  expect 0 ground.xyz -o open.ply --report report.json
  grep -q 'closed: no (.* 1 rim)' out || die "the rim is not told"
  grep -q '% of it covered by samples' out || die "the share covered is not told"
  grep -q 'one side: seen from +z' out || die "the side is not told"
  if grep -Eq 'volume|inward' out err; then die "an open mesh has no volume and looks nowhere"; fi
  equal scene "$(value report.json /scene)" facade
  equal facade "$(value report.json /facade)" +z
  equal volume "$(value report.json /mesh/volume)" null
  expect 6 check open.ply
  if grep -Eq 'volume|inward' out; then die "an open mesh has no volume and looks nowhere"; fi
  # Who saw it from above changes nothing.
  expect 0 ground.xyz -o seen.ply --sensor 20,20,60 --report report.json
  equal scene "$(value report.json /scene)" facade
  equal rims "$(value report.json /mesh/boundary_loops)" 1
  if grep -q 'bridged without data' err; then die "warned in vain"; fi
  expect 0 ground.xyz -o closed.ply --facade off --report report.json
  equal scene "$(value report.json /scene)" body
}

test_base_closes_ground() {
  awk 'BEGIN { for (i = 0; i < 6400; ++i) { x = (i % 80) / 4 - 10; y = int(i / 80) / 4 - 10; r = sqrt(x * x + y * y);
    print x, y, r < 4 ? 2.6 * (1 - r / 4) : 0 } }' >pile.xyz
  expect 0 pile.xyz -o pile.ply --base --report report.json
  grep -q 'above the plane of the rim' out || die "the volume of the pile is not told"
  expect 0 check pile.ply --json
  value report.json /base/volume_above_rim | awk '{ exit !($1 > 42.7 && $1 < 44.5) }' || die "the pile has 43.56"
  expect_error 2 "leave out one" pile.xyz -o trimmed.ply --base --trim
  awk '{ printf "%.7f %.7f %.7f\n", $1 * 4e-6 + 1e7, $2 * 4e-6 + 1e7, $3 * 4e-6 }' pile.xyz >far.xyz
  expect_error 3 "nearer to zero with --shift" far.xyz -o far.ply --base --facade +z
  sphere 1000 >ball.xyz
  expect_error 2 "--facade +z" ball.xyz -o ball.ply --base
}

test_rooms_are_their_free_space() {
  # A cube from within.
  awk 'BEGIN { print "x y z sx sy sz"; n = 20
    for (i = 0; i <= n; ++i) for (j = 0; j <= n; ++j) for (k = 0; k <= n; ++k)
      if (i % n == 0 || j % n == 0 || k % n == 0) print i / 5, j / 5, k / 5, 1.9, 2.2, 1.6 }' >room.txt
  expect 0 room.txt -o room.ply --report report.json
  grep -q 'interior: free space of 64, walls of 96' out || die "the free space is not told"
  if grep -Eq 'volume|inward' out; then die "a room has free space, and looks to the scanners"; fi
  equal scene "$(value report.json /scene)" interior
  expect 0 check room.ply
  expect 0 room.txt -o body.ply --sensors none --report report.json
  equal scene "$(value report.json /scene)" body
}

# One turn of a scanner on the road between houses: nothing but the user knows where it stood.
test_what_is_hardly_a_body_names_options_that_work() {
  awk '
    BEGIN { turn = atan2(0, -1) / 180
      for (beam = -9; beam <= 31; beam += 2) for (k = 0; k < 360; ++k) {
        x = cos(beam * turn) * cos(k * turn); y = cos(beam * turn) * sin(k * turn); z = sin(beam * turn)
        far = 20 / (x * x > 1e-6 ? sqrt(x * x) : 1e-3); if (33 / sqrt(y * y + 1e-6) < far) far = 33 / sqrt(y * y + 1e-6)
        if (z < 0 && -2 / z < far) far = -2 / z
        print far * x, far * y, far * z } }' >street.xyz
  expect 0 street.xyz -o body.ply
  grep -q 'ground with what stands on it, --facade +z.* --sensor 0,0,0' err || die "the options are not named"
  expect 0 street.xyz -o ground.ply --facade +z
  grep -q '1 component, genus 0' out || die "the street is not in one piece"
  grep -q 'one side: seen from +z, solid behind' out || die "the option does not work"
  expect 0 street.xyz -o free.ply --sensor 0,0,0
  grep -q 'interior: free space of' out || die "the sensor does not tell the free space"
  sphere 1000 >ball.xyz
  expect 0 ball.xyz -o ball.ply
  [ ! -s err ] || die "a ball is a body: $(cat err)"
}

test_named_points_come_from_files() {
  { sphere 3000; sphere 1000 0.5; } >cloud.xyz
  echo '0 0 0' >middle.xyz
  echo '0.75 0 0' >shell.xyz
  expect 0 cloud.xyz -o mesh.ply --outside-points middle.xyz --inside-points shell.xyz --report report.json
  equal outside "$(value report.json /options/outside_points/0/2)" 0.0
  equal inside "$(value report.json /options/inside_points/0/0)" 0.75
  equal components "$(value report.json /mesh/components)" 2
  expect_error 3 "missing.xyz" cloud.xyz -o mesh.ply --inside-points missing.xyz
}

test_verb_may_be_left_out() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz -o a.ply
  expect 0 reconstruct cloud.xyz -o b.ply
  same a.ply b.ply
}

test_far_coordinates() {
  # A survey grid: metres, millions of them from the origin. Float would melt the points into one another.
  sphere 1000 | awk '{ printf "%.6f %.6f %.6f\n", 4500000 + $1 / 50, 5600000 + $2 / 50, 300 + $3 / 50 }' >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --report report.json
  equal vertices "$(value report.json /mesh/vertices)" 1000
  sed '/end_header/q' mesh.ply | grep -aqx "property double x" || die "the coordinates are not double"
  expect 0 check mesh.ply
}
