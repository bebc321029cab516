// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that lie beside the plane of their neighbours move onto it (not in the paper; docs/decisions/0049).
#include "samples/easing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "geometry/exact_difference.h"
#include "geometry/float_places.h"
#include "geometry/place_hash.h"
#include "samples/local_frame.h"
#include "samples/places.h"
#include "samples/scales.h"

namespace eigencrust {
namespace {

// Less noise tangles no tetrahedra.
constexpr float least_noise_in_spacings = 0.3f;
// Of clean samples so many that are next to one another lie in a plane.
constexpr std::size_t nearest_few = 6;
constexpr double clean_in_spacings = 0.1; // but for so much
// Neighbours weigh as a Gaussian of so many spacings does: narrower than walls that can still be told from noise.
constexpr double width_in_spacings = 1.1;
// What is left goes the way of what is taken away: both together are so many times the root of their squares.
constexpr double whole_noise = 1.6;
// What samples say of a place say those of so many places along the curve on either side, too.
constexpr std::size_t places_beside = 4, ask_one_in = 8;

/// First and behind last.
std::pair<std::ptrdiff_t, std::ptrdiff_t> places_around(std::size_t place, std::size_t places) {
  const std::size_t first = place < places_beside ? 0 : place - places_beside;
  return {static_cast<std::ptrdiff_t>(first), static_cast<std::ptrdiff_t>(std::min(places, place + places_beside + 1))};
}

/// Where a sample goes, relative to the origin.
Vec3 eased(const Vec3& origin, std::span<const Vec3> positions, const Neighbours& around, const SampleModel& model,
           SampleIndex s) {
  const Vec3& place = positions[s.value];
  const auto spacing = static_cast<double>(model.spacing[s]);
  const double width = width_in_spacings * spacing;
  std::array<double, neighbours_around + 1> weight{};
  for (std::size_t k = 0; k < around.size(); ++k)
    weight[k] = std::exp(-squared_norm(positions[around[k]] - place) / (2 * width * width));
  const LocalFrame frame = local_frame(positions, around, place, weight);
  const double height = dot(frame.mean - place, frame.axis[0]);
  if (!(std::fabs(height) <= static_cast<double>(noise_bound * model.noise[s]))) return place;
  // A vertex that comes back to it is written as it was triangulated.
  const Vec3 in_input = as_floats(place + height * frame.axis[0] + origin, spacing);
  return is_exact_difference(in_input, origin) ? in_input - origin : place;
}

/// Are they? Told by hashes: that some are equal by chance does no harm.
bool are_distinct(std::span<const Vec3> places, const Threads& threads) {
  std::vector<std::size_t> hash(places.size());
  for_each_index(threads, hash.size(), [&](std::size_t i) { hash[i] = PlaceHash()(places[i]); });
  sort_blocks(threads, hash);
  return std::adjacent_find(hash.begin(), hash.end()) == hash.end();
}

/// Those that are unclear for noise: most samples lie beside the plane of their five nearest neighbours. The two sheets
/// of a clean wall are unclear from farther away only.
std::vector<std::uint8_t> noisy_places(std::span<const Vec3> positions, std::span<const Neighbours> around,
                                       const SampleModel& model, const Threads& threads) {
  std::vector<std::uint8_t> beside((positions.size() + ask_one_in - 1) / ask_one_in), result(model.unclear.size());
  for_each_index(
      threads, beside.size(),
      [&](std::size_t k) {
        const std::size_t i = k * ask_one_in;
        if (!model.unclear[i / samples_per_place]) return;
        const LocalFrame narrow = local_frame(positions, std::span(around[i]).first(nearest_few), positions[i]);
        beside[k] = std::sqrt(narrow.variance[0]) > clean_in_spacings * static_cast<double>(model.spacing.raw()[i]);
      },
      costly_block);
  constexpr auto asked = static_cast<std::ptrdiff_t>(samples_per_place / ask_one_in); // at each place
  const auto all = static_cast<std::ptrdiff_t>(beside.size());
  for (std::size_t p = 0; p < result.size(); ++p) {
    const auto [begin, end] = places_around(p, result.size());
    const auto first = beside.begin() + begin * asked, last = beside.begin() + std::min(all, end * asked);
    result[p] = model.unclear[p] && 2 * std::count(first, last, 1) > last - first;
  }
  return result;
}

/// Mean square of how far the samples of each place, and of those beside it, moved.
std::vector<double> squares_moved(std::span<const Vec3> before, std::span<const Vec3> after, std::size_t places) {
  std::vector<double> result(places, 0);
  for (std::size_t p = 0; p < places; ++p) {
    const auto [first, last] = places_around(p, places);
    const std::size_t begin = static_cast<std::size_t>(first) * samples_per_place,
                      end = std::min(before.size(), static_cast<std::size_t>(last) * samples_per_place);
    for (std::size_t i = begin; i < end; ++i) result[p] += squared_norm(after[i] - before[i]);
    result[p] /= static_cast<double>(end - begin);
  }
  return result;
}

} // namespace

void keep_distinct(std::span<const Vec3> before, std::vector<Vec3>& after, const Threads& threads) {
  if (are_distinct(after, threads)) return;
  std::unordered_map<Vec3, std::uint32_t, PlaceHash> at;
  at.reserve(after.size());
  std::vector<std::uint32_t> back;
  for (std::uint32_t i = 0; i < after.size(); ++i)
    if (const auto [other, is_new] = at.emplace(after[i], i); !is_new) back.insert(back.end(), {i, other->second});
  while (!back.empty()) { // the places that they come from may be taken by now
    const std::uint32_t i = back.back();
    back.pop_back();
    after[i] = before[i];
    if (const auto [other, is_new] = at.emplace(after[i], i); !is_new && other->second != i)
      back.push_back(std::exchange(other->second, i));
  }
}

std::vector<Vec3> eased_positions(const Samples& samples, std::span<const Neighbours> around, const SampleModel& model,
                                  const Threads& threads) {
  const std::vector<Vec3>& positions = samples.positions.raw();
  const std::vector<std::uint8_t> places = noisy_places(positions, around, model, threads);
  if (std::find(places.begin(), places.end(), 1) == places.end()) return {};
  std::vector<Vec3> result = positions;
  for_each_index(
      threads, result.size(),
      [&](std::size_t i) {
        const SampleIndex s{static_cast<std::uint32_t>(i)};
        const bool is_noisy = model.noise[s] > least_noise_in_spacings * model.spacing[s];
        if (is_noisy && places[i / samples_per_place] && !(model.isolated[s] > 0))
          result[i] = eased(samples.origin, positions, around[i], model, s);
      },
      costly_block);
  return result;
}

void take_eased(std::span<const Vec3> eased, const PlaceModels& models, Places places, std::optional<double> given,
                Samples& samples, SampleModel& model, const Threads& threads) {
  std::vector<Vec3>& positions = samples.positions.raw();
  measure_again(models, eased, model.unclear, places, threads);
  const std::vector<float> left = flat_places_around(places, threads).noise;
  const std::vector<double> moved = squares_moved(positions, eased, left.size());
  std::vector<Vec3> result = positions;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::size_t place = i / samples_per_place;
    float &noise = model.noise.raw()[i], after = left[place];
    if (given) after = static_cast<float>(std::sqrt(std::max(0.0, *given * *given - moved[place])));
    if (!(after < std::min(noise, SampleModel::noisy_in_spacings * model.spacing.raw()[i]))) continue;
    const auto deviation = static_cast<double>(after); // squares of floats can vanish
    model.input_noise.raw()[i] =
        std::min(noise, static_cast<float>(whole_noise * std::sqrt(deviation * deviation + moved[place])));
    noise = after;
    result[i] = eased[i];
  }
  keep_distinct(positions, result, threads);
  for (std::size_t i = 0; i < positions.size(); ++i) model.eased += positions[i] != result[i];
  positions = std::move(result);
}

} // namespace eigencrust
