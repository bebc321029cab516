// SPDX-License-Identifier: GPL-3.0-or-later
#include "help.h"

#include <algorithm>
#include <array>

namespace eigencrust::cli {
namespace {

/// The ten that --help shows of a verb with many.
constexpr std::array<std::string_view, 12> everyday{"--output", "--report",     "--columns", "--crop",
                                                    "--thin",   "--sensor",     "--noise",   "--trim",
                                                    "--smooth", "--components", "--keep",    "--drop-outliers"};
constexpr std::size_t few = 17; ///< options that are shown all at once

OptionText text_of(const Option& option) {
  OptionText text;
  text.names = option.names();
  text.positional = option.is_positional();
  if (!text.positional && option.takes_value()) text.value = option.value_name();
  text.choices = option.choices();
  text.meaning = option.meaning();
  if (!option.standard().empty() && !text.meaning.ends_with(']'))
    text.meaning.append(" [").append(option.standard()).append("]");
  text.chapter = option.chapter();
  for (const std::string& name : text.names)
    text.everyday =
        text.everyday || std::find(everyday.begin(), everyday.end(), std::string_view(name)) != everyday.end();
  return text;
}

std::string left_column(const OptionText& option) {
  std::string left = "  ";
  for (std::size_t i = 0; i < option.names.size(); ++i) left += (i == 0 ? "" : ", ") + option.names[i];
  if (!option.value.empty()) left.append(" ").append(option.value);
  return left;
}

void append_option(std::string& text, const OptionText& option) {
  constexpr std::size_t column = 28, width = 100;
  std::string line = left_column(option);
  if (line.size() + 2 > column)
    text.append(line).append("\n").append(column, ' ');
  else
    text += line + std::string(column - line.size(), ' ');
  text += wrapped(option.meaning, width - column, column) + "\n";
}

} // namespace

std::string wrapped(const std::string& text, std::size_t width, std::size_t indent) {
  const std::size_t bracket = text.ends_with(']') ? text.rfind('[') : std::string::npos;
  std::string result;
  std::size_t column = 0, at = 0;
  while (at < text.size()) {
    std::size_t end = at >= bracket ? text.size() : std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (column > 0 && column + 1 + word.size() > width) {
      result.append("\n").append(indent, ' ');
      column = 0;
    }
    result += (column > 0 ? " " : "") + word;
    column += word.size() + (column > 0 ? 1 : 0);
    at = end + 1;
  }
  return result;
}

std::vector<OptionText> option_texts(const OptionTable& table) {
  std::vector<OptionText> texts;
  for (const auto& option : table.options()) texts.push_back(text_of(*option));
  return texts;
}

std::string help_text(const OptionTable& table, bool all) {
  const std::vector<OptionText> options = option_texts(table);
  const auto is_option = [](const OptionText& o) { return !o.positional; };
  const auto count = static_cast<std::size_t>(std::count_if(options.begin(), options.end(), is_option));
  const bool shortened = !all && count > few;
  std::string text = wrapped(table.description(), 100, 0) + "\n\nUsage: " + usage_line(table) + "\n\n";
  for (const OptionText& option : options)
    if (option.positional) append_option(text, option);
  if (shortened) {
    text += "\nOptions of every day:\n";
    for (const OptionText& option : options)
      if (!option.positional && option.everyday) append_option(text, option);
    return text + "\nAll " + std::to_string(count) + " options, by chapter: " + table.name() + " --help-all\n";
  }
  std::vector<std::string> chapters;
  for (const OptionText& option : options)
    if (!option.positional && std::find(chapters.begin(), chapters.end(), option.chapter) == chapters.end())
      chapters.push_back(option.chapter);
  for (const std::string& chapter : chapters) {
    text.append("\n").append(chapter).append(":\n");
    for (const OptionText& option : options)
      if (!option.positional && option.chapter == chapter) append_option(text, option);
  }
  return text;
}

} // namespace eigencrust::cli
