// SPDX-License-Identifier: GPL-3.0-or-later
// Handles as large as the noise are closed (not in the paper; docs/decisions/0016, 0027).
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "repair/generators.h"
#include "repair/handle_loops.h"

namespace eigencrust {
namespace {

// Noise makes tunnels and bridges as wide as this at most, in deviations. Closing one turns faces over a disc of that
// radius, two for each sample, which cost about one each: g = 2π (16 σ / h)². Where there is no noise a handle is meant.
constexpr double noise_reach = 16;
// Longer loops go around what is there.
constexpr std::uint32_t longest_loop = 100;
// Tetrahedra tried at one loop for each unit of what it is worth: what turns costs about one each.
constexpr double tetrahedra_per_worth = 8;
constexpr int max_rounds = 6;

class HandleClosing {
 public:
  explicit HandleClosing(Moves& moves)
      : moves_(moves), t_(moves.scene.t), stars_(moves.scene.stars), taken_(t_.tetrahedra.size(), 0) {}

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
  using Loop = std::vector<std::uint32_t>;
  using Region = std::vector<TetrahedronIndex>;

  std::uint64_t close_short_loops(const Checkpoint& checkpoint) {
    const Surface surface = extract_surface(t_, moves_.labels().all(), moves_.scene.threads);
    std::vector<std::uint8_t> changed(t_.positions.size(), 0);
    std::uint64_t closed = 0;
    Loop loop;
    for (const auto& vertices : handle_loops(surface.mesh.triangles, surface.mesh.vertices.size(), longest_loop,
                                             moves_.scene.threads)) {
      if (checkpoint) checkpoint(0);
      loop.clear();
      for (const std::uint32_t v : vertices) loop.push_back(surface.sample_of[v].value);
      // What was changed nearby may have closed this one; the next round knows.
      if (std::any_of(loop.begin(), loop.end(), [&](std::uint32_t s) { return changed[s] != 0; })) continue;
      std::sort(loop.begin(), loop.end());
      const double worth = worth_of(loop);
      if (!(worth > 0) || !failed_.insert(loop).second) continue;
      const Moves::Outcome best = close(loop, worth);
      if (best.turned.empty()) continue;
      failed_.erase(loop);
      moves_.make(best);
      for (const std::uint32_t s : moves_.samples_of(best.turned)) changed[s] = 1;
      ++closed;
    }
    return closed;
  }

  /// g: what closing a handle of this loop is worth.
  double worth_of(const Loop& loop) const {
    const SampleModel& model = moves_.scene.model;
    double noise = 0, spacing = 0;
    for (const std::uint32_t s : loop) {
      noise += static_cast<double>(model.noise[s]);
      spacing += static_cast<double>(model.spacing[s]);
    }
    const double reach = noise_reach * noise / spacing;
    return 2 * std::numbers::pi * reach * reach;
  }

  /// The better of filling and cutting for the first region that does it; the regions grow.
  Moves::Outcome close(const Loop& loop, double worth) {
    Loop ring = loop;
    const auto most = static_cast<std::size_t>(100 + tetrahedra_per_worth * worth);
    for (int size = 0; size <= 6; ++size) {
      if (size == 4) ring = moves_.samples_of(stars_of(loop));
      const Region region = size == 0 || size > 3 ? stars_of(ring) : disc_of(loop, 0.5 * (1 << size), most);
      if (size > 3) ring = moves_.samples_of(region);
      if (region.size() > most) break;
      Moves::Outcome best;
      for (const Label from : {Label::outside, Label::inside}) {
        Region turned;
        for (const TetrahedronIndex i : region)
          if (moves_.labels()[i] == from && moves_.is_open(i)) turned.push_back(i);
        if (turned.empty()) continue;
        Moves::Outcome outcome = moves_.weigh(turned, worth);
        if (outcome.change < best.change) best = std::move(outcome);
      }
      if (best.change < 0) return best;
    }
    return {};
  }

  Region stars_of(const Loop& samples) {
    Region region;
    for (const std::uint32_t s : samples)
      for (const TetrahedronIndex i : stars_[SampleIndex{s}]) take(i, region);
    return release(region);
  }

  /// Tetrahedra near the flat disc that the loop bounds, thickness in edges of the loop; with their stars.
  Region disc_of(const Loop& loop, double thickness, std::size_t most) {
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
    for (std::size_t k = 0; k < region.size() && region.size() <= most; ++k)
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

  Moves& moves_;
  const Tetrahedralization& t_;
  const VertexStars& stars_;
  std::set<Loop> failed_;           ///< loops that nothing closed
  std::vector<std::uint8_t> taken_; ///< tetrahedra, while a region is gathered
};

} // namespace

HandleCounts close_handles(Moves& moves, const Checkpoint& checkpoint) {
  return {HandleClosing(moves).run(checkpoint)};
}

} // namespace eigencrust
