// SPDX-License-Identifier: GPL-3.0-or-later
// Handles that no pole vouches for are closed (not in the paper; docs/decisions/0016).
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <eigencrust/stages.h>

#include "repair/handle_loops.h"
#include "repair/handles.h"
#include "repair/star_repair.h"
#include "repair/surface_part.h"

namespace eigencrust {
namespace {

// Longer loops go around what is there.
constexpr std::uint32_t longest_loop = 100;
// Tetrahedra tried at one loop for each of its vertices; more are no small change.
constexpr std::size_t region_per_vertex = 400;
// A change may leave so many specks behind; the component filter takes them.
constexpr std::int64_t tolerated_specks = 2;
// Loops wider than so many grid spacings are no noise.
constexpr double extent_in_grid_spacings = 96;
// Tetrahedra with larger values are as good as labelled by the first stage.
constexpr float sure = 0.8f;
constexpr int max_rounds = 6;
constexpr double infinity = std::numeric_limits<double>::infinity();

class HandleClosing {
 public:
  HandleClosing(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles, const Labels& first,
                const Labels& known, std::span<const float> grid_spacing, ManifoldRule rule, TetrahedronLabels& labels,
                const Threads& threads)
      : t_(t),
        stars_(stars),
        first_(first),
        grid_spacing_(grid_spacing),
        labels_(labels),
        threads_(threads),
        repair_(t, stars, poles, known, rule, labels),
        changed_(t.positions.size(), 0),
        taken_(t.tetrahedra.size(), 0) {}

  std::uint64_t run(const Checkpoint& checkpoint) {
    std::uint64_t closed = 0;
    for (int round = 0; round < max_rounds; ++round) {
      if (checkpoint) checkpoint(static_cast<double>(round) / max_rounds);
      const std::uint64_t in_round = close_short_loops(checkpoint);
      if (in_round == 0) break;
      closed += in_round;
    }
    return closed;
  }

 private:
  using Samples = std::vector<std::uint32_t>;
  using Region = std::vector<TetrahedronIndex>;
  using Journal = TetrahedronLabels::Journal;

  std::uint64_t close_short_loops(const Checkpoint& checkpoint) {
    const Surface surface = extract_surface(t_, labels_.labels(), threads_);
    std::fill(changed_.begin(), changed_.end(), 0);
    std::uint64_t closed = 0;
    Samples loop;
    for (const auto& vertices :
         handle_loops(surface.mesh.triangles, surface.mesh.vertices.size(), longest_loop, threads_)) {
      if (checkpoint) checkpoint(0);
      loop.clear();
      for (const std::uint32_t v : vertices) loop.push_back(surface.sample_of[v].value);
      // What was changed nearby may have closed this one; the next round knows.
      if (std::any_of(loop.begin(), loop.end(), [&](std::uint32_t s) { return changed_[s] != 0; })) continue;
      std::sort(loop.begin(), loop.end());
      if (!is_noise(loop) || failed_.contains(loop)) continue;
      if (close(loop))
        ++closed;
      else
        failed_.insert(loop);
    }
    return closed;
  }

  /// Is the loop no larger than noise may make one?
  bool is_noise(const Samples& loop) const {
    Box3 box;
    double noise = 0;
    for (const std::uint32_t s : loop) {
      box.add(t_.positions.raw()[s]);
      noise += static_cast<double>(grid_spacing_[s]) / static_cast<double>(loop.size());
    }
    return box.diagonal() <= extent_in_grid_spacings * noise;
  }

  /// Tries ever larger regions at the loop, both ways; takes the cheaper of the first that closes a handle.
  bool close(const Samples& loop) {
    Samples ring = loop;
    for (int size = 0; size <= 6; ++size) {
      if (size == 4) ring = samples_of(stars_of(loop));
      const Region region = size == 0 || size > 3 ? stars_of(ring) : disc_of(loop, 0.5 * (1 << size));
      if (size > 3) ring = samples_of(region);
      if (region.size() > region_per_vertex * loop.size()) break;
      double least = infinity;
      Journal best;
      for (const Label from : {Label::outside, Label::inside}) {
        Journal flips;
        const double price = flip_and_repair(region, from, flips);
        repair_.undo(flips);
        if (price >= least) continue;
        least = price;
        best = std::move(flips);
      }
      if (best.empty()) continue;
      keep(best);
      return true;
    }
    return false;
  }

  /// Changes the sides of the open tetrahedra of the region that are `from`, and repairs what that spoils.
  /// \return Σ |value| of what changed; infinite unless it took a handle away
  double flip_and_repair(const Region& region, Label from, Journal& flips) {
    for (const TetrahedronIndex i : region) {
      if (labels_[i] != from || first_[i] != Label::unlabelled || t_.touches_cube(i)) continue;
      if (std::fabs(labels_.value(i)) <= sure) labels_.turn(i, flips);
    }
    if (flips.empty()) return infinity;
    Journal repairs;
    repair_.hold(flips); // the repair shall not take them back
    repair_.run(samples_of(flips), &repairs);
    repair_.release(flips);
    flips.insert(flips.end(), repairs.begin(), repairs.end());
    return has_closed_one(flips) ? price_of(flips) : infinity;
  }

  bool has_closed_one(const Journal& flips) {
    const Samples around = samples_of(flips);
    const SurfacePart after = surface_part(t_, stars_, labels_.labels(), around);
    labels_.undo(flips);
    const SurfacePart before = surface_part(t_, stars_, labels_.labels(), around);
    for (const TetrahedronIndex i : flips) labels_.turn(i);
    const std::int64_t specks = after.closed_pieces - before.closed_pieces;
    return specks <= tolerated_specks && specks - (after.euler - before.euler) / 2 < 0;
  }

  double price_of(const Journal& flips) const {
    double price = 0;
    for (const TetrahedronIndex i : flips) price += std::fabs(static_cast<double>(labels_.value(i)));
    return price;
  }

  /// Makes the flips (undone by now) for good.
  void keep(const Journal& flips) {
    for (const TetrahedronIndex i : flips) {
      labels_.turn(i);
      for (const SampleIndex s : t_.tetrahedra[i]) changed_[s.value] = 1;
    }
  }

  Region stars_of(const Samples& samples) {
    Region region;
    for (const std::uint32_t s : samples)
      for (const TetrahedronIndex i : stars_[SampleIndex{s}]) take(i, region);
    return release(region);
  }

  /// Tetrahedra near the flat disc that the loop bounds, thickness in edges of the loop; with their stars.
  Region disc_of(const Samples& loop, double thickness) {
    Vec3 centre;
    for (const std::uint32_t s : loop)
      centre = centre + (1.0 / static_cast<double>(loop.size())) * t_.positions[SampleIndex{s}];
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    double radius = 0;
    for (const std::uint32_t s : loop) {
      const Vec3 d = t_.positions[SampleIndex{s}] - centre;
      const Eigen::Vector3d e(d.x, d.y, d.z);
      moments += e * e.transpose();
      radius = std::max(radius, norm(d));
    }
    const Eigen::Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
    const Vec3 normal{axis[0], axis[1], axis[2]};
    const double edge = 2 * std::numbers::pi * radius / static_cast<double>(loop.size());
    Region region;
    for (const std::uint32_t s : loop)
      for (const TetrahedronIndex i : stars_[SampleIndex{s}]) take(i, region);
    for (std::size_t k = 0; k < region.size() && region.size() <= region_per_vertex * loop.size(); ++k)
      for (const TetrahedronIndex n : t_.neighbours[region[k]]) {
        if (!n.valid()) continue;
        Vec3 middle;
        for (const SampleIndex s : t_.tetrahedra[n]) middle = middle + 0.25 * (t_.positions[s] - centre);
        if (std::fabs(dot(middle, normal)) <= thickness * edge && norm(middle) <= radius + edge) take(n, region);
      }
    return release(region);
  }

  void take(TetrahedronIndex i, Region& region) {
    if (taken_[i.value]) return;
    taken_[i.value] = 1;
    region.push_back(i);
  }
  Region release(Region& region) {
    for (const TetrahedronIndex i : region) taken_[i.value] = 0;
    std::sort(region.begin(), region.end());
    return std::move(region);
  }

  Samples samples_of(const Region& region) const {
    Samples samples;
    for (const TetrahedronIndex i : region) add_samples(i, samples);
    return sorted(samples);
  }
  void add_samples(TetrahedronIndex i, Samples& samples) const {
    for (const SampleIndex s : t_.tetrahedra[i])
      if (!t_.is_corner(s)) samples.push_back(s.value);
  }
  static Samples sorted(Samples& samples) {
    std::sort(samples.begin(), samples.end());
    samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
    return std::move(samples);
  }

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Labels& first_;
  std::span<const float> grid_spacing_;
  TetrahedronLabels& labels_;
  const Threads& threads_;
  StarRepair repair_;
  std::set<Samples> failed_;          ///< loops that nothing closed
  std::vector<std::uint8_t> changed_; ///< samples, in this round
  std::vector<std::uint8_t> taken_;   ///< tetrahedra, while a region is gathered
};

} // namespace

HandleCounts close_handles(const Tetrahedralization& t, const VertexStars& stars, const Poles& poles,
                           const Labels& first, const Labels& known, std::span<const float> grid_spacing,
                           ManifoldRule rule, TetrahedronLabels& labels, const Threads& threads,
                           const Checkpoint& checkpoint) {
  if (grid_spacing.empty()) return {}; // without noise every handle is meant
  return {HandleClosing(t, stars, poles, first, known, grid_spacing, rule, labels, threads).run(checkpoint)};
}

} // namespace eigencrust
