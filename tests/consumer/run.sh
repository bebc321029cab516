#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs a build into a temporary prefix, moves that elsewhere, and builds and runs programs against it, those of
# README.md and docs/development.md among them.
# Usage: run.sh BUILD_FOLDER COMPILER
set -euo pipefail
build=$1 compiler=$2
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/first" >"$work/install.log"
mv "$work/first" "$work/installed here" # it must not remember where it was installed

# block PAGE LANGUAGE: the first block of code in that language.
block() { awk -v fence='```'"$2" '$0 == fence { on = 1; next } on && /^```$/ { exit } on' "$here/../../$1"; }
mkdir "$work/pages"
block README.md cpp >"$work/pages/readme.cpp"
block docs/development.md cpp >"$work/pages/development.cpp"
{
  block docs/walkthroughs/embedding.md cpp
  echo 'int main() { return mesh_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}).triangles.size() != 8; }'
} >"$work/pages/embedding.cpp"
{
  printf '#include <eigencrust_c.h>\n#include <stdio.h>\n\nint main(void) {\n'
  printf 'const size_t count = 6;\nconst double points[] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};\n'
  block docs/development.md c
  printf 'printf("%%zu triangles\\n", eigencrust_result_triangle_count(result));\neigencrust_result_free(result);\nreturn 0;\n}\n'
} >"$work/pages/in_c.c"

cmake -S "$here" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/installed here" -DPAGES="$work/pages" \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release
cmake --build "$work/build"
"$work/build/consumer" "$work/sphere.ply" "$work/sphere.png"
"$work/build/method"
"$work/build/c_program"
(cd "$work" && cp sphere.ply scan.ply && build/readme && cmp -n 3 mesh.ply scan.ply)
"$work/build/development" "$work/scan.ply" "$work/smooth.ply" | grep -q 'triangles, genus 0'
"$work/build/embedding"
"$work/build/in_c" | grep -qx '8 triangles'
if ldd "$work/build/method" | grep -E 'libpng|libcrypto|libpugixml|libtinygltf|lib3MF|libz\.'; then
  echo "run.sh: the method alone asks for these"
  exit 1
fi

# Shared libraries in a folder that the system does not know.
shared=$(find "$work/installed here" -name 'libeigencrust.so')
[ -z "$shared" ] || export LD_LIBRARY_PATH=${shared%/*}

# The same without CMake, as pkg-config says.
if command -v pkg-config >/dev/null; then
  export PKG_CONFIG_PATH
  PKG_CONFIG_PATH=$(dirname "$(find "$work/installed here" -name eigencrust.pc)")
  static=--static
  [ -z "$shared" ] || static=
  # The folder's name holds a blank, which pkg-config escapes: hence eval.
  eval "$compiler -x c++ -std=c++20 $here/method.cpp -x none -o $work/by_pkg_config $(pkg-config --cflags --libs $static eigencrust)"
  "$work/by_pkg_config"
fi

# The program takes the bundled scan from beside itself.
cd "$work"
"$work/installed here/bin/eigencrust" check sphere.ply
"$work/installed here/bin/eigencrust" demo -o demo >demo.log
[ ! -e "$work/installed here/bin/eigencrust-scan" ] || "$work/installed here/bin/eigencrust-scan" --help >scan.log
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
