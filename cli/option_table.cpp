// SPDX-License-Identifier: GPL-3.0-or-later
#include "option_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <set>

#include <eigencrust/error.h>

#include "unknown_option.h"

namespace eigencrust::cli {
namespace {

[[noreturn]] void fail(const std::string& cause, const std::string& remedy) {
  throw Error(ErrorKind::usage, "command line", cause, remedy);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

template <class Number>
Number number(const std::string& name, const std::string& text) {
  Number value{};
  const char* begin = text.data() + (text.size() > 1 && text[0] == '+' ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    fail(name + ": '" + text + "' is no number" + (std::is_integral_v<Number> ? " that counts" : ""),
         std::is_integral_v<Number> ? "give a number: 0, 1, 2 ..." : "give a number such as 0.5");
  return value;
}

std::string shown(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// `--name` or `-n` at the beginning of a word; empty: it is a value or a file.
std::string name_in(const std::string& word) {
  const auto is_letter = [&](std::size_t i) {
    return i < word.size() && std::isalpha(static_cast<unsigned char>(word[i])) != 0;
  };
  if (word.starts_with("--") && is_letter(2)) return word.substr(0, word.find('='));
  return word.starts_with("-") && is_letter(1) ? word.substr(0, 2) : std::string();
}

struct Set {
  const std::string &name, &value;

  void operator()(bool*) const {}
  void operator()(std::string* target) const { *target = value; }
  void operator()(std::optional<std::string>* target) const { *target = value; }
  void operator()(std::vector<std::string>* target) const { target->push_back(value); }
  template <class Number>
  void operator()(Number* target) const {
    *target = number<Number>(name, value);
  }
  template <class Number>
  void operator()(std::optional<Number>* target) const {
    *target = number<Number>(name, value);
  }
};

struct Show {
  std::string operator()(const std::string* target) const { return *target; }
  std::string operator()(const double* target) const { return shown(*target); }
  std::string operator()(const std::uint32_t* target) const { return std::to_string(*target); }
  std::string operator()(const std::uint64_t* target) const { return std::to_string(*target); }
  template <class Other>
  std::string operator()(const Other*) const {
    return {};
  }
};

/// N for whole numbers, X for others.
struct NameOfValue {
  std::string operator()(const bool*) const { return {}; }
  std::string operator()(const std::string*) const { return "TEXT"; }
  std::string operator()(const std::optional<std::string>*) const { return "TEXT"; }
  std::string operator()(const std::vector<std::string>*) const { return "TEXT"; }
  std::string operator()(const double*) const { return "X"; }
  std::string operator()(const std::optional<double>*) const { return "X"; }
  template <class Whole>
  std::string operator()(const Whole*) const {
    return "N";
  }
};

} // namespace

Option::Option(std::vector<std::string> names, Target target, std::string meaning, std::string chapter)
    : names_(std::move(names)), target_(target), meaning_(std::move(meaning)), chapter_(std::move(chapter)) {
  for (std::string& name : names_) {
    if (!name.starts_with('!')) continue;
    name.erase(0, 1);
    negated_.push_back(name);
  }
  value_name_ = std::visit(NameOfValue{}, target_);
}

Option* Option::required() {
  required_ = true;
  return this;
}
Option* Option::type_name(std::string name) {
  value_name_ = std::move(name);
  return this;
}
Option* Option::usually_of(std::vector<std::string> values) {
  choices_ = std::move(values);
  value_name_.clear();
  for (const std::string& choice : choices_) value_name_ += (value_name_.empty() ? "{" : ",") + choice;
  value_name_ += '}';
  return this;
}
Option* Option::one_of(std::vector<std::string> choices) {
  strict_ = true;
  return usually_of(std::move(choices));
}
Option* Option::capture_default_str() {
  standard_ = std::visit(Show{}, target_);
  return this;
}
Option* Option::delimiter(char separator) {
  delimiter_ = separator;
  return this;
}

bool Option::has_name(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

void Option::set(const std::string& name, const std::string& value) const {
  if (bool* const* flag = std::get_if<bool*>(&target_)) {
    **flag = std::find(negated_.begin(), negated_.end(), name) == negated_.end();
    return;
  }
  for (const std::string& part : delimiter_ == '\0' ? std::vector{value} : split(value, delimiter_)) {
    if (strict_ && std::find(choices_.begin(), choices_.end(), part) == choices_.end())
      fail(name + ": '" + part + "' is none of " + joined(choices_), "choose one of those");
    std::visit(Set{name, part}, target_);
  }
}

Option* OptionTable::add(const std::string& names, Target target, const std::string& meaning) {
  options_.push_back(std::make_unique<Option>(split(names, ','), target, meaning, chapter_));
  return options_.back().get();
}

Option* OptionTable::find(const std::string& name) const {
  for (const auto& option : options_)
    if (option->has_name(name)) return option.get();
  return nullptr;
}

const Option* OptionTable::positional(std::size_t place) const {
  for (const auto& option : options_) {
    if (!option->is_positional()) continue;
    if (place == 0 || option->is_list()) return option.get();
    --place;
  }
  return nullptr;
}

std::vector<Given> OptionTable::scan(const std::vector<std::string>& words) const {
  std::vector<Given> given;
  bool only_files = false;
  std::size_t files = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--" && !only_files) {
      only_files = true;
      continue;
    }
    const std::string name = only_files ? std::string() : name_in(word);
    if (name.empty()) {
      const Option* file = positional(files++);
      if (file == nullptr) fail("nothing takes the word '" + word + "'", "write " + usage_line(*this));
      given.push_back({file, file->name(), word});
      continue;
    }
    const Option* option = find(name);
    if (option == nullptr) fail("unknown option " + name, remedy_for_unknown(*this, name));
    std::string value = word.substr(name.size());
    if (!option->takes_value()) {
      if (!value.empty()) fail(name + " takes no value, but there is '" + value + "'", "write " + name + " alone");
    } else if (!value.empty()) {
      if (value[0] == '=') value.erase(0, 1);
    } else if (i + 1 < words.size()) {
      value = words[++i]; // whatever it looks like
    } else {
      fail(name + " has no value behind it", "give " + name + " one value, for example after =");
    }
    given.push_back({option, name, std::move(value)});
  }
  return given;
}

void OptionTable::set(const std::vector<Given>& given) const {
  std::set<const Option*> seen;
  for (const Given& g : given) {
    if (!seen.insert(g.option).second && g.option->takes_value() && !g.option->is_list())
      fail(g.name + " is there twice", "give " + g.name + " one value, once");
    g.option->set(g.name, g.value);
  }
  for (const auto& option : options_) {
    if (!option->is_required() || seen.count(option.get()) > 0) continue;
    if (option->name() == "--output")
      fail("nothing says where the result goes: -o, --output is missing", "add -o and the name of a file");
    fail(option->name() + " is missing", "write " + usage_line(*this));
  }
}

std::string usage_line(const OptionTable& table) {
  std::string line = table.name();
  for (const auto& option : table.options()) {
    if (!option->is_positional()) continue;
    const std::string text = option->name() + (option->is_list() ? "..." : "");
    line += option->is_required() ? " " + text : " [" + text + "]";
  }
  return line + " [options]";
}

} // namespace eigencrust::cli
