// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A page as blocks, written as Markdown or as one HTML file.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace eigencrust::bench {

/// Texts may hold *emphasis*, **strong** and `code`.
struct Heading {
  int level;
  std::string text;
};
struct Paragraph {
  std::string text;
};
struct PageTable {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};
/// PNG or SVG files.
struct Pictures {
  struct One {
    std::filesystem::path file;
    std::string caption;
  };
  std::vector<One> pictures;
  bool in_markdown = false; ///< else in HTML only
  std::string prefix;       ///< of the names of the copies for the Markdown
};
using Blocks = std::vector<std::variant<Heading, Paragraph, PageTable, Pictures>>;

/// \param pictures folder to copy pictures into; its name is how the page refers to it; empty: none are shown
std::string blocks_as_markdown(const Blocks& blocks, const std::filesystem::path& pictures);
/// Nothing is loaded from elsewhere.
std::string blocks_as_html(const Blocks& blocks, const std::string& title);

} // namespace eigencrust::bench
