#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the documentation as one site, without a network: the Markdown pages, the C++ and C interfaces (Doxygen), and the
# Python reference from the built package's docstrings and types. Fails where something public has no description, and
# where a link inside the site leads nowhere. Apart from scripts/test.sh, for the Python package must be built.
# Usage: scripts/docs.sh [folder for the site [build folder with the Python package]]; build-docs and build-python
# without, where the package is then built as scripts/test_python.sh does
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

site=$(realpath -m -- "${1:-$repository/build-docs}")
build=$(realpath -m -- "${2:-$repository/build-python}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
install_packages doxygen python3-markdown
if [ $# -lt 2 ]; then
  install_packages "${build_packages[@]}" "${test_packages[@]}" "${python_packages[@]}"
  configure test build-python -DEIGENCRUST_BUILD_PYTHON=ON
  cmake --build "$build" --parallel "$(job_count)" --target eigencrust_python_package
fi
[ -f "$build/python/eigencrust/__init__.py" ] || fail "there is no Python package in $build"
version=$(sed -n 's/^project(eigencrust VERSION \([0-9.]*\).*/\1/p' "$repository/CMakeLists.txt")

rm -rf "$site.new"
mkdir -p "$site.new"
cat >"$work/main.md" <<END
# C++ and C {#mainpage}
The headers under \`eigencrust/\` are the library in C++: eigencrust.h has \`reconstruct()\`, stages.h every step of the
method, io.h files, render.h pictures. eigencrust_c.h is the same for C.
<a href="../index.html">All documentation</a>
END
cd "$repository"
doxygen - >"$work/doxygen.log" 2>&1 <<END
PROJECT_NAME = Eigencrust
PROJECT_NUMBER = $version
INPUT = include $work/main.md
USE_MDFILE_AS_MAINPAGE = $work/main.md
FILE_PATTERNS = *.h *.md
RECURSIVE = YES
OUTPUT_DIRECTORY = "$site.new"
HTML_OUTPUT = api
HTML_TIMESTAMP = NO
GENERATE_LATEX = NO
QUIET = YES
JAVADOC_AUTOBRIEF = YES
DISTRIBUTE_GROUP_DOC = YES
HIDE_UNDOC_RELATIONS = NO
WARN_IF_INCOMPLETE_DOC = NO
SORT_MEMBER_DOCS = NO
STRIP_FROM_PATH = "$repository/include"
STRIP_FROM_INC_PATH = include
INPUT_FILTER = "/usr/bin/python3 scripts/docs/split_declarations.py"
HAVE_DOT = NO
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = EIGENCRUST_C_API= __GNUC__ __cplusplus
END
if [ -s "$work/doxygen.log" ]; then
  cat "$work/doxygen.log" >&2
  fail "Doxygen has $(grep -c 'warning:' "$work/doxygen.log") warnings; describe what it names"
fi
PYTHONPATH=$build/python PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 scripts/docs/make_site.py "$site.new" "$version"
/usr/bin/python3 scripts/docs/check_links.py "$site.new"
rm -rf "$site"
mv "$site.new" "$site"
printf 'Documentation: %s/index.html\n' "$site"
