// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/data_term.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tetrahedra/circumsphere.h"

namespace eigencrust {
namespace {

// A tie weighs so much where its directions are at right angles, and e^4 = 55 times that where they agree
// (docs/decisions/0026: 0.03 to 0.3 make little difference).
constexpr double tie = 0.1;
// What it costs a labelled pole to be on the other side, where all its neighbours agree with it: half of a tie at its
// strongest, and more than its largest face.
constexpr double cost_of_pole = 2.7;
// What a deviation of the noise from the mean plane costs.
constexpr double cost_of_sigma = 0.5;
// What a line in front costs who is inside, a sample right in front who is outside (log-odds of a line that is true
// nineteen times in twenty are 3), and how many count at most: lines are not independent.
constexpr double cost_of_line = 3, cost_of_sample = 2, most_lines = 8;

} // namespace

void DataTerms::add_ties(SampleIndex s, TetrahedronIndex i, const Vec3& centre, DataTerm& sum) const {
  auto [first, second] = poles_.of_sample[s];
  if (!first.valid() || !second.valid()) return;
  const auto label = [&](PoleIndex p) { return labels_.labels[poles_.tetrahedron[p]]; };
  const auto trust = [&](PoleIndex p) { return labels_.trust[poles_.tetrahedron[p]] / 255.0; };
  if (label(first) == Label::inside) std::swap(first, second);
  for (const PoleIndex p : {first, second})
    if (poles_.tetrahedron[p] == i && label(p) != Label::unlabelled) {
      (label(p) == Label::outside ? sum.outside : sum.inside) += static_cast<float>(tie * std::exp(4) * trust(p));
      return;
    }
  if (label(first) != Label::outside || label(second) != Label::inside) return;
  const Vec3 way = centre - t_.positions[s];
  const double length = norm(way), both = tie * trust(first) * trust(second);
  const auto weight = [&](PoleIndex p) {
    const Vec3 towards = poles_.sphere[p].centre - t_.positions[s];
    // The shape of the pole graph's weights between tangent spheres (§3.1).
    return std::exp(4 * std::clamp(dot(towards, way) / (norm(towards) * length), -1.0, 1.0));
  };
  sum.outside += static_cast<float>(both * weight(first));
  sum.inside += static_cast<float>(both * weight(second));
}

void DataTerms::add_heights(TetrahedronIndex i, DataTerm& sum) const {
  Vec3 centroid;
  for (const SampleIndex s : t_.tetrahedra[i]) centroid = centroid + 0.25 * t_.positions[s];
  double height = 0;
  int planes = 0;
  for (const SampleIndex s : t_.tetrahedra[i]) {
    if (!has_plane(s) || !planes_.is_near(s, centroid)) continue;
    height += planes_.height(s, centroid);
    ++planes;
  }
  if (planes == 0) return;
  height /= planes;
  (height > 0 ? sum.outside : sum.inside) += static_cast<float>(cost_of_sigma * std::fabs(height));
}

void DataTerms::add_lines(TetrahedronIndex i, DataTerm& sum) const {
  if (!sight_ || sight_->front.empty()) return;
  sum.outside += static_cast<float>(cost_of_line * std::min<double>(most_lines, sight_->front[i]));
  sum.inside += static_cast<float>(cost_of_sample * std::min<double>(most_lines, sight_->behind[i]));
}

DataTerm DataTerms::operator()(TetrahedronIndex i) const {
  const auto& v = t_.tetrahedra[i];
  DataTerm sum;
  std::optional<Vec3> centre;
  for (const SampleIndex s : v) {
    if (t_.is_corner(s) || has_plane(s) || (!isolated_.empty() && isolated_[s.value] > 0)) continue;
    if (!centre) centre = circumcentre(t_.positions[v[0]], t_.positions[v[1]], t_.positions[v[2]], t_.positions[v[3]]);
    add_ties(s, i, *centre, sum);
  }
  if (const Label label = labels_.labels[i]; label != Label::unlabelled)
    (label == Label::outside ? sum.outside : sum.inside) += static_cast<float>(cost_of_pole * labels_.trust[i] / 255);
  add_heights(i, sum);
  add_lines(i, sum);
  return sum;
}

} // namespace eigencrust
