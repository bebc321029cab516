// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/widths.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eigencrust {
namespace {

// In units of the larger of σ and 0.7 spacings; each has twice the samples of the one before.
constexpr std::array<double, 7> widths{2.83, 4, 5.66, 8, 11.3, 16, 22.6};
// Half an interval of confidence, in standard deviations.
constexpr double confidence = 0.8;
// The choice is averaged over so many units.
constexpr double choice_reach = 4;
// An estimate is needed as far beyond the vertices that go on as the average reaches, about.
constexpr int rings_beyond = 2;

/// What the fits of one width say, for all vertices.
struct Level {
  std::vector<float> offset; ///< NaN: nothing
  std::vector<Vec3> normal;
};

class WidthChoice {
 public:
  WidthChoice(const FitPlaces& places, std::span<const std::uint8_t> moving, const SurfaceFans& fans,
              const Threads& threads)
      : places_(places),
        moving_(moving),
        fans_(fans),
        threads_(threads),
        vertices_(places.position),
        vertex_of_(nearest_vertices(vertices_, places.samples, threads)),
        running_(places.position.size(), 0),
        chosen_(running_.size(), no_level),
        noise_(running_.size(), 0),
        low_(running_.size(), -std::numeric_limits<double>::infinity()),
        high_(running_.size(), std::numeric_limits<double>::infinity()) {
    for (std::size_t v = 0; v < running_.size(); ++v) running_[v] = moving[v] && squared_norm(places.normal[v]) > 0;
  }

  std::vector<Foot> run() {
    std::vector<std::uint8_t> wanted = running_;
    for (std::size_t k = 0; k < widths.size(); ++k) {
      if (k > 0) wanted = wanted_beyond();
      levels_.push_back(narrow_down(k, estimates(places_, vertices_, vertex_of_, widths[k], wanted, threads_)));
    }
    std::vector<Foot> feet(running_.size());
    for_each_index(
        threads_, feet.size(), [&](std::size_t v) { feet[v] = foot(v, average_choice(v)); }, costly_block);
    return feet;
  }

 private:
  static constexpr std::uint8_t no_level = 255;

  /// Intersects the intervals with those of one more width.
  Level narrow_down(std::size_t k, const std::vector<Estimate>& found) {
    Level level{std::vector<float>(found.size(), std::numeric_limits<float>::quiet_NaN()),
                std::vector<Vec3>(found.size())};
    for_each_index(threads_, found.size(), [&](std::size_t v) {
      const Estimate& e = found[v];
      if (!(e.deviation > 0)) return;
      level.offset[v] = static_cast<float>(e.offset);
      level.normal[v] = e.normal;
      if (!running_[v]) return;
      if (chosen_[v] == no_level) noise_[v] = noise_at(v, e);
      const double half = confidence * noise_[v] * e.deviation;
      const double low = std::max(low_[v], e.offset - half), high = std::min(high_[v], e.offset + half);
      running_[v] = low <= high;
      if (!running_[v]) return;
      low_[v] = low;
      high_[v] = high;
      chosen_[v] = static_cast<std::uint8_t>(k);
    });
    return level;
  }

  /// The narrowest fit knows the noise best, but where the shape is as fine it takes that for noise, too.
  [[nodiscard]] double noise_at(std::size_t v, const Estimate& narrowest) const {
    constexpr double most_over_model = 1.2;
    const double model = places_.noise[v];
    return model > 0 ? std::min(narrowest.noise, most_over_model * model) : narrowest.noise;
  }

  /// Vertices that go on, and those around.
  [[nodiscard]] std::vector<std::uint8_t> wanted_beyond() const {
    std::vector<std::uint8_t> wanted = running_;
    for (int ring = 0; ring < rings_beyond; ++ring) {
      std::vector<std::uint8_t> wider = wanted;
      for_each_index(threads_, wanted.size(), [&](std::size_t v) {
        if (!moving_[v] || squared_norm(places_.normal[v]) == 0) return;
        for (const auto& wing : fans_[v]) wider[v] |= wanted[wing.next];
      });
      wanted.swap(wider);
    }
    return wanted;
  }

  /// Mean of the levels chosen around on the same side; negative: there are none.
  [[nodiscard]] double average_choice(std::size_t v) const {
    if (!moving_[v] || squared_norm(places_.normal[v]) == 0) return -1;
    constexpr double same_side = 0.5;
    const double radius = choice_reach * places_.unit[v];
    double sum = 0, total = 0;
    for (const std::uint32_t o : vertices_.within(places_.position[v], radius)) {
      if (chosen_[o] == no_level || !(dot(places_.normal[o], places_.normal[v]) > same_side)) continue;
      const double nearness = 1 - squared_norm(places_.position[o] - places_.position[v]) / (radius * radius);
      sum += nearness * nearness * chosen_[o];
      total += nearness * nearness;
    }
    return total > 0 ? sum / total : -1;
  }

  /// Between the two levels beside the choice; the next one that has an estimate stands in for one that has not.
  [[nodiscard]] Foot foot(std::size_t v, double choice) const {
    if (choice < 0) return {};
    const auto floor = static_cast<std::size_t>(choice);
    const std::size_t narrow = nearest_level(v, floor), wide = nearest_level(v, std::min(floor + 1, widths.size() - 1));
    if (narrow == widths.size()) return {};
    const double share = choice - static_cast<double>(floor);
    const Vec3 normal = (1 - share) * levels_[narrow].normal[v] + share * levels_[wide].normal[v];
    const double length = norm(normal);
    return {(1 - share) * static_cast<double>(levels_[narrow].offset[v]) +
                share * static_cast<double>(levels_[wide].offset[v]),
            length > 0 ? (1 / length) * normal : levels_[narrow].normal[v]};
  }

  /// The number of levels: there is none.
  [[nodiscard]] std::size_t nearest_level(std::size_t v, std::size_t level) const {
    const auto has = [&](std::size_t k) { return !std::isnan(levels_[k].offset[v]); };
    for (std::size_t k = level + 1; k-- > 0;)
      if (has(k)) return k;
    while (level < widths.size() && !has(level)) ++level;
    return level;
  }

  const FitPlaces& places_;
  std::span<const std::uint8_t> moving_;
  const SurfaceFans& fans_;
  const Threads& threads_;
  PointTree vertices_;
  std::vector<std::uint32_t> vertex_of_; ///< nearest one of each sample
  std::vector<std::uint8_t> running_;    ///< vertices whose fits agree so far
  std::vector<std::uint8_t> chosen_;     ///< the widest level that agrees
  std::vector<double> noise_, low_, high_;
  std::vector<Level> levels_;
};

} // namespace

std::vector<Foot> fit_with_chosen_widths(const FitPlaces& places, std::span<const std::uint8_t> moving,
                                         const SurfaceFans& fans, const Threads& threads) {
  return WidthChoice(places, moving, fans, threads).run();
}

} // namespace eigencrust
