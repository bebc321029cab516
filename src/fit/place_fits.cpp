// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/place_fits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "samples/place_model.h"

namespace eigencrust {
namespace {

// In units of the larger of σ and 0.7 spacings; each has twice the samples of the one before.
constexpr std::array<double, QuadricFit::most_widths> widths{2.83, 4, 5.66, 8, 11.3, 16, 22.6};
// Cosine: samples of one side.
constexpr double same_side = 0.6;
// Up to so many times the noise that the model knows of is noise; what is more about a narrow fit is shape.
constexpr double over_model = 1.2;
// Clusters are as coarse as leaves so many of them in a fit that is compared with others.
constexpr double enough_to_choose = 25;
// What the means over few places leave of the bias counts so much: more leaves noise in, less rounds off what is sharp.
constexpr double bias_counts = 0.7;
// A width whose risk is so many times that of another is the last one looked at.
constexpr double hopeless = 3;
// In noise of less than so many spacings every third place is looked at; in more each counts.
constexpr double little_noise = 0.6;
constexpr std::size_t in_little_noise = 3;
// Rounds in which the choice is averaged over the neighbours: a single one hangs on the noise at its place.
constexpr int averaging_rounds = 4;
// Places are looked at in blocks, each with a memory of its own.
constexpr std::size_t places_per_block = 512;

/// Clusters around a place, found along the surface. The way leads over clusters of the next level, which are fewer.
/// Whether one is new or near is anybody's guess: all are written down, and the next overwrites those that are not.
class Neighbourhood {
 public:
  /// Those of the level, in the ball, that look the same way; valid until the next call.
  /// \param start one of the level above, which is always one of those whose children are looked at
  std::span<const SampleCluster* const> find(const ClusterPyramid& samples, std::size_t level, std::uint32_t start,
                                             const Vec3& origin, const Vec3& normal, double radius) {
    const ClusterLevel& above = samples[level + 1];
    const std::size_t ways = walk(above, level, start, origin, normal, radius);
    std::size_t count = 0;
    for (std::size_t i = 0; i < ways; ++i) {
      const std::size_t begin = above.children.begin[way_[i]], end = above.children.begin[way_[i] + 1];
      if (found_.size() < count + (end - begin)) found_.resize(2 * (count + (end - begin)));
      for (std::size_t k = begin; k < end; ++k) {
        const ClusterLevel::Child& child = above.child[k];
        found_[count] = &child.cluster;
        const bool near =
            squared_norm(child.cluster.mean - origin)<radius * radius, same = dot(child.normal, normal)> same_side;
        count += near & same;
      }
    }
    return std::span(found_).first(count);
  }

 private:
  static constexpr std::size_t most = 400; // a bound on the work

  /// \return how many there are
  std::size_t walk(const ClusterLevel& level, std::size_t below, std::uint32_t start, const Vec3& origin,
                   const Vec3& normal, double radius) {
    std::vector<std::uint32_t>& seen_in = seen_in_[below];
    seen_in.resize(level.place.size(), 0);
    ++round_;
    way_[0] = start;
    seen_in[start] = round_;
    std::size_t ways = 1, seen = 1;
    for (std::size_t i = 0; i < ways; ++i) {
      std::size_t fresh = 0;
      for (const std::uint32_t c : level.neighbours[way_[i]]) {
        fresh_[fresh] = c;
        const bool is_new = seen_in[c] != round_, is_one_more = seen + fresh < most;
        fresh += is_new & is_one_more;
        seen_in[c] = round_;
      }
      seen += fresh;
      for (std::size_t k = 0; k < fresh; ++k) {
        const ClusterLevel::Place& place = level.place[fresh_[k]];
        const double reach = radius + place.extent;
        const bool same = dot(place.normal, normal) > same_side,
                   near = squared_norm(place.mean - origin) < reach * reach;
        way_[ways] = fresh_[k];
        ways += same & near;
      }
    }
    return ways;
  }

  std::array<std::vector<std::uint32_t>, ClusterPyramid::most_levels> seen_in_; ///< of each cluster the last round
  std::uint32_t round_ = 0; // a few for each place, of which there are 2^28 at most
  std::array<std::uint32_t, most + 1> way_, fresh_;
  std::vector<const SampleCluster*> found_;
};

/// One for each thread, which go from block to block: they are as large as the pyramid.
class Neighbourhoods {
 public:
  std::unique_ptr<Neighbourhood> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Neighbourhood>();
    std::unique_ptr<Neighbourhood> last = std::move(free_.back());
    free_.pop_back();
    return last;
  }
  void give_back(std::unique_ptr<Neighbourhood> used) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(used));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Neighbourhood>> free_;
};

class PlaceFitter {
 public:
  PlaceFitter(const FitPlaces& places, const ClusterPyramid& samples, double enough, Neighbourhoods& all)
      : places_(places), samples_(samples), enough_(enough), all_(all), around_(all.take()) {}
  ~PlaceFitter() { all_.give_back(std::move(around_)); }
  PlaceFitter(const PlaceFitter&) = delete;
  PlaceFitter& operator=(const PlaceFitter&) = delete;

  std::optional<LocalQuadric> fit(std::size_t p, double width) { return fits(p, std::span(&width, 1))[0]; }

  /// Those of the increasing widths that look at clusters of one level, the first at least: one search does for all.
  const std::vector<std::optional<LocalQuadric>>& fits(std::size_t p, std::span<const double> width) {
    const Vec3 &origin = places_.position[p], &normal = places_.normal[p];
    const auto radius = [&](std::size_t k) { return width[k] * places_.unit[p]; };
    const std::size_t l = level_for(radius(0) / places_.spacing[p]);
    radius_.assign(1, radius(0));
    for (std::size_t k = 1; k < width.size() && level_for(radius(k) / places_.spacing[p]) == l; ++k)
      radius_.push_back(radius(k));
    QuadricFit fit(origin, normal, radius_);
    // Where the width ends samples are still as thick as in the middle.
    const double reach = std::hypot(radius_.back(), static_cast<double>(noise_bound) * places_.noise[p]);
    const std::uint32_t start = samples_.ancestor(FitPlaces::level, static_cast<std::uint32_t>(p), l + 1);
    fit.add(around_->find(samples_, l, start, origin, normal, reach));
    solved_.clear();
    for (std::size_t k = 0; k < radius_.size(); ++k) solved_.push_back(fit.solve(most_noise(p), k));
    return solved_;
  }

  /// The narrowest fit knows the noise best, but where the shape is as fine it takes that for noise, too.
  [[nodiscard]] double most_noise(std::size_t p) const {
    return places_.noise[p] > 0 ? over_model * places_.noise[p] : std::numeric_limits<double>::infinity();
  }

 private:
  [[nodiscard]] std::size_t level_for(double radius_in_spacings) const {
    double clusters = std::numbers::pi * radius_in_spacings * radius_in_spacings / 4;
    std::size_t l = 0;
    for (; clusters > enough_ && l + 2 < samples_.levels(); clusters /= 4) ++l;
    return l;
  }
  const FitPlaces& places_;
  const ClusterPyramid& samples_;
  double enough_;
  Neighbourhoods& all_;
  std::unique_ptr<Neighbourhood> around_;
  std::vector<double> radius_;
  std::vector<std::optional<LocalQuadric>> solved_;
};

/// The width of least risk, which is the square of the bias and the variance together. Fits twice as wide have a bias
/// 16 times as large (quadrics miss terms of the fourth order), so that the difference of two fits shows the bias of
/// the wider one; what noise explains of it is taken off. Single differences say little, their means over the places
/// around a good deal.
class WidthChoice {
 public:
  WidthChoice(const FitPlaces& places, const ClusterPyramid& samples, const Threads& threads)
      : places_(places),
        samples_(samples),
        threads_(threads),
        running_(places.wanted),
        noise_(places.position.size(), -1),
        bias_(noise_.size(), 0),
        choice_(noise_.size(), -1),
        fitted_(noise_.size(), 0) {
    const std::vector<float> zeros(noise_.size(), 0);
    levels_.fill({zeros, zeros, std::vector<float>(noise_.size(), none)});
    for (std::size_t p = 0; p < running_.size(); ++p)
      running_[p] &= squared_norm(places.normal[p]) > 0 &&
                     (p % in_little_noise == 0 || places.noise[p] > little_noise * places.spacing[p]);
  }

  ChosenWidths run() {
    for (std::size_t k = 0; k < widths.size(); ++k) {
      fit(k);
      if (k == 0) find_noise();
      weigh(k);
    }
    for_each_index(threads_, choice_.size(), [&](std::size_t p) { choice_[p] = least(p); });
    for (int round = 0; round < averaging_rounds; ++round) choice_ = pooled(choice_);
    for (double& c : choice_) c = c < 0 ? 0 : widths[0] * std::exp2(c / 2);
    return {std::move(choice_), std::move(narrowest_)};
  }

 private:
  static constexpr float none = -1;
  struct Level {
    std::vector<float> offset, variance; ///< variance in units of a sample's; 0: no fit
    std::vector<float> risk;
  };

  /// Fits of this width, and of the next ones where they cost little more.
  void fit(std::size_t k) {
    for_blocks(threads_, running_.size(), places_per_block, [&](std::size_t begin, std::size_t end, std::size_t) {
      PlaceFitter fitter(places_, samples_, enough_to_choose, around_);
      for (std::size_t p = begin; p < end; ++p) {
        if (!running_[p] || fitted_[p] > k) continue;
        for (const auto& found : fitter.fits(p, std::span(widths).subspan(k))) {
          Level& level = levels_[fitted_[p]++];
          if (!found) continue;
          level.offset[p] = static_cast<float>(found->offset(places_.position[p], places_.normal[p]));
          level.variance[p] = static_cast<float>(found->variance);
          if (noise_[p] < 0) noise_[p] = found->noise_variance;
        }
      }
    });
  }

  /// The narrowest fits know the noise best. The model knows too little of it in thin parts, and is not asked.
  void find_noise() {
    narrowest_ = noise_;
    const std::vector<double> mean = pooled(noise_);
    for (std::size_t p = 0; p < mean.size(); ++p)
      if (mean[p] >= 0) noise_[p] = mean[p];
  }

  void weigh(std::size_t k) {
    const std::size_t j = k < 2 ? 0 : k - 2;
    const double less_biased = std::pow(widths[j] / widths[k], 4);
    const auto& [offset, variance, unused] = levels_[k];
    std::vector<double> apart(offset.size(), -1), explained(offset.size(), -1);
    for_each_index(threads_, offset.size(), [&](std::size_t p) {
      if (variance[p] == 0 || levels_[j].variance[p] == 0) return;
      apart[p] = std::fabs(static_cast<double>(offset[p] - levels_[j].offset[p]));
      explained[p] = noise_[p] * std::max(0.0, static_cast<double>(levels_[j].variance[p] - variance[p]));
    });
    if (k > 0) {
      apart = pooled(apart);
      explained = pooled(explained);
    }
    for_each_index(threads_, offset.size(), [&](std::size_t p) {
      if (!running_[p] || variance[p] == 0) return;
      if (k > 0 && apart[p] >= 0) {
        // Of normal deviates the mean square is pi / 2 of the squared mean; that is surer where some are wild.
        const double square = std::numbers::pi / 2 * apart[p] * apart[p] - explained[p];
        bias_[p] = std::max(bias_[p], square / ((1 - less_biased) * (1 - less_biased)));
      }
      levels_[k].risk[p] = static_cast<float>(bias_counts * bias_[p] + noise_[p] * static_cast<double>(variance[p]));
      double best = std::numeric_limits<double>::infinity();
      for (const Level& level : levels_) // those to come have none yet
        if (level.risk[p] >= 0) best = std::min(best, static_cast<double>(level.risk[p]));
      running_[p] = static_cast<double>(levels_[k].risk[p]) < hopeless * best;
    });
  }

  /// Means over the places and their neighbours on the same side of what is not negative; -1: nothing.
  [[nodiscard]] std::vector<double> pooled(const std::vector<double>& value) const {
    std::vector<double> result(value.size());
    for_each_index(threads_, value.size(), [&](std::size_t p) {
      double sum = 0, count = 0;
      for_same_side(p, [&](std::size_t q) {
        if (value[q] < 0) return;
        sum += value[q];
        count += 1;
      });
      result[p] = count > 0 ? sum / count : -1;
    });
    return result;
  }

  /// The place itself counts twice among its neighbours.
  template <class Visit>
  void for_same_side(std::size_t p, Visit&& visit) const {
    visit(p);
    visit(p);
    for (const std::uint32_t q : samples_[FitPlaces::level].neighbours[p])
      if (dot(places_.normal[q], places_.normal[p]) > same_side) visit(q);
  }

  /// The level of least risk, between levels by the parabola through three; negative: none.
  [[nodiscard]] double least(std::size_t p) const {
    std::size_t best = widths.size();
    const auto risk = [&](std::size_t k) { return static_cast<double>(levels_[k].risk[p]); };
    for (std::size_t k = 0; k < widths.size(); ++k)
      if (risk(k) >= 0 && (best == widths.size() || risk(k) < risk(best))) best = k;
    if (best == widths.size()) return -1;
    const auto at = static_cast<double>(best);
    if (best == 0 || best + 1 == widths.size() || risk(best - 1) < 0 || risk(best + 1) < 0) return at;
    const double bend = risk(best - 1) - 2 * risk(best) + risk(best + 1);
    return bend > 0 ? at + 0.5 * (risk(best - 1) - risk(best + 1)) / bend : at;
  }

  const FitPlaces& places_;
  const ClusterPyramid& samples_;
  const Threads& threads_;
  Neighbourhoods around_;
  std::vector<std::uint8_t> running_; ///< places whose risk may still fall
  std::vector<double> noise_;         ///< variance; negative: unknown
  std::vector<double> narrowest_;     ///< the same, of each place's narrowest fit alone
  std::vector<double> bias_;          ///< square, of the level before or of narrower ones
  std::vector<double> choice_;
  std::vector<std::uint8_t> fitted_; ///< the number of widths that were
  std::array<Level, widths.size()> levels_;
};

} // namespace

ChosenWidths chosen_widths(const FitPlaces& places, const ClusterPyramid& samples, const Threads& threads) {
  return WidthChoice(places, samples, threads).run();
}

namespace {

/// Where all fits are wide.
std::vector<std::uint8_t> wide_clusters(const FitPlaces& places, const ClusterPyramid& samples,
                                        const std::vector<double>& width, double wide_in_spacings) {
  const std::vector<std::uint32_t>& parent = samples[FitPlaces::level].parent;
  std::vector<std::uint8_t> wide(samples[FitPlaces::level + 1].cluster.size(), 1);
  for (std::size_t p = 0; p < width.size(); ++p)
    if (width[p] * places.unit[p] < wide_in_spacings * places.spacing[p]) wide[parent[p]] = 0;
  return wide;
}

} // namespace

PlaceFits fits_of_widths(const FitPlaces& places, const ClusterPyramid& samples, const std::vector<double>& width,
                         const FitEffort& effort, const Threads& threads) {
  PlaceFits fits{std::vector<LocalQuadric>(places.position.size()), wide_clusters(places, samples, width, effort.wide)};
  const std::vector<std::uint32_t>&parent = samples[FitPlaces::level].parent,
        &seed = samples[FitPlaces::level + 1].seed;
  Neighbourhoods around;
  for_blocks(threads, fits.fit.size(), places_per_block, [&](std::size_t begin, std::size_t end, std::size_t) {
    PlaceFitter fitter(places, samples, effort.clusters, around);
    for (std::size_t p = begin; p < end; ++p) {
      if (!(width[p] > 0) || !(squared_norm(places.normal[p]) > 0)) continue;
      if (fits.wide[parent[p]] && seed[parent[p]] != p) continue;
      std::optional<LocalQuadric> fit;
      for (double w = width[p]; !fit && w < 2 * widths.back(); w *= 2) fit = fitter.fit(p, w);
      if (fit) fits.fit[p] = *fit;
    }
  });
  return fits;
}

} // namespace eigencrust
