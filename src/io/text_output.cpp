// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/text_output.h"

namespace eigencrust::io {

void append_comments(std::string& out, const std::string& mark, const std::vector<std::string>& comments) {
  for (const std::string& comment : comments) {
    std::string_view rest = comment;
    for (bool more = true; more;) {
      const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
      out += mark;
      out += rest.substr(0, end);
      out += '\n';
      more = end < rest.size();
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
}

} // namespace eigencrust::io
