// SPDX-License-Identifier: GPL-3.0-or-later
#include "crusts/tight_cocone.h"

#include <algorithm>

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
        marked_(t_.tetrahedra.size(), 0),
        peeled_(t_.tetrahedra.size(), Label::inside) {
    for_blocks(threads, t_.sample_count, costly_block, [&](std::size_t begin, std::size_t end, std::size_t) {
      Umbrellas own(scene, cocone);
      for (std::size_t s = begin; s < end; ++s) good_[s] = own.is_good(SampleIndex{static_cast<std::uint32_t>(s)});
    });
  }

  Labels run() && {
    mark_from_the_cube();
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (t_.touches_cube(i)) peel(i);
    peel_on();
    // Good samples that nothing came to lie inside, or their patch hangs loose in there: they hold nothing up.
    std::vector<std::uint8_t> reached(t_.sample_count, 0);
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (peeled_[i] == Label::outside)
        for (const SampleIndex s : t_.tetrahedra[i])
          if (!t_.is_corner(s)) reached[s.value] = 1;
    for (std::uint32_t s = 0; s < t_.sample_count; ++s) good_[s] = good_[s] && reached[s];
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (peeled_[i] == Label::outside) stack_.push_back(i);
    peel_on();
    return std::move(peeled_);
  }

 private:
  [[nodiscard]] bool is_good(SampleIndex s) const { return !t_.is_corner(s) && good_[s.value]; }

  /// From good sample to good sample along their umbrellas: the part of a star that holds something outside is outside.
  void mark_from_the_cube() {
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (t_.touches_cube(i)) marked_[i] = 1;
    for (TetrahedronIndex i{0}; i.value < t_.tetrahedra.size(); ++i.value)
      if (marked_[i])
        for (const SampleIndex s : t_.tetrahedra[i])
          if (is_good(s)) mark(s, i);
    while (!samples_.empty()) {
      const auto [s, i] = samples_.back();
      samples_.pop_back();
      mark(s, i);
    }
  }

  /// The part of the star of s around i, which is outside.
  void mark(SampleIndex s, TetrahedronIndex i) {
    const Umbrellas::Part part = umbrellas_.part_of(s, i);
    if (!part.has_pole) return; // between the faces of a flat tetrahedron
    bool some = false;
    for (const TetrahedronIndex n : part.tetrahedra) {
      some = some || !marked_[n];
      if (!marked_[n]) fresh_.push_back(n);
      marked_[n] = 1;
    }
    if (!some) return;
    for (const SampleIndex q : part.rim) {
      if (!is_good(q)) continue;
      for (const TetrahedronIndex n : part.tetrahedra)
        if (const auto& v = t_.tetrahedra[n]; std::find(v.begin(), v.end(), q) != v.end()) {
          samples_.emplace_back(q, n);
          break;
        }
    }
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
      // Good samples that the marking did not come to, past places without a cocone.
      fresh_.clear();
      for (const SampleIndex s : t_.tetrahedra[i])
        if (is_good(s)) mark(s, i);
      while (!samples_.empty()) {
        const auto [s, n] = samples_.back();
        samples_.pop_back();
        mark(s, n);
      }
      for (const TetrahedronIndex n : fresh_)
        for (const TetrahedronIndex beside : t_.neighbours[n])
          if (beside.valid() && peeled_[beside] == Label::outside) peel(n);
    }
  }

  /// May what lies outside in `from` go on into `to`? It may where that is marked, and through all but the smallest
  /// face where no corner is good.
  [[nodiscard]] bool opens(TetrahedronIndex from, TetrahedronIndex to) const {
    if (marked_[to]) return true;
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
  IndexedArray<TetrahedronIndex, std::uint8_t> marked_; ///< outside, by the umbrellas
  Labels peeled_;                                       ///< outside: reached from the cube
  std::vector<std::pair<SampleIndex, TetrahedronIndex>> samples_;
  std::vector<TetrahedronIndex> stack_, fresh_;
};

} // namespace

Labels tight_cocone(const Scene& scene, const Threads& threads) {
  return Peeling(scene, cocone(scene, threads), threads).run();
}

} // namespace eigencrust
