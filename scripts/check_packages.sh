#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Tries the packages as a user would; takes too long for every change, since each builds the library once more.
# pip: `pip install --no-build-isolation .` without network in a fresh virtual environment with system packages; then the
#      tests of the Python package against what was installed, and whether the module needs other libraries than
#      docs/python.md names.
# deb: scripts/package.sh; the package is unpacked elsewhere, and command, Python module and a program in C are run
#      from there; lintian finds no error, if it is installed.
# bare: that package is installed with apt in a bare Debian (debootstrap; needs root and a network), and used there.
# same: a copy of the last commit in another folder, built without a compiler cache, gives the same bytes.
# Usage: scripts/check_packages.sh [pip|deb|bare|same]; all without
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

# The package of build-package; made if it is not there.
the_package() {
  [ -f "$(echo "$repository"/build-package/eigencrust_*.deb)" ] || "$repository/scripts/package.sh" >&2
  echo "$repository"/build-package/eigencrust_*.deb
}

# inside TREE COMMAND...: as on a system that runs, with /proc, in a namespace of its own, so that nothing stays mounted.
inside() {
  # shellcheck disable=SC2016
  unshare --mount bash -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$@"
}

check_bare() {
  [ "$(id -u)" -eq 0 ] || fail "a bare Debian is made by root only"
  install_packages debootstrap
  local package suite mirror tree=$work/bare
  package=$(the_package)
  # shellcheck source=/dev/null
  suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
  mirror=$(apt-get indextargets --format '$(SITE) $(RELEASE)' 'Created-By: Packages' | awk -v s="$suite" '$2 == s { print $1; exit }')
  debootstrap --variant=minbase "$suite" "$tree" "${mirror:-http://deb.debian.org/debian}" >"$work/debootstrap.log" ||
    { tail -5 "$work/debootstrap.log"; fail "debootstrap failed"; }
  cp "$package" "$tree/tmp/eigencrust.deb"
  inside "$tree" apt-get update -qq
  inside "$tree" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends /tmp/eigencrust.deb \
    >"$work/install.log" 2>&1 || { tail -20 "$work/install.log"; fail "the package cannot be installed"; }
  # Nobody in particular uses it, in a folder of his own.
  inside "$tree" su -s /bin/bash nobody -c 'set -e; cd "$(mktemp -d)"; eigencrust --version; eigencrust demo
    python3 -c "import eigencrust; r = eigencrust.reconstruct(eigencrust.read_point_cloud(\"/usr/share/eigencrust/examples/teapot_scan.ply\"));
print(eigencrust.check(r))"'
  [ -f "$tree/usr/share/bash-completion/completions/eigencrust" ] || fail "the completion is missing"
  if [ -f "$tree/usr/share/eigencrust/viewer.html" ]; then
    inside "$tree" su -s /bin/bash nobody -c 'cd "$(mktemp -d)" && eigencrust --quiet \
      /usr/share/eigencrust/examples/teapot_scan.ply -o t.ply --report page.html && ls -l page.html'
  else
    printf 'the package is without the viewer: no page was made\n'
  fi
  printf 'bare: installed with %s other packages, and used\n' "$(grep -c '^Setting up' "$work/install.log")"
}

check_same() {
  local package copy="$work/a copy in a folder of another length"
  "$repository/scripts/package.sh"
  package=$(the_package)
  git clone --quiet --no-hardlinks "$repository" "$copy"
  [ -z "$(git -C "$repository" status --porcelain)" ] || fail "commit first: the copy is of the last commit"
  CCACHE_DISABLE=1 "$copy/scripts/package.sh"
  cmp "$package" "$copy"/build-package/eigencrust_*.deb
  sha256sum "$package"
  printf 'same: two folders, the same bytes\n'
}

case ${1:-all} in
  pip) (check_pip) ;;
  deb) (check_deb) ;;
  bare) (check_bare) ;;
  same) (check_same) ;;
  all) (check_pip) && (check_deb) && (check_bare) && (check_same) ;;
  *) fail "usage: check_packages.sh [pip|deb|bare|same]" ;;
esac
