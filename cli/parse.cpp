// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iostream>

#include "command.h"
#include "config_file.h"
#include "help.h"

namespace eigencrust::cli {

Parsed parse(OptionTable& table, const Arguments& arguments) {
  bool help = false, help_all = false;
  std::vector<std::string> configs;
  table.begin_chapter(help_chapter);
  table.add_flag("-h,--help", help, "Print the options of every day");
  table.add_flag("--help-all", help_all, "Print all options by chapter");
  table
      .add_option("--config", configs,
                  "Take options from a TOML file: option = value; those of the command line go before it")
      ->type_name("FILE");
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
  const std::vector<std::string> words = with_config(table, arguments.words);
  table.set(table.scan(words));
  Parsed parsed{false, 0, arguments.command};
  if (words != arguments.words && arguments.command.size() >= arguments.words.size()) {
    parsed.command.resize(arguments.command.size() - arguments.words.size());
    parsed.command.insert(parsed.command.end(), words.begin(), words.end());
  }
  return parsed;
}

} // namespace eigencrust::cli
