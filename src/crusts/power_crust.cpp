// SPDX-License-Identifier: GPL-3.0-or-later
#include "crusts/power_crust.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "parallel/compressed_rows.h"

namespace eigencrust {
namespace {

/// What speaks for either side of a pole, each in [0, 1].
struct Say {
  double inside = 0, outside = 0;
  /// One side alone: how sure that is; both: how far they differ, after all of those.
  [[nodiscard]] double priority() const {
    return inside == 0 || outside == 0 ? std::max(inside, outside) : std::abs(inside - outside) - 1;
  }
};

struct Opposite {
  PoleIndex pole;
  double weight; ///< -cos of the angle at the sample
};
struct Beside {
  PoleIndex pole;
  double weight; ///< cos of the angle at which the balls intersect; > 0: deeply
};

/// (r² + s² - d²) / 2rs: 1 where two balls coincide, 0 where they intersect at right angles.
double depth_of_intersection(const Sphere& a, const Sphere& b) {
  return (a.radius * a.radius + b.radius * b.radius - squared_norm(a.centre - b.centre)) / (2 * a.radius * b.radius);
}

class Queue {
 public:
  Queue(const Scene& scene, const PowerDiagram& diagram, IndexedArray<PoleIndex, Label> known)
      : side_(std::move(known)),
        evidence_(side_.size()),
        opposite_(opposites(scene)),
        beside_(neighbours(scene.poles, diagram)) {}

  IndexedArray<PoleIndex, Label> run() && {
    for (PoleIndex p{0}; p.value < side_.size(); ++p.value)
      if (side_[p] != Label::unlabelled) tell(p);
    // A pole is in the queue once for each time that its evidence changed; the last entry counts.
    while (!queue_.empty()) {
      const auto [priority, index] = queue_.top();
      queue_.pop();
      const PoleIndex p{index};
      if (side_[p] != Label::unlabelled || priority != evidence_[p].priority()) continue;
      side_[p] = evidence_[p].inside > evidence_[p].outside ? Label::inside : Label::outside;
      tell(p);
    }
    // Nothing reaches these from anywhere.
    for (Label& label : side_.raw())
      if (label == Label::unlabelled) label = Label::outside;
    return std::move(side_);
  }

 private:
  static CompressedRows<Opposite> opposites(const Scene& scene) {
    const Tetrahedralization& t = scene.tetrahedralization;
    const Poles& poles = scene.poles;
    return build_rows<Opposite>(poles.sphere.size(), [&](auto&& visit) {
      for (SampleIndex s{0}; s.value < t.sample_count; ++s.value) {
        const auto [first, second] = poles.of_sample[s];
        if (!second.valid()) continue;
        const Vec3 u = poles.sphere[first].centre - t.positions[s], v = poles.sphere[second].centre - t.positions[s];
        const double weight = -dot(u, v) / (norm(u) * norm(v));
        visit(first.value, Opposite{second, weight});
        visit(second.value, Opposite{first, weight});
      }
    });
  }
  static CompressedRows<Beside> neighbours(const Poles& poles, const PowerDiagram& diagram) {
    return build_rows<Beside>(poles.sphere.size(), [&](auto&& visit) {
      for (const auto& [a, b] : diagram.facets) {
        const double weight = depth_of_intersection(poles.sphere[PoleIndex{a}], poles.sphere[PoleIndex{b}]);
        if (!(weight > 0)) continue;
        visit(a, Beside{PoleIndex{b}, weight});
        visit(b, Beside{PoleIndex{a}, weight});
      }
    });
  }

  void tell(PoleIndex p) {
    const bool inside = side_[p] == Label::inside;
    const double sure = inside ? evidence_[p].inside : evidence_[p].outside;
    for (const auto& [other, weight] : opposite_[p.value])
      raise(other, inside ? &Say::outside : &Say::inside, (sure > 0 ? sure : 1) * weight);
    for (const auto& [other, weight] : beside_[p.value]) raise(other, inside ? &Say::inside : &Say::outside, weight);
  }
  void raise(PoleIndex p, double Say::*which, double value) {
    if (side_[p] != Label::unlabelled || !(value > evidence_[p].*which)) return;
    evidence_[p].*which = value;
    queue_.emplace(evidence_[p].priority(), p.value);
  }

  IndexedArray<PoleIndex, Label> side_;
  IndexedArray<PoleIndex, Say> evidence_;
  CompressedRows<Opposite> opposite_;
  CompressedRows<Beside> beside_;
  std::priority_queue<std::pair<double, std::uint32_t>> queue_; ///< ties go to the larger number
};

} // namespace

IndexedArray<PoleIndex, Label> queue_labels(const Scene& scene, const PowerDiagram& diagram,
                                            IndexedArray<PoleIndex, Label> known) {
  return Queue(scene, diagram, std::move(known)).run();
}

TriangleMesh power_crust(const PowerDiagram& diagram, const IndexedArray<PoleIndex, Label>& side) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex(diagram.vertices.size(), no_index);
  const auto vertex_of = [&](std::uint32_t v) {
    if (vertex[v] == no_index) {
      vertex[v] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(diagram.vertices[v]);
    }
    return vertex[v];
  };
  for (std::size_t f = 0; f < diagram.facets.size(); ++f) {
    const auto [a, b] = diagram.facets[f];
    const bool inward = side[PoleIndex{a}] == Label::outside;
    if (side[PoleIndex{a}] == side[PoleIndex{b}]) continue;
    const auto polygon = diagram.polygon(f);
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      std::array<std::uint32_t, 3> triangle{vertex_of(polygon[0]), vertex_of(polygon[k - 1]), vertex_of(polygon[k])};
      if (inward) std::swap(triangle[1], triangle[2]);
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

} // namespace eigencrust
