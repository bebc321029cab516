# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# What people get wrong, and the words of the answer that put it right. One line on stderr, no file written.

# A row of a table: status | remedy | command line. Blanks separate the words.
expect_table() {
  local status_wanted remedy line words
  while IFS='|' read -r status_wanted remedy line; do
    [ -n "$status_wanted" ] || continue
    read -ra words <<<"$line"
    expect_error "$((status_wanted))" "$(sed 's/^ *//; s/ *$//' <<<"$remedy")" "${words[@]}"
    # What is to be done stands behind the semicolon.
    grep -qE "; .*$(sed 's/^ *//; s/ *$//; s/[][().*+?{}|^$\\]/\\&/g' <<<"$remedy")" err ||
      die "the remedy is not at the end: $line"
  done
}

clouds() {
  sphere 300 >cloud.xyz
  sphere 300 1 5 >other.xyz
  tetrahedron >mesh.off
  mkdir folder
}

test_likely_mistakes_on_the_command_line() {
  clouds
  expect_table <<'END'
2 | add -o mesh.ply behind cloud.xyz | cloud.xyz
2 | add -o before the name of the result | cloud.xyz other.xyz
2 | name the input first | new.ply cloud.xyz
2 | add -o before it | cloud.xyz other.xyz mesh.ply
2 | or add -o before it | cloud.xyz mesh.docx
2 | did you mean --noise? | cloud.xyz -o mesh.ply --nosie 1
2 | did you mean --components? | cloud.xyz -o mesh.ply --component all
2 | did you mean --no-manifold? | cloud.xyz -o mesh.ply --no-manifolds
2 | did you mean --threads? | cloud.xyz -o mesh.ply -t 4
2 | --thin L makes the result coarser | cloud.xyz -o mesh.ply --depth 9
2 | inputs are named without an option | -i cloud.xyz -o mesh.ply
2 | normals are neither needed nor used | cloud.xyz -o mesh.ply --normals
2 | it is an option of render | cloud.xyz -o mesh.ply --azimuth 30
2 | did you mean reconstruct? | reconstrcut cloud.xyz -o mesh.ply
2 | the verbs are reconstruct, orient, outliers | pointcloud -o mesh.ply
2 | end it in .ply, obj, off, stl, glb or 3mf, or add --format | cloud.xyz -o mesh.docx
2 | add --format ply | cloud.xyz -o -
2 | use ply, obj, off, stl, glb or 3mf | cloud.xyz -o mesh.ply --format gltf
2 | create it first: mkdir -p nowhere/deep | cloud.xyz -o nowhere/deep/mesh.ply
2 | name a file in it | cloud.xyz -o folder
2 | choose another name | cloud.xyz -o cloud.xyz --format ply
2 | use auto, off, a positive length or N% | cloud.xyz -o mesh.ply --noise 5mm
2 | use auto, off, a positive length or N% | cloud.xyz -o mesh.ply --noise 0,5
2 | use three numbers x,y,z | cloud.xyz -o mesh.ply --sensor 1 2 3
2 | name one for each input, in order | cloud.xyz other.xyz -o mesh.ply --sensor 1,2,3
2 | use one of robust, paper | cloud.xyz -o mesh.ply --preset papr
2 | choose one of those | cloud.xyz -o mesh.ply --progress loud
2 | give a number | cloud.xyz -o mesh.ply --threads many
2 | use 4G, 500M, 1.5Gi or bytes | cloud.xyz -o mesh.ply --max-memory 4X
2 | give --noise one value | cloud.xyz -o mesh.ply --noise
2 | give two corners of a box | cloud.xyz -o mesh.ply --crop 1,2,3
2 | give a length or N% | cloud.xyz -o mesh.ply --thin off
2 | put {} where the name of the input goes | cloud.xyz other.xyz --each -o mesh.ply
2 | add --keep inliers | outliers cloud.xyz -o flags.obj
2 | end the name in .png | render mesh.off -o picture.jpg
2 | use front, right, back, left, top, bottom, corner | render mesh.off -o picture.png --view above
2 | write eigencrust check MESH | check
2 | write eigencrust compare MESH REFERENCE | compare mesh.off
END
  expect_files cloud.xyz other.xyz mesh.off folder
}

test_likely_mistakes_with_files() {
  clouds
  : >empty.xyz
  awk 'BEGIN { for (i = 0; i < 400; ++i) print i % 20, int(i / 20), 3 }' >plane.xyz
  printf 'noise = 0.1\nnosie = 2\n' >options.toml
  printf 'noise = five\n' >words.toml
  printf '{"schema": 1}\n' >report.json
  expect_table <<'END'
3 | check | clod.xyz -o mesh.ply
3 | use a ply, obj, off, stl, glb or 3mf file | check cloud.xyz
3 | use | empty.xyz -o mesh.ply
3 | give points that surround a volume | plane.xyz -o mesh.ply
3 | check that the folder exists and is writable | cloud.xyz -o /proc/mesh.ply
3 | check that the folder exists and is writable | cloud.xyz -o mesh.ply --report /proc/report.json
3 | check that the folder exists and is writable | render mesh.off -o /proc/picture.png
3 | compare it with the bounds that eigencrust info shows | cloud.xyz -o mesh.ply --crop 5,5,5,6,6,6
2 | did you mean --noise? | cloud.xyz -o mesh.ply --config options.toml
3 | put texts between quotation marks | cloud.xyz -o mesh.ply --config words.toml
3 | check the name after --config | cloud.xyz -o mesh.ply --config missing.toml
3 | give the file that --report wrote | rerun report.json
END
  expect_files cloud.xyz other.xyz mesh.off folder empty.xyz plane.xyz options.toml words.toml report.json
}

test_every_verb_refuses_what_it_does_not_know() {
  # Generated from the program's own list: a letter too many in each of its options.
  clouds
  local verb option
  for verb in $("$program" --help | sed -n 's/^  \([a-z]*\) .*/\1/p' | grep -vx eigencrust); do
    expect_error 2 "unknown option --frobnicate" "$verb" --frobnicate
    for option in $("$program" "$verb" --help-all | grep -oE '^  (-., )?--[a-z-]{6,}' | grep -oE -- '--[a-z-]+'); do
      expect_error 2 "did you mean $option" "$verb" "${option}x"
    done
  done
}

test_what_cannot_be_written_is_refused_before_reading() {
  # The input is a pipe into which nobody writes: whoever reads it first waits for ever.
  mkfifo cloud.xyz
  local name
  for name in /proc/mesh.ply nowhere/mesh.ply; do
    timeout 20 "$program" cloud.xyz -o "$name" >out 2>err </dev/null && die "no error for $name"
    grep -qF "$name" err || die "it read before it looked at $name"
  done
  timeout 20 "$program" cloud.xyz -o mesh.ply --report /proc/report.json 2>err </dev/null && die "no error for a report"
  grep -qF /proc/report.json err || die "it read before it looked at the report's place"
}

test_a_full_disk_is_told_before_reading() {
  mkdir disk
  unshare --user --map-root-user --mount mount -t tmpfs -o size=64k none disk 2>/dev/null ||
    skip "no right to mount a small file system"
  sphere 300 >cloud.xyz
  export program
  # shellcheck disable=SC2016
  unshare --user --map-root-user --mount bash -c '
    mount -t tmpfs -o size=64k none disk || exit 99
    head -c 65536 /dev/zero >disk/filler 2>/dev/null
    status=0
    "$program" missing.xyz -o disk/mesh.ply >out 2>err || status=$?
    [ "$status" -eq 3 ] || { echo "status $status"; exit 1; }
    [ "$(ls -A disk)" = filler ] || { echo "left over: $(ls -A disk)"; exit 1; }' || die "a full disk"
  grep -q 'space' err || die "the message does not speak of space"
}
