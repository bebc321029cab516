// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Nothing that is read is ever written. What an option does with the file it names is said in the option's own entry,
/// as the type of its value; all lists follow from that.
#pragma once

#include <string>
#include <vector>

namespace eigencrust::cli {

// The types of values that are paths, as --help shows them.
inline constexpr const char* file_to_read = "FILE";
inline constexpr const char* shape_or_file = "SHAPE";
inline constexpr const char* file_to_write = "OUTPUT";
/// Files that begin with two digits and an underscore appear in it.
inline constexpr const char* folder_to_write = "FOLDER";

struct NamedFiles {
  std::vector<std::string> read, written, folders; ///< folders into which stages are written
};

/// Compares all that is named for reading, and what is read beside it, with all that is named for writing, after links
/// were followed. \throws Error{usage} where one would be the other, where two outputs would be one file, and where an
/// output's links go round in a circle or its name is too long
void check_files(const NamedFiles& named);

} // namespace eigencrust::cli
