#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The packages that Eigencrust is made with, as an SBOM in the form CycloneDX 1.4 (JSON): those of scripts/packages.sh
# with the versions that are installed here. Usage: scripts/sbom.sh [FILE, standard output by default]
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/packages.sh"

version=$(sed -n 's/^project(eigencrust VERSION \([0-9.]*\).*/\1/p' "$repository/CMakeLists.txt")
[ -n "$version" ] || fail "CMakeLists.txt tells no version"

component() { # PACKAGE SCOPE
  local found architecture source
  found=$(dpkg-query --show --showformat='${Version}' "$1" 2>/dev/null) || found=unknown
  architecture=$(dpkg-query --show --showformat='${Architecture}' "$1" 2>/dev/null) || architecture=any
  source=$(dpkg-query --show --showformat='${source:Package}' "$1" 2>/dev/null) || source=$1
  printf '    {"type": "library", "name": "%s", "version": "%s", "scope": "%s", ' "$1" "$found" "$2"
  printf '"purl": "pkg:deb/debian/%s@%s?arch=%s", ' "$1" "$found" "$architecture"
  printf '"properties": [{"name": "debian:source", "value": "%s"}]}' "$source"
}

print() {
  printf '{\n  "bomFormat": "CycloneDX",\n  "specVersion": "1.4",\n  "version": 1,\n'
  printf '  "metadata": {"component": {"type": "application", "name": "eigencrust", "version": "%s", ' "$version"
  printf '"licenses": [{"license": {"id": "GPL-3.0-or-later"}}]}},\n  "components": [\n'
  local first=1 package
  for package in "${build_packages[@]}"; do
    [ "$first" -eq 1 ] || printf ',\n'
    first=0
    component "$package" required
  done
  for package in "${test_packages[@]}" "${fuzz_packages[@]}"; do
    printf ',\n'
    component "$package" excluded
  done
  printf '\n  ]\n}\n'
}

if [ $# -gt 0 ]; then print >"$1"; else print; fi
