// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pictures as files: what render and info share.
#pragma once

#include <string>
#include <vector>

#include <eigencrust/render.h>

namespace eigencrust::cli {

/// \throws Error{usage} unless the name ends in .png or is standard output; Error{input} where it cannot be written
void check_picture(const std::string& path);

/// Pictures of `objects` objects, `views` of the first, then those of the second ..., as one. One object: its views in
/// one or two rows. Several: side by side, a row for each view.
void write_picture(const std::string& path, const std::vector<Image>& pictures, std::size_t objects, std::size_t views);

} // namespace eigencrust::cli
