# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Status 2: what the command line says makes no sense. Help and version.

test_no_arguments_prints_the_overview() {
  expect 2
  [ ! -s out ] || die "the overview belongs on stderr when it was not asked for"
  grep -q 'Exit status:' err || die "no overview"
}

test_help_goes_to_stdout() {
  local verb
  for verb in reconstruct orient outliers info check compare render demo rerun completion man; do
    expect 0 "$verb" --help
    grep -q "Usage: eigencrust $verb" out || die "no usage line of $verb"
    [ ! -s err ] || die "help on stderr"
  done
  expect 0 --help
  for verb in reconstruct orient outliers info check compare render demo rerun completion man; do
    grep -qE "^  $verb " out || die "$verb is missing in the overview"
  done
  grep -q -- '--noise' out || die "the options of reconstruct are missing"
  expect 0 --help-all
  grep -q -- '--preset' out || die "not all options of reconstruct"
  expect 0 help render
  grep -q "Usage: eigencrust render" out || die "help does not take a verb"
  # The old name still works, but is not listed.
  expect 0 classify --help
  grep -q "Usage: eigencrust outliers" out || die "no alias"
}

test_version() {
  expect 0 --version
  grep -qxE 'eigencrust [0-9]+\.[0-9]+\.[0-9]+' out || die "no version"
}

test_unknown_option() {
  sphere 300 >cloud.xyz
  expect_error 2 --frobnicate cloud.xyz -o mesh.ply --frobnicate
  expect_files cloud.xyz
}

test_unknown_verb() {
  expect_error 2 "the verbs are" frobnicate
  expect_error 2 "unknown verb or no such file: frobnicate" frobnicate -o mesh.ply
  sphere 300 >a.xyz
  expect_error 2 "did you mean reconstruct?" recnstruct a.xyz -o mesh.ply
  expect_error 2 "did you mean check?" chekc a.xyz
  expect_error 2 "did you mean compare?" comp a.xyz a.xyz
  expect_error 2 "did you mean info?" Info a.xyz
  expect_files a.xyz
}

test_first_word_without_a_verb_is_an_input() {
  # A file of the name wins; what looks like the name of a file is one that is missing.
  sphere 300 >recnstruct
  expect 0 recnstruct -o mesh.ply
  expect_error 3 "recnstruct.xyz" recnstruct.xyz -o mesh.ply
  expect_error 3 "scans/recnstruct" scans/recnstruct -o mesh.ply
}

test_missing_output() {
  sphere 300 >cloud.xyz
  expect_error 2 output reconstruct cloud.xyz
  expect_error 2 output cloud.xyz
  expect_error 2 output render cloud.xyz
}

test_missing_input() {
  expect_error 2 INPUT reconstruct -o mesh.ply
  expect_error 2 INPUT info
  expect_error 2 MESH check
  tetrahedron >a.off
  expect_error 2 REFERENCE compare a.off
}

test_values_that_make_no_sense() {
  sphere 300 >cloud.xyz
  local options
  for options in "--preset none" "--grid-spacing -1" "--grid-spacing 0%" "--grid-spacing 1x" "--components 0" \
    "--questionable later" "--second-stage third" "--eigensolver magic" "--smoothing none" "--surface rough" "--smooth -1" \
    "--smooth 1001" "--tolerance 0" "--tolerance nan" "--max-steps 0" "--outside-point 1,2" \
    "--inside-point 1,2,three" "--inside-point 1,2,3,4" "--facade up" "--threads -1" "--threads 2000" \
    "--threads many" "--max-memory none" "--max-memory 0" "--max-memory 4X" "--max-memory -1G" "--progress loud" "--preset" "--sensor 1,2" "--sensor 1,2,inf" "--sensor-direction 0,0,0" \
    "--sensor 1,2,3 --sensor 1,2,3" "--sensor 1,2,3 --sensor-direction 1,2,3" "--sensor 1,2,3 --sensors none"; do
    # shellcheck disable=SC2086
    expect_error 2 "" cloud.xyz -o mesh.ply $options
  done
  expect_files cloud.xyz
}

test_output_folder_is_missing() {
  sphere 300 >cloud.xyz
  expect_error 2 "nowhere" cloud.xyz -o nowhere/mesh.ply
  expect_error 2 "nowhere" cloud.xyz -o mesh.ply --report nowhere/report.json
  expect_files cloud.xyz
}

test_output_is_a_folder() {
  sphere 300 >cloud.xyz
  mkdir mesh.ply
  expect_error 2 "mesh.ply" cloud.xyz -o mesh.ply
  expect_files cloud.xyz mesh.ply
}

test_output_is_an_input() {
  sphere 300 >cloud.xyz
  expect 0 cloud.xyz -o cloud.ply
  cp cloud.ply copy
  ln -s cloud.ply link.ply
  expect_error 2 "input" cloud.ply -o cloud.ply
  expect_error 2 "input" cloud.ply -o ./cloud.ply
  expect_error 2 "input" cloud.ply -o link.ply
  expect_error 2 "input" cloud.xyz cloud.ply -o cloud.ply
  expect_error 2 "input" cloud.xyz -o cloud.ply --sensors cloud.ply
  same cloud.ply copy
}

test_report_is_an_input_or_the_mesh() {
  sphere 300 >cloud.xyz
  cp cloud.xyz copy
  expect_error 2 "cloud.xyz" cloud.xyz -o mesh.ply --report cloud.xyz
  same cloud.xyz copy
  expect_error 2 "mesh.ply" cloud.xyz -o mesh.ply --report mesh.ply
  expect_error 2 "mesh.ply" cloud.xyz -o mesh.ply --report ./mesh.ply
  expect_files cloud.xyz copy
}

test_output_extension() {
  sphere 300 >cloud.xyz
  local name
  for name in mesh.docx mesh mesh.xyz ply .ply; do
    expect_error 2 "$name" cloud.xyz -o "$name"
  done
  expect_files cloud.xyz
  tetrahedron >a.off
  expect_error 2 "picture.jpg" render a.off -o picture.jpg
}

test_scan_index_needs_one_input() {
  sphere 300 >a.xyz
  sphere 300 1 5 >b.xyz
  printf '0\n' >scans.txt
  expect_error 2 "--scan-index" a.xyz b.xyz -o mesh.ply --scan-index scans.txt
}

test_sense_is_checked_before_work() {
  # The file is missing, but the options are looked at first: no minutes are lost over a typing error.
  expect_error 2 "preset" missing.xyz -o mesh.ply --preset none
  expect_error 2 "mesh.docx" missing.xyz -o mesh.docx
}

test_options_that_went_say_what_replaced_them() {
  local option
  sphere 300 >cloud.xyz
  for option in --local-noise --no-centring --close-handles --min-agreement=0.5 --pole-ties --recover-share \
    --crossing-count --behind-count; do
    expect_error 2 "$option is no longer an option" cloud.xyz -o mesh.ply "$option"
  done
  expect_error 2 "use --noise" cloud.xyz -o mesh.ply --no-local-noise
  expect_files cloud.xyz
  # Behind -- there are only files.
  expect_error 3 "--centring" -o mesh.ply -- --centring
}
