#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs a build into a temporary prefix, moves that elsewhere, and builds and runs a program against it.
# Usage: run.sh BUILD_FOLDER COMPILER
set -euo pipefail
build=$1 compiler=$2
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/first" >"$work/install.log"
mv "$work/first" "$work/installed here" # it must not remember where it was installed

cmake -S "$here" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/installed here" \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release
cmake --build "$work/build"
"$work/build/consumer" "$work/sphere.ply" "$work/sphere.png"
"$work/build/method"
"$work/build/c_program"
if ldd "$work/build/method" | grep -E 'libpng|libcrypto|libpugixml|libtinygltf|lib3MF|libz\.'; then
  echo "run.sh: the method alone asks for these"
  exit 1
fi

# The same without CMake, as pkg-config says.
if command -v pkg-config >/dev/null; then
  export PKG_CONFIG_PATH
  PKG_CONFIG_PATH=$(dirname "$(find "$work/installed here" -name eigencrust.pc)")
  static=--static
  [ -z "$(find "$work/installed here" -name 'libeigencrust.so')" ] || static=
  # The folder's name holds a blank, which pkg-config escapes: hence eval.
  eval "$compiler -x c++ -std=c++20 $here/method.cpp -x none -o $work/by_pkg_config $(pkg-config --cflags --libs $static eigencrust)"
  "$work/by_pkg_config"
fi

# The program takes the bundled scan from beside itself.
cd "$work"
"$work/installed here/bin/eigencrust" check sphere.ply
"$work/installed here/bin/eigencrust" demo -o demo >demo.log
"$work/installed here/bin/eigencrust-scan" --help >scan.log
for file in man/man1/eigencrust.1 bash-completion/completions/eigencrust zsh/site-functions/_eigencrust \
  fish/vendor_completions.d/eigencrust.fish; do
  grep -q reconstruct "$work/installed here/share/$file"
done
grep -q "installed here/share/eigencrust/examples/teapot_scan.ply" demo.log

# Nothing of the machine it was built on may remain in the package.
if grep -rlF --include="*.cmake" --include="*.h" -e "$build" -e "$(cd "$here/../.." && pwd)" "$work/installed here"; then
  echo "run.sh: these files name folders of the build"
  exit 1
fi
