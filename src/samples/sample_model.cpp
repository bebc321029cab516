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
#include "samples/easing.h"
#include "samples/local_frame.h"
#include "samples/places.h"
#include "samples/scales.h"

namespace eigencrust {
namespace {

// A sample is isolated when it is lonely and so many neighbours are in no plane: their smallest deviation is more than
// so much of the second.
constexpr std::size_t lonely_neighbours = 20;
constexpr double flat_lonely = 0.4;

/// Of an even sampling π r² of surface holds as many samples as there are within r.
double spacing_at(double radius, std::size_t neighbours) {
  return neighbours > 0 ? radius * std::sqrt(std::numbers::pi / static_cast<double>(neighbours)) : radius;
}

double typical_of(std::vector<float> spacing) { return static_cast<double>(median(spacing)); }

/// \param neighbours of all samples, set; null: not asked for
std::vector<float> spacings(const PointTree& tree, std::span<const Vec3> positions, std::vector<Neighbours>* neighbours,
                            const Threads& threads) {
  std::vector<float> result(positions.size());
  if (neighbours != nullptr) neighbours->resize(positions.size());
  for_each_index(
      threads, positions.size(),
      [&](std::size_t i) {
        std::array<std::uint32_t, neighbours_around + 1> index{};
        std::array<double, neighbours_around + 1> square{};
        const std::size_t found = tree.nearest(positions[i], index.size(), index.data(), square.data());
        result[i] = static_cast<float>(spacing_at(std::sqrt(square[found - 1]), found - 1));
        if (neighbours == nullptr) return;
        Neighbours& around = (*neighbours)[i];
        std::fill(std::copy_n(index.begin(), found, around.begin()), around.end(), static_cast<std::uint32_t>(i));
      },
      costly_block);
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

/// All but the planes. \param neighbours see spacings() \param places set
SampleModel measured(std::span<const Vec3> positions, const PlaceModels& models, std::optional<double> given,
                     std::vector<Neighbours>* neighbours, Places& places, const Threads& threads) {
  const PointTree& tree = models.tree();
  SampleModel model;
  model.spacing = SampleLengths(spacings(tree, positions, neighbours, threads));
  model.typical_spacing = typical_of(model.spacing.raw());
  places = measure_places(models, positions, model.spacing.raw(), threads);
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
  model.input_noise = model.noise;
  if (neighbours != nullptr) model.unclear = unclear_places(places, threads);
  return model;
}

} // namespace

SampleModel sample_model(std::span<const Vec3> positions, std::optional<double> given, const Threads& threads) {
  const PlaceModels models(positions, threads);
  Places places;
  SampleModel model = measured(positions, models, given, nullptr, places, threads);
  measure_planes(models, positions, model, threads);
  return model;
}

SampleModel eased_sample_model(Samples& samples, std::optional<double> given, const Threads& threads) {
  const std::vector<Vec3> positions = samples.positions.raw(); // those of the trees stay where they are
  const PlaceModels models(positions, threads);
  std::vector<Neighbours> neighbours;
  Places places;
  SampleModel model = measured(positions, models, given, &neighbours, places, threads);
  const std::vector<Vec3> eased = eased_positions(samples, neighbours, model, threads);
  if (eased.empty()) {
    measure_planes(models, positions, model, threads);
    return model;
  }
  const PlaceModels models_of_eased(models, eased);
  take_eased(eased, models_of_eased, std::move(places), given, samples, model, threads);
  measure_planes(models_of_eased, eased, model, threads);
  return model;
}

} // namespace eigencrust
