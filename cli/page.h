// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reports that are pages.
#pragma once

#include <string>

namespace eigencrust::cli {

/// Does a report of this name get a page instead of JSON: does it end in .html or .htm?
bool is_page(const std::string& path);

/// The viewer that pages are made of. \throws Error{usage} saying how to get it where it was not built
std::string read_viewer(const std::string& page);

} // namespace eigencrust::cli
