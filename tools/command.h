// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the small commands share: reading values, reporting errors, exit status.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <eigencrust/types.h>

namespace CLI {
class App;
}

namespace eigencrust::tools {

/// Parses the command line and calls `work`. Errors go to stderr as `NAME: error: ...`.
/// \returns the exit status: 0, or the value of the ErrorKind
int run_command(CLI::App& app, int argc, char** argv, const std::function<void()>& work);

/// "x,y,z". \throws Error{usage} naming the option
Vec3 parse_vector(const std::string& text, const std::string& option);

/// A number; with %, that share of `whole`. \throws Error{usage}
double parse_length(const std::string& text, double whole, const std::string& option);

/// Numbers separated by `separator`. \throws Error{usage} unless there are at_least to at_most of them
std::vector<double> parse_numbers(const std::string& text, char separator, std::size_t at_least, std::size_t at_most,
                                  const std::string& option);

/// A mesh, or for .txt and .bpt the tessellation of Bézier patches. \throws Error{input}
TriangleMesh read_surface(const std::filesystem::path& path, std::uint32_t subdivisions);

} // namespace eigencrust::tools
