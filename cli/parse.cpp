// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iostream>

#include "command.h"
#include "config_file.h"
#include "help.h"

namespace eigencrust::cli {
namespace {

/// What an option does with a file is said by the type of its value. A shape may be a file, too.
NamedFiles files_of(const std::vector<Given>& given) {
  NamedFiles files;
  for (const auto& [option, name, value] : given) {
    const std::string& type = option->value_name();
    if (type == file_to_read || type == shape_or_file) files.read.push_back(value);
    if (type == file_to_write) files.written.push_back(value);
    if (type == folder_to_write) files.folders.push_back(value);
  }
  return files;
}

} // namespace

Parsed parse(OptionTable& table, const Arguments& arguments) {
  bool help = false, help_all = false;
  std::vector<std::string> configs;
  table.begin_chapter(help_chapter);
  table.add_flag("-h,--help", help, "Print the options of every day");
  table.add_flag("--help-all", help_all, "Print all options by chapter");
  table
      .add_option("--config", configs,
                  "Take options from a TOML file: option = value; those of the command line go before it")
      ->type_name(file_to_read);
  if (arguments.describe) {
    arguments.describe(table);
    return {true, 0, {}};
  }
  // Help is given whatever else is wrong.
  const auto asks = [&](const char* flag) {
    const auto end = std::find(arguments.words.begin(), arguments.words.end(), "--");
    return std::find(arguments.words.begin(), end, flag) != end;
  };
  if (asks("--help") || asks("-h") || asks("--help-all")) {
    std::cout << help_text(table, asks("--help-all"));
    return {true, 0, {}};
  }
  check_files(files_of(table.scan(arguments.words))); // a file of options is read, too
  const std::vector<std::string> words = with_config(table, arguments.words);
  const std::vector<Given> given = table.scan(words);
  table.set(given);
  check_files(files_of(given));
  Parsed parsed{false, 0, arguments.command};
  if (words != arguments.words && arguments.command.size() >= arguments.words.size()) {
    parsed.command.resize(arguments.command.size() - arguments.words.size());
    parsed.command.insert(parsed.command.end(), words.begin(), words.end());
  }
  return parsed;
}

} // namespace eigencrust::cli
