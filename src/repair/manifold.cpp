// SPDX-License-Identifier: GPL-3.0-or-later
// §3.5 as in the paper: labels only go from inside to outside. star_repair.cpp has the rule by energy.
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include <eigencrust/stages.h>

#include "parallel/threads.h"
#include "repair/unsound_stars.h"
#include "tetrahedra/star.h"

namespace eigencrust {
namespace {

class PaperRepair {
 public:
  PaperRepair(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, const Labels& known,
              TetrahedronLabels& labels)
      : t_(t),
        poles_(poles),
        known_(known),
        labels_(labels),
        star_(t, stars),
        link_(t, stars, labels.labels()),
        waiting_(t.sample_count, 0) {}

  ManifoldCounts run(std::vector<std::uint32_t> round, const Checkpoint& checkpoint) {
    for (const std::uint32_t s : round) waiting_[s] = 1;
    while (!round.empty()) {
      for (std::size_t i = 0; i < round.size(); ++i) {
        if (checkpoint && i % default_block == 0)
          checkpoint(static_cast<double>(i) / static_cast<double>(round.size()));
        waiting_[round[i]] = 0;
        if (!link_.is_disc(VertexIndex{round[i]})) repair(SampleIndex{round[i]});
      }
      // Samples whose star changed after their turn come again, in increasing order.
      round.clear();
      std::swap(round, next_);
      std::sort(round.begin(), round.end());
    }
    return counts_;
  }

 private:
  void repair(SampleIndex s) {
    star_.fill(s);
    for (VertexIndex edge; (edge = edge_with_several_strands(star_, labels_.labels())).valid(); ++counts_.edges) {
      star_.components(labels_.labels(), Label::inside, edge, component_);
      drop_all_but(strongest_component());
    }
    keep_one_inside_component(s);
    while (join_two_outside_components()) {
    }
  }

  /// How sure the label is; what is known beforehand gives way last.
  double magnitude(std::uint32_t i) const {
    return known_[star_[i]] == Label::unlabelled ? std::fabs(static_cast<double>(labels_.value(star_[i])))
                                                 : last_resort;
  }

  double volume(std::uint32_t i) const {
    const auto& [a, b, c, d] = t_.tetrahedra[star_[i]];
    const Vec3& o = t_.positions[a];
    return dot(cross(t_.positions[b] - o, t_.positions[c] - o), t_.positions[d] - o);
  }

  /// The component that holds the tetrahedron with the largest |value|, then volume, then smallest index.
  std::uint32_t strongest_component() const {
    std::uint32_t best = Star::none;
    for (std::uint32_t i = 0; i < star_.size(); ++i) {
      if (component_[i] == Star::none) continue;
      if (best == Star::none || std::pair(magnitude(i), volume(i)) > std::pair(magnitude(best), volume(best))) best = i;
    }
    return component_[best];
  }

  void set_outside(std::uint32_t i) {
    labels_.turn(star_[i]);
    ++counts_.relabelled;
    for (const VertexIndex v : t_.tetrahedra[star_[i]]) {
      if (t_.is_corner(v) || waiting_[v.value]) continue;
      waiting_[v.value] = 1;
      next_.push_back(v.value);
    }
  }

  void drop_all_but(std::uint32_t kept) {
    for (std::uint32_t i = 0; i < star_.size(); ++i)
      if (component_[i] != Star::none && component_[i] != kept) set_outside(i);
  }

  void keep_one_inside_component(SampleIndex s) {
    if (star_.components(labels_.labels(), Label::inside, VertexIndex{}, component_) < 2) return;
    const PolePair pair = poles_.of_sample[s];
    std::uint32_t kept_pole = Star::none;
    for (std::uint32_t i = 0; i < star_.size(); ++i) {
      if (component_[i] == Star::none) continue;
      const bool is_pole = (pair.first.valid() && poles_.tetrahedron[pair.first] == star_[i]) ||
                           (pair.second.valid() && poles_.tetrahedron[pair.second] == star_[i]);
      if (is_pole && (kept_pole == Star::none || magnitude(i) > magnitude(kept_pole))) kept_pole = i;
    }
    drop_all_but(kept_pole != Star::none ? component_[kept_pole] : strongest_component());
    ++counts_.vertices;
  }

  bool join_two_outside_components() {
    if (star_.components(labels_.labels(), Label::outside, VertexIndex{}, component_) < 2) return false;
    const auto length = [&](std::uint32_t i) { return magnitude(i); };
    const std::vector<std::uint32_t> path = shortest_path(star_, component_, length);
    for (const std::uint32_t i : path) set_outside(i);
    counts_.vertices += !path.empty();
    return !path.empty(); // without a way there is nothing to be done here
  }

  const Tetrahedralization& t_;
  const Poles& poles_;
  const Labels& known_;
  TetrahedronLabels& labels_;
  Star star_;
  LinkCheck link_;
  std::vector<std::uint8_t> waiting_;
  std::vector<std::uint32_t> next_; ///< those that wait for the next round
  std::vector<std::uint32_t> component_;
  ManifoldCounts counts_;
};

} // namespace

ManifoldCounts make_manifold(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles,
                             const Labels& known, TetrahedronLabels& labels, const Threads& threads,
                             const Checkpoint& checkpoint) {
  ManifoldCounts counts =
      PaperRepair(t, stars, poles, known, labels).run(unsound_stars(t, stars, labels.labels(), threads), checkpoint);
  counts.overruled = overruled(t, known, labels.labels());
  return counts;
}

} // namespace eigencrust
