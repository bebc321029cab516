// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The digest that tells in a report which file was read.
#pragma once

#include <string>

#include "io/file_content.h"

namespace eigencrust::io {

/// As sha256_of_file() in io.h.
std::string sha256_of(const FileContent& file);

} // namespace eigencrust::io
