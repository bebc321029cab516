// SPDX-License-Identifier: GPL-3.0-or-later
#include "unknown_option.h"

#include <array>
#include <string_view>

#include "option_table.h"
#include "suggest.h"
#include "verbs.h"

namespace eigencrust::cli {
namespace {

/// What other programs of the kind call it.
struct OtherName {
  std::string_view name, remedy;
};
constexpr std::array<OtherName, 14> other_names{
    {{"--in", "inputs are named without an option: eigencrust scan.ply -o mesh.ply"},
     {"--input", "inputs are named without an option: eigencrust scan.ply -o mesh.ply"},
     {"-i", "inputs are named without an option: eigencrust scan.ply -o mesh.ply"},
     {"--out", "did you mean --output?"},
     {"-v", "use --progress bar to watch the run, --version for the version"},
     {"--verbose", "use --progress bar to watch the run, --report FILE for all figures"},
     {"-t", "did you mean --threads?"},
     {"-j", "did you mean --threads?"},
     {"--depth", "there is no depth to choose: the samples decide; --thin L makes the result coarser"},
     {"--voxel-size", "did you mean --thin?"},
     {"--resolution", "there is none to choose: the samples decide; --thin L makes the result coarser"},
     {"--normals", "leave it out: normals are neither needed nor used"},
     {"--normal", "leave it out: normals are neither needed nor used"},
     {"--force", "leave it out: results replace files of their name"}}};

} // namespace

std::string verb_that_knows(const std::string& name) {
  std::string owner;
  for (const Verb& verb : all_verbs())
    describe_options(verb, [&](const OptionTable& options) {
      if (owner.empty() && verb.alias_of == nullptr && options.find(name) != nullptr) owner = verb.name;
    });
  return owner;
}

std::string remedy_for_unknown(const OptionTable& table, const std::string& name) {
  std::vector<std::string> known;
  for (const auto& option : table.options())
    for (const std::string& other : option->names())
      if (other.starts_with("--")) known.push_back(other);
  for (const OtherName& other : other_names)
    if (name == other.name && !(name == "--out" && table.find("--output") == nullptr)) return std::string(other.remedy);
  if (const std::string nearest = nearest_word(name, known); !nearest.empty()) return "did you mean " + nearest + "?";
  const std::string owner = verb_that_knows(name);
  if (!owner.empty()) return "it is an option of " + owner + ", not of this verb";
  return "see " + table.name() + " --help-all";
}

} // namespace eigencrust::cli
