// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/values.h"

#include <array>
#include <charconv>
#include <cmath>

#include <eigencrust/error.h>

namespace eigencrust {

void reject_value(const std::string& what, const std::string& text, const std::string& accepted) {
  throw Error(ErrorKind::usage, "options", "'" + text + "' is no " + what, "use " + accepted);
}

std::optional<double> number_in(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::uint32_t> count_in(std::string_view text) {
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return count;
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  std::string text(buffer.data(), end);
  // to_chars gives an exponent two digits at least: 1e-08.
  const std::size_t exponent = text.find_first_of("0123456789", text.find('e'));
  if (text.find('e') != std::string::npos && text[exponent] == '0') text.erase(exponent, 1);
  return text;
}

} // namespace eigencrust
