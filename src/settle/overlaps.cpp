// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/overlaps.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numbers>
#include <span>

#include "evidence/next_sheet.h"
#include "geometry/distinct_numbers.h"
#include "geometry/mesh_topology.h"
#include "geometry/tetrahedron.h"
#include "samples/scales.h"
#include "settle/outside_regions.h"

namespace eigencrust {
namespace {

// Parts of the solid that this ball has room in, and that no way for the smaller one connects, are parts of their own.
// In the unit of clearance(), as all balls here.
constexpr double solid_ball = 1.5, connecting_ball = 1;
// Samples around an opening that the passing ball just does not get through, on both of its sides.
constexpr double least_curve = 2 * 2 * std::numbers::pi * passing_ball;
// What has more samples along the curve for each of its own is a crack, lies among strays, or is the pore between
// beads.
constexpr double most_curve = 1.25;
// Square of the samples along the curve for each of the chamber: a peg that sticks four of its radii deep in a body has
// 5, where the curve is seen from both sides; a vessel whose neck is narrow, or closed by strays, up to 3.9.
constexpr double least_outline = 5;
// What lies around a sample: so many edges away.
constexpr int edges_around = 3;
// A chamber is so many times as wide as the ways out of it; the pores between touching beads are less.
constexpr double least_room = 4;
// Where parts overlap the solid is parted along a third of the curve or more, where noise tears thin walls along a
// sixth of it at most (docs/decisions/0045).
constexpr double least_parted = 0.25;
// So many samples of such a curve say how it is with all.
constexpr std::size_t enough_of_curve = 256;

/// Samples and tetrahedra around some samples, each in order.
struct Around {
  std::vector<SampleIndex> samples;
  std::vector<TetrahedronIndex> tetrahedra;
};

class OverlapSearch {
 public:
  OverlapSearch(const Scene& scene, const Labels& labels, const Labels& known, const Threads& threads)
      : scene_(scene), t_(scene.tetrahedralization), labels_(labels), regions_(scene, labels, known, threads) {}

  Overlaps find() {
    std::vector<std::uint32_t> chambers; // in order
    for (const UnknownRegion& region : regions_.unknown())
      if (is_overlap(region)) chambers.push_back(region.number);
    Overlaps overlaps{static_cast<std::uint32_t>(chambers.size()), {}};
    if (!chambers.empty())
      for (TetrahedronIndex i{0}; i.value < labels_.size(); ++i.value)
        if (std::binary_search(chambers.begin(), chambers.end(), regions_[i])) overlaps.tetrahedra.push_back(i);
    return overlaps;
  }

 private:
  [[nodiscard]] bool is_overlap(const UnknownRegion& chamber) {
    const Around near = around(chamber.samples, std::numeric_limits<double>::infinity());
    regions_.divide(near.tetrahedra);
    std::vector<SampleIndex> curve;
    std::copy_if(near.samples.begin(), near.samples.end(), std::back_inserter(curve),
                 [&](SampleIndex s) { return touches(s, chamber.number); });
    const auto on_curve = static_cast<double>(curve.size()), all = static_cast<double>(chamber.samples.size());
    return on_curve >= least_curve && on_curve * on_curve >= least_outline * all && on_curve < most_curve * all &&
           chamber.widest >= least_room * widest_gate(near.tetrahedra, chamber.number) && is_solid_parted(curve) &&
           is_borne_out(chamber);
  }

  [[nodiscard]] Around around(std::span<const SampleIndex> from, double reach) const {
    Around found{{from.begin(), from.end()}, {}};
    std::vector<SampleIndex> ring = found.samples, next, all;
    for (int edges = 0; edges < edges_around; ++edges) {
      next.clear();
      for (const SampleIndex s : ring)
        for (const TetrahedronIndex i : scene_.stars[s]) {
          found.tetrahedra.push_back(i);
          for (const VertexIndex v : t_.tetrahedra[i])
            if (!t_.is_corner(v) && distance(t_.positions[v], t_.positions[from.front()]) <= reach)
              next.push_back(t_.sample(v));
        }
      sort_distinct(next);
      ring.clear();
      std::set_difference(next.begin(), next.end(), found.samples.begin(), found.samples.end(),
                          std::back_inserter(ring));
      all.clear();
      std::set_union(found.samples.begin(), found.samples.end(), ring.begin(), ring.end(), std::back_inserter(all));
      std::swap(all, found.samples);
    }
    sort_distinct(found.tetrahedra);
    return found;
  }

  /// Are there samples around most of it? The space between what a scanner saw is none.
  [[nodiscard]] bool is_borne_out(const UnknownRegion& chamber) const {
    double all = 0, sampled = 0;
    for (const TetrahedronIndex i : chamber.tetrahedra)
      for (std::size_t k = 0; k < 4; ++k) {
        const TetrahedronIndex n = t_.neighbours[i][k];
        if (!n.valid() || labels_[n] != Label::inside) continue;
        const auto& [a, b, c] = face_opposite[k];
        const auto& v = t_.tetrahedra[i];
        const Vec3& p = t_.positions[v[a]];
        const double area = norm(cross(t_.positions[v[b]] - p, t_.positions[v[c]] - p));
        all += area;
        if (is_in_sheet(scene_, i, n)) sampled += area;
      }
    return 2 * sampled > all;
  }
  /// The largest ball that gets from the chamber to another region.
  [[nodiscard]] double widest_gate(std::span<const TetrahedronIndex> near, std::uint32_t chamber) const {
    double widest = 0;
    for (const TetrahedronIndex i : near) {
      if (regions_[i] != chamber) continue;
      for (std::size_t k = 0; k < 4; ++k)
        if (const TetrahedronIndex n = t_.neighbours[i][k];
            n.valid() && regions_[n] != OutsideRegions::none && regions_[n] != chamber)
          widest = std::max(widest, clearance(scene_, i, k));
    }
    return widest;
  }
  /// Do the chamber and another region meet at the sample?
  [[nodiscard]] bool touches(SampleIndex s, std::uint32_t chamber) const {
    bool is_at_chamber = false, is_at_other = false;
    for (const TetrahedronIndex i : scene_.stars[s])
      if (const std::uint32_t region = regions_[i]; region != OutsideRegions::none)
        (region == chamber ? is_at_chamber : is_at_other) = true;
    return is_at_chamber && is_at_other;
  }

  /// Is the solid parted at enough of these samples?
  [[nodiscard]] bool is_solid_parted(std::span<const SampleIndex> curve) const {
    const std::size_t step = curve.size() / enough_of_curve + 1;
    std::size_t looked_at = 0, parted = 0;
    for (std::size_t k = 0; k < curve.size(); k += step, ++looked_at) parted += is_solid_parted(curve[k]);
    return static_cast<double>(parted) > least_parted * static_cast<double>(looked_at);
  }
  /// Is what is inside around the sample in two parts or more that balls get through?
  [[nodiscard]] bool is_solid_parted(SampleIndex s) const {
    const double reach = longest_edge * static_cast<double>(scene_.measures.model.spacing[s]);
    const std::vector<TetrahedronIndex> near = around(std::span(&s, 1), reach).tetrahedra;
    DisjointSets parts(near.size());
    std::vector<std::uint32_t> roomy;
    for (std::uint32_t at = 0; at < near.size(); ++at) {
      if (labels_[near[at]] != Label::inside) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        const TetrahedronIndex n = t_.neighbours[near[at]][k];
        if (!n.valid() || n < near[at] || labels_[n] != Label::inside) continue;
        const auto found = std::lower_bound(near.begin(), near.end(), n);
        if (found == near.end() || *found != n) continue;
        const double ball = clearance(scene_, near[at], k);
        if (ball >= connecting_ball) parts.unite(at, static_cast<std::uint32_t>(found - near.begin()));
        if (ball >= solid_ball) roomy.push_back(at);
      }
    }
    return std::any_of(roomy.begin(), roomy.end(),
                       [&](std::uint32_t at) { return parts.find(at) != parts.find(roomy.front()); });
  }

  const Scene& scene_;
  const Tetrahedralization& t_;
  const Labels& labels_;
  OutsideRegions regions_;
};

} // namespace

Overlaps find_overlaps(const Scene& scene, const Evidence& evidence, const Labels& labels, const Threads& threads) {
  return OverlapSearch(scene, labels, evidence.labels, threads).find();
}

} // namespace eigencrust
