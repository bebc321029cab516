// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Cases chosen by words.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <eigencrust/error.h>

namespace eigencrust::bench {

/// Keeps the cases whose group/name contains a word of the lists, which are separated by commas; without words all.
/// \param option where the words come from \throws Error{usage} for a word that no case contains
template <class Case>
void keep_named(const std::vector<std::string>& lists, const char* option, std::vector<Case>& cases) {
  std::vector<std::string> words;
  for (const std::string& list : lists) {
    std::istringstream stream(list);
    for (std::string word; std::getline(stream, word, ',');)
      if (!word.empty()) words.push_back(word);
  }
  const auto fits = [](const Case& c, const std::string& word) {
    return (c.group + "/" + c.name).find(word) != std::string::npos;
  };
  for (const std::string& word : words)
    if (std::none_of(cases.begin(), cases.end(), [&](const Case& c) { return fits(c, word); }))
      throw Error(ErrorKind::usage, option, "no case fits '" + word + "'", "see --list");
  std::erase_if(cases, [&](const Case& c) {
    return !words.empty() && std::none_of(words.begin(), words.end(), [&](const auto& word) { return fits(c, word); });
  });
}

} // namespace eigencrust::bench
