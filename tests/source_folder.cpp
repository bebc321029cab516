// SPDX-License-Identifier: GPL-3.0-or-later
#include "source_folder.h"

namespace eigencrust {

std::filesystem::path source_folder() { return EIGENCRUST_SOURCE_DIR; }

} // namespace eigencrust
