// SPDX-License-Identifier: GPL-3.0-or-later
// The part of TOML 1.0 (toml.io) that options need: tables by name, bare or quoted keys, strings of one line, numbers,
// truth values and arrays of them.
#include "config_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>

#include "unknown_option.h"
#include "verbs.h"

namespace eigencrust::cli {
namespace {

struct Entry {
  std::string verb; ///< of the table it stands in; empty: for all
  std::string key;
  std::vector<std::string> values;
  bool is_array = false, is_text = false;
  std::size_t line = 0;
};

class TomlReader {
 public:
  TomlReader(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {}

  std::vector<Entry> read() {
    std::vector<Entry> entries;
    std::string verb;
    for (skip(); at_ < text_.size(); skip()) {
      if (text_[at_] == '[') {
        verb = read_table();
      } else {
        Entry entry = read_entry();
        entry.verb = verb;
        entries.push_back(std::move(entry));
      }
      expect_line_end();
    }
    return entries;
  }

  [[noreturn]] void fail(const std::string& cause, const std::string& remedy, std::size_t line = 0) const {
    throw Error(ErrorKind::input, path_ + ":" + std::to_string(line > 0 ? line : line_), cause, remedy);
  }

 private:
  [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_blanks() {
    while (peek() == ' ' || peek() == '\t' || peek() == '\r') ++at_;
  }
  /// Blanks, comments and line ends.
  void skip() {
    for (;; ++at_) {
      skip_blanks();
      if (peek() == '#')
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
      if (peek() != '\n') return;
      ++line_;
    }
  }
  void expect_line_end() {
    skip_blanks();
    if (at_ < text_.size() && peek() != '\n' && peek() != '#')
      fail("something follows the value", "write one option per line, and texts between quotation marks");
  }

  std::string read_table() {
    ++at_;
    skip_blanks();
    std::string name = read_key();
    skip_blanks();
    if (peek() != ']') fail("the table's name does not end in ]", "write [reconstruct] or another verb");
    ++at_;
    const Verb* verb = find_verb(name);
    if (verb == nullptr) fail("the table [" + name + "] is no verb", "write [reconstruct], or leave it out");
    return verb->alias_of != nullptr ? verb->alias_of : verb->name;
  }

  Entry read_entry() {
    Entry entry;
    entry.line = line_;
    entry.key = read_key();
    skip_blanks();
    if (peek() != '=') fail("there is no = behind '" + entry.key + "'", "write option = value");
    ++at_;
    skip_blanks();
    entry.is_array = peek() == '[';
    entry.is_text = peek() == '"' || peek() == '\'';
    if (!entry.is_array) {
      entry.values.push_back(read_value());
      return entry;
    }
    ++at_;
    for (skip(); peek() != ']'; skip()) {
      entry.values.push_back(read_value());
      skip();
      if (peek() == ',')
        ++at_;
      else if (peek() != ']')
        fail("the array does not go on with a comma or end in ]", "write [1, 2, 3]");
    }
    ++at_;
    return entry;
  }

  std::string read_key() {
    if (peek() == '"' || peek() == '\'') return read_text();
    const std::size_t begin = at_;
    while (std::isalnum(static_cast<unsigned char>(peek())) != 0 || peek() == '-' || peek() == '_') ++at_;
    if (at_ == begin) fail("an option's name was expected", "write option = value");
    return text_.substr(begin, at_ - begin);
  }

  std::string read_value() {
    if (peek() == '"' || peek() == '\'') return read_text();
    const std::size_t begin = at_;
    while (std::isalnum(static_cast<unsigned char>(peek())) != 0 || (peek() != '\0' && std::strchr("+-._", peek())))
      ++at_;
    std::string word = text_.substr(begin, at_ - begin);
    if (word == "true" || word == "false") return word;
    std::erase(word, '_');
    const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
    double number = 0;
    const auto [end, error] = std::from_chars(first, word.data() + word.size(), number);
    if (word.empty() || error != std::errc{} || end != word.data() + word.size())
      fail("'" + text_.substr(begin, text_.find_first_of("\n#", begin) - begin) + "' is no number, true or false",
           "put texts between quotation marks");
    return word;
  }

  std::string read_text() {
    const char quote = text_[at_++];
    std::string text;
    for (; peek() != quote; ++at_) {
      if (at_ >= text_.size() || peek() == '\n') fail("the text does not end", "close the quotation mark on its line");
      if (quote == '"' && peek() == '\\') {
        constexpr std::string_view letters = "\"\\tn";
        constexpr std::string_view meanings = "\"\\\t\n";
        ++at_;
        const std::size_t which = letters.find(peek());
        if (which == std::string_view::npos)
          fail(R"(only \\, \", \t and \n are known behind a backslash)", "write 'text' for names with backslashes");
        text += meanings[which];
      } else {
        text += peek();
      }
    }
    ++at_;
    return text;
  }

  std::string path_, text_;
  std::size_t at_ = 0, line_ = 1;
};

std::vector<Entry> read_config(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw Error(ErrorKind::input, path, "the file of options cannot be read", "check the name after --config");
  return TomlReader(path, {std::istreambuf_iterator<char>(file), {}}).read();
}

std::string option_of(const Entry& entry) {
  std::string name = entry.key;
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

const Option* first_positional(const OptionTable& table) {
  for (const auto& option : table.options())
    if (option->is_positional()) return option.get();
  return nullptr;
}

/// The words that say the same.
void append_words(const OptionTable& table, const Entry& entry, const std::string& path,
                  std::vector<std::string>& words) {
  if (entry.key == "input") {
    words.insert(words.end(), entry.values.begin(), entry.values.end());
    return;
  }
  const std::string name = option_of(entry), place = path + ":" + std::to_string(entry.line);
  const Option* option = table.find(name);
  if (option == nullptr || (option->chapter() == help_chapter))
    throw Error(ErrorKind::usage, place, "unknown option " + entry.key, remedy_for_unknown(table, name));
  if (option->takes_value()) {
    for (const std::string& value : entry.values) words.push_back(name + "=" + value);
    return;
  }
  if (entry.is_array || entry.is_text || (entry.values[0] != "true" && entry.values[0] != "false"))
    throw Error(ErrorKind::usage, place, entry.key + " takes no value", "write " + entry.key + " = true");
  const std::string off = "--no-" + name.substr(2);
  if (entry.values[0] == "true")
    words.push_back(name);
  else if (option->has_name(off))
    words.push_back(off);
}

} // namespace

std::vector<std::string> with_config(const OptionTable& table, const std::vector<std::string>& words) {
  const std::vector<Given> given = table.scan(words);
  std::vector<std::string> paths, from_files, result;
  for (const Given& g : given)
    if (g.name == "--config") paths.push_back(g.value);
  if (paths.empty()) return words;
  const auto is_given = [&](const Option* option) {
    return std::any_of(given.begin(), given.end(), [&](const Given& g) { return g.option == option; });
  };
  const std::string verb = table.name().substr(table.name().rfind(' ') + 1);
  for (const std::string& path : paths)
    for (const Entry& entry : read_config(path)) {
      if (!entry.verb.empty() && entry.verb != verb) continue;
      const Option* option = entry.key == "input" ? first_positional(table) : table.find(option_of(entry));
      // One file may serve several verbs, each of which takes what it knows.
      if (option == nullptr && entry.verb.empty() && entry.key != "input" && !verb_that_knows(option_of(entry)).empty())
        continue;
      if (option == nullptr || option->chapter() == help_chapter || !is_given(option))
        append_words(table, entry, path, from_files);
    }
  result = from_files;
  bool only_files = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    only_files = only_files || words[i] == "--";
    if (!only_files && words[i] == "--config")
      ++i;
    else if (only_files || !words[i].starts_with("--config="))
      result.push_back(words[i]);
  }
  return result;
}

} // namespace eigencrust::cli
