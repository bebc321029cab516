// SPDX-License-Identifier: GPL-3.0-or-later
// Completion of the command line in three shells, from the same tables as --help.
#include <iostream>

#include "help.h"
#include "verbs.h"

namespace eigencrust::cli {
namespace {

struct VerbText {
  std::string name, summary;
  std::vector<OptionText> options; ///< without positional ones
};

std::vector<VerbText> verb_texts() {
  std::vector<VerbText> texts;
  for (const Verb& verb : all_verbs()) {
    if (verb.alias_of != nullptr) continue;
    texts.push_back({verb.name, verb.summary, {}});
    describe_options(verb, [&](const OptionTable& app) {
      for (OptionText& option : option_texts(app))
        if (!option.positional) texts.back().options.push_back(std::move(option));
    });
  }
  return texts;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::string> verb_names(const std::vector<VerbText>& verbs) {
  std::vector<std::string> names;
  for (const VerbText& verb : verbs) names.push_back(verb.name);
  return names;
}

bool names_file(const OptionText& option) {
  return option.value == file_to_read || option.value == file_to_write || option.value == shape_or_file;
}

/// Options without a verb are those of reconstruct.
void print_bash() {
  const std::vector<VerbText> verbs = verb_texts();
  std::cout << "# Completion of eigencrust for bash; made by `eigencrust completion bash`.\n"
               "_eigencrust() {\n"
               "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} verb=reconstruct options=\n"
               "  COMPREPLY=()\n"
               "  case ${COMP_WORDS[1]} in "
            << joined(verb_names(verbs), " | ") << ") [ \"$COMP_CWORD\" -gt 1 ] && verb=${COMP_WORDS[1]} ;; esac\n"
            << "  case $verb:$before in\n";
  for (const VerbText& verb : verbs)
    for (const OptionText& option : verb.options) {
      if (option.value.empty()) continue;
      std::cout << "    ";
      for (std::size_t i = 0; i < option.names.size(); ++i)
        std::cout << (i == 0 ? "" : " | ") << verb.name << ":" << option.names[i];
      std::cout << ") ";
      if (!option.choices.empty())
        std::cout << "mapfile -t COMPREPLY < <(compgen -W '" << joined(option.choices, " ")
                  << "' -- \"$word\"); return";
      else if (names_file(option))
        std::cout << "mapfile -t COMPREPLY < <(compgen -f -- \"$word\"); return";
      else if (option.value == "DIR")
        std::cout << "mapfile -t COMPREPLY < <(compgen -d -- \"$word\"); return";
      else
        std::cout << "return";
      std::cout << " ;;\n";
    }
  std::cout << "  esac\n  case $verb in\n";
  for (const VerbText& verb : verbs) {
    std::cout << "    " << verb.name << ") options='";
    for (const OptionText& option : verb.options) std::cout << joined(option.names, " ") << " ";
    std::cout << "' ;;\n";
  }
  std::cout << "  esac\n"
               "  if [[ $word == -* ]]; then\n"
               "    mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\")\n"
               "    return\n"
               "  fi\n"
               "  mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
               "  [ \"$COMP_CWORD\" -gt 1 ] ||\n"
               "    mapfile -t -O \"${#COMPREPLY[@]}\" COMPREPLY < <(compgen -W '"
            << joined(verb_names(verbs), " ")
            << "' -- \"$word\")\n"
               "}\n"
               "complete -o filenames -F _eigencrust eigencrust\n";
}

/// Between single quotes, for zsh and fish.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text)
    if (c == '\'')
      result += "'\\''";
    else
      result += c;
  return result + "'";
}

void print_zsh_options(const VerbText& verb) {
  std::cout << "    " << verb.name << ")\n      _arguments \\\n";
  for (const OptionText& option : verb.options)
    for (const std::string& name : option.names) {
      std::string meaning;
      for (const char c : option.meaning) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') meaning += '\\';
        meaning += c;
      }
      std::string text = "*";
      text.append(name).append("[").append(meaning).append("]");
      if (!option.value.empty()) {
        text += ":value:";
        if (!option.choices.empty())
          text.append("(").append(joined(option.choices, " ")).append(")");
        else if (names_file(option))
          text += "_files";
        else if (option.value == "DIR")
          text += "_files -/";
      }
      std::cout << "        " << quoted(text) << " \\\n";
    }
  std::cout << "        '*:file:_files'\n      ;;\n";
}

void print_zsh() {
  const std::vector<VerbText> verbs = verb_texts();
  std::cout << "#compdef eigencrust\n# Completion of eigencrust for zsh; made by `eigencrust completion zsh`.\n"
               "_eigencrust() {\n"
               "  local verb=reconstruct\n"
               "  local -a verbs=(\n";
  for (const VerbText& verb : verbs) std::cout << "    " << quoted(verb.name + ":" + verb.summary) << "\n";
  std::cout << "  )\n"
               "  if (( CURRENT == 2 )) && [[ $words[2] != -* ]]; then\n"
               "    _describe verb verbs\n"
               "    _files\n"
               "    return\n"
               "  fi\n"
               "  case $words[2] in\n    "
            << joined(verb_names(verbs), "|")
            << ") verb=$words[2]; shift words; (( CURRENT-- )) ;;\n"
               "  esac\n"
               "  case $verb in\n";
  for (const VerbText& verb : verbs) print_zsh_options(verb);
  std::cout << "  esac\n}\ncompdef _eigencrust eigencrust\n";
}

void print_fish() {
  const std::vector<VerbText> verbs = verb_texts();
  const std::string names = joined(verb_names(verbs), " ");
  std::cout << "# Completion of eigencrust for fish; made by `eigencrust completion fish`.\n";
  for (const VerbText& verb : verbs)
    std::cout << "complete -c eigencrust -n '__fish_use_subcommand' -a " << verb.name << " -d " << quoted(verb.summary)
              << "\n";
  for (const VerbText& verb : verbs) {
    std::string when = "__fish_seen_subcommand_from ";
    when.append(verb.name);
    if (verb.name == "reconstruct") when.append("; or not __fish_seen_subcommand_from ").append(names);
    for (const OptionText& option : verb.options) {
      std::cout << "complete -c eigencrust -n " << quoted(when);
      for (const std::string& name : option.names)
        std::cout << (name.starts_with("--") ? " -l " : " -s ") << name.substr(name.starts_with("--") ? 2 : 1);
      if (!option.choices.empty())
        std::cout << " -x -a " << quoted(joined(option.choices, " "));
      else if (names_file(option))
        std::cout << " -r -F";
      else if (option.value == "DIR")
        std::cout << " -x -a '(__fish_complete_directories)'";
      else if (!option.value.empty())
        std::cout << " -x";
      std::cout << " -d " << quoted(option.meaning) << "\n";
    }
  }
}

} // namespace

int completion_verb(const Arguments& arguments) {
  std::string shell;
  OptionTable app("What completes the command line; for bash: source <(eigencrust completion bash).",
                  "eigencrust completion");
  app.add_option("SHELL", shell, "bash, zsh or fish")->required()->one_of({"bash", "zsh", "fish"});
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  if (shell == "bash")
    print_bash();
  else if (shell == "zsh")
    print_zsh();
  else
    print_fish();
  return 0;
}

} // namespace eigencrust::cli
