// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Named numbers, and what is asked of them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace eigencrust::bench {

/// Figures of one run in the order in which they were measured.
class Figures {
 public:
  void set(std::string name, double value) { values_.emplace_back(std::move(name), value); }
  [[nodiscard]] std::optional<double> find(std::string_view name) const;
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& all() const { return values_; }

 private:
  std::vector<std::pair<std::string, double>> values_;
};

enum class Relation : std::uint8_t { equal, at_most, at_least };

/// What a case must show, as data.
struct Requirement {
  std::string figure;
  Relation relation = Relation::equal;
  double bound = 0;

  [[nodiscard]] bool met(const Figures& figures) const; ///< never without the figure
};

/// "components = 1", "true_samples_kept >= 0.99".
std::string describe(const Requirement& requirement);

/// The requirements that are not met, each with the value: "components = 1 (is 3)".
std::vector<std::string> missed(const std::vector<Requirement>& requirements, const Figures& figures);

/// Up to four significant digits; whole numbers as such.
std::string short_number(double value);

} // namespace eigencrust::bench
