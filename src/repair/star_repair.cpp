// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/star_repair.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eigencrust {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

StarRepair::StarRepair(const Tetrahedralization& t, const VertexStars& stars, const Labels& known, PricedLabels& labels)
    : t_(t),
      stars_(stars),
      known_(known),
      labels_(labels),
      star_(t, stars),
      link_(t, stars, labels.all()),
      held_(t.tetrahedra.size(), 0),
      filled_(t.tetrahedra.size(), 0),
      waiting_(t.sample_count, 0) {}

bool StarRepair::run(std::vector<std::uint32_t> round, std::span<const TetrahedronIndex> held, std::uint64_t most,
                     const Checkpoint& checkpoint) {
  ++run_;
  for (const TetrahedronIndex i : held) held_[i] = run_;
  const std::uint64_t before = counts.relabelled;
  bool possible = true;
  next_.clear();
  while (possible && !round.empty()) {
    for (const std::uint32_t s : round) waiting_[s] = 1;
    for (std::size_t k = 0; k < round.size() && possible; ++k) {
      if (checkpoint && k % default_block == 0) checkpoint(static_cast<double>(k) / static_cast<double>(round.size()));
      waiting_[round[k]] = 0;
      possible = mend(VertexIndex{round[k]}) && counts.relabelled - before <= most;
    }
    for (const std::uint32_t s : round) waiting_[s] = 0;
    // Samples whose star changed after their turn come again, in increasing order.
    std::swap(round, next_);
    next_.clear();
    std::sort(round.begin(), round.end());
    round.erase(std::unique(round.begin(), round.end()), round.end());
  }
  for (const std::uint32_t s : round) waiting_[s] = 0;
  return possible;
}

bool StarRepair::mend(VertexIndex s) {
  if (!labels_.on_surface(s) || link_.is_disc(s)) return true;
  star_.fill(s);
  for (bool mended = false; !mended;) {
    if (!mend_edges()) return false;
    if (!labels_.on_surface(s)) return true;
    if (!mend_vertex(mended)) return false;
  }
  return true;
}

bool StarRepair::mend_edges() {
  for (VertexIndex edge; (edge = edge_with_several_strands(star_, labels_.all())).valid(); ++counts.edges) {
    Candidate best{infinity, {}};
    offer_components(Label::inside, edge, best);
    offer_components(Label::outside, edge, best);
    if (best.members.empty()) return false;
    turn(best.members);
  }
  return true;
}

bool StarRepair::mend_vertex(bool& mended) {
  Candidate best{infinity, {}};
  const std::uint32_t inside = offer_components(Label::inside, VertexIndex{}, best);
  const std::uint32_t outside = offer_components(Label::outside, VertexIndex{}, best);
  mended = inside < 2 && outside < 2;
  if (mended) return true;
  offer_path(Label::inside, best);
  offer_path(Label::outside, best);
  if (best.members.empty()) return false;
  turn(best.members);
  ++counts.vertices;
  return true;
}

/// What becomes inside does so once in a run, so that repairs end.
bool StarRepair::may_turn(TetrahedronIndex i) const {
  return labels_[i] == Label::inside || (filled_[i] != run_ && known_[i] == Label::unlabelled && !t_.touches_cube(i));
}

/// What is held or known gives way last.
double StarRepair::extra_price(TetrahedronIndex i) const {
  return known_[i] != Label::unlabelled || held_[i] == run_ ? last_resort : 0;
}

double StarRepair::price_of(std::span<const TetrahedronIndex> members) {
  double price = 0;
  for (const TetrahedronIndex i : members) {
    if (!may_turn(i)) return infinity;
    price += extra_price(i);
  }
  const std::size_t then = labels_.now();
  const double before = labels_.cost();
  for (const TetrahedronIndex i : members) labels_.turn(i);
  price += labels_.cost() - before;
  labels_.back_to(then);
  return price;
}

void StarRepair::offer(std::vector<TetrahedronIndex> members, Candidate& best) {
  if (members.empty()) return;
  const double price = price_of(members);
  if (price < best.price) best = {price, std::move(members)};
}

/// Offers the sets of `label` (at an edge, or in the whole star) where there are several. \return how many
std::uint32_t StarRepair::offer_components(Label label, VertexIndex edge, Candidate& best) {
  const std::uint32_t count = star_.components(labels_.all(), label, edge, component_);
  for (std::uint32_t c = 0; count > 1 && c < count; ++c) {
    std::vector<TetrahedronIndex> members;
    for (std::uint32_t i = 0; i < star_.size(); ++i)
      if (component_[i] == c) members.push_back(star_[i]);
    offer(std::move(members), best);
  }
  return count;
}

/// Offers a path through the other label that joins two sets of `label`: the shortest by the sum of what each
/// tetrahedron costs alone (> 0 at a minimum of the energy).
void StarRepair::offer_path(Label label, Candidate& best) {
  if (star_.components(labels_.all(), label, VertexIndex{}, component_) < 2) return;
  std::vector<TetrahedronIndex> path;
  for (const std::uint32_t i : shortest_path(star_, component_, [&](std::uint32_t p) {
         if (!may_turn(star_[p])) return infinity;
         return std::max(0.0, labels_.cost_of(star_[p])) + extra_price(star_[p]);
       }))
    path.push_back(star_[i]);
  offer(std::move(path), best);
}

void StarRepair::turn(const std::vector<TetrahedronIndex>& members) {
  for (const TetrahedronIndex i : members) {
    if (labels_[i] == Label::outside) filled_[i] = run_;
    labels_.turn(i);
    ++counts.relabelled;
    for (const VertexIndex s : t_.tetrahedra[i]) {
      if (t_.is_corner(s) || waiting_[s.value]) continue;
      waiting_[s.value] = 1;
      next_.push_back(s.value);
    }
  }
}

} // namespace eigencrust
