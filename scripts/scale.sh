#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What eigencrust-mpi takes with more and more ranks, and whether SLEPc finds the same eigenvector: the tables of
# docs/scale.md. Installs OpenMPI and SLEPc (Debian 12). Half an hour; ranks beyond the cores take turns.
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

{
  printf '## As many points on more ranks\n\n'
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
