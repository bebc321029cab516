// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/clear_stars.h"

#include <algorithm>

namespace eigencrust {
namespace {

using Wings = std::span<const SurfaceFans::Wing>;

/// Is every neighbour the first of one triangle and the last of one? The triangles form closed rings then.
bool is_closed(Wings wings) {
  return std::all_of(wings.begin(), wings.end(), [&](const SurfaceFans::Wing& wing) {
    int first = 0, last = 0;
    for (const auto& other : wings) {
      first += other.next == wing.next;
      last += other.last == wing.next;
    }
    return first == 1 && last == 1;
  });
}

/// Sign of an inner product n·(u × w) of vectors with these squared lengths; 0: rounding may hide it. Where each
/// coordinate has one rounding it is off by less than 15 · 2^-53 of the product of the lengths.
int sure_sign(double value, double squares) {
  constexpr double roundings = 4e-15, tiny = 1e-250; // below it products might vanish
  if (!(squares > tiny) || !(value * value > roundings * roundings * squares)) return 0;
  return value > 0 ? 1 : -1;
}

/// The star of one vertex, with memory for the next.
class Star {
 public:
  explicit Star(std::span<const Vec3> vertices) : vertices_(vertices) {}

  bool is_clear(std::size_t v, Wings wings) {
    return wings.size() >= 3 && is_closed(wings) && lies_flat(v, wings) && goes_around_once();
  }

 private:
  /// Seen along the sum of the areas, does each triangle turn the same way?
  bool lies_flat(std::size_t v, Wings wings) {
    next_.clear();
    area_.clear();
    normal_ = {};
    for (const auto& wing : wings) {
      next_.push_back(vertices_[wing.next] - vertices_[v]);
      area_.push_back(cross(next_.back(), vertices_[wing.last] - vertices_[v]));
      normal_ = normal_ + area_.back();
    }
    last_.clear();
    for (const auto& wing : wings) last_.push_back(vertices_[wing.last] - vertices_[v]);
    const double square = squared_norm(normal_);
    for (std::size_t i = 0; i < wings.size(); ++i)
      if (sure_sign(dot(normal_, area_[i]), square * squared_norm(next_[i]) * squared_norm(last_[i])) != 1)
        return false;
    return true;
  }

  /// Each ring of triangles crosses the line through the vertex and a point of the first triangle, on one side, as
  /// often as it goes around: none turns by half a turn.
  [[nodiscard]] bool goes_around_once() const {
    const Vec3 ahead = 0.6 * next_[0] + 0.4 * last_[0]; // not in the middle: rings may be regular
    const Vec3 across = cross(normal_, ahead);
    const double square = squared_norm(normal_) * squared_norm(ahead);
    int turns = 0;
    for (std::size_t i = 0; i < next_.size(); ++i) {
      const int from = sure_sign(dot(across, next_[i]), square * squared_norm(next_[i])),
                to = sure_sign(dot(across, last_[i]), square * squared_norm(last_[i]));
      if (from == 0 || to == 0) return false;
      turns += from < 0 && to > 0;
    }
    return turns == 1;
  }

  std::span<const Vec3> vertices_;
  std::vector<Vec3> next_, last_, area_; ///< of each triangle, from the vertex; twice its area
  Vec3 normal_;
};

} // namespace

std::vector<std::uint8_t> clear_stars(std::span<const Vec3> vertices, const SurfaceFans& fans, const Threads& threads) {
  std::vector<std::uint8_t> clear(vertices.size());
  for_blocks(threads, clear.size(), default_block, [&](std::size_t begin, std::size_t end, std::size_t) {
    Star star(vertices);
    for (std::size_t v = begin; v < end; ++v) clear[v] = star.is_clear(v, fans[v]) ? 1 : 0;
  });
  return clear;
}

} // namespace eigencrust
