// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/moves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "repair/surface_fronts.h"

namespace eigencrust {
namespace {

// What a sample is worth that the surface passes by, in units of the energy, where a face costs 0.01 (well borne out by
// the samples) to 2 (not at all): less than the ties of the three samples of a triangle can say for the space over it,
// 3 × 0.1 e⁴ (settle/data_term.h). On clean scans nineteen of twenty cost less (docs/decisions/0027).
constexpr double sample_price = 13;
// Of the samples on the surface: as many that are not lonely and passed by are noise, no one misses any.
constexpr double most_passed = 0.04;
// Lonely are samples whose third nearest one is so many spacings away: 3 % of samples at random places on a surface.
constexpr double lonely_from = 1.5;
// Lonely samples may be strays where more of them are passed by than not, and are where three quarters are: of clean
// meshes a twentieth, of strays around bodies seven to nine tenths. Where more than a tenth are, some may be.
constexpr double strays_from = 0.5, strays_at = 0.75, perhaps_strays = 0.1;
// So many samples for each stray that is passed by, near the surface or another stray, do not look lonely: 0.07 to 0.17
// around boxes, plates, rods and cups.
constexpr double strays_in_company = 0.1;
// So few tetrahedra are no piece when a move leaves them over, and may turn with any move to mend what it breaks; with
// more than twice its own beside it is no small change.
constexpr std::uint64_t few_tetrahedra = 64;

bool is_passed(const MoveScene& scene, const Labels& labels, SampleIndex s) {
  const auto star = scene.stars[s];
  return std::all_of(star.begin(), star.end(), [&](TetrahedronIndex i) { return labels[i] == labels[star.front()]; });
}

bool is_lonely(const MoveScene& scene, SampleIndex s) {
  if (scene.model.isolated[s] > 0) return true;
  const auto around = nearest_samples(scene, s);
  double spacing = 0;
  for (const NearSample& near : around)
    if (near.sample.valid())
      spacing += static_cast<double>(scene.model.spacing[near.sample]) / static_cast<double>(around.size());
  // Its own is as wide as what it stands off from.
  return around.back().distance > lonely_from * std::min(spacing, static_cast<double>(scene.model.spacing[s]));
}

/// What it costs to pass each sample by: nothing where noise exceeds the spacing, and the less the more noise or strays
/// explain that samples of its kind, lonely ones or others, are passed by.
Moves::Prices prices(const MoveScene& scene, const Labels& labels) {
  const std::size_t n = scene.t.sample_count;
  std::vector<std::uint8_t> lonely(n), passed(n);
  for_each_index(scene.threads, n, [&](std::size_t at) {
    const SampleIndex s{static_cast<std::uint32_t>(at)};
    lonely[at] = is_lonely(scene, s);
    passed[at] = is_passed(scene, labels, s);
  });
  std::array<double, 2> off{}, on{};
  for (std::size_t at = 0; at < n; ++at) (passed[at] ? off : on)[lonely[at]] += 1;
  const double share = off[1] > 0 ? off[1] / (off[1] + on[1]) : 0;
  const double strays = std::clamp((share - strays_from) / (strays_at - strays_from), 0.0, 1.0);
  const double noise = off[0] / (most_passed * (on[0] + on[1]));
  const double in_company = off[0] > 0 ? strays * strays_in_company * off[1] / off[0] : 0;
  const std::array<double, 2> explained{std::max(noise, in_company), std::max(noise, strays)};
  Moves::Prices result{std::vector<float>(n), share > perhaps_strays};
  for (std::size_t at = 0; at < n; ++at) {
    if (scene.model.is_noisy(SampleIndex{static_cast<std::uint32_t>(at)})) continue;
    result.price[at] = static_cast<float>(sample_price * std::max(0.0, 1 - explained[lonely[at]]));
  }
  return result;
}

} // namespace

std::array<NearSample, 3> nearest_samples(const MoveScene& scene, SampleIndex s) {
  std::array<NearSample, 3> nearest;
  for (const TetrahedronIndex i : scene.stars[s])
    for (const VertexIndex v : scene.t.tetrahedra[i]) {
      if (v == s || scene.t.is_corner(v)) continue;
      NearSample next{squared_norm(scene.t.positions[v] - scene.t.positions[s]), scene.t.sample(v)};
      for (NearSample& near : nearest) {
        if (near.sample == next.sample) break;
        if (next.distance < near.distance) std::swap(near, next);
      }
    }
  for (NearSample& near : nearest) near.distance = std::sqrt(near.distance);
  return nearest;
}

Moves::Moves(const MoveScene& s, TetrahedronLabels& labels) : Moves(s, labels, prices(s, labels.labels())) {}

Moves::Moves(const MoveScene& s, TetrahedronLabels& labels, Prices prices)
    : scene(s),
      among_strays(prices.strays),
      all_(labels),
      priced_(s.t, s.stars, s.energy, s.model.spacing, std::move(prices.price), labels, s.threads),
      repair_(s.t, s.stars, s.energy.known, priced_),
      seen_(s.t.tetrahedra.size(), 0),
      owner_(s.t.positions.size(), SurfaceFronts::none) {}

ManifoldCounts Moves::make_manifold(const Checkpoint& checkpoint) {
  repair_.counts = {};
  repair_.run(unsound_stars(scene.t, scene.stars, all_.labels(), scene.threads), {}, ~std::uint64_t{0}, checkpoint);
  repair_.counts.overruled = overruled(scene.t, scene.energy.known, all_.labels());
  return repair_.counts;
}

std::vector<std::uint32_t> Moves::samples_of(std::span<const TetrahedronIndex> tetrahedra) const {
  std::vector<std::uint32_t> samples;
  for (const TetrahedronIndex i : tetrahedra)
    for (const VertexIndex v : scene.t.tetrahedra[i])
      if (!scene.t.is_corner(v)) samples.push_back(v.value);
  std::sort(samples.begin(), samples.end());
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  return samples;
}

Moves::Outcome Moves::weigh(std::span<const TetrahedronIndex> region, double handle, Gain gain) {
  const std::size_t then = priced_.now();
  const double before = priced_.cost();
  for (const TetrahedronIndex i : region) priced_.turn(i);
  const bool possible = repair_.run(samples_of(region), region, 2 * region.size() + few_tetrahedra);
  if (possible) swallow_specks(priced_.turned_since(then));
  Outcome outcome{0, priced_.turned_since(then), 0, 0};
  const auto& turned = outcome.turned;
  if (!possible || !std::all_of(turned.begin(), turned.end(), [&](TetrahedronIndex i) { return is_open(i); })) {
    priced_.back_to(then);
    return {};
  }
  relax(turned);
  outcome.turned = priced_.turned_since(then);
  outcome.change = priced_.cost() - before;
  const std::int64_t euler = -priced_.back_with_euler(then);
  // At best two more in the Euler characteristic are a handle less, two fewer a piece less.
  const std::int64_t hoped = gain == Gain::handles ? euler : -euler;
  if (!(outcome.change - handle * static_cast<double>(std::max<std::int64_t>(hoped, 0)) / 2 < 0)) return {};
  const std::vector<std::uint32_t> around = samples_of(outcome.turned);
  const std::int64_t pieces_before = pieces_at(around);
  make(outcome);
  outcome.pieces = pieces_at(around) - pieces_before;
  outcome.handles = outcome.pieces - euler / 2;
  priced_.back_to(then);
  if (outcome.handles > 0) return {};
  // A piece more costs as much as a handle.
  outcome.change += handle * static_cast<double>(outcome.pieces + outcome.handles);
  return outcome;
}

/// Small sets of equal label beside what was turned that all else surrounds turn, too.
void Moves::swallow_specks(const std::vector<TetrahedronIndex>& turned) {
  std::vector<TetrahedronIndex> seen;
  for (const TetrahedronIndex beside : turned)
    for (const TetrahedronIndex start : scene.t.neighbours[beside])
      if (start.valid())
        for (const TetrahedronIndex i : speck_at(start, few_tetrahedra, seen)) priced_.turn(i);
  forget(seen);
}

std::span<const TetrahedronIndex> Moves::speck_at(TetrahedronIndex start, std::uint64_t most,
                                                  std::vector<TetrahedronIndex>& seen) {
  constexpr std::uint8_t earlier = 1, now = 2;
  if (seen_[start.value] || !is_open(start)) return {};
  std::vector<TetrahedronIndex>& speck = speck_;
  speck.assign(1, start);
  seen_[start.value] = now;
  bool is_speck = true;
  for (std::size_t k = 0; k < speck.size() && is_speck; ++k)
    for (const TetrahedronIndex n : scene.t.neighbours[speck[k]]) {
      if (!n.valid() || priced_[n] != priced_[start]) continue;
      // What was seen earlier belongs to more than a speck.
      is_speck = is_speck && is_open(n) && seen_[n.value] != earlier;
      if (seen_[n.value] || !is_speck) continue;
      seen_[n.value] = now;
      speck.push_back(n);
      is_speck = speck.size() <= most;
    }
  for (const TetrahedronIndex i : speck) seen_[i.value] = earlier;
  seen.insert(seen.end(), speck.begin(), speck.end());
  if (!is_speck) speck.clear();
  return speck;
}

void Moves::forget(std::span<const TetrahedronIndex> seen) {
  for (const TetrahedronIndex i : seen) seen_[i.value] = 0;
}

/// Turns back one at a time what need not be turned: where that costs less and leaves every star a disc.
void Moves::relax(const std::vector<TetrahedronIndex>& turned) {
  for (bool some = true; some;) {
    some = false;
    for (const TetrahedronIndex i : turned) some |= turn_back(i);
  }
}

bool Moves::turn_back(TetrahedronIndex i) {
  constexpr double least = std::numeric_limits<float>::epsilon(); // of the terms, which are floats
  if (!priced_.is_simple(i) || !(priced_.cost_of(i) < -least)) return false;
  priced_.turn(i);
  return true;
}

void Moves::make(const Outcome& outcome) {
  for (const TetrahedronIndex i : outcome.turned) priced_.turn(i);
}

/// How many pieces of the surface touch these samples.
std::int64_t Moves::pieces_at(const std::vector<std::uint32_t>& samples) {
  return SurfaceFronts(scene.t, scene.stars, priced_, owner_).pieces(samples);
}

void Moves::settle_values() {
  std::vector<TetrahedronIndex> touched = priced_.turned_since(0);
  const std::size_t turned = touched.size();
  for (std::size_t k = 0; k < turned; ++k)
    for (const TetrahedronIndex i : scene.t.neighbours[touched[k]])
      if (i.valid()) touched.push_back(i);
  IndexedArray<TetrahedronIndex, float> value = all_.values();
  Labels labels = std::move(all_).labels();
  for (const TetrahedronIndex i : touched) {
    const float balance = scene.energy.known[i] == labels[i] ? 1.0f : scene.energy.balance(scene.t, labels, i);
    value[i] = (labels[i] == Label::outside) == (balance > 0) || scene.energy.known[i] == labels[i] ? balance : 0.0f;
  }
  all_ = {std::move(labels), std::move(value)};
}

} // namespace eigencrust
