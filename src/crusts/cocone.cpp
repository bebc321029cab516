// SPDX-License-Identifier: GPL-3.0-or-later
#include "crusts/cocone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/tetrahedron.h"
#include "parallel/compressed_rows.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust {
namespace {

// The cocone holds what is within π/8 of the tangent plane (Amenta et al. 2000, and all successors).
const double cocone_sine = std::sin(std::numbers::pi / 8);
// A flat cell is so much longer than wide; Dey and Goswami's program has the same ratio.
constexpr double least_ratio = 1.2;
// Normals of neighbours of a flat sample are within π/3 of its own (ibid.).
constexpr double least_cosine = 0.5;

/// Does the segment from a to b, relative to the sample, come within the cocone around the plane with normal n? It does
/// where (y·n)² <= sin² |y|², a quadratic inequality along the segment.
bool meets_cocone(const Vec3& a, const Vec3& b, const Vec3& n) {
  const double ss = cocone_sine * cocone_sine;
  const Vec3 d = b - a;
  const double an = dot(a, n), dn = dot(d, n);
  const double quadratic = dn * dn - ss * squared_norm(d), linear = 2 * (an * dn - ss * dot(a, d)),
               constant = an * an - ss * squared_norm(a);
  if (constant <= 0 || quadratic + linear + constant <= 0) return true;
  const double at = -linear / (2 * quadratic);
  return quadratic > 0 && at > 0 && at < 1 && constant + at * linear / 2 <= 0;
}

class CoconeBuilder {
 public:
  CoconeBuilder(const Scene& scene, const Threads& threads)
      : scene_(scene), t_(scene.tetrahedralization), threads_(threads), centre_(t_.tetrahedra.size()) {
    for_each_index(threads_, t_.tetrahedra.size(), [&](std::size_t i) {
      const auto& v = t_.tetrahedra.raw()[i];
      centre_.raw()[i] = circumcentre(t_.positions[v[0]], t_.positions[v[1]], t_.positions[v[2]], t_.positions[v[3]]);
    });
  }

  Cocone run() {
    find_normals();
    find_flat();
    find_faces();
    return std::move(result_);
  }

 private:
  /// Every edge of the sample's cell: visit(from, to, the two other samples of its dual face); relative to the sample.
  template <class Visit>
  void for_each_cell_edge(SampleIndex s, Visit&& visit) const {
    const Vec3& p = t_.positions[s];
    for (const TetrahedronIndex i : scene_.stars[s]) {
      const auto& v = t_.tetrahedra[i];
      for (std::size_t k = 0; k < v.size(); ++k) {
        const TetrahedronIndex n = t_.neighbours[i][k];
        // Each edge once; the faces at the cube's sides have no second tetrahedron.
        if (v[k] == s || !n.valid() || n < i) continue;
        std::array<SampleIndex, 2> others;
        std::size_t count = 0;
        for (const std::size_t c : face_opposite[k])
          if (v[c] != s) others[count++] = v[c];
        visit(centre_[i] - p, centre_[n] - p, others);
      }
    }
  }

  void find_normals() {
    result_.normal.resize(t_.sample_count);
    for_each_index(threads_, t_.sample_count, [&](std::size_t at) {
      const SampleIndex s{static_cast<std::uint32_t>(at)};
      const PoleIndex pole = scene_.poles.of_sample[s].first;
      if (!pole.valid()) return;
      const Vec3 u = scene_.poles.sphere[pole].centre - t_.positions[s];
      result_.normal[at] = (1 / norm(u)) * u;
    });
  }

  /// Is the cell long on both sides, beside its width in the tangent plane?
  bool is_long(SampleIndex s) const {
    const auto [first, second] = scene_.poles.of_sample[s];
    if (!second.valid()) return false;
    const Vec3& n = result_.normal[s.value];
    double width = 0;
    for_each_cell_edge(s, [&](const Vec3& a, const Vec3& b, const auto&) {
      const double an = dot(a, n), bn = dot(b, n);
      if ((an > 0) == (bn > 0)) return;
      width = std::max(width, squared_norm(a + (an / (an - bn)) * (b - a)));
    });
    const double height = std::min(norm(scene_.poles.sphere[first].centre - t_.positions[s]),
                                   norm(scene_.poles.sphere[second].centre - t_.positions[s]));
    return least_ratio * std::sqrt(width) <= height;
  }

  /// Samples whose cells touch that of s within its cocone; may name some twice.
  void cocone_neighbours(SampleIndex s, std::vector<std::uint32_t>& neighbours) const {
    const Vec3& n = result_.normal[s.value];
    for_each_cell_edge(s, [&](const Vec3& a, const Vec3& b, const std::array<SampleIndex, 2>& others) {
      if (!meets_cocone(a, b, n)) return;
      for (const SampleIndex q : others)
        if (!t_.is_corner(q)) neighbours.push_back(q.value);
    });
  }

  bool agree(std::uint32_t a, std::uint32_t b) const {
    return std::abs(dot(result_.normal[a], result_.normal[b])) >= least_cosine;
  }

  /// Flat are long cells all of whose neighbours' normals agree, and long cells that agree with a flat neighbour.
  void find_flat() {
    std::vector<std::uint8_t> long_cell(t_.sample_count);
    for_each_index(threads_, t_.sample_count,
                   [&](std::size_t s) { long_cell[s] = is_long(SampleIndex{static_cast<std::uint32_t>(s)}); });
    const auto neighbours = build_rows<std::uint32_t>(threads_, t_.sample_count, default_block, [&] {
      return [&](std::size_t s, std::vector<std::uint32_t>& row) {
        if (long_cell[s]) cocone_neighbours(SampleIndex{static_cast<std::uint32_t>(s)}, row);
      };
    });
    result_.flat.assign(t_.sample_count, 0);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t s = 0; s < t_.sample_count; ++s)
      if (long_cell[s] &&
          std::all_of(neighbours[s].begin(), neighbours[s].end(), [&](std::uint32_t q) { return agree(s, q); })) {
        result_.flat[s] = 1;
        queue.push_back(s);
      }
    for (std::size_t k = 0; k < queue.size(); ++k)
      for (const std::uint32_t q : neighbours[queue[k]]) {
        if (result_.flat[q] || !long_cell[q] || !agree(queue[k], q)) continue;
        result_.flat[q] = 1;
        queue.push_back(q);
      }
  }

  bool in_cocone(TetrahedronIndex i, std::size_t k) const {
    const TetrahedronIndex n = t_.neighbours[i][k];
    if (!n.valid()) return false;
    bool some = false;
    for (const std::size_t c : face_opposite[k]) {
      const SampleIndex s = t_.tetrahedra[i][c];
      if (t_.is_corner(s)) return false;
      if (!result_.flat[s.value]) continue;
      some = true;
      const Vec3& p = t_.positions[s];
      if (!meets_cocone(centre_[i] - p, centre_[n] - p, result_.normal[s.value])) return false;
    }
    return some;
  }

  void find_faces() {
    result_.face = IndexedArray<TetrahedronIndex, std::array<bool, 4>>(t_.tetrahedra.size());
    for_each_index(threads_, t_.tetrahedra.size(), [&](std::size_t at) {
      const TetrahedronIndex i{static_cast<std::uint32_t>(at)};
      for (std::size_t k = 0; k < 4; ++k) {
        // Both sides of a face must say the same: from the smaller tetrahedron.
        const TetrahedronIndex n = t_.neighbours[i][k];
        if (!n.valid()) continue;
        if (i < n) {
          result_.face[i][k] = in_cocone(i, k);
          continue;
        }
        const auto& back = t_.neighbours[n];
        result_.face[i][k] =
            in_cocone(n, static_cast<std::size_t>(std::find(back.begin(), back.end(), i) - back.begin()));
      }
    });
  }

  const Scene& scene_;
  const Tetrahedralization& t_;
  const Threads& threads_;
  IndexedArray<TetrahedronIndex, Vec3> centre_;
  Cocone result_;
};

} // namespace

Cocone cocone(const Scene& scene, const Threads& threads) { return CoconeBuilder(scene, threads).run(); }

} // namespace eigencrust
