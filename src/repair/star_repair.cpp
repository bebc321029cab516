// SPDX-License-Identifier: GPL-3.0-or-later
// §3.5: from a watertight surface to a manifold, by relabelling. With the paper's rule labels only go from
// inside to outside; with the other each tetrahedron may come back once. So both end.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include <eigencrust/stages.h>

#include "repair/star_repair.h"
#include "tetrahedra/star.h"

namespace eigencrust {

class StarRepair::Impl {
 public:
  Impl(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, const Labels& known,
       ManifoldRule rule, TetrahedronLabels& labels)
      : t_(t),
        stars_(stars),
        poles_(poles),
        known_(known),
        rule_(rule),
        labels_(labels),
        star_(t, stars),
        waiting_(t.sample_count, 0) {
    if (rule_ == ManifoldRule::cheapest) filled_.assign(t.tetrahedra.size(), 0);
  }

  ManifoldCounts run(std::vector<std::uint32_t> round, TetrahedronLabels::Journal* journal,
                     const Checkpoint& checkpoint) {
    counts_ = {};
    journal_ = journal;
    for (const std::uint32_t s : round) waiting_[s] = 1;
    while (!round.empty()) {
      const std::uint64_t before = counts_.relabelled;
      for (std::size_t i = 0; i < round.size(); ++i) {
        if (checkpoint && i % 65536 == 0) checkpoint(static_cast<double>(i) / static_cast<double>(round.size()));
        waiting_[round[i]] = 0;
        repair(SampleIndex{round[i]});
      }
      // Samples whose star changed after their turn come again, in increasing order.
      round.clear();
      std::swap(round, next_);
      if (counts_.relabelled == before) break;
      std::sort(round.begin(), round.end());
    }
    for (const std::uint32_t s : round) waiting_[s] = 0;
    return counts_;
  }

  void undo(const TetrahedronLabels::Journal& journal) {
    for (std::size_t i = journal.size(); i-- > 0;) {
      labels_.turn(journal[i]);
      if (labels_[journal[i]] == Label::outside && !filled_.empty()) filled_[journal[i].value] = 0;
    }
  }

  void set_held(std::span<const TetrahedronIndex> tetrahedra, bool held) {
    if (held_.empty()) held_.assign(t_.tetrahedra.size(), 0);
    for (const TetrahedronIndex i : tetrahedra) held_[i.value] = held;
  }

 private:
  /// Turns a tetrahedron of the star; its samples come again.
  void turn(std::uint32_t i) {
    const TetrahedronIndex tetrahedron = star_[i];
    ++counts_.relabelled;
    labels_.turn(tetrahedron);
    if (journal_) journal_->push_back(tetrahedron);
    for (const SampleIndex v : t_.tetrahedra[tetrahedron]) {
      if (t_.is_corner(v) || waiting_[v.value]) continue;
      waiting_[v.value] = 1;
      next_.push_back(v.value);
    }
  }

  bool is_mixed(SampleIndex s) const {
    const auto star = stars_[s];
    return std::any_of(star.begin(), star.end(),
                       [&](TetrahedronIndex t) { return labels_[t] != labels_[star.front()]; });
  }

  void repair(SampleIndex s) {
    if (!is_mixed(s)) return;
    star_.fill(s);
    repair_edges();
    if (!is_mixed(s)) return;
    if (rule_ == ManifoldRule::cheapest) {
      while (repair_vertex_cheaply()) repair_edges(); // a flip may have spoilt an edge again
      return;
    }
    keep_one_inside_component(s);
    while (join_two_outside_components()) {
    }
  }

  void repair_edges() {
    while (repair_one_edge()) {
    }
  }

  // The cheapest of all flips, either way.

  /// May this tetrahedron become inside? Each may once, so that repairs end; those known to be outside never.
  bool may_fill(std::uint32_t i) const {
    return !filled_[star_[i].value] && known_[star_[i]] == Label::unlabelled && !t_.touches_cube(star_[i]);
  }

  void flip(std::uint32_t i) {
    if (labels_[star_[i]] == Label::outside) filled_[star_[i].value] = 1;
    turn(i);
  }

  struct Candidate {
    double price = std::numeric_limits<double>::infinity();
    std::vector<std::uint32_t> members;
  };

  /// Offers the cheapest set of `label` (at an edge, or in the whole star); its price is Σ |value|.
  /// \return how many such sets there are
  std::uint32_t offer_components(Label label, SampleIndex edge, Candidate& best) {
    const std::uint32_t count = star_.components(labels_.labels(), label, edge, component_);
    if (count < 2) return count;
    price_.assign(count, 0.0);
    for (std::uint32_t i = 0; i < star_.size(); ++i) {
      if (component_[i] == Star::none) continue;
      const bool forbidden = label == Label::outside && !may_fill(i);
      price_[component_[i]] += forbidden ? std::numeric_limits<double>::infinity() : static_cast<double>(magnitude(i));
    }
    const auto cheapest = static_cast<std::uint32_t>(std::min_element(price_.begin(), price_.end()) - price_.begin());
    if (price_[cheapest] >= best.price) return count;
    best.price = price_[cheapest];
    best.members.clear();
    for (std::uint32_t i = 0; i < star_.size(); ++i)
      if (component_[i] == cheapest) best.members.push_back(i);
    return count;
  }

  /// Offers the cheapest path through the other label that joins two sets of `label`.
  void offer_path(Label label, Candidate& best) {
    if (star_.components(labels_.labels(), label, SampleIndex{}, component_) < 2) return;
    std::vector<std::uint32_t> path = cheapest_path(label);
    double price = 0;
    for (const std::uint32_t i : path) price += static_cast<double>(magnitude(i));
    if (path.empty() || price >= best.price) return;
    best.price = price;
    best.members = std::move(path);
  }

  bool repair_vertex_cheaply() {
    Candidate best;
    const std::uint32_t inside = offer_components(Label::inside, SampleIndex{}, best);
    const std::uint32_t outside = offer_components(Label::outside, SampleIndex{}, best);
    if (inside < 2 && outside < 2) return false;
    offer_path(Label::inside, best);
    offer_path(Label::outside, best);
    for (const std::uint32_t i : best.members) flip(i);
    ++counts_.vertices;
    return !best.members.empty();
  }

  bool repair_edge_cheaply(SampleIndex edge) {
    Candidate best;
    if (offer_components(Label::inside, edge, best) < 2) return false;
    offer_components(Label::outside, edge, best);
    for (const std::uint32_t i : best.members) flip(i);
    ++counts_.edges;
    return !best.members.empty();
  }

  // The paper's rule.

  /// How sure the label is; what is held gives way late, what is known beforehand last.
  float magnitude(std::uint32_t i) const {
    constexpr float known_price = 1e6f, held_price = 100; // values are at most 1
    if (known_[star_[i]] != Label::unlabelled) return known_price;
    return !held_.empty() && held_[star_[i].value] ? held_price : std::fabs(labels_.value(star_[i]));
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

  void drop_all_but(std::uint32_t kept) {
    for (std::uint32_t i = 0; i < star_.size(); ++i)
      if (component_[i] != Star::none && component_[i] != kept) turn(i);
  }

  /// An edge with more than two surface triangles has several strands of inside tetrahedra around it.
  bool repair_one_edge() {
    surface_ends_.clear();
    for (std::uint32_t i = 0; i < star_.size(); ++i) {
      if (labels_[star_[i]] != Label::inside) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t n = star_.neighbours(i)[k];
        if (n == Star::none || labels_[star_[n]] == Label::inside) continue;
        for (std::size_t j = 0; j < 3; ++j)
          if (j != k) surface_ends_.push_back(star_.others(i)[j]);
      }
    }
    std::sort(surface_ends_.begin(), surface_ends_.end());
    for (std::size_t i = 0; i + 2 < surface_ends_.size(); ++i) {
      if (surface_ends_[i] != surface_ends_[i + 2]) continue;
      if (rule_ == ManifoldRule::cheapest) {
        if (repair_edge_cheaply(surface_ends_[i])) return true;
        continue;
      }
      if (star_.components(labels_.labels(), Label::inside, surface_ends_[i], component_) < 2) continue;
      drop_all_but(strongest_component());
      ++counts_.edges;
      return true;
    }
    return false;
  }

  void keep_one_inside_component(SampleIndex s) {
    if (star_.components(labels_.labels(), Label::inside, SampleIndex{}, component_) < 2) return;
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

  bool join_two_outside_components() {
    if (star_.components(labels_.labels(), Label::outside, SampleIndex{}, component_) < 2) return false;
    for (const std::uint32_t i : cheapest_path(Label::outside)) turn(i);
    ++counts_.vertices;
    return true;
  }

  /// Shortest face-connected path through the star from the first set of component_ to another, not
  /// counting those sets; length Σ |value|. Only tetrahedra that may become `label` are walked through.
  std::vector<std::uint32_t> cheapest_path(Label label) const {
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
        std::vector<std::uint32_t> path;
        for (std::uint32_t p = previous[i]; p != Star::none && component_[p] == Star::none; p = previous[p])
          path.push_back(p);
        return path;
      }
      for (const std::uint32_t n : star_.neighbours(i)) {
        if (n == Star::none || (component_[n] == Star::none && label == Label::inside && !may_fill(n))) continue;
        const double step = component_[n] == Star::none ? static_cast<double>(magnitude(n)) : 0.0;
        if (d + step >= length[n]) continue;
        length[n] = d + step;
        previous[n] = i;
        queue.emplace(length[n], n);
      }
    }
    return {};
  }

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Poles& poles_;
  const Labels& known_;
  ManifoldRule rule_;
  TetrahedronLabels& labels_;
  Star star_;
  std::vector<std::uint8_t> waiting_;
  std::vector<std::uint32_t> next_; ///< those that wait for the next round
  TetrahedronLabels::Journal* journal_ = nullptr;
  std::vector<std::uint8_t> filled_, held_; ///< tetrahedra; the second empty until some are held
  std::vector<std::uint32_t> component_;
  std::vector<double> price_;
  std::vector<SampleIndex> surface_ends_;
  ManifoldCounts counts_;
};

StarRepair::StarRepair(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, const Labels& known,
                       ManifoldRule rule, TetrahedronLabels& labels)
    : impl_(std::make_unique<Impl>(t, stars, poles, known, rule, labels)) {}
StarRepair::~StarRepair() = default;

ManifoldCounts StarRepair::run(std::vector<std::uint32_t> samples, TetrahedronLabels::Journal* journal,
                               const Checkpoint& checkpoint) {
  return impl_->run(std::move(samples), journal, checkpoint);
}
void StarRepair::undo(const TetrahedronLabels::Journal& journal) { impl_->undo(journal); }
void StarRepair::hold(std::span<const TetrahedronIndex> tetrahedra) { impl_->set_held(tetrahedra, true); }
void StarRepair::release(std::span<const TetrahedronIndex> tetrahedra) { impl_->set_held(tetrahedra, false); }

} // namespace eigencrust
