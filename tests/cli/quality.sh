# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# eigencrust-quality --cases contest: that it runs and measures every method and writes its page. Here $program is
# eigencrust-quality.

contest() { expect 0 --cases contest --contest clean/bumpy-ball --work work --threads 2 "$@"; }

# cell METHOD COLUMN: what the table of page.md has there, without marks.
cell() {
  awk -F ' *[|] *' -v method="$1" -v column="$2" '
    { gsub(/\*|★ /, "") }
    $2 == "method" { for (i = 3; i < NF; ++i) if ($i == column) at = i }
    $2 == method { print $at }' page.md
}

test_methods_on_one_small_cloud() {
  contest --python none --peers none --table page.md --page page.html --pictures images
  [ ! -s out ] || die "something on stdout in spite of files"
  local method
  for method in eigencrust spectral-powercrust powercrust spectral-cocone tight-cocone robust-cocone; do
    equal "pieces of $method" "$(cell "$method" pieces)" 1
    equal "genus of $method" "$(cell "$method" genus)" 0
    equal "boundary edges of $method" "$(cell "$method" 'boundary edges')" 0
  done
  equal "faults of eigencrust" "$(cell eigencrust non-manifold)/$(cell eigencrust crossings)" 0/0
  awk -v share="$(cell tight-cocone 'agree %')" 'BEGIN { exit !(share >= 99) }' || die "tight-cocone makes another surface"
  awk -v same="$(cell tight-cocone 'agree %')" -v share="$(cell tight-cocone 'but for turned %')" \
    'BEGIN { exit !(share >= same && share <= 100) }' || die "turned edges are counted wrong"
  equal "time of eigencrust" "$(cell eigencrust time)" 1.00
  grep -q '^| Open3D Poisson | not installed |' page.md || die "a peer that is not there is not named"
  grep -q '^| CGAL alpha wrap | not built |' page.md || die "a driver that is not there is not named"
  [ -s images/quality-clean-bumpy-ball-curves.svg ] || die "the curves of the table are missing"
  [ "$(grep -o 'src="data:image/png;base64,' page.html | wc -l)" -ge 8 ] || die "pictures are missing in the page"
  ! grep -qE '(src|href)="[^d]' page.html || die "the page loads something"
  [ -z "$(find work -name '*.ply' ! -name cloud.ply ! -name truth.ply)" ] || die "meshes are left behind"

  grep -q '`fig9/hand+1200`' page.md || die "the page does not say what was not run"

  # What was run is not run again: the same page from what was kept.
  mv page.md first.md
  contest --python none --peers none --table page.md --pictures images
  ! grep -q 'tight-cocone:' err || die "it ran again"
  same page.md first.md
}

test_peers_on_one_small_cloud() {
  /usr/bin/python3 -c 'import open3d' 2>/dev/null || skip "there is no python3-open3d"
  contest --peers none --table page.md
  equal "pieces of Open3D's Poisson" "$(cell 'Open3D Poisson, normals by eigencrust orient' pieces)" 1
  awk -v share="$(cell 'Open3D Poisson, normals by eigencrust orient' 'to truth')" 'BEGIN { exit !(share > 0 && share < 0.5) }' ||
    die "Poisson with our normals is far from the truth"
  ! grep '^| .*Open3D' page.md | grep -q 'not installed' || die "Open3D was not run"
  if command -v meshlabserver > /dev/null && command -v xvfb-run > /dev/null; then
    equal "pieces of MeshLab's Poisson" "$(cell 'MeshLab Poisson' pieces)" 1
    equal "genus of MeshLab's ball pivoting" "$(cell 'MeshLab ball pivoting' genus)" 0
  fi
}

test_wrong_words_are_told() {
  run --cases contest --contest no-such-case
  [ "$status" -eq 2 ] || die "status $status"
  grep -q "no case fits 'no-such-case'" err || die "the message does not say what is wrong"
  expect 0 --cases contest --list
  grep -qx fig9/hand+1200 out || die "the cases are not listed"
}
