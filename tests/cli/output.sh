# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# The output appears whole or not at all; formats; streams.

test_every_format_passes_check() {
  sphere 1000 >cloud.xyz
  local name
  for name in mesh.ply mesh.obj mesh.off mesh.stl mesh.glb mesh.3mf MESH.PLY; do
    expect 0 cloud.xyz -o "$name"
    expect 0 check "$name" --json
    equal "vertices of $name" "$(value out /vertices)" 1000
    equal "triangles of $name" "$(value out /triangles)" 1996
    equal "genus of $name" "$(value out /genus)" 0
  done
}

test_messages_and_results_have_their_streams() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply
  [ ! -s err ] || die "a good run says nothing on stderr"
  grep -q 'mesh.ply: 500 points' out || die "no summary on stdout"
  grep -q 'closed: yes, manifold: yes, oriented: yes' out || die "no guarantees on stdout"
}

test_quiet_prints_nothing() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --quiet
  if [ -s out ] || [ -s err ]; then die "not quiet"; fi
  expect_files cloud.xyz mesh.ply
  # STL far from the origin gives a warning otherwise.
  sphere 500 1 1e7 >far.xyz
  expect 0 far.xyz -o far.stl -q
  if [ -s out ] || [ -s err ]; then die "not quiet about warnings"; fi
  # Errors are still told.
  expect_error 3 missing.xyz missing.xyz -o mesh.ply --quiet
}

test_warnings_go_to_stderr() {
  sphere 500 1 1e7 >far.xyz
  expect 0 far.xyz -o far.stl --report report.json
  grep -qE '^eigencrust: warning: .' err || die "no warning"
  [ "$(value report.json /warnings)" != "[]" ] || die "no warning in the report"
  expect 0 check far.stl
}

test_progress_jsonl() {
  sphere 2000 >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --progress jsonl
  local lines
  lines=$("$probe" lines err) || die "stderr holds lines that are no JSON"
  [ "$lines" -ge 20 ] || die "only $lines lines of progress"
  equal "stages that begin" "$(grep -c '"event":"begin"' err)" "$(grep -c '"event":"end"' err)"
  local stage
  for stage in reading delaunay writing; do
    grep -q "\"stage\":\"$stage\",\"event\":\"begin\"" err || die "no stage $stage"
  done
  equal "the last line" "$(tail -1 err)" '{"event":"finished","status":0}'
  sed -n 's/.*"overall":\([0-9.]*\)}/\1/p' err |
    awk '$1 < last || $1 > 1 { exit 1 } { last = $1 } END { exit last < 0.999 }' || die "the whole does not grow from 0 to 1"
}

# Nothing else is on that stream: warnings and errors are lines of JSON, too.
test_progress_jsonl_tells_everything() {
  sphere 500 1 1e7 >far.xyz
  expect 0 far.xyz -o far.stl --progress jsonl
  "$probe" lines err >/dev/null || die "a warning is no JSON"
  grep -q '^{"event":"warning","text":".' err || die "no warning"
  expect 3 missing.xyz -o mesh.ply --progress=jsonl
  "$probe" lines err >/dev/null || die "an error is no JSON"
  grep -q '^{"event":"error","text":".*missing.xyz' err || die "no error"
  equal "the last line" "$(tail -1 err)" '{"event":"finished","status":3}'
  expect 2 far.xyz --progress jsonl --nosie
  "$probe" lines err >/dev/null || die "what is wrong with the words is no JSON"
  expect 0 far.xyz -o - --format ply --progress jsonl
  "$probe" lines err >/dev/null || die "the summary is among the lines of JSON"
}

test_progress_moves_within_the_triangulation() {
  sphere 100000 >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --progress jsonl --threads 1
  grep -q '"stage":"delaunay","event":"progress","fraction":0\.' err || die "it stands still on one thread"
  expect 0 cloud.xyz -o mesh.ply --progress jsonl --threads 2
  grep -q '"stage":"delaunay","event":"progress","fraction":0\.' err || die "it stands still on two threads"
}

test_the_bar_fits_any_terminal() {
  sphere 2000 >cloud.xyz
  local columns
  for columns in 1 20 40 60 80 200; do
    COLUMNS=$columns expect 0 cloud.xyz -o mesh.ply --progress bar
    tr '\r' '\n' <err | sed 's/\x1b\[K//g' >lines
    awk -v most="$((columns - 1))" 'length($0) > most { print "longer than", most ":", $0; exit 1 }' lines ||
      die "a line of the bar is too long"
    [ "$columns" -lt 20 ] || grep -q 'reading' lines || die "reading is not shown in $columns columns"
    [ "$columns" -lt 20 ] || grep -q 'writing' lines || die "writing is not shown in $columns columns"
  done
}

test_quiet_wins_over_progress() {
  sphere 500 >cloud.xyz
  local mode
  for mode in bar jsonl auto; do
    expect 0 cloud.xyz -o mesh.ply -q --progress "$mode"
    if [ -s out ] || [ -s err ]; then die "not quiet with --progress $mode"; fi
  done
}

test_smoothing_without_steps_is_told() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --smoothing taubin --report report.json
  equal warnings "$(grep -c '^eigencrust: warning: ' err)" 1
  grep -qF -- '--smoothing has no effect without --smooth N' err || die "not told"
  value report.json /warnings/0 | grep -qF -- '--smooth N' || die "not in the report"
  expect 0 cloud.xyz -o mesh.ply --smoothing taubin --smooth 1
  [ ! -s err ] || die "a warning in spite of --smooth"
}

test_progress_off_and_bar() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --progress off
  [ ! -s err ] || die "progress although it is off"
  expect 0 cloud.xyz -o mesh.ply --progress bar
  grep -q 'delaunay' err || die "no bar"
}

# A file system without room is played by a limit of 8 blocks on the size of a file.
test_failed_write_leaves_the_old_file() {
  sphere 2000 >cloud.xyz
  local name
  for name in mesh.ply mesh.obj mesh.off mesh.stl mesh.glb mesh.3mf; do
    echo "the old mesh" >"$name"
    cp "$name" old
    (
      trap '' XFSZ
      ulimit -f 8
      run cloud.xyz -o "$name"
      [ "$status" -eq 3 ] || exit 1
    ) || die "status $status of a failed write of $name"
    grep -qF "$name" err || die "the message does not name $name"
    same "$name" old
    expect_files cloud.xyz old "$name"
    rm "$name" old
  done
}

test_full_device() {
  [ -w /dev/full ] || skip "no /dev/full"
  sphere 2000 >cloud.xyz
  ln -s /dev/full mesh.ply
  expect_error 3 mesh.ply cloud.xyz -o mesh.ply
  ln -s /dev/full report.json
  expect_error 3 report.json cloud.xyz -o good.ply --report report.json
  # Results that nobody can read are an error, too.
  expect 0 cloud.xyz -o good.ply
  status=0
  "$program" check good.ply >/dev/full 2>err || status=$?
  equal "status with a full stdout" "$status" 3
}

test_full_disk() {
  mkdir disk
  # A name space of its own lets a user mount; it goes with the process.
  unshare --user --map-root-user --mount mount -t tmpfs -o size=64k none disk 2>/dev/null ||
    skip "no right to mount a small file system"
  sphere 3000 >cloud.xyz
  export program
  # shellcheck disable=SC2016
  unshare --user --map-root-user --mount bash -c '
    mount -t tmpfs -o size=64k none disk || exit 99
    echo "the old mesh" >disk/mesh.ply
    status=0
    "$program" cloud.xyz -o disk/mesh.ply >out 2>err || status=$?
    [ "$status" -eq 3 ] || { echo "status $status"; exit 1; }
    [ "$(ls -A disk)" = mesh.ply ] || { echo "left over: $(ls -A disk)"; exit 1; }
    [ "$(cat disk/mesh.ply)" = "the old mesh" ]' || die "a full disk"
  grep -q 'space' err || die "the message does not speak of space"
}

test_unwritable_folder() {
  sphere 500 >cloud.xyz
  if [ "$(id -u)" -eq 0 ]; then
    # Permissions do not stop root, but nobody can create a file in /proc.
    [ -d /proc/self ] || skip "no /proc"
    expect_error 3 /proc/mesh.ply cloud.xyz -o /proc/mesh.ply
  else
    mkdir closed
    chmod 555 closed
    expect_error 3 closed/mesh.ply cloud.xyz -o closed/mesh.ply
    chmod 755 closed
  fi
}

test_overwrites_whole() {
  sphere 2000 >large.xyz
  sphere 500 >small.xyz
  expect 0 large.xyz -o mesh.ply
  expect 0 small.xyz -o mesh.ply
  expect 0 small.xyz -o fresh.ply
  same mesh.ply fresh.ply
}

test_names_with_blanks_and_umlauts() {
  mkdir "a folder, ünd mehr"
  sphere 500 >"a folder, ünd mehr/die wolke.xyz"
  expect 0 "a folder, ünd mehr/die wolke.xyz" -o "a folder, ünd mehr/das netz.ply" \
    --report "a folder, ünd mehr/bericht.json"
  equal path "$(value "a folder, ünd mehr/bericht.json" /input/files/0/path)" "a folder, ünd mehr/die wolke.xyz"
  expect 0 check "a folder, ünd mehr/das netz.ply"
}

test_name_that_begins_with_a_dash() {
  sphere 500 >-cloud.xyz
  expect 0 -o mesh.ply -- -cloud.xyz
  expect 0 ./-cloud.xyz -o ./-mesh.ply
}

test_numbers_do_not_depend_on_the_locale() {
  local name
  name=$(locale -a 2>/dev/null | grep -iE '^(de|fr)_' | head -1 || true)
  [ -n "$name" ] || skip "no locale with a decimal comma is installed"
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz -o plain.obj --report plain.json
  LC_ALL=$name expect 0 cloud.xyz -o other.obj --report other.json
  same plain.obj other.obj
  equal spacing "$(value other.json /input/spacing)" "$(value plain.json /input/spacing)"
}

test_dump_stages() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --dump-stages stages
  equal products "$(cd stages && echo *)" "01_samples.ply 02_poles.ply 03_tetrahedra.ply 04_surface.ply 05_mesh.ply"
  sed '/end_header/q' stages/04_surface.ply | grep -aqx 'property uchar kept' || die "not told what was kept"
  sed '/end_header/q' stages/05_mesh.ply | grep -aqx 'property uchar unsupported' || die "not told what was invented"
  expect 0 cloud.xyz -o plain.ply
  same mesh.ply plain.ply # looking on changes nothing
}
