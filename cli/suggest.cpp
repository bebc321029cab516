// SPDX-License-Identifier: GPL-3.0-or-later
#include "suggest.h"

#include <algorithm>
#include <cctype>

namespace eigencrust::cli {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Letters to insert, to remove, to change or to swap with the next (restricted Damerau-Levenshtein distance).
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

} // namespace

std::string nearest_word(const std::string& typed, const std::vector<std::string>& words) {
  constexpr std::size_t longest = 64; // a longer word is no slip, and the table of edits would be large
  if (typed.size() > longest) return {};
  const std::string wanted = lower(typed);
  // More letters wrong are no slip; in a short word two make another one.
  std::size_t least = wanted.size() < 4 ? 2 : 3;
  std::string nearest;
  for (const std::string& word : words) {
    const std::size_t distance = edits(wanted, lower(word));
    const bool begins = wanted.size() >= 3 && lower(word).starts_with(wanted);
    if (distance < least || (begins && nearest.empty())) {
      least = std::min(least, distance);
      nearest = word;
    }
  }
  return nearest;
}

} // namespace eigencrust::cli
