// SPDX-License-Identifier: GPL-3.0-or-later
#include "crusts/tight_cocone.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "crusts/umbrella.h"
#include "geometry/tetrahedron.h"

namespace eigencrust {
namespace {

class Peeling {
 public:
  Peeling(const Scene& scene, const Cocone& cocone, const Threads& threads)
      : scene_(scene),
        t_(scene.tetrahedralization),
        umbrellas_(scene, cocone),
        good_(t_.sample_count),
        oriented_(t_.sample_count, 0),
        marked_(t_.tetrahedra.size()),
        peeled_(t_.tetrahedra.size(), Label::inside) {
    for_blocks(threads, t_.sample_count, costly_block, [&](std::size_t begin, std::size_t end, std::size_t) {
      Umbrellas own(scene, cocone);
      for (std::size_t s = begin; s < end; ++s) good_[s] = own.is_good(SampleIndex{static_cast<std::uint32_t>(s)});
    });
  }

  Labels run() && {
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (t_.touches_cube(i)) orient_at(i);
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (t_.touches_cube(i)) peel(i);
    peel_on();
    // Good samples that nothing came to lie inside, or their patch hangs loose in there: they hold nothing up.
    for (std::uint32_t s = 0; s < t_.sample_count; ++s) good_[s] = good_[s] && oriented_[s];
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (peeled_[i] == Label::outside) stack_.push_back(i);
    peel_on();
    return std::move(peeled_);
  }

 private:
  struct Mark { ///< what the umbrellas of a tetrahedron's corners say
    bool outside = false, inside = false;
  };

  [[nodiscard]] bool is_good(SampleIndex s) const { return !t_.is_corner(s) && good_[s.value]; }

  /// The good samples of a tetrahedron that is outside, and from them along umbrellas all others.
  void orient_at(TetrahedronIndex outside) {
    for (const SampleIndex s : t_.tetrahedra[outside])
      if (is_good(s)) samples_.emplace_back(s, outside);
    // The first in first, so that a sample is mostly reached from several sides before it is its turn.
    for (; !samples_.empty(); samples_.pop_front())
      if (const auto [s, i] = samples_.front(); !oriented_[s.value]) orient(s, i);
  }

  /// The side of the umbrella of s on which a tetrahedron lies is outside, the other inside; unless most of what other
  /// umbrellas said of those tetrahedra is the reverse.
  void orient(SampleIndex s, TetrahedronIndex outside) {
    auto [out, in] = umbrellas_.sides_of(s, outside);
    if (out.tetrahedra.empty()) return;
    if (votes_for_outside(out) < votes_for_outside(in)) std::swap(out, in);
    oriented_[s.value] = 1;
    for (const TetrahedronIndex i : in.tetrahedra) marked_[i].inside = true;
    for (const TetrahedronIndex i : out.tetrahedra) {
      marked_[i].outside = true;
      for (const TetrahedronIndex beside : t_.neighbours[i])
        if (beside.valid() && peeled_[beside] == Label::outside) stack_.push_back(beside); // it may be open now
    }
    for (const auto& [q, behind] : out.rim)
      if (is_good(q) && !oriented_[q.value]) samples_.emplace_back(q, behind);
  }

  [[nodiscard]] std::int64_t votes_for_outside(const Umbrellas::Part& part) const {
    std::int64_t votes = 0;
    for (const TetrahedronIndex i : part.tetrahedra) votes += int{marked_[i].outside} - int{marked_[i].inside};
    return votes;
  }

  void peel(TetrahedronIndex i) {
    if (peeled_[i] == Label::outside) return;
    peeled_[i] = Label::outside;
    stack_.push_back(i);
  }

  void peel_on() {
    while (!stack_.empty()) {
      const TetrahedronIndex i = stack_.back();
      stack_.pop_back();
      for (std::size_t k = 0; k < 4; ++k)
        if (const TetrahedronIndex n = t_.neighbours[i][k]; n.valid() && peeled_[n] == Label::inside && opens(i, n))
          peel(n);
      // Good samples that no umbrella led to, past places without a cocone.
      orient_at(i);
    }
  }

  /// May what lies outside in `from` go on into `to`? It may where the umbrellas say so and none contradicts, and
  /// through all but the smallest face where no corner is good.
  [[nodiscard]] bool opens(TetrahedronIndex from, TetrahedronIndex to) const {
    if (marked_[to].inside || marked_[to].outside) return !marked_[to].inside;
    const auto& v = t_.tetrahedra[to];
    if (std::any_of(v.begin(), v.end(), [&](SampleIndex s) { return is_good(s); })) return false;
    return t_.neighbours[to][smallest_face(to)] != from;
  }

  /// The face with the smallest circumscribed circle, by the corner opposite.
  [[nodiscard]] std::size_t smallest_face(TetrahedronIndex i) const {
    std::size_t smallest = 0;
    double least = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<Vec3, 3> p{};
      for (std::size_t c = 0; c < 3; ++c) p[c] = t_.positions[t_.tetrahedra[i][face_opposite[k][c]]];
      const double edges = squared_norm(p[1] - p[0]) * squared_norm(p[2] - p[1]) * squared_norm(p[0] - p[2]);
      // R = abc / 4A; squared, without the constant
      const double circle = edges / squared_norm(cross(p[1] - p[0], p[2] - p[0]));
      if (k == 0 || circle < least) {
        least = circle;
        smallest = k;
      }
    }
    return smallest;
  }

  const Scene& scene_;
  const Tetrahedralization& t_;
  Umbrellas umbrellas_;
  std::vector<std::uint8_t> good_;
  std::vector<std::uint8_t> oriented_; ///< good samples whose outer side is known
  IndexedArray<TetrahedronIndex, Mark> marked_;
  Labels peeled_; ///< outside: reached from the cube
  std::deque<std::pair<SampleIndex, TetrahedronIndex>> samples_;
  std::vector<TetrahedronIndex> stack_;
};

} // namespace

Labels tight_cocone(const Scene& scene, const Threads& threads) {
  return Peeling(scene, cocone(scene, threads), threads).run();
}

} // namespace eigencrust
