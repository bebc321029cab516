// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/data_term.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "geometry/tetrahedron.h"
#include "tetrahedra/circumsphere.h"

namespace eigencrust {
namespace {

// What a deviation of the noise from the mean plane costs.
constexpr double cost_of_sigma = 0.5;
// What a line in front costs who is inside, a sample right in front who is outside (log-odds of a line that is true
// nineteen times in twenty are 3).
constexpr float cost_of_line = 3, cost_of_sample = 2;
// What a sample in front costs who is outside, hidden behind a façade, and a line along its axis who is inside: it need
// not be solid right behind a sample, nor seen along the axis, so less than what is known of lines.
constexpr float cost_of_hiding = 1;

} // namespace

void DataTerms::add_ties(SampleIndex s, TetrahedronIndex i, const Vec3& centre, DataTerm& sum) const {
  const auto [first, second] = poles_.of_sample[s];
  if (!first.valid() || !second.valid()) return;
  const auto label = [&](PoleIndex p) { return labels_.labels[poles_.tetrahedron[p]]; };
  const auto trust = [&](PoleIndex p) { return trust_in(poles_.tetrahedron[p]); };
  const auto add = [&](PoleIndex p, double cost) {
    (label(p) == Label::outside ? sum.outside : sum.inside) += static_cast<float>(cost);
  };
  // A sample with both poles on one side is not on the surface; where a hole lets balls through, such ties would hold a
  // spike up to a stray.
  if (label(first) == label(second)) return;
  for (const PoleIndex p : {first, second})
    if (poles_.tetrahedron[p] == i && label(p) != Label::unlabelled) return add(p, strongest_tie * trust(p));
  // Of two poles one often lies within the noise; beyond that the other still knows its side. Elsewhere one alone would
  // eat away what is thin.
  const bool is_labelled = label(first) != Label::unlabelled && label(second) != Label::unlabelled;
  if (!is_labelled && !planes_.has(s)) return;
  const Vec3 way = centre - t_.positions[s];
  const double length = norm(way);
  const auto towards = [&](PoleIndex p) { return poles_.sphere[p].centre - t_.positions[s]; };
  // Where the coordinates are huge a centre may round onto its sample: it has no direction then.
  if (!(length > 0) || !(norm(towards(first)) > 0) || !(norm(towards(second)) > 0)) return;
  double strength = tie;
  for (const PoleIndex p : {first, second})
    if (label(p) != Label::unlabelled) strength *= trust(p);
  for (const PoleIndex p : {first, second}) {
    if (label(p) == Label::unlabelled) continue;
    const Vec3 to = towards(p);
    // The shape of the pole graph's weights between tangent spheres (§3.1).
    add(p, strength * std::exp(steepness * std::clamp(dot(to, way) / (norm(to) * length), -1.0, 1.0)));
  }
}

void DataTerms::add_heights(TetrahedronIndex i, const Vec3& middle, DataTerm& sum) const {
  double height = 0;
  int planes = 0;
  for (const VertexIndex v : t_.tetrahedra[i]) {
    if (t_.is_corner(v)) continue;
    const SampleIndex s = t_.sample(v);
    if (!planes_.knows(s, middle)) continue;
    height += planes_.height(s, middle);
    ++planes;
  }
  if (planes == 0) return;
  height /= planes;
  (height > 0 ? sum.outside : sum.inside) += static_cast<float>(cost_of_sigma * std::fabs(height));
}

void DataTerms::add_lines(TetrahedronIndex i, DataTerm& sum) const {
  if (hidden_) {
    const std::int16_t count = (*hidden_)[i];
    (count > 0 ? sum.inside : sum.outside) += cost_of_hiding * static_cast<float>(std::abs(count));
  }
  if (!sight_ || sight_->front.empty()) return;
  sum.outside += cost_of_line * sight_->front[i];
  sum.inside += cost_of_sample * sight_->behind[i];
}

DataTerm DataTerms::operator()(TetrahedronIndex i) const {
  DataTerm sum;
  const Vec3 middle = centroid(corners_of(t_, i));
  std::optional<Vec3> centre;
  for (const VertexIndex v : t_.tetrahedra[i]) {
    if (t_.is_corner(v)) continue;
    const SampleIndex s = t_.sample(v);
    if (planes_.knows(s, middle) || (!isolated_.empty() && isolated_[s] > 0)) continue;
    if (!centre) centre = std::apply(circumcentre, corners_of(t_, i));
    add_ties(s, i, *centre, sum);
  }
  if (const Label label = labels_.labels[i]; label != Label::unlabelled)
    // On the other side a labelled pole costs half of a tie, where all its neighbours agree with it: more than its
    // largest face.
    (label == Label::outside ? sum.outside : sum.inside) += static_cast<float>(strongest_tie / 2 * trust_in(i));
  add_heights(i, middle, sum);
  add_lines(i, sum);
  return sum;
}

} // namespace eigencrust
