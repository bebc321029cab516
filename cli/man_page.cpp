// SPDX-License-Identifier: GPL-3.0-or-later
// The manual page, from the same tables as --help (man(7)).
#include <algorithm>
#include <cctype>
#include <iostream>

#include "help.h"
#include "verbs.h"

namespace eigencrust::cli {
namespace {

/// Text in which nothing is taken for a command of the page.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

void print_options(const std::vector<OptionText>& options) {
  std::vector<std::string> chapters;
  for (const OptionText& option : options)
    if (!option.positional && std::find(chapters.begin(), chapters.end(), option.chapter) == chapters.end())
      chapters.push_back(option.chapter);
  for (const std::string& chapter : chapters) {
    std::cout << ".PP\n\\fI" << escaped(chapter) << "\\fR\n";
    for (const OptionText& option : options) {
      if (option.positional || option.chapter != chapter) continue;
      std::cout << ".TP\n";
      for (std::size_t i = 0; i < option.names.size(); ++i)
        std::cout << (i == 0 ? "" : ", ") << "\\fB" << escaped(option.names[i]) << "\\fR";
      if (!option.value.empty()) std::cout << " \\fI" << escaped(option.value) << "\\fR";
      std::cout << "\n" << escaped(option.meaning) << "\n";
    }
  }
}

void print_verb(const Verb& verb) {
  std::string title = verb.name;
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
  describe_options(verb, [&](const OptionTable& app) {
    std::cout << ".SH " << title << "\n\\fB" << escaped(usage_line(app)) << "\\fR\n.PP\n"
              << escaped(app.description()) << "\n";
    for (const OptionText& option : option_texts(app))
      if (option.positional)
        std::cout << ".TP\n\\fI" << escaped(option.names[0]) << "\\fR\n" << escaped(option.meaning) << "\n";
    print_options(option_texts(app));
  });
}

} // namespace

int man_verb(const Arguments& arguments) {
  OptionTable app("The manual page, for man -l or a folder man1.", "eigencrust man");
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  std::cout << ".TH EIGENCRUST 1 \"\" \"eigencrust " << version() << "\"\n"
            << ".SH NAME\neigencrust \\- watertight, manifold triangle meshes from raw point clouds\n"
            << ".SH SYNOPSIS\n";
  for (const Verb& verb : all_verbs())
    if (verb.alias_of == nullptr)
      std::cout << "\\fBeigencrust " << verb.name << "\\fR " << escaped(verb.arguments) << "\n.br\n";
  std::cout << ".SH DESCRIPTION\nWithout a verb, reconstruct is meant: \\fBeigencrust scan.ply mesh.ply\\fR.\n";
  for (const Verb& verb : all_verbs()) {
    if (verb.alias_of != nullptr) continue;
    std::cout << ".TP\n\\fB" << verb.name << "\\fR\n" << escaped(verb.summary) << "\n";
  }
  for (const Verb& verb : all_verbs())
    if (verb.alias_of == nullptr) print_verb(verb);
  std::cout << ".SH EXIT STATUS\n";
  for (const auto& [status, meaning] : exit_statuses)
    std::cout << ".TP\n\\fB" << status << "\\fR\n" << escaped(meaning) << "\n";
  return 0;
}

} // namespace eigencrust::cli
