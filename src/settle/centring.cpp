// SPDX-License-Identifier: GPL-3.0-or-later
// In noise the surface runs through the middle of the samples (not in the paper; docs/decisions/0015).
#include <algorithm>
#include <cmath>

#include <eigencrust/stages.h>

#include "geometry/nearest.h"
#include "numerics/quantile.h"
#include "parallel/threads.h"
#include "settle/centring.h"

namespace eigencrust {
namespace {

// Samples are taken together by runs along the Hilbert curve. A run has one level: longer ones are as wide as the
// tip of an ear, where levels differ most.
constexpr std::uint32_t run_length = 8;
// The middle is that of all samples within so many lengths of `reach`; of so many runs at least.
constexpr double radius_in_reach = 1;
constexpr std::size_t least_runs = 8;
constexpr std::size_t least_samples = 8;
constexpr std::size_t smoothing_runs = 8;
// Values spread over a few spacings before they are taken apart again, twice: what is thinner than that is
// noise (threshold dynamics, Merriman, Bence and Osher 1992).
constexpr int sharpenings = 2;
constexpr int diffusion_steps = 8;

/// Where inside changes to outside, in values of stage two, and how far the samples lie from it.
struct Level {
  float middle = 0;
  float spread = 0; ///< half the distance between the quartiles; 0: no noise here
};

class Centring {
 public:
  Centring(const Tetrahedralization& t, const VertexStars& stars, std::span<const float> reach,
           std::span<const float> isolated, const Labels& first, const Threads& threads, TetrahedronLabels& labels)
      : t_(t),
        stars_(stars),
        reach_(reach),
        isolated_(isolated),
        first_(first),
        threads_(threads),
        labels_(labels),
        runs_((t.sample_count + run_length - 1) / run_length),
        value_(t.sample_count),
        next_(t.sample_count) {
    std::vector<Vec3> centre(runs_);
    for (std::uint32_t r = 0; r < runs_; ++r) {
      const auto [begin, end] = samples_of(r);
      for (std::uint32_t i = begin; i < end; ++i) centre[r] = centre[r] + (1.0 / (end - begin)) * t_.positions.raw()[i];
    }
    centre_ = std::move(centre);
  }

  std::uint64_t run() {
    const PointTree tree(centre_);
    average([&](TetrahedronIndex i) { return labels_.value(i); }, false);
    for (int k = 0; k < sharpenings; ++k) {
      measure_levels(tree);
      for_each_noisy([&](std::size_t i) {
        const Level& level = level_[i / run_length];
        value_[i] = std::clamp((value_[i] - level.middle) / level.spread, -1.0f, 1.0f);
      });
      for (int step = 0; step < diffusion_steps; ++step) average([&](TetrahedronIndex i) { return mean_at(i); }, true);
    }
    measure_levels(tree);
    for_each_noisy([&](std::size_t i) { value_[i] -= level_[i / run_length].middle; });
    return relabel();
  }

 private:
  std::pair<std::uint32_t, std::uint32_t> samples_of(std::uint32_t run) const {
    return {run * run_length, std::min(t_.sample_count, (run + 1) * run_length)};
  }
  bool is_noisy(std::uint32_t sample) const { return level_[sample / run_length].spread > 0; }

  template <class Work>
  void for_each_noisy(Work&& work) {
    for_each_index(threads_, t_.sample_count, [&](std::size_t i) {
      if (is_noisy(static_cast<std::uint32_t>(i))) work(i);
    });
  }

  /// What the first stage settled stays; the others take the mean of their samples.
  float mean_at(TetrahedronIndex i) const {
    if (first_[i] != Label::unlabelled) return first_[i] == Label::outside ? 1.0f : -1.0f;
    float sum = 0, count = 0;
    for (const SampleIndex s : t_.tetrahedra[i]) {
      if (t_.is_corner(s)) continue;
      sum += value_[s.value];
      ++count;
    }
    return sum / count;
  }

  /// Every (noisy) sample takes the mean over the tetrahedra around it.
  template <class Value>
  void average(Value&& value, bool only_noisy) {
    for_each_index(threads_, t_.sample_count, [&](std::size_t i) {
      if (only_noisy && !is_noisy(static_cast<std::uint32_t>(i))) {
        next_[i] = value_[i];
        return;
      }
      float sum = 0;
      const auto star = stars_[SampleIndex{static_cast<std::uint32_t>(i)}];
      for (const TetrahedronIndex k : star) sum += value(k);
      next_[i] = sum / static_cast<float>(star.size());
    });
    std::swap(value_, next_);
  }

  Level level_of(const PointTree& tree, std::uint32_t run) const {
    const auto [begin, end] = samples_of(run);
    const double reach = static_cast<double>(reach_[(begin + end) / 2]);
    if (!(reach > 0)) return {};
    std::vector<std::uint32_t> near = tree.within(centre_[run], radius_in_reach * reach);
    if (near.size() < least_runs) {
      near.resize(least_runs);
      std::array<double, least_runs> square{};
      near.resize(tree.nearest(centre_[run], least_runs, near.data(), square.data()));
    }
    std::vector<float> values;
    values.reserve(near.size() * run_length);
    for (const std::uint32_t r : near)
      for (auto [i, last] = samples_of(r); i < last; ++i)
        if (isolated_.empty() || !(isolated_[i] > 0)) values.push_back(value_[i]);
    if (values.size() < least_samples) return {};
    const float middle = quantile(values, 0.5), upper = quantile(values, 0.75), lower = quantile(values, 0.25);
    return {middle, std::max(1e-6f, (upper - lower) / 2)};
  }

  void measure_levels(const PointTree& tree) {
    std::vector<Level> own(runs_);
    for_each_index(
        threads_, runs_, [&](std::size_t r) { own[r] = level_of(tree, static_cast<std::uint32_t>(r)); }, 64);
    level_.assign(runs_, {});
    for_each_index(
        threads_, runs_,
        [&](std::size_t r) {
          if (!(own[r].spread > 0)) return;
          std::array<std::uint32_t, smoothing_runs> near{};
          std::array<double, smoothing_runs> square{};
          const std::size_t found = tree.nearest(centre_[r], smoothing_runs, near.data(), square.data());
          float count = 0;
          for (std::size_t k = 0; k < found; ++k) {
            if (!(own[near[k]].spread > 0)) continue;
            level_[r].middle += own[near[k]].middle;
            level_[r].spread += own[near[k]].spread;
            ++count;
          }
          level_[r] = {level_[r].middle / count, level_[r].spread / count};
        },
        64);
  }

  std::uint64_t relabel() {
    std::vector<std::uint8_t> changed(t_.tetrahedra.size(), 0);
    Labels labels = labels_.labels();
    IndexedArray<TetrahedronIndex, float> values = labels_.values();
    for_each_index(threads_, t_.tetrahedra.size(), [&](std::size_t k) {
      const TetrahedronIndex i{static_cast<std::uint32_t>(k)};
      if (first_[i] != Label::unlabelled) return;
      for (const SampleIndex s : t_.tetrahedra[i])
        if (t_.is_corner(s) || !is_noisy(s.value)) return;
      values[i] = mean_at(i);
      labels[i] = values[i] >= 0 ? Label::outside : Label::inside;
      changed[k] = labels[i] != labels_[i];
    });
    labels_ = {std::move(labels), std::move(values)};
    return static_cast<std::uint64_t>(std::count(changed.begin(), changed.end(), 1));
  }

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  std::span<const float> reach_, isolated_;
  const Labels& first_;
  const Threads& threads_;
  TetrahedronLabels& labels_;
  std::uint32_t runs_;
  std::vector<Vec3> centre_;
  std::vector<float> value_, next_; ///< of samples; > 0 outside
  std::vector<Level> level_;        ///< of runs
};

} // namespace

CentringCounts centre_in_noise(const Tetrahedralization& t, const VertexStars& stars, std::span<const float> reach,
                               std::span<const float> isolated, const Labels& first, const Threads& threads,
                               TetrahedronLabels& labels) {
  if (std::none_of(reach.begin(), reach.end(), [](float r) { return r > 0; })) return {};
  // Where nothing is known to be inside there is no surface to move.
  if (std::find(first.begin(), first.end(), Label::inside) == first.end()) return {};
  return {Centring(t, stars, reach, isolated, first, threads, labels).run()};
}

} // namespace eigencrust
