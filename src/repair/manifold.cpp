// SPDX-License-Identifier: GPL-3.0-or-later
// §3.5: which stars are no discs; star_repair.cpp relabels them.
#include <algorithm>
#include <array>

#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "repair/star_repair.h"

namespace eigencrust {
namespace {

/// Is what the surface cuts out of a sphere around the sample one closed curve, or nothing?
class LinkCheck {
 public:
  LinkCheck(const Tetrahedralization& t, const VertexStars& stars, const Labels& labels)
      : t_(t), stars_(stars), labels_(labels) {}

  bool is_disc(SampleIndex s) {
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

 private:
  /// How many arcs the curve through the first vertex has; every vertex has two.
  std::size_t steps_around() const {
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

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Labels& labels_;
  std::vector<std::array<std::uint32_t, 2>> arcs_; ///< both ways, sorted
};

} // namespace

ManifoldCounts make_manifold(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles,
                             const Labels& known, ManifoldRule rule, TetrahedronLabels& labels, const Threads& threads,
                             const Checkpoint& checkpoint) {
  // Most stars are sound; looking is for all threads, repairing for one.
  constexpr std::size_t block = 4096;
  std::vector<std::vector<std::uint32_t>> found((t.sample_count + block - 1) / block);
  for_blocks(threads, t.sample_count, block, [&](std::size_t begin, std::size_t end, std::size_t b) {
    LinkCheck link(t, stars, labels.labels());
    for (std::size_t s = begin; s < end; ++s)
      if (!link.is_disc(SampleIndex{static_cast<std::uint32_t>(s)})) found[b].push_back(static_cast<std::uint32_t>(s));
  });
  std::vector<std::uint32_t> unsound;
  for (const auto& part : found) unsound.insert(unsound.end(), part.begin(), part.end());
  ManifoldCounts counts = StarRepair(t, stars, poles, known, rule, labels).run(std::move(unsound), nullptr, checkpoint);
  for (std::size_t i = 0; i < known.size(); ++i)
    counts.overruled += known.raw()[i] != Label::unlabelled && known.raw()[i] != labels.labels().raw()[i];
  return counts;
}

} // namespace eigencrust
