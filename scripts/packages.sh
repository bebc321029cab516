# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# What the other scripts share: the Debian packages, and the two steps of every build. To be sourced.

repository=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)

# libcgal-dev brings Boost, GMP and MPFR.
build_packages=(g++ cmake ninja-build libcgal-dev libeigen3-dev libspectra-dev libnanoflann-dev
  nlohmann-json3-dev libtbb-dev libpng-dev zlib1g-dev libssl-dev libpugixml-dev
  libtinygltf-dev lib3mf-dev)
tool_packages=(libcli11-dev) # of the tools and the benchmarks
mpi_packages=(libopenmpi-dev openmpi-bin)
slepc_packages=(libslepc-real-dev pkg-config) # 300 MB of others
test_packages=("${tool_packages[@]}" "${mpi_packages[@]}" libgtest-dev libgmock-dev clang-format)
# What the Python package is built with, and what its tests need beside it. Open3D comes with 200 MB of others.
python_packages=(pybind11-dev python3-dev python3-numpy)
python_test_packages=(python3-pip python3-venv python3-setuptools python3-wheel python3-open3d)
# What others reconstruct with, to be compared with.
peer_packages=(python3-open3d meshlab xvfb xauth)
fuzz_packages=(clang libclang-rt-14-dev)

fail() {
  printf '%s: error: %s\n' "${0##*/}" "$1" >&2
  exit 1
}

is_installed() {
  dpkg-query --show --showformat='${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed
}

# Installs those of the named packages that are missing. Does nothing, and needs no rights, when all are there.
install_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    printf '%s: not a Debian system; these must be installed by hand: %s\n' "${0##*/}" "$*" >&2
    return 0
  fi
  local missing=() package
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "these packages are missing: ${missing[*]}; install them as root, or install sudo"
    as_root=(sudo)
  fi
  printf 'Installing %s\n' "${missing[*]}"
  # Old package lists name files that the mirrors no longer have.
  "${as_root[@]}" apt-get update -qq ||
    fail "apt-get update failed; check the network and /etc/apt/sources.list"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null ||
    fail "these packages could not be installed: ${missing[*]}; Eigencrust needs Debian 12 or newer"
}

# Compilers at work at the same time: one per core, but a file that includes CGAL takes 1.5 GB.
job_count() {
  local cores memory_kb=0 key value rest
  cores=$(nproc 2>/dev/null || echo 1)
  while read -r key value rest; do
    if [ "$key" = MemAvailable: ]; then memory_kb=$value; fi
  done </proc/meminfo 2>/dev/null || true
  local fit=$((memory_kb / 1500000))
  if [ "$memory_kb" -gt 0 ] && [ "$fit" -lt "$cores" ]; then cores=$((fit > 1 ? fit : 1)); fi
  echo "$cores"
}

# configure PRESET FOLDER [CMake options]
configure() {
  local preset=$1 folder=$repository/$2 fresh=()
  shift 2
  # A checkout that was moved or copied carries the old place in its cache.
  if [ -f "$folder/CMakeCache.txt" ] &&
    ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$repository" "$folder/CMakeCache.txt"; then
    fresh=(--fresh)
  fi
  # Set each time, so that a ccache that was removed is forgotten.
  (cd "$repository" && cmake --preset "$preset" -B "$folder" "${fresh[@]}" --log-level=WARNING \
    -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" "$@")
}
