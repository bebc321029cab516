// SPDX-License-Identifier: GPL-3.0-or-later
// Spikes to isolated samples that no pole vouches for are cut off (not in the paper; docs/decisions/0013).
#include <algorithm>
#include <cmath>

#include <eigencrust/stages.h>

#include "stages/star_repair.h"
#include "stages/surface_part.h"
#include "stages/triangle_support.h"

namespace eigencrust {
namespace {

// All triangles at a tip are borne out less than that: edges of 12 to 25 spacings, by contrast.
constexpr float most_support = 0.1f;

class SpikeCutting {
 public:
  SpikeCutting(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, const Labels& first,
               const Labels& known, const Neighbourhoods& neighbourhoods, std::span<const float> grid_spacing,
               ManifoldRule rule, FinalLabels& labels)
      : t_(t),
        stars_(stars),
        first_(first),
        labels_(labels),
        support_(t, labels, neighbourhoods, grid_spacing),
        repair_(t, stars, poles, known, rule, labels) {}

  /// Is that a tip? It leaves the surface if the surface stays what it is otherwise.
  bool cut(SampleIndex tip) {
    if (!is_tip(tip)) return false;
    std::vector<Flip> cheaper = side_of_star(tip, Label::inside), other = side_of_star(tip, Label::outside);
    if (price_of(other) < price_of(cheaper)) std::swap(cheaper, other);
    return flip(cheaper) || flip(other);
  }

 private:
  /// On the surface, with no triangle that the samples bear out.
  bool is_tip(SampleIndex s) const {
    bool on_surface = false;
    for (const TetrahedronIndex i : stars_[s]) {
      if (labels_.labels[i] != Label::inside) continue;
      const auto& v = t_.tetrahedra[i];
      for (std::size_t k = 0; k < 4; ++k) {
        const TetrahedronIndex n = t_.neighbours[i][k];
        if (v[k] == s || !n.valid() || labels_.labels[n] == Label::inside) continue;
        if (support_({v[(k + 1) % 4], v[(k + 2) % 4], v[(k + 3) % 4]}, i, n) >= most_support) return false;
        on_surface = true;
      }
    }
    return on_surface;
  }

  /// The tetrahedra of one side around s; none where the first stage settled one of them.
  std::vector<Flip> side_of_star(SampleIndex s, Label side) const {
    std::vector<Flip> flips;
    for (const TetrahedronIndex i : stars_[s]) {
      if (labels_.labels[i] != side) continue;
      if (first_[i] != Label::unlabelled || t_.touches_cube(i)) return {};
      flips.push_back({i, side});
    }
    return flips;
  }

  double price_of(const std::vector<Flip>& flips) const {
    double price = 0;
    for (const Flip& f : flips) price += std::fabs(static_cast<double>(labels_.value[f.tetrahedron]));
    return price;
  }

  /// How much the surface's area would change.
  double area_change(const std::vector<Flip>& flips) const {
    double change = 0;
    for (const Flip& f : flips) {
      const auto& v = t_.tetrahedra[f.tetrahedron];
      for (std::size_t k = 0; k < 4; ++k) {
        const TetrahedronIndex n = t_.neighbours[f.tetrahedron][k];
        const auto same = [&](const Flip& other) { return other.tetrahedron == n; };
        if (!n.valid() || std::any_of(flips.begin(), flips.end(), same)) continue;
        const Vec3& a = t_.positions[v[(k + 1) % 4]];
        const double area = norm(cross(t_.positions[v[(k + 2) % 4]] - a, t_.positions[v[(k + 3) % 4]] - a)) / 2;
        change += labels_.labels[n] == f.before ? area : -area;
      }
    }
    return change;
  }

  /// Changes sides where that makes the surface smaller: filling up beside a spike can reach out to the next outlier.
  /// Takes it back if the surface is no manifold then, or has other handles or more pieces.
  bool flip(const std::vector<Flip>& flips) {
    if (flips.empty() || !(area_change(flips) < 0)) return false;
    std::vector<std::uint32_t> around;
    for (const Flip& f : flips)
      for (const SampleIndex s : t_.tetrahedra[f.tetrahedron])
        if (!t_.is_corner(s)) around.push_back(s.value);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());

    const SurfacePart before = surface_part(t_, stars_, labels_.labels, around);
    for (const Flip& f : flips) turn(f.tetrahedron);
    const SurfacePart after = surface_part(t_, stars_, labels_.labels, around);
    std::vector<Flip> repairs;
    if (after.euler == before.euler && after.closed_pieces == before.closed_pieces) {
      repair_.run(around, &repairs);
      if (repairs.empty()) return true;
      repair_.undo(repairs);
    }
    for (const Flip& f : flips) turn(f.tetrahedron);
    return false;
  }

  void turn(TetrahedronIndex i) {
    Label& label = labels_.labels[i];
    label = label == Label::outside ? Label::inside : Label::outside;
    labels_.value[i] = -labels_.value[i];
  }

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Labels& first_;
  FinalLabels& labels_;
  TriangleSupport support_;
  StarRepair repair_;
};

} // namespace

std::uint64_t cut_spikes(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, const Labels& first,
                         const Labels& known, const Neighbourhoods& neighbourhoods, std::span<const float> grid_spacing,
                         ManifoldRule rule, FinalLabels& labels) {
  std::vector<std::uint32_t> left;
  for (std::uint32_t s = 0; s < t.sample_count; ++s)
    if (neighbourhoods.isolated[s] > 0) left.push_back(s);
  if (left.empty()) return 0;
  SpikeCutting cutting(t, stars, poles, first, known, neighbourhoods, grid_spacing, rule, labels);
  // A spike on a spike stands free only after the outer one is gone.
  std::uint64_t count = 0;
  for (std::size_t before = left.size() + 1; left.size() < before;) {
    before = left.size();
    std::erase_if(left, [&](std::uint32_t s) { return cutting.cut(SampleIndex{s}); });
    count += before - left.size();
  }
  return count;
}

} // namespace eigencrust
