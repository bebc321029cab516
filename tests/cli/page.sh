# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# The report as a page. What is on it a browser tells: scripts/test_page.sh.

# with_viewer: skips where the viewer was not built.
with_viewer() {
  [ -e "$(dirname -- "$program")/viewer.html" ] || skip "viewer.html was not built: scripts/viewer.sh $(dirname -- "$program")"
}

test_without_viewer_is_told_before_any_work() {
  mkdir bin
  cp -- "$program" bin/eigencrust # where no viewer is
  local name
  for name in page.html page.HTM; do
    # Nothing is read: the cloud is not even there.
    program=$PWD/bin/eigencrust expect_error 2 'viewer.html' no.xyz -o mesh.ply --report $name
    grep -qF 'scripts/viewer.sh' err || die "not told how to get it: $(cat err)"
    grep -qF '.json' err || die "not told what works without: $(cat err)"
  done
  expect_files bin bin/eigencrust
  sphere 500 >cloud.xyz
  program=$PWD/bin/eigencrust expect_error 2 'viewer.html' cloud.xyz --each -o '{}.ply' --report '{}.html'
  program=$PWD/bin/eigencrust expect 0 cloud.xyz -o mesh.ply --report report.json
  equal schema "$(value report.json /schema)" 1
}

# data ID PAGE: what a script element of the page holds.
data() {
  awk -v begin="<script id=\"$1\" " 'index($0, begin) { sub(/^[^>]*>/, ""); on = 1 }
    on { end = index($0, "</script>"); print end ? substr($0, 1, end - 1) : $0; if (end) exit }' "$2"
}

test_page_holds_the_report() {
  with_viewer
  { sphere 1000; echo 9 9 9; } >'a<b.xyz'
  expect 0 'a<b.xyz' -o mesh.ply --report page.html
  expect 0 'a<b.xyz' -o plain.ply
  same mesh.ply plain.ply # looking on changes nothing
  expect_files 'a<b.xyz' mesh.ply plain.ply page.html
  data report page.html >report.json
  equal path "$(value report.json /input/files/0/path)" 'a<b.xyz'
  equal "points on the surface told" "$(value report.json /options/point_results)" true
  data scene page.html >scene.json
  equal outliers "$(value scene.json /outliers/all)" 1
  equal points "$(value scene.json /points/shown)" 1000
  equal triangles "$(value scene.json /mesh/all)" "$(value report.json /mesh/triangles)"
  equal "marks of triangles" "$(value scene.json /buffers/mesh.invented/count)" "$(value report.json /mesh/triangles)"
  local side
  for side in front back left right top bottom; do
    data picture.$side page.html | base64 -d >picture.png
    cmp -n 8 picture.png <(printf '\x89PNG\r\n\x1a\n') || die "no picture of $side"
  done
  ! grep -qE '(src|href)="?https?:' page.html || die "the page asks a network for something"
}

test_pages_of_points() {
  with_viewer
  { sphere 1000; echo 9 9 9; } >cloud.xyz
  local verb
  for verb in orient outliers; do
    expect 0 $verb cloud.xyz -o points.ply --keep inliers --report page.html
    data scene page.html >scene.json
    equal "outliers of $verb" "$(value scene.json /outliers/all)" 1
  done
}

test_page_is_an_output_like_others() {
  with_viewer
  sphere 500 >scan.html
  expect_error 2 'would overwrite an input' scan.html -o mesh.ply --report scan.html
  expect_error 2 'does not exist' scan.html -o mesh.ply --report nowhere/page.html
  expect_files scan.html
  echo old >page.html
  expect_error 4 '' scan.html -o mesh.ply --report page.html --max-memory 1M
  equal "the old page" "$(cat page.html)" old
}

test_pages_of_other_methods() {
  with_viewer
  sphere 300 >cloud.xyz
  local method
  for method in powercrust tight-cocone spectral-cocone; do
    expect 0 cloud.xyz -o mesh.ply --report page.html --method $method
    data scene page.html >scene.json
    equal "triangles of $method" "$(value scene.json /mesh/all)" "$(data report page.html >r.json && value r.json /mesh/triangles)"
  done
}

test_page_where_surface_is_cut_away_or_added() {
  with_viewer
  # Ground without sensors, seen from above.
  awk 'BEGIN { srand(5); for (i = 0; i < 3000; ++i) { x = rand(); y = rand(); printf "%.6f %.6f %.6f\n", x, y, 0.05 * sin(9 * x) * cos(7 * y) } }' >ground.xyz
  local how
  for how in '' --base --trim; do
    # shellcheck disable=SC2086 # no word, or one
    expect 0 ground.xyz -o mesh.ply --report page.html --facade +z $how
    data scene page.html >scene.json
    equal "marks with '$how'" "$(value scene.json /buffers/mesh.invented/count)" "$(value scene.json /mesh/all)"
  done
}

# Other triangles than those of the surface that was found have marks, too.
test_page_of_fewer_triangles() {
  with_viewer
  sphere 2000 | awk '$3 < 0.8' >cloud.xyz
  expect 0 cloud.xyz -o mesh.ply --report page.html --triangles 400
  data scene page.html >scene.json
  equal marks "$(value scene.json /buffers/mesh.invented/count)" "$(value scene.json /mesh/all)"
}
