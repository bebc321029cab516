// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/unsound_stars.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

#include "parallel/compressed_rows.h"

namespace eigencrust {

bool LinkCheck::is_disc(VertexIndex s) {
  arcs_.clear();
  for (const TetrahedronIndex i : stars_[s]) {
    if (labels_[i] != Label::inside) continue;
    const auto& v = t_.tetrahedra[i];
    for (std::size_t k = 0; k < 4; ++k) {
      if (v[k] == s) continue;
      const TetrahedronIndex n = t_.neighbours[i][k];
      if (n.valid() && labels_[n] == Label::inside) continue;
      std::array<std::uint32_t, 2> ends{};
      std::size_t end = 0;
      for (std::size_t j = 0; j < 4; ++j)
        if (j != k && v[j] != s) ends[end++] = v[j].value;
      arcs_.push_back({ends[0], ends[1]});
      arcs_.push_back({ends[1], ends[0]});
    }
  }
  if (arcs_.empty()) return true;
  std::sort(arcs_.begin(), arcs_.end());
  for (std::size_t a = 0; a < arcs_.size(); a += 2)
    if (arcs_[a][0] != arcs_[a + 1][0] || (a > 0 && arcs_[a][0] == arcs_[a - 1][0])) return false;
  return steps_around() == arcs_.size() / 2;
}

/// How many arcs the curve through the first vertex has; every vertex has two.
std::size_t LinkCheck::steps_around() const {
  std::uint32_t previous = arcs_.front()[0], here = arcs_.front()[1];
  std::size_t steps = 1;
  while (here != arcs_.front()[0]) {
    auto arc = std::lower_bound(arcs_.begin(), arcs_.end(), std::array<std::uint32_t, 2>{here, 0});
    if ((*arc)[1] == previous) ++arc;
    previous = here;
    here = (*arc)[1];
    ++steps;
  }
  return steps;
}

std::vector<std::uint32_t> unsound_stars(const Tetrahedralization& t, const VertexStars& stars, const Labels& labels,
                                         const Threads& threads) {
  auto rows = build_rows<std::uint32_t>(threads, t.sample_count, default_block, [&] {
    return [link = LinkCheck(t, stars, labels)](std::size_t at, std::vector<std::uint32_t>& row) mutable {
      const auto s = static_cast<std::uint32_t>(at);
      if (!link.is_disc(VertexIndex{s})) row.push_back(s);
    };
  });
  return std::move(rows.item);
}

std::uint64_t overruled(const Tetrahedralization& t, const Labels& known, const Labels& labels) {
  std::uint64_t count = 0;
  for (TetrahedronIndex i{0}; i.value < known.size(); ++i.value)
    count += known[i] != Label::unlabelled && known[i] != labels[i] && !t.touches_cube(i);
  return count;
}

VertexIndex edge_with_several_strands(const Star& star, const Labels& labels) {
  std::vector<VertexIndex> ends;
  for (std::uint32_t i = 0; i < star.size(); ++i) {
    if (labels[star[i]] != Label::inside) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = star.neighbours(i)[k];
      if (n == Star::none || labels[star[n]] == Label::inside) continue;
      for (std::size_t j = 0; j < 3; ++j)
        if (j != k) ends.push_back(star.others(i)[j]);
    }
  }
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 0; i + 2 < ends.size(); ++i)
    if (ends[i] == ends[i + 2]) return ends[i];
  return {};
}

std::vector<std::uint32_t> shortest_path(const Star& star, const std::vector<std::uint32_t>& component,
                                         const std::function<double(std::uint32_t)>& length_of) {
  using Entry = std::tuple<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<double> length(star.size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> previous(star.size(), Star::none);
  for (std::uint32_t i = 0; i < star.size(); ++i)
    if (component[i] == 0) {
      length[i] = 0;
      queue.emplace(0.0, i);
    }
  while (!queue.empty()) {
    const auto [d, i] = queue.top();
    queue.pop();
    if (d > length[i]) continue;
    if (component[i] != Star::none && component[i] != 0) {
      std::vector<std::uint32_t> path;
      for (std::uint32_t p = previous[i]; p != Star::none && component[p] == Star::none; p = previous[p])
        path.push_back(p);
      return path;
    }
    for (const std::uint32_t n : star.neighbours(i)) {
      if (n == Star::none) continue;
      const double step = component[n] == Star::none ? length_of(n) : 0.0;
      if (!(d + step < length[n])) continue;
      length[n] = d + step;
      previous[n] = i;
      queue.emplace(length[n], n);
    }
  }
  return {};
}

} // namespace eigencrust
