// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/places.h"

#include <algorithm>
#include <array>
#include <limits>

#include "geometry/nearest.h"
#include "numerics/quantile.h"
#include "samples/scales.h"

namespace eigencrust {
namespace {

// The noise of a place is the upper quartile of the places around: spots where nothing is told from curvature must not
// read as free of it. The level of the surface is the median of as many. Fewer places say nothing of the whole: a small
// body has edges everywhere.
constexpr double smoothing_quantile = 0.75;

// More than one in so many of the places around are not clear; fewer are not by chance.
constexpr std::size_t one_in_unclear = 3;

} // namespace

void measure_again(const PlaceModels& models, std::span<const Vec3> positions, std::span<const std::uint8_t> wanted,
                   Places& places, const Threads& threads) {
  const auto measure = [&](std::size_t p) {
    if (!wanted[p]) return;
    places.at[p] = positions[std::min(positions.size() - 1, p * samples_per_place + samples_per_place / 2)];
    places.model[p] = models.at(places.at[p]);
  };
  for_each_index(threads, places.at.size(), measure, costly_block);
}

Places measure_places(const PlaceModels& models, std::span<const Vec3> positions, std::span<const float> spacing,
                      const Threads& threads) {
  const std::size_t n = positions.size(), count = (n + samples_per_place - 1) / samples_per_place;
  Places places{std::vector<Vec3>(count), std::vector<PlaceModel>(count), std::vector<float>(count)};
  for (std::size_t p = 0; p < count; ++p)
    places.spacing[p] = spacing[std::min(n - 1, p * samples_per_place + samples_per_place / 2)];
  measure_again(models, positions, std::vector<std::uint8_t>(count, 1), places, threads);
  return places;
}

FlatPlaces flat_places_around(const Places& places, const Threads& threads) {
  std::vector<Vec3> at;
  std::vector<std::uint32_t> number;
  for (std::uint32_t p = 0; p < places.at.size(); ++p) {
    if (!places.model[p].is_flat) continue;
    at.push_back(places.at[p]);
    number.push_back(p);
  }
  const std::size_t n = places.at.size();
  FlatPlaces result{std::vector<float>(n, std::numeric_limits<float>::infinity()), std::vector<float>(n, 0)};
  if (at.empty()) return result;
  const PointTree tree(at);
  const auto look = [&](std::size_t p) {
    std::array<std::uint32_t, enough_around> index{};
    std::array<double, enough_around> square{};
    const std::size_t found = tree.nearest(places.at[p], index.size(), index.data(), square.data());
    std::vector<float> spacing, noise;
    for (const std::uint32_t i : std::span(index).first(found)) {
      spacing.push_back(places.spacing[number[i]]);
      noise.push_back(static_cast<float>(places.model[number[i]].noise));
    }
    result.level[p] = median(spacing);
    result.noise[p] = quantile(noise, smoothing_quantile);
  };
  for_each_index(threads, n, look, costly_block);
  return result;
}

std::vector<std::uint8_t> unclear_places(const Places& places, const Threads& threads) {
  std::vector<std::uint8_t> result(places.at.size());
  const PointTree tree(places.at);
  const auto look = [&](std::size_t p) {
    std::array<std::uint32_t, enough_around> index{};
    std::array<double, enough_around> square{};
    const auto around = std::span(index).first(tree.nearest(places.at[p], index.size(), index.data(), square.data()));
    const auto unclear = std::count_if(around.begin(), around.end(), [&](auto q) { return !places.model[q].is_clear; });
    result[p] = one_in_unclear * static_cast<std::size_t>(unclear) > around.size();
  };
  for_each_index(threads, result.size(), look, costly_block);
  return result;
}

} // namespace eigencrust
