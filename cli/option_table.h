// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of a verb's options: declared once, and all that is said of them made from it: parsing, help, manual page,
/// completions, files of options.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace eigencrust::cli {

/// What an option sets. Lists grow by one each time the option is named.
using Target = std::variant<bool*, std::string*, std::vector<std::string>*, std::uint32_t*, std::uint64_t*, double*,
                            std::optional<std::string>*, std::optional<std::uint32_t>*, std::optional<double>*>;

/// One option, or one of the words without a name.
class Option {
 public:
  Option(std::vector<std::string> names, Target target, std::string meaning, std::string chapter);

  // To be called after add_option(), one behind the other.
  Option* required();
  Option* type_name(std::string name);                 ///< of the value: FILE, L, X,Y,Z
  Option* one_of(std::vector<std::string> choices);    ///< no other value is accepted
  Option* usually_of(std::vector<std::string> values); ///< shown as one_of, but another part of the program judges
  Option* capture_default_str();                       ///< the target's value is shown
  Option* delimiter(char separator);                   ///< of values of a list in one word

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; } ///< "-o", "--output" or "INPUT"
  /// The longest of them.
  [[nodiscard]] const std::string& name() const { return names_.back(); }
  [[nodiscard]] bool has_name(const std::string& name) const;
  [[nodiscard]] bool is_positional() const { return names_[0][0] != '-'; }
  [[nodiscard]] bool takes_value() const { return !std::holds_alternative<bool*>(target_); }
  [[nodiscard]] bool is_list() const { return std::holds_alternative<std::vector<std::string>*>(target_); }
  [[nodiscard]] bool is_required() const { return required_; }
  [[nodiscard]] const std::string& value_name() const { return value_name_; }
  [[nodiscard]] const std::vector<std::string>& choices() const { return choices_; }
  [[nodiscard]] const std::string& standard() const { return standard_; } ///< the default as text; empty: not shown
  [[nodiscard]] const std::string& meaning() const { return meaning_; }
  [[nodiscard]] const std::string& chapter() const { return chapter_; }

  /// \param name as it was written; those of flags that begin with --no- may turn it off
  /// \throws Error{usage} for a value that is none
  void set(const std::string& name, const std::string& value) const;

 private:
  std::vector<std::string> names_, choices_;
  Target target_;
  std::string meaning_, chapter_, value_name_, standard_;
  std::vector<std::string> negated_; ///< names that turn a flag off
  bool required_ = false, strict_ = false;
  char delimiter_ = '\0';
};

/// What the words of a command line say, before it is done.
struct Given {
  const Option* option = nullptr;
  std::string name, value;
};

class OptionTable {
 public:
  /// \param name "eigencrust render"
  OptionTable(std::string description, std::string name)
      : description_(std::move(description)), name_(std::move(name)) {}
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;

  /// \param names "-o,--output"; "--manifold,!--no-manifold": the second turns the flag off; "INPUT": words without a
  /// name, of which the last one declared may be a list. The pointer stays good as long as the table.
  template <class T>
  Option* add_option(const std::string& names, T& target, const std::string& meaning) {
    return add(names, &target, meaning);
  }
  Option* add_flag(const std::string& names, bool& target, const std::string& meaning) {
    return add(names, &target, meaning);
  }
  /// Options declared from here on belong to it.
  void begin_chapter(std::string name) { chapter_ = std::move(name); }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& description() const { return description_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Option>>& options() const { return options_; }
  /// null: there is none of that name
  [[nodiscard]] Option* find(const std::string& name) const;

  /// Tells options from their values and from files. \throws Error{usage} for options that are not in the table
  [[nodiscard]] std::vector<Given> scan(const std::vector<std::string>& words) const;
  /// Sets the targets. \throws Error{usage} for values that are none, what is missing, or named twice
  void set(const std::vector<Given>& given) const;

 private:
  Option* add(const std::string& names, Target target, const std::string& meaning);
  [[nodiscard]] const Option* positional(std::size_t place) const;

  std::string description_, name_, chapter_ = "Options";
  std::vector<std::unique_ptr<Option>> options_;
};

/// "eigencrust info INPUT... [options]"
std::string usage_line(const OptionTable& table);

} // namespace eigencrust::cli
