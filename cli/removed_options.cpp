// SPDX-License-Identifier: GPL-3.0-or-later
#include "removed_options.h"

#include <array>
#include <string>
#include <string_view>

#include <eigencrust/error.h>

namespace eigencrust::cli {
namespace {

struct Removed {
  std::string_view name;
  const char* remedy;
};

constexpr const char* in_the_energy = "leave it out: it is part of the energy now, there is nothing to set";
constexpr std::array<Removed, 8> removed{
    {{"local-noise", "use --noise auto (the default), off, a length or N%"},
     {"centring", in_the_energy},
     {"close-handles", "leave it out: handles of the size of the noise are closed; --noise off leaves all"},
     {"min-agreement", in_the_energy},
     {"pole-ties", in_the_energy},
     {"recover-share", in_the_energy},
     {"crossing-count", in_the_energy},
     {"behind-count", in_the_energy}}};

} // namespace

void reject_removed_options(const Arguments& arguments) {
  for (const std::string& word : arguments.words) {
    std::string_view name = word;
    if (name == "--") return; // what follows are files
    if (!name.starts_with("--")) continue;
    name.remove_prefix(name.starts_with("--no-") ? 5 : 2);
    name = name.substr(0, name.find('='));
    for (const Removed& option : removed)
      if (name == option.name)
        throw Error(ErrorKind::usage, "command line", word + " is no longer an option", option.remedy);
  }
}

} // namespace eigencrust::cli
