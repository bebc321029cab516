// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iostream>
#include <new>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "bezier_patches.h"

namespace eigencrust::tools {
namespace {

double parse_number(std::string_view text, const std::string& option) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || after != end || !std::isfinite(value))
    throw Error(ErrorKind::usage, option, "'" + std::string(text) + "' is not a number", "give a decimal number");
  return value;
}

} // namespace

int run_command(CLI::App& app, int argc, char** argv, const std::function<void()>& work) {
  const auto fail = [&app](const std::string& message, ErrorKind kind) {
    std::cerr << app.get_name() << ": error: " << message << "\n";
    return static_cast<int>(kind);
  };
  try {
    app.parse(argc, argv);
    work();
    return 0;
  } catch (const CLI::Success& e) {
    return app.exit(e); // --help
  } catch (const CLI::ParseError& e) {
    return fail(std::string(e.what()) + "; see --help", ErrorKind::usage);
  } catch (const Error& e) {
    return fail(e.what(), e.kind());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; ask for fewer rays or subdivisions", ErrorKind::memory);
  }
}

std::vector<double> parse_numbers(const std::string& text, char separator, std::size_t at_least, std::size_t at_most,
                                  const std::string& option) {
  std::vector<double> numbers;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    numbers.push_back(parse_number(std::string_view(text).substr(begin, end - begin), option));
    if (end == text.size()) break;
    begin = end + 1;
  }
  if (numbers.size() < at_least || numbers.size() > at_most)
    throw Error(ErrorKind::usage, option, "'" + text + "' has the wrong number of values", "see --help");
  return numbers;
}

Vec3 parse_vector(const std::string& text, const std::string& option) {
  const std::vector<double> v = parse_numbers(text, ',', 3, 3, option);
  return {v[0], v[1], v[2]};
}

double parse_length(const std::string& text, double whole, const std::string& option) {
  if (!text.empty() && text.back() == '%')
    return 0.01 * whole * parse_number(std::string_view(text).substr(0, text.size() - 1), option);
  return parse_number(text, option);
}

TriangleMesh read_surface(const std::filesystem::path& path, std::uint32_t subdivisions) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".txt" || extension == ".bpt") return tessellate(read_bezier_patches(path), subdivisions);
  return read_mesh(path);
}

} // namespace eigencrust::tools
