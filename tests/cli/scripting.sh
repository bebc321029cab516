# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# For scripts: two names, streams, files of options, runs once more, completion and the manual page.

test_the_second_of_two_names_is_the_result() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz mesh.ply
  expect 0 cloud.xyz -o wanted.ply
  same mesh.ply wanted.ply
  # A mesh with faces may be replaced, a cloud never.
  sphere 300 >small.xyz
  expect 0 reconstruct small.xyz mesh.ply --report report.json
  equal vertices "$(value report.json /mesh/vertices)" 300
  equal command "$(value report.json /command)" \
    "[\"$program\",\"reconstruct\",\"-o\",\"mesh.ply\",\"small.xyz\",\"--report\",\"report.json\"]"
  expect 0 orient cloud.xyz -o cloud.ply
  cp cloud.ply copy
  expect_error 2 "cloud.ply exists and is no mesh" small.xyz cloud.ply
  same cloud.ply copy
}

test_standard_output() {
  sphere 500 >cloud.xyz
  local name format
  for format in ply obj off stl glb 3mf; do
    expect 0 cloud.xyz -o "wanted.$format"
    for name in - /dev/stdout; do
      status=0
      "$program" cloud.xyz -o "$name" --format "$format" >found 2>err || status=$?
      equal status "$status" 0
      same found "wanted.$format"
      grep -q '500 points in' err || die "no summary on stderr"
      "$program" cloud.xyz -o "$name" --format "$format" -q 2>err | cat >found
      same found "wanted.$format"
      [ ! -s err ] || die "not quiet"
    done
  done
  # Behind what is there already.
  echo before >found
  "$program" cloud.xyz -o - --format off -q >>found
  { echo before; cat wanted.off; } >both
  same found both
  expect 0 cloud.xyz -o mesh.ply --report -
  value out /mesh/vertices >/dev/null || die "no report on stdout"
}

test_format_goes_before_the_ending() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz -o mesh.off
  expect 0 cloud.xyz -o mesh.dat --format off
  same mesh.dat mesh.off
  expect 0 outliers cloud.xyz -o flags.dat --format csv
  head -1 flags.dat | grep -qx 'x,y,z,inlier,confidence' || die "no CSV"
}

test_standard_input_and_pipes() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz -o wanted.ply
  "$program" - -o mesh.ply --report report.json <cloud.xyz >out 2>err || die "- is not read"
  same mesh.ply wanted.ply
  equal path "$(value report.json /input/files/0/path)" -
  equal hash "$(value report.json /input/files/0/sha256)" "$(sha256sum cloud.xyz | cut -d ' ' -f 1)"
  "$program" <(cat cloud.xyz) -o mesh.ply >out 2>err || die "a pipe is not read"
  same mesh.ply wanted.ply
  "$program" render - -o picture.png <wanted.ply || die "render does not read -"
  printf '1 2 3\n1 2 x\n' | "$program" info - >out 2>err && die "no error"
  grep -qF '(standard input:2)' err || die "the place is not named"
}

test_options_from_a_file() {
  sphere 500 >cloud.xyz
  cat >run.toml <<'END'
# a comment
input = ["cloud.xyz"]        # the cloud
output = 'mesh.ply'
smooth = 3
smoothing = "taubin"
manifold = true
outside-point = [
  "5,0,0",
  "-5,0,0",   # behind a comma
]
[render]
width = 77
[reconstruct]
report = "report.json"
END
  expect 0 --config run.toml
  equal smooth "$(value report.json /options/smooth)" 3
  equal smoothing "$(value report.json /options/smoothing)" taubin
  equal points "$(value report.json /options/outside_points/1/0)" -5.0
  # The words of the command line go first, and the report holds what was done.
  expect 0 cloud.xyz -o other.ply --config run.toml --smooth=1 --report report.json
  equal smooth "$(value report.json /options/smooth)" 1
  ! value report.json /command | grep -q config || die "the file of options is still named"
  value report.json /command | grep -q -- '--smoothing=taubin' || die "an option of the file is not in the report"
  # Options of other verbs are passed over, those in their table go to that verb.
  expect 0 render mesh.ply -o picture.png --config run.toml --height 55
  equal width "$(od -A n -t u1 -j 16 -N 4 picture.png | awk '{ print $4 }')" 77
  local line
  for line in 'smooth 3' 'smooth = [1' 'smooth = "1' '[nonsense]' 'trim = 3' 'smooth = 1 2' '= 3' 'config = "a"'; do
    printf '%s\n' "$line" >bad.toml
    run cloud.xyz -o mesh.ply --config bad.toml
    [ "$status" -eq 2 ] || [ "$status" -eq 3 ] || die "status $status for $line"
    grep -qE '^eigencrust: error: .+ \(bad.toml:[12]\); .+$' err || die "the place is not named for $line"
  done
}

test_rerun() {
  sphere 500 >cloud.xyz
  expect 0 cloud.xyz mesh.ply --smooth 2 --report report.json
  cp mesh.ply first.ply
  cp report.json kept.json
  rm mesh.ply
  expect 0 rerun report.json
  same mesh.ply first.ply
  same report.json kept.json # what is read is never written
  expect 0 rerun report.json -o again.ply --report again.json
  same again.ply first.ply
  equal smooth "$(value again.json /options/smooth)" 2
  expect 0 rerun again.json
  expect_error 2 "would overwrite an input" rerun report.json --report report.json
  expect 0 orient cloud.xyz -o=normals.ply --report=normals.json
  mv normals.ply first.ply
  expect 0 rerun normals.json
  same normals.ply first.ply
  sphere 501 >cloud.xyz
  expect_error 3 "SHA-256" rerun report.json
  rm cloud.xyz
  expect_error 3 "call rerun in the folder" rerun report.json
  expect_error 3 "missing.json" rerun missing.json
}

test_each_input_is_a_job() {
  local n
  mkdir meshes
  for n in a b c; do sphere 500 1 "$((${#n} * 3))" >"$n.xyz"; done
  printf '1 2 3\n' >bad.xyz
  expect 3 a.xyz bad.xyz b.xyz c.xyz --each -o 'meshes/{}.ply' --report 'meshes/{}.json'
  equal errors "$(grep -c '^eigencrust: error: bad.xyz: ' err)" 1
  expect_files meshes meshes/{a,b,c}.{ply,json} {a,b,c,bad}.xyz
  for n in a b c; do
    expect 0 "$n.xyz" -o wanted.ply
    same "meshes/$n.ply" wanted.ply
  done
  rm wanted.ply
  expect 0 outliers a.xyz b.xyz --each -o '{}.csv'
  mkdir other
  cp a.xyz other
  expect_error 2 "would be one result" a.xyz other/a.xyz --each -o 'meshes/{}.ply'
  expect_error 2 "would overwrite an input" a.xyz b.xyz --each -o '{}.xyz' --format ply
  expect_error 2 "not one --sensor for each input" a.xyz b.xyz --each -o 'meshes/{}.ply' --sensor 1,2,3
}

test_completion() {
  local shell
  for shell in bash zsh fish; do
    expect 0 completion "$shell"
    grep -q -- 'crossing-depth' out || die "an option is missing for $shell"
    ! grep -q classify out || die "an old name for $shell"
    if command -v "$shell" >/dev/null && [ "$shell" != fish ]; then "$shell" -n out || die "no $shell script"; fi
  done
  "$program" completion bash >completion.bash
  complete_words() { # the words typed so far, the last one unfinished
    trap - ERR # a completion that finds nothing is no failure
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    _eigencrust
    printf '%s\n' "${COMPREPLY[@]}" | LC_ALL=C sort | tr '\n' ' '
  }
  : >cloud.xyz
  # shellcheck disable=SC1091
  source completion.bash
  equal verbs "$(complete_words eigencrust re)" "reconstruct render rerun "
  equal options "$(complete_words eigencrust cloud.xyz --smo)" "--smooth --smoothing "
  equal choices "$(complete_words eigencrust cloud.xyz --smoothing t)" "taubin "
  equal "options of a verb" "$(complete_words eigencrust render cloud.xyz --ele)" "--elevation "
  equal files "$(complete_words eigencrust info clo)" "cloud.xyz "
}

test_manual_page() {
  expect 0 man
  local verb
  for verb in reconstruct orient outliers info check compare render demo rerun completion; do
    grep -qx "\.SH $(tr '[:lower:]' '[:upper:]' <<<"$verb")" out || die "no chapter on $verb"
  done
  grep -q 'crossing\\-depth' out || die "an option is missing"
  command -v groff >/dev/null || return 0
  groff -man -Tutf8 -ww out >page 2>complaints
  [ ! -s complaints ] || die "groff complains: $(head -3 complaints)"
}

test_help_is_short_and_help_all_is_whole() {
  expect 0 reconstruct --help
  equal "options of every day" "$(grep -cE '^  (-., )?--' out)" 10
  grep -q 'eigencrust reconstruct --help-all' out || die "does not say where the others are"
  expect 0 reconstruct --help-all
  [ "$(grep -cE '^  (-., )?--' out)" -ge 40 ] || die "not all options"
  local chapter
  for chapter in Reading 'What is known beforehand' Results Method Running Help; do
    grep -qx "$chapter:" out || die "no chapter $chapter"
  done
  ! grep -qE '.{101}' out || die "a line is longer than 100 columns"
  expect 0 info --help
  grep -q -- '--pcd-viewpoint' out || die "few options are not shown at once"
}
