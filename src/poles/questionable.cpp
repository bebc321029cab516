// SPDX-License-Identifier: GPL-3.0-or-later
// §3.3: tetrahedra below the scale of the noise have nothing to say.
#include <algorithm>

#include <eigencrust/stages.h>

#include "parallel/threads.h"

namespace eigencrust {
namespace {

double squared_longest_edge(const Tetrahedralization& t, const std::array<VertexIndex, 4>& v) {
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      longest = std::max(longest, squared_norm(t.positions[v[i]] - t.positions[v[j]]));
  return longest;
}

} // namespace

std::vector<std::uint8_t> questionable_tetrahedra(const Tetrahedralization& t, SampleLengthsView grid_spacing,
                                                  const Threads& threads) {
  if (grid_spacing.empty()) return {};
  std::vector<std::uint8_t> questionable(t.tetrahedra.size(), 0);
  for_each_index(threads, questionable.size(), [&](std::size_t i) {
    const TetrahedronIndex index{static_cast<std::uint32_t>(i)};
    if (t.touches_cube(index)) return;
    double limit = 0; // 4 × the mean of four
    for (const VertexIndex v : t.tetrahedra[index]) limit += static_cast<double>(grid_spacing[t.sample(v)]);
    questionable[i] = squared_longest_edge(t, t.tetrahedra[index]) < limit * limit;
  });
  return questionable;
}

std::uint64_t unlabel_questionable(std::span<const std::uint8_t> questionable, const Labels& known, Labels& labels) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < questionable.size(); ++i) {
    Label& label = labels.raw()[i];
    if (!questionable[i] || label == Label::unlabelled || known.raw()[i] != Label::unlabelled) continue;
    label = Label::unlabelled;
    ++count;
  }
  return count;
}

} // namespace eigencrust
