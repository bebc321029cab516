#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Tries the packages as a user would; takes too long for every change, since each builds the library once more.
# pip: `pip install --no-build-isolation .` without network in a fresh virtual environment with system packages; then the
#      tests of the Python package against what was installed, and whether the module needs other libraries than
#      docs/python.md names.
# deb: scripts/package.sh; the package is unpacked elsewhere, and command, Python module and a program in C are run
#      from there; lintian finds no error, if it is installed.
# Usage: scripts/check_packages.sh [pip|deb]; both without
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

python=/usr/bin/python3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
install_packages "${build_packages[@]}" "${python_packages[@]}" python3-pip python3-venv python3-setuptools python3-wheel

# unknown_needs MODULE: libraries that the module asks for and docs/python.md does not name.
unknown_needs() {
  local library package
  while read -r library; do
    case $library in libstdc++.so.* | libgcc_s.so.* | libc.so.* | libm.so.* | ld-linux*) continue ;; esac
    package=$(dpkg -S "*/$library" 2>/dev/null | cut -d: -f1 | head -1)
    grep -qw -- "${package:-$library}" "$repository/docs/python.md" || printf '%s (%s)\n' "$library" "$package"
  done < <(readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
}

check_pip() {
  "$python" -m venv --system-site-packages "$work/env"
  local launcher
  launcher=$(command -v ccache || true)
  CMAKE_ARGS=${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher} CMAKE_BUILD_PARALLEL_LEVEL=$(job_count) \
    "$work/env/bin/pip" install --quiet --no-index --no-build-isolation "$repository"
  cd "$work"
  local module
  module=$(env -u PYTHONPATH "$work/env/bin/python" -c 'import eigencrust._core as c; print(c.__file__)')
  case $module in "$work/env/"*) ;; *) fail "another eigencrust was imported: $module" ;; esac
  local unknown
  unknown=$(unknown_needs "$module")
  [ -z "$unknown" ] || fail "docs/python.md does not name what the module needs: $unknown"
  local test
  for test in input files_and_metrics stages types; do
    env -u PYTHONPATH "$work/env/bin/python" "$repository/tests/python/test_$test.py"
  done
  printf 'pip: installed and tested, %s\n' "$(du -h "$module" | cut -f1)"
}

check_deb() {
  "$repository/scripts/package.sh"
  local package triplet
  package=$(echo "$repository"/build-package/eigencrust_*.deb)
  dpkg-deb --field "$package" Package Version Depends
  dpkg-deb --extract "$package" "$work/tree"
  triplet=$(basename "$(dirname "$(find "$work/tree/usr/lib" -name 'libeigencrust.so')")")
  export LD_LIBRARY_PATH=$work/tree/usr/lib/$triplet
  cd "$work"
  "$work/tree/usr/bin/eigencrust" demo -o demo
  PYTHONPATH=$work/tree/usr/lib/python3/dist-packages "$python" -c 'import eigencrust; print(eigencrust.__version__)'
  cc -o c_program "$repository/tests/consumer/c_program.c" -I"$work/tree/usr/include" -L"$LD_LIBRARY_PATH" -leigencrust -lm
  ./c_program
  # Nothing but what the public headers declare is shown.
  if nm -DC --defined-only "$LD_LIBRARY_PATH/libeigencrust.so" | grep -E ' T ' | grep -E 'CGAL|tbb::|Eigen::|nanoflann'; then
    fail "the library shows parts of others"
  fi
  if command -v lintian >/dev/null; then
    lintian --fail-on error "$package" | tee lintian.log
  else
    printf 'lintian is not installed: not asked\n'
  fi
}

case ${1:-both} in
  pip) (check_pip) ;;
  deb) (check_deb) ;;
  both) (check_pip) && (check_deb) ;;
  *) fail "usage: check_packages.sh [pip|deb]" ;;
esac
