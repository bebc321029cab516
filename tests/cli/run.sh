#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs one case of a group in a fresh folder of its own. Bash, awk and coreutils are all it needs.
# Usage: run.sh PROGRAM PROBE GROUP.sh CASE. Status 77: skipped.
set -euEo pipefail
program=$1 probe=$2 group=$3 case=$4
tests=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
repository=$(cd -- "$tests/../.." && pwd)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'echo "failed: line $LINENO of ${BASH_SOURCE[0]##*/}: $BASH_COMMAND"' ERR
cd "$work"
source "$tests/harness.sh"
source "$tests/$group"
"$case"
