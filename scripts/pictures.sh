#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the pictures in docs/images: teapot.png from the bundled scan, room.png from simulated scans of a made room.
# Needs scripts/build.sh --all.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root"
build/eigencrust examples/teapot_scan.ply -o "$work/teapot.ply" --quiet
build/eigencrust render examples/teapot_scan.ply "$work/teapot.ply" -o docs/images/teapot.png \
  --width 700 --height 500 --up z --azimuth -60 --point-size 1.5

# Boxes, two corners each, in metres. The first one is seen from within; what stands in it reaches through its walls.
boxes() {
  awk '{ for (k = 0; k < 8; ++k) v[n++] = (k % 2 ? $4 : $1) " " (int(k / 2) % 2 ? $5 : $2) " " (k > 3 ? $6 : $3) }
    END {
      faces = split("0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5", f)
      print "OFF"; print n, n / 8 * 6, 0
      for (i = 0; i < n; ++i) print v[i]
      for (b = 0; b < n; b += 8) for (i = 1; i <= faces; i += 4)
        if (b) print 4, b + f[i], b + f[i + 1], b + f[i + 2], b + f[i + 3]
        else print 4, f[i + 3], f[i + 2], f[i + 1], f[i]
    }'
}
boxes >"$work/room.off" <<'END'
0 0 0 5 4 2.7
3.5 2.5 -0.1 3.85 2.85 2.8
-0.1 -0.1 -0.1 0.6 1.8 2
4.4 0.4 -0.1 5.1 1.6 0.8
1.4 2.4 0.7 2.6 3.2 0.75
END
views=()
for place in 2.6,1.4,1.5 0.7,3.4,1.5; do
  IFS=, read -r x y z <<<"$place"
  for ahead in 1,0,0 -1,0,0 0,1,0 0,-1,0 0,0,1 0,0,-1; do
    target=$(awk -v p="$x $y $z" -v d="${ahead//,/ }" \
      'BEGIN { split(p, a, " "); split(d, b, " "); print a[1] + b[1] "," a[2] + b[2] "," a[3] + b[3] }')
    views+=(--sensor "$place:$target:90:52")
  done
done
build/eigencrust-scan "$work/room.off" -o "$work/scan.ply" "${views[@]}" --noise 0.004 --double --quiet
build/eigencrust "$work/scan.ply" -o "$work/room.ply" --quiet
build/eigencrust render "$work/room.ply" -o docs/images/room.png --width 640 --height 460 --up z --elevation 50 \
  --azimuth 30 --clip-normal 0,0,1 --clip-point 0,0,2.5
