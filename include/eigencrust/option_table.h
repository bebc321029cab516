// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every option as text, with its help: what the command line, the bindings for other languages and their
/// documentation are made of.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <eigencrust/options.h>

namespace eigencrust {

/// One option.
struct OptionEntry {
  /// What its values are.
  enum class Kind : std::uint8_t {
    choice, ///< one of a few words
    length, ///< a length in the unit of the input, or a word; some take N%, too
    number,
    count,
    flag,   ///< on or off
    points, ///< x,y,z; each setting adds a point
    bytes   ///< 4G, 500M, a number of bytes
  };
  /// The chapter of the help that it stands in.
  enum class Group : std::uint8_t {
    known,     ///< points whose side is known beforehand
    method,    ///< changes the labels or which pieces are kept
    smoothing, ///< of the mesh
    run,       ///< threads and memory
    library    ///< not on the command line
  };

  std::string_view name;       ///< as on the command line without its dashes: grid-spacing
  Kind kind = Kind::choice;    ///< what its values are
  Group group = Group::method; ///< its chapter
  std::string_view value;      ///< what help shows for it: "L", or the words of a choice: "on|off"
  std::string_view help;       ///< without a full stop and without the default
  void (*set)(Options& options, const std::string& value); ///< \throws Error{usage} naming the accepted values
  std::string (*get)(const Options& options);              ///< reads back through `set`, but for points and "none"
};

/// The heading under which help lists a group; empty for what is not on the command line.
std::string_view chapter(OptionEntry::Group group);

/// The words of a choice, empty where other values are accepted, too.
std::vector<std::string> choices(const OptionEntry& entry);

/// All of them; `preset` comes first, for it replaces what was set before.
std::span<const OptionEntry> option_table();

/// The default for people: "60; paper: 300", or "auto" where both presets agree.
std::string describe_default(const OptionEntry& entry);

/// Sets an option by its name; underscores are as good as dashes.
/// \throws Error{usage} for a name that does not exist or a value that is not accepted, naming those that are
void set_option(Options& options, std::string_view name, const std::string& value);

} // namespace eigencrust
