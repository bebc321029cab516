// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/place_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "samples/local_frame.h"
#include "samples/scales.h"
#include "samples/two_sheets.h"

namespace eigencrust {
namespace {

// Neighbourhoods grow threefold in number, about 1.7-fold in radius on a surface; from the fourth on they are told
// from a third, a ninth ... of the samples.
constexpr std::size_t narrowest = 10, growth = 3;
constexpr std::array<std::size_t, 3> sizes{narrowest, narrowest* growth, narrowest* growth* growth};
// Wider neighbourhoods of clear places are no thicker than narrower ones, but for chance: their variance is not so many
// times as large.
constexpr double thicker = 1.5;
// Neighbourhoods that are not flat must fit so many times into the cloud: a larger one is as thick as the object.
constexpr std::size_t least_neighbourhoods = 20;

// So many lie in a plane by chance once in 80 times, in a lattice never.
constexpr std::size_t sheet_neighbours = 20;

// The middle of the noise is that of the samples within 3 σ, weighted by their distance with a deviation of 2 σ.
constexpr double deviation_in_sigmas = 2;

/// Thickness² = σ² + c radius²: a crease has c > 0 and σ = 0, a smooth surface grows even faster.
double thickness_without_growth(const LocalFrame& inner, const LocalFrame& outer) {
  const double inner_width = inner.variance[1] + inner.variance[2];
  const double wider = outer.variance[1] + outer.variance[2] - inner_width;
  const double slope = wider > 0 ? std::max(0.0, (outer.variance[0] - inner.variance[0]) / wider) : 0.0;
  return std::sqrt(std::max(0.0, inner.variance[0] - slope * inner_width));
}

/// Is a place whose neighbourhood of that level is flat, as is the one before, a clear one?
bool is_clear(std::size_t level, const LocalFrame& inner, const LocalFrame& outer) {
  return level < sizes.size() || (level == sizes.size() && outer.variance[0] < thicker * inner.variance[0]);
}

/// In a ball much smaller than the noise samples lie as in a solid; the flatter they lie, the thinner it must be:
/// 1 / thickness² = 1 / σ² + 1 / width² of noise cut by a ball, both as if they were Gaussian.
double largest_variance_of_noise(const LocalFrame& frame) {
  const double smaller = frame.variance[0], larger = frame.variance[1];
  return larger > smaller ? smaller * larger / (larger - smaller) : std::numeric_limits<double>::infinity();
}

std::vector<Vec3> every(std::size_t step, std::span<const Vec3> positions) {
  std::vector<Vec3> some;
  some.reserve(positions.size() / step + 1);
  for (std::size_t i = step / 2; i < positions.size(); i += step) some.push_back(positions[i]);
  return some;
}

/// Is the place no farther from the plane of the neighbourhood than noise explains?
bool lies_within(const Vec3& place, const LocalFrame& sheet) {
  constexpr double rounding = 1e-12; // of the squared width: the thickness of an exact plane may come out as 0
  const double height = dot(place - sheet.mean, sheet.axis[0]);
  return height * height <=
         static_cast<double>(noise_bound * noise_bound) * sheet.variance[0] + rounding * sheet.variance[1];
}

} // namespace

PlaceModels::PlaceModels(std::span<const Vec3> positions, const Threads& threads)
    : positions_(positions), densities_(1) {
  for (std::size_t step = growth; sizes.back() * step * least_neighbourhoods <= positions.size() * growth;
       step *= growth)
    densities_.push_back({every(step, positions), nullptr});
  threads.run(densities_.size(),
              [&](std::size_t k) { densities_[k].tree = std::make_shared<const PointTree>(points(k)); });
}

PlaceModels::PlaceModels(const PlaceModels& before, std::span<const Vec3> positions)
    : positions_(positions), densities_{{{}, before.densities_.front().tree}} {
  std::size_t step = growth;
  for (std::size_t k = 1; k < before.densities_.size(); ++k, step *= growth)
    densities_.push_back({every(step, positions), before.densities_[k].tree});
}

/// Are most of the narrowest neighbourhoods flat? In noise one in seven is, by chance; on thin rods and in lattices,
/// which look thick from afar, nearly all are.
bool PlaceModels::is_smooth_up_close(std::span<const Vec3> points, std::span<const std::uint32_t> around) const {
  std::array<std::uint32_t, sizes[0]> index{};
  std::array<double, sizes[0]> square{};
  std::size_t flat = 0;
  for (std::size_t k = 0; k < narrowest; ++k) {
    const Vec3& at = points[around[k * (around.size() - 1) / (narrowest - 1)]];
    const std::size_t found = tree().nearest(at, sizes[0], index.data(), square.data());
    flat += local_frame(positions_, std::span(index).first(found), at).is_flat();
  }
  return 2 * flat > narrowest;
}

PlaceModel PlaceModels::at(const Vec3& place) const {
  PlaceModel model = flat_at(place);
  model.is_sheet = model.is_flat;
  if (model.is_flat) return model;
  // Sheets a few spacings apart, as those of plates and fins, are flat in no wider neighbourhood.
  std::array<std::uint32_t, sheet_neighbours> index{};
  std::array<double, sheet_neighbours> square{};
  const std::size_t found = tree().nearest(place, index.size(), index.data(), square.data());
  model.is_sheet = local_frame(positions_, std::span(index).first(found), place).is_flat();
  return model;
}

PlaceModel PlaceModels::flat_at(const Vec3& place) const {
  std::array<std::uint32_t, sizes.back()> index{};
  std::array<double, sizes.back()> square{};
  double square_of_reach = 0; // of 30 neighbours
  const auto density = [&](std::size_t level) { return std::max(level + 1, sizes.size()) - sizes.size(); };
  const auto neighbours = [&](std::size_t level) -> std::span<const std::uint32_t> {
    if (level == 0) {
      const std::size_t found = tree().nearest(place, sizes.back(), index.data(), square.data());
      square_of_reach = square[std::min(found, sizes[1]) - 1];
      return std::span(index).first(std::min(found, sizes[0]));
    }
    if (level < sizes.size()) return std::span(index).first(std::min(positions_.size(), sizes[level]));
    const std::size_t found =
        densities_[density(level)].tree->nearest(place, sizes.back(), index.data(), square.data());
    return std::span(index).first(found);
  };
  const std::size_t levels = sizes.size() + densities_.size() - 1;
  std::optional<LocalFrame> inner;
  std::size_t count = sizes[0];
  double largest = std::numeric_limits<double>::infinity();
  for (std::size_t level = 0; level < levels; ++level, count *= growth) {
    const auto around = neighbours(level);
    const LocalFrame frame = local_frame(points(density(level)), around, place);
    const bool is_flat = frame.is_flat();
    if (is_flat && level > 0) {
      // Large neighbourhoods of far strays reach the object, which looks flat from there.
      if (!lies_within(place, frame)) return {};
      if (const auto sheets = two_sheets(points(density(level)), around, frame)) {
        // What lies between sheets that are seen one by one from nearby are walls of holes and ribs.
        if (level >= sizes.size() && sheets->gap * sheets->gap > square_of_reach) return {};
        return {true, sheets->deviation, true, false};
      }
      // A few samples lie in a plane by chance; the next larger neighbourhood has to agree.
      if (inner->is_flat()) {
        if (level > 1 && is_smooth_up_close(points(density(level)), around)) return {true, 0, true, true};
        // Parts of a body side by side, as a pair of legs, are thick from afar only.
        if (inner->variance[0] > largest) return {};
        return {true, thickness_without_growth(*inner, frame), true, is_clear(level, *inner, frame)};
      }
    }
    if (!is_flat && count * growth * least_neighbourhoods > positions_.size()) return {};
    // Of fewer samples the smallest variance is small by chance.
    if (around.size() == sizes.back()) largest = std::min(largest, largest_variance_of_noise(frame));
    inner = frame;
  }
  return {};
}

MeanPlane PlaceModels::mean_plane(const Vec3& place, double noise) const {
  const double radius = static_cast<double>(noise_bound) * noise, deviation = deviation_in_sigmas * noise;
  std::span<const Vec3> some;
  std::vector<std::uint32_t> index;
  for (std::size_t k = densities_.size(); k-- > 0 && index.size() < enough_around;) {
    some = points(k);
    index = densities_[k].tree->within(place, radius);
  }
  if (index.size() < enough_around) {
    index.resize(std::min(enough_around, some.size()));
    std::vector<double> square(index.size());
    tree().nearest(place, index.size(), index.data(), square.data());
  }
  std::sort(index.begin(), index.end()); // sums in one order
  std::vector<double> weight;
  weight.reserve(index.size());
  for (const std::uint32_t i : index)
    weight.push_back(std::exp(-squared_norm(some[i] - place) / (2 * deviation * deviation)));
  const LocalFrame frame = local_frame(some, index, place, weight);
  if (!is_finite(frame.mean)) return {}; // all are too far away to weigh anything
  return {frame.mean, frame.axis[0]};
}

} // namespace eigencrust
