// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Options as text: numbers there and back, and one way to refuse.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace eigencrust {

/// \throws Error{usage}
[[noreturn]] void reject_value(const std::string& what, const std::string& text, const std::string& accepted);

/// The whole text as a finite number; a plus sign may precede it.
std::optional<double> number_in(std::string_view text);
/// The whole text as a number of things.
std::optional<std::uint32_t> count_in(std::string_view text);
/// The fewest digits that read back as the same number: 1e-8, 0.25.
std::string shortest(double value);

} // namespace eigencrust
