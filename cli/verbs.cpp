// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs.h"

#include <algorithm>
#include <array>
#include <iostream>

#include "help.h"
#include "removed_options.h"
#include "suggest.h"

namespace eigencrust::cli {
namespace {

constexpr std::array<Verb, 12> table{{
    {"reconstruct", "INPUT... -o MESH", "point clouds to a closed mesh; what happens without a verb", reconstruct_verb},
    {"orient", "INPUT... -o CLOUD", "the cloud with normals that look outward", orient_verb},
    {"outliers", "INPUT... -o CLOUD", "which points belong to the surface, and how sure that is", outliers_verb},
    {"info", "INPUT...", "what is in a cloud: counts, bounds, spacing; forecast of memory and time", info_verb},
    {"check", "MESH", "closed? manifold? oriented? genus, volume, self-intersections", check_verb},
    {"compare", "MESH REFERENCE", "distances both ways, F-score, volume IoU", compare_verb},
    {"render", "MESH... -o PNG", "a picture without a display", render_verb},
    {"demo", "[-o DIR]", "the bundled scan, reconstructed, with its report and picture", demo_verb},
    {"rerun", "REPORT.json", "the run that a report tells of, once more", rerun_verb},
    {"completion", "SHELL", "what completes the command line: bash, zsh or fish", completion_verb},
    {"man", "", "the manual page", man_verb},
    {"classify", "INPUT... -o CLOUD", "the old name of outliers", outliers_verb, "outliers"},
}};

constexpr const char* examples =
    R"(Eigencrust: raw point clouds into watertight, manifold triangle meshes.

  eigencrust scan.ply mesh.ply                  one cloud
  eigencrust a.ply b.ply c.ply -o mesh.ply      several scans of one scene
  eigencrust scan.ply -o mesh.ply --report r.json

Verbs (eigencrust VERB --help for the options of each):
)";

/// The first word is an input where it is no verb; but a word without a dot or a slash that names no file was meant
/// as a verb. \throws Error{usage}
void require_input(const std::string& word) {
  std::error_code ignored;
  if (word.empty() || word.front() == '-' || word.find_first_of("./") != std::string::npos ||
      std::filesystem::exists(word, ignored))
    return;
  std::vector<std::string> names;
  std::string listed;
  for (const Verb& verb : table) {
    if (verb.alias_of != nullptr) continue;
    names.emplace_back(verb.name);
    listed += (listed.empty() ? "" : ", ") + names.back();
  }
  const std::string nearest = nearest_word(word, names);
  throw Error(ErrorKind::usage, "command line", "unknown verb or no such file: " + word,
              nearest.empty() ? "the verbs are " + listed : "did you mean " + nearest + "?");
}

} // namespace

std::span<const Verb> all_verbs() { return table; }

const Verb* find_verb(const std::string& name) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Verb& verb) { return name == verb.name; });
  return found == table.end() ? nullptr : &*found;
}

void describe_options(const Verb& verb, const std::function<void(const OptionTable&)>& describe) {
  verb.call({{}, {}, describe});
}

std::string overview() {
  std::string text = examples;
  for (const Verb& verb : table) {
    if (verb.alias_of != nullptr) continue;
    std::string left = "  " + std::string(verb.name) + " " + verb.arguments;
    constexpr std::size_t column = 33;
    left.resize(std::max(left.size() + 1, column), ' ');
    text += left + verb.summary + "\n";
  }
  std::string statuses;
  for (const auto& [status, meaning] : exit_statuses)
    statuses += (statuses.empty() ? "" : "; ") + std::to_string(status) + " " + meaning;
  return text + "\nExit status: " + wrapped(statuses + ".", 107, 0) + "\n";
}

int run_command(const Arguments& all) {
  if (all.words.empty()) {
    std::cerr << overview();
    return static_cast<int>(ErrorKind::usage);
  }
  reject_removed_options(all);
  const std::string& first = all.words.front();
  const bool everything = first == "--help-all";
  if (first == "--help" || first == "-h" || first == "help" || everything) {
    if (all.words.size() > 1 && find_verb(all.words[1]) != nullptr)
      return find_verb(all.words[1])->call({{everything ? "--help-all" : "--help"}, all.command, {}, {}});
    std::cout << overview() << "\n";
    return reconstruct_verb({{everything ? "--help-all" : "--help"}, all.command, {}, {}});
  }
  if (first == "--version") {
    std::cout << "eigencrust " << version() << "\n";
    return 0;
  }
  const Verb* verb = find_verb(first);
  if (verb == nullptr) {
    require_input(first);
    return reconstruct_verb(all);
  }
  return verb->call({{all.words.begin() + 1, all.words.end()}, all.command, {}, all.ranks});
}

} // namespace eigencrust::cli
