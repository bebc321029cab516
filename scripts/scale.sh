#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What eigencrust-mpi takes with more and more ranks, and whether SLEPc finds the same eigenvector: the tables of
# docs/machines.md; and what the ordinary command takes with a disk instead of memory. Installs OpenMPI and SLEPc
# (Debian 12). An hour; ranks beyond the cores take turns. 20 GB of memory and 50 GB of disk for the largest cloud.
# Usage: scripts/scale.sh [FOLDER, default scale_out]; clouds of $EIGENCRUST_DATA that are not there are left out
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"
folder=$(realpath -m -- "${1:-scale_out}")
install_packages "${build_packages[@]}" "${tool_packages[@]}" "${mpi_packages[@]}" "${slepc_packages[@]}"
build=$repository/build
configure release build -DEIGENCRUST_BUILD_TOOLS=ON -DEIGENCRUST_BUILD_BENCH=ON -DEIGENCRUST_BUILD_MPI=ON
cmake --build "$build" --parallel "$(job_count)" --target eigencrust_cli eigencrust_mpi_cli eigencrust-scale-tiles \
  eigencrust-scale-eigenvector
mkdir -p "$folder"

# More ranks than cores are wanted here; root may be all there is in a container.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
# rows POINTS:RANKS...
rows() {
  "$build/eigencrust-scale-tiles" --head
  local pair
  for pair in "$@"; do mpiexec -n "${pair#*:}" "$build/eigencrust-scale-tiles" "${pair%:*}"; done
}

# out_of_core POINTS LIMIT...: the same cloud in memory (limit: none) and with less, after which the mesh is
# checked and must be the same.
out_of_core() {
  local points=$1 limit options
  "$build/eigencrust-scale-tiles" "$points" --write "$folder/cloud.ply" >/dev/null
  for limit in "${@:2}"; do
    options=()
    [ "$limit" = none ] || options=(--max-memory "$limit" --temp-dir "$folder/disk")
    "$build/eigencrust" "$folder/cloud.ply" -o "$folder/mesh.ply" --report "$folder/report.json" "${options[@]}" \
      >"$folder/summary"
    "$build/eigencrust" check "$folder/mesh.ply" >/dev/null
    printf '| %s | %s | %s | %s |\n' "$points" "$limit" \
      "$(sed -nE '1s/.* in ([0-9.e+]+) s, ([0-9.e+]+) MB( and ([0-9.e+]+) MB on disk)?$/\1 | \2 | \4/p' "$folder/summary")" \
      "$(sha256sum <"$folder/mesh.ply" | cut -c 1-12)"
  done
  rm -rf "$folder"/{cloud.ply,mesh.ply,report.json,summary,disk}
}

{
  printf '## Out of core\n\n'
  printf '| points | limit | seconds | memory, MB | on disk, MB | sha256 of the mesh |\n|---|---|---|---|---|---|\n'
  out_of_core 4000000 none 2G 1200M 600M
  out_of_core 20000000 none 6G
  printf '\n## As many points on more ranks\n\n'
  rows 4000000:{1,2,4,8}
  printf '\n'
  rows 400000:{1,2,4,8,16,32,64}
  printf '\n## More ranks for more points\n\n'
  rows 50000:1 100000:2 200000:4 400000:8 800000:16 1600000:32
  printf '\n## The eigenvector\n'
  data=${EIGENCRUST_DATA:-$repository/../shared/data} clouds=("$repository/examples/teapot_scan.ply")
  for cloud in reconbench/{anchor,gargoyle,lordquas}_mvs_sensors gargoyle/gargoyle armadillo/armadillo_standflip_raw \
    bunny/bunny_raw dragon/dragon_stand_side_raw happy/happy_stand_side_raw; do
    if [ -e "$data/$cloud.ply" ]; then clouds+=("$data/$cloud.ply"); fi
  done
  for ranks in 2 4; do
    printf '\n%s ranks\n\n' "$ranks"
    mpiexec -n "$ranks" "$build/eigencrust-scale-eigenvector" "${clouds[@]}"
  done
} | tee "$folder/scale.md"
