// SPDX-License-Identifier: GPL-3.0-or-later
// Spikes to isolated samples, and fins to small groups of samples far from all others, are cut off where no pole
// vouches for them (not in the paper; docs/decisions/0013).
#include <algorithm>
#include <cmath>
#include <set>

#include <eigencrust/stages.h>

#include "repair/spikes.h"
#include "repair/star_repair.h"
#include "repair/surface_part.h"
#include "surface/triangle_support.h"

namespace eigencrust {
namespace {

// All triangles at a tip are borne out less than that: edges of 12 to 25 spacings, by contrast.
constexpr float most_support = 0.1f;
// A group is lonely that has so few samples ...
constexpr std::size_t most_in_group = 64;
// ... and is so many typical distances from all others: twice what is no support at all.
constexpr double gap_in_spacings = 20;

/// Samples that stand together, increasing.
using Group = std::vector<SampleIndex>;

bool holds(const Group& group, SampleIndex s) { return std::binary_search(group.begin(), group.end(), s); }

class SpikeCutting {
 public:
  SpikeCutting(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, const Labels& first,
               const Labels& known, const Neighbourhoods& neighbourhoods, std::span<const float> grid_spacing,
               ManifoldRule rule, TetrahedronLabels& labels)
      : t_(t),
        stars_(stars),
        first_(first),
        labels_(labels),
        support_(t, labels, neighbourhoods, grid_spacing),
        repair_(t, stars, poles, known, rule, labels) {}

  /// Is that a tip? It leaves the surface if the surface stays what it is otherwise.
  bool cut(const Group& tip) {
    if (!is_tip(tip)) return false;
    Journal cheaper = side_of_stars(tip, Label::inside), other = side_of_stars(tip, Label::outside);
    if (price_of(other) < price_of(cheaper)) std::swap(cheaper, other);
    return flip(cheaper) || flip(other);
  }

 private:
  using Journal = TetrahedronLabels::Journal;

  /// On the surface, with no triangle to other samples that the samples bear out.
  bool is_tip(const Group& group) const {
    bool on_surface = false;
    for (const SampleIndex s : group)
      for (const TetrahedronIndex i : stars_[s]) {
        if (labels_[i] != Label::inside) continue;
        const auto& v = t_.tetrahedra[i];
        for (std::size_t k = 0; k < 4; ++k) {
          const TetrahedronIndex n = t_.neighbours[i][k];
          if (v[k] == s || !n.valid() || labels_[n] == Label::inside) continue;
          const std::array<SampleIndex, 3> face{v[(k + 1) % 4], v[(k + 2) % 4], v[(k + 3) % 4]};
          if (std::all_of(face.begin(), face.end(), [&](SampleIndex f) { return holds(group, f); })) continue;
          if (support_(face, i, n) >= most_support) return false;
          on_surface = true;
        }
      }
    return on_surface;
  }

  /// The tetrahedra of one side around the samples; none where the first stage settled one of them. What it says of a
  /// lonely group it has from that group alone.
  Journal side_of_stars(const Group& group, Label side) const {
    std::vector<TetrahedronIndex> stars;
    for (const SampleIndex s : group) stars.insert(stars.end(), stars_[s].begin(), stars_[s].end());
    std::sort(stars.begin(), stars.end());
    stars.erase(std::unique(stars.begin(), stars.end()), stars.end());
    Journal flips;
    for (const TetrahedronIndex i : stars) {
      if (labels_[i] != side) continue;
      if ((group.size() == 1 && first_[i] != Label::unlabelled) || t_.touches_cube(i)) return {};
      flips.push_back(i);
    }
    return flips;
  }

  double price_of(const Journal& flips) const {
    double price = 0;
    for (const TetrahedronIndex i : flips) price += std::fabs(static_cast<double>(labels_.value(i)));
    return price;
  }

  /// How much the surface's area would change.
  double area_change(const Journal& flips) const {
    double change = 0;
    for (const TetrahedronIndex i : flips) {
      const auto& v = t_.tetrahedra[i];
      for (std::size_t k = 0; k < 4; ++k) {
        const TetrahedronIndex n = t_.neighbours[i][k];
        if (!n.valid() || std::find(flips.begin(), flips.end(), n) != flips.end()) continue;
        const Vec3& a = t_.positions[v[(k + 1) % 4]];
        const double area = norm(cross(t_.positions[v[(k + 2) % 4]] - a, t_.positions[v[(k + 3) % 4]] - a)) / 2;
        change += labels_[n] == labels_[i] ? area : -area;
      }
    }
    return change;
  }

  /// Changes sides where that makes the surface smaller: filling up beside a spike can reach out to the next outlier.
  /// Takes it back if the surface is no manifold then, or has other handles or more pieces.
  bool flip(const Journal& flips) {
    if (flips.empty() || !(area_change(flips) < 0)) return false;
    std::vector<std::uint32_t> around;
    for (const TetrahedronIndex i : flips)
      for (const SampleIndex s : t_.tetrahedra[i])
        if (!t_.is_corner(s)) around.push_back(s.value);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());

    const SurfacePart before = surface_part(t_, stars_, labels_.labels(), around);
    for (const TetrahedronIndex i : flips) labels_.turn(i);
    const SurfacePart after = surface_part(t_, stars_, labels_.labels(), around);
    Journal repairs;
    if (after.euler == before.euler && after.closed_pieces == before.closed_pieces) {
      repair_.run(around, &repairs);
      if (repairs.empty()) return true;
      repair_.undo(repairs);
    }
    labels_.undo(flips);
    return false;
  }

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Labels& first_;
  TetrahedronLabels& labels_;
  TriangleSupport support_;
  StarRepair repair_;
};

/// Corners of surface triangles with an edge that is longer than the gap.
std::vector<SampleIndex> at_long_triangles(const Tetrahedralization& t, const Labels& labels, double gap) {
  std::vector<SampleIndex> samples;
  for (TetrahedronIndex i{0}; i.value < t.tetrahedra.size(); ++i.value) {
    if (labels[i] != Label::inside) continue;
    const auto& v = t.tetrahedra[i];
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours[i][k];
      if (!n.valid() || labels[n] == Label::inside) continue;
      const std::array<SampleIndex, 3> face{v[(k + 1) % 4], v[(k + 2) % 4], v[(k + 3) % 4]};
      const auto is_long = [&](std::size_t e) {
        return squared_norm(t.positions[face[e]] - t.positions[face[(e + 1) % 3]]) > gap * gap;
      };
      if (is_long(0) || is_long(1) || is_long(2)) samples.insert(samples.end(), face.begin(), face.end());
    }
  }
  std::sort(samples.begin(), samples.end());
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  return samples;
}

/// The samples that edges of at most `gap` join with one; empty if they are too many to be lonely.
Group group_of(const Tetrahedralization& t, const VertexStars& stars, SampleIndex first, double gap) {
  Group group{first};
  for (std::size_t k = 0; k < group.size(); ++k)
    for (const TetrahedronIndex i : stars[group[k]])
      for (const SampleIndex s : t.tetrahedra[i]) {
        if (t.is_corner(s) || squared_norm(t.positions[s] - t.positions[group[k]]) > gap * gap) continue;
        if (std::find(group.begin(), group.end(), s) != group.end()) continue;
        if (group.size() == most_in_group) return {};
        group.push_back(s);
      }
  std::sort(group.begin(), group.end());
  return group;
}

/// Isolated samples, each for itself, and lonely groups of two or more; only those that long triangles lead to.
std::vector<Group> possible_tips(const Tetrahedralization& t, const VertexStars& stars,
                                 const Neighbourhoods& neighbourhoods, const Labels& labels) {
  std::vector<Group> tips;
  for (SampleIndex s{0}; s.value < t.sample_count; ++s.value)
    if (neighbourhoods.isolated[s.value] > 0) tips.push_back({s});
  const double gap = gap_in_spacings * neighbourhoods.typical;
  std::set<Group> groups;
  for (const SampleIndex s : at_long_triangles(t, labels, gap))
    if (Group group = group_of(t, stars, s, gap); group.size() > 1) groups.insert(std::move(group));
  tips.insert(tips.end(), groups.begin(), groups.end());
  return tips;
}

} // namespace

SpikeCounts cut_spikes(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, const Labels& first,
                       const Labels& known, const Neighbourhoods& neighbourhoods, std::span<const float> grid_spacing,
                       ManifoldRule rule, TetrahedronLabels& labels) {
  std::vector<Group> left = possible_tips(t, stars, neighbourhoods, labels.labels());
  if (left.empty()) return {};
  SpikeCutting cutting(t, stars, poles, first, known, neighbourhoods, grid_spacing, rule, labels);
  // A spike on a spike stands free only after the outer one is gone.
  SpikeCounts counts;
  for (std::size_t before = left.size() + 1; left.size() < before;) {
    before = left.size();
    std::erase_if(left, [&](const Group& tip) { return cutting.cut(tip); });
    counts.cut += before - left.size();
  }
  return counts;
}

} // namespace eigencrust
