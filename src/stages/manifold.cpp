// SPDX-License-Identifier: GPL-3.0-or-later
// §3.5: from a watertight surface to a manifold, by relabelling inside tetrahedra outside. Labels only go
// one way, so it ends.
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include <eigencrust/stages.h>

#include "stages/star.h"

namespace eigencrust {
namespace {

class ManifoldRepair {
 public:
  ManifoldRepair(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, FinalLabels& labels)
      : t_(t), stars_(stars), poles_(poles), labels_(labels), star_(t, stars), waiting_(t.sample_count, 1) {}

  ManifoldCounts run(const Checkpoint& checkpoint) {
    std::vector<std::uint32_t> round(t_.sample_count);
    for (std::uint32_t s = 0; s < t_.sample_count; ++s) round[s] = s;
    while (!round.empty()) {
      const std::uint64_t before = counts_.relabelled;
      for (std::size_t i = 0; i < round.size(); ++i) {
        if (checkpoint && i % 65536 == 0) checkpoint(static_cast<double>(i) / static_cast<double>(round.size()));
        waiting_[round[i]] = 0;
        repair(SampleIndex{round[i]});
      }
      // Samples whose star changed after their turn come again, in increasing order.
      round.clear();
      if (counts_.relabelled == before) break;
      for (std::uint32_t s = 0; s < t_.sample_count; ++s)
        if (waiting_[s]) round.push_back(s);
    }
    return counts_;
  }

 private:
  bool is_mixed(SampleIndex s) const {
    const auto star = stars_[s];
    return std::any_of(star.begin(), star.end(),
                       [&](TetrahedronIndex t) { return labels_.labels[t] != labels_.labels[star.front()]; });
  }

  void repair(SampleIndex s) {
    if (!is_mixed(s)) return;
    star_.fill(s);
    while (repair_one_edge()) {
    }
    if (!is_mixed(s)) return;
    keep_one_inside_component(s);
    while (join_two_outside_components()) {
    }
  }

  void set_outside(std::uint32_t i) {
    const TetrahedronIndex tetrahedron = star_[i];
    labels_.labels[tetrahedron] = Label::outside;
    ++counts_.relabelled;
    for (const SampleIndex v : t_.tetrahedra[tetrahedron])
      if (!t_.is_corner(v)) waiting_[v.value] = 1;
  }

  float magnitude(std::uint32_t i) const { return std::fabs(labels_.value[star_[i]]); }

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

  void drop_all_but(std::uint32_t kept) {
    for (std::uint32_t i = 0; i < star_.size(); ++i)
      if (component_[i] != Star::none && component_[i] != kept) set_outside(i);
  }

  /// An edge with more than two surface triangles has several strands of inside tetrahedra around it.
  bool repair_one_edge() {
    surface_ends_.clear();
    for (std::uint32_t i = 0; i < star_.size(); ++i) {
      if (labels_.labels[star_[i]] != Label::inside) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t n = star_.neighbours(i)[k];
        if (n == Star::none || labels_.labels[star_[n]] == Label::inside) continue;
        for (std::size_t j = 0; j < 3; ++j)
          if (j != k) surface_ends_.push_back(star_.others(i)[j]);
      }
    }
    std::sort(surface_ends_.begin(), surface_ends_.end());
    for (std::size_t i = 0; i + 2 < surface_ends_.size(); ++i) {
      if (surface_ends_[i] != surface_ends_[i + 2]) continue;
      if (star_.components(labels_.labels, Label::inside, surface_ends_[i], component_) < 2) continue;
      drop_all_but(strongest_component());
      ++counts_.edges;
      return true;
    }
    return false;
  }

  void keep_one_inside_component(SampleIndex s) {
    if (star_.components(labels_.labels, Label::inside, SampleIndex{}, component_) < 2) return;
    const PolePair pair = poles_.of_sample[s];
    std::uint32_t kept = Star::none, kept_pole = Star::none;
    for (std::uint32_t i = 0; i < star_.size(); ++i) {
      if (component_[i] == Star::none) continue;
      const bool is_pole = (pair.first.valid() && poles_.tetrahedron[pair.first] == star_[i]) ||
                           (pair.second.valid() && poles_.tetrahedron[pair.second] == star_[i]);
      if (is_pole && (kept_pole == Star::none || magnitude(i) > magnitude(kept_pole))) {
        kept_pole = i;
        kept = component_[i];
      }
    }
    drop_all_but(kept != Star::none ? kept : strongest_component());
    ++counts_.vertices;
  }

  /// Shortest path through inside tetrahedra of the star from the first outside component to another,
  /// length Σ |value|; relabelled outside.
  bool join_two_outside_components() {
    if (star_.components(labels_.labels, Label::outside, SampleIndex{}, component_) < 2) return false;
    using Entry = std::tuple<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<double> length(star_.size(), std::numeric_limits<double>::infinity());
    std::vector<std::uint32_t> previous(star_.size(), Star::none);
    for (std::uint32_t i = 0; i < star_.size(); ++i)
      if (component_[i] == 0) {
        length[i] = 0;
        queue.emplace(0.0, i);
      }
    while (!queue.empty()) {
      const auto [d, i] = queue.top();
      queue.pop();
      if (d > length[i]) continue;
      if (component_[i] != Star::none && component_[i] != 0) {
        for (std::uint32_t p = previous[i]; p != Star::none && component_[p] == Star::none; p = previous[p])
          set_outside(p);
        ++counts_.vertices;
        return true;
      }
      for (const std::uint32_t n : star_.neighbours(i)) {
        if (n == Star::none) continue;
        const double step = component_[n] == Star::none ? static_cast<double>(magnitude(n)) : 0.0;
        if (d + step >= length[n]) continue;
        length[n] = d + step;
        previous[n] = i;
        queue.emplace(length[n], n);
      }
    }
    return false; // a closed star is face-connected, so this is not reached
  }

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Poles& poles_;
  FinalLabels& labels_;
  Star star_;
  std::vector<std::uint8_t> waiting_;
  std::vector<std::uint32_t> component_;
  std::vector<SampleIndex> surface_ends_;
  ManifoldCounts counts_;
};

} // namespace

ManifoldCounts make_manifold(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles,
                             FinalLabels& labels, const Checkpoint& checkpoint) {
  return ManifoldRepair(t, stars, poles, labels).run(checkpoint);
}

} // namespace eigencrust
