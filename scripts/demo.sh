#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the command and reconstructs the bundled scan. Usage: scripts/demo.sh [FOLDER, default demo_out]
set -euo pipefail
repository=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)

bash "$repository/scripts/build.sh"
exec "$repository/build/eigencrust" demo -o "${1:-$repository/demo_out}"
