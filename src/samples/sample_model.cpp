// SPDX-License-Identifier: GPL-3.0-or-later
// One model of the samples for all stages (not in the paper; docs/decisions/0024).
#include "samples/sample_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/nearest.h"
#include "numerics/quantile.h"
#include "samples/local_frame.h"
#include "samples/scales.h"

namespace eigencrust {
namespace {

// One place is measured for so many samples along the curve.
constexpr std::uint32_t samples_per_place = 64;
// The noise of a place is the upper quartile of the places around: spots where nothing is told from curvature must not
// read as free of it. The level of the surface is the median of as many. Fewer places say nothing of the whole: a small
// body has edges everywhere.
constexpr double smoothing_quantile = 0.75;
// A sample is isolated when it is lonely and so many neighbours are in no plane: their smallest deviation is more than
// so much of the second.
constexpr std::size_t lonely_neighbours = 20;
constexpr double flat_lonely = 0.4;

/// Of an even sampling π r² of surface holds as many samples as there are within r.
double spacing_at(double radius, std::size_t neighbours) {
  return neighbours > 0 ? radius * std::sqrt(std::numbers::pi / static_cast<double>(neighbours)) : radius;
}

double typical_of(std::vector<float> spacing) { return static_cast<double>(median(spacing)); }

std::vector<float> spacings(const PointTree& tree, std::span<const Vec3> positions, const Threads& threads) {
  std::vector<float> result(positions.size());
  for_each_index(
      threads, positions.size(),
      [&](std::size_t i) {
        std::array<std::uint32_t, neighbours_around + 1> index{};
        std::array<double, neighbours_around + 1> square{};
        const std::size_t found = tree.nearest(positions[i], index.size(), index.data(), square.data());
        result[i] = static_cast<float>(spacing_at(std::sqrt(square[found - 1]), found - 1));
      },
      costly_block);
  return result;
}

/// Places along the curve with what was measured there.
struct Places {
  std::vector<Vec3> at;
  std::vector<PlaceModel> model;
  std::vector<float> spacing;
};

Places measure_places(const PlaceModels& models, std::span<const Vec3> positions, std::span<const float> spacing,
                      const Threads& threads) {
  const std::size_t n = positions.size(), count = (n + samples_per_place - 1) / samples_per_place;
  Places places{std::vector<Vec3>(count), std::vector<PlaceModel>(count), std::vector<float>(count)};
  for_each_index(
      threads, count,
      [&](std::size_t p) {
        const std::size_t middle = std::min(n - 1, p * samples_per_place + samples_per_place / 2);
        places.at[p] = positions[middle];
        places.spacing[p] = spacing[middle];
        places.model[p] = models.at(places.at[p]);
      },
      costly_block);
  return places;
}

/// What the flat places around each place say.
struct Surroundings {
  std::vector<float> level, noise; ///< median of the spacings, infinite where there are none; upper quartile, 0
};
Surroundings flat_places_around(const Places& places, const Threads& threads) {
  std::vector<Vec3> at;
  std::vector<std::uint32_t> number;
  for (std::uint32_t p = 0; p < places.at.size(); ++p) {
    if (!places.model[p].is_flat) continue;
    at.push_back(places.at[p]);
    number.push_back(p);
  }
  const std::size_t n = places.at.size();
  Surroundings result{std::vector<float>(n, std::numeric_limits<float>::infinity()), std::vector<float>(n, 0)};
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

/// Distance to the 20th nearest sample, or 0 where the neighbourhood is flat.
float lonely_radius(const PointTree& tree, std::span<const Vec3> positions, const Vec3& at) {
  std::array<std::uint32_t, lonely_neighbours + 1> index{};
  std::array<double, lonely_neighbours + 1> square{};
  const std::size_t found = tree.nearest(at, index.size(), index.data(), square.data());
  const LocalFrame frame = local_frame(positions, std::span(index).first(found), at);
  const bool is_flat = frame.variance[0] < flat_lonely * flat_lonely * frame.variance[1];
  return is_flat ? 0 : static_cast<float>(std::sqrt(square[found - 1]));
}

void measure_planes(const PlaceModels& models, std::span<const Vec3> positions, SampleModel& model,
                    const Threads& threads) {
  const std::size_t n = positions.size(), runs = (n + SampleModel::run - 1) / SampleModel::run;
  std::vector<MeanPlane> planes(runs);
  std::vector<std::uint8_t> noisy(runs, 0);
  for_each_index(
      threads, runs,
      [&](std::size_t r) {
        const std::size_t begin = r * SampleModel::run, end = std::min(n, begin + SampleModel::run);
        for (std::size_t i = begin; i < end; ++i)
          noisy[r] |= model.is_noisy(SampleIndex{static_cast<std::uint32_t>(i)});
        if (!noisy[r]) return;
        Vec3 place;
        for (std::size_t i = begin; i < end; ++i)
          place = place + (1.0 / static_cast<double>(end - begin)) * positions[i];
        planes[r] = models.mean_plane(place, static_cast<double>(model.noise.raw()[begin]));
      },
      costly_block);
  if (std::find(noisy.begin(), noisy.end(), 1) != noisy.end()) model.plane = std::move(planes);
}

} // namespace

SampleModel sample_model(std::span<const Vec3> positions, std::optional<double> given, const Threads& threads) {
  const PointTree tree(positions);
  SampleModel model;
  model.spacing = SampleLengths(spacings(tree, positions, threads));
  model.typical_spacing = typical_of(model.spacing.raw());
  const PlaceModels models(positions, tree);
  const Places places = measure_places(models, positions, model.spacing.raw(), threads);
  if (places.at.size() >= enough_around)
    model.sheet_share = static_cast<double>(std::count_if(places.model.begin(), places.model.end(),
                                                          [](const PlaceModel& m) { return m.is_sheet; })) /
                        static_cast<double>(places.at.size());
  const auto [level, noise] = flat_places_around(places, threads);
  model.noise = model.isolated = SampleLengths(positions.size(), 0.0f);
  for_each_index(
      threads, positions.size(),
      [&, &level = level, &noise = noise](std::size_t i) {
        const SampleIndex s{static_cast<std::uint32_t>(i)};
        const std::size_t place = i / samples_per_place;
        model.noise[s] = given ? static_cast<float>(*given) : noise[place];
        if (!(static_cast<double>(model.spacing[s]) > isolation * static_cast<double>(level[place]))) return;
        model.isolated[s] = lonely_radius(tree, positions, positions[i]);
        if (model.isolated[s] > 0) model.spacing[s] = level[place];
      },
      costly_block);
  measure_planes(models, positions, model, threads);
  return model;
}

} // namespace eigencrust
