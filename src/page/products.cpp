// SPDX-License-Identifier: GPL-3.0-or-later
// What a page keeps of the stages' products.
#include <algorithm>
#include <cmath>

#include <eigencrust/page.h>

#include "numerics/quantile.h"
#include "page/view_mesh.h"

namespace eigencrust {
namespace {

constexpr std::size_t most_values = 2000, most_poles = 50000; // of a curve a screen wide; of each side
constexpr std::size_t most_points = 250000;

std::vector<float> values_of(const TriangleMesh& snapshot, std::string_view name) {
  std::vector<float> values;
  const Attribute* column = find_attribute(snapshot.vertex_attributes, name);
  if (column == nullptr) return values;
  for (std::size_t i = 0; i < column->rows(); ++i) values.push_back(static_cast<float>(attribute_value(*column, i)));
  return values;
}

SortedValues sorted_values(const TriangleMesh& snapshot) {
  std::vector<float> values = values_of(snapshot, "value");
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  std::sort(values.begin(), values.end());
  SortedValues sorted;
  sorted.count = values.size();
  sorted.inside = static_cast<std::uint64_t>(std::lower_bound(values.begin(), values.end(), 0.0f) - values.begin());
  sorted.values = evenly(std::span<const float>(values), most_values);
  return sorted;
}

std::vector<Vec3> poles_with(const TriangleMesh& snapshot, Label label) {
  std::vector<Vec3> places;
  const Attribute* column = find_attribute(snapshot.vertex_attributes, "label");
  for (std::size_t i = 0; column != nullptr && i < snapshot.vertices.size(); ++i)
    if (attribute_value(*column, i) == static_cast<double>(label)) places.push_back(snapshot.vertices[i]);
  return evenly(std::span<const Vec3>(places), most_poles);
}

/// \param high > 0
Histogram histogram_of(std::span<const float> values, double high) {
  constexpr std::size_t bins = 40;
  Histogram histogram{0, high, std::vector<double>(bins, 0)};
  for (const float v : values) {
    const double place = static_cast<double>(v) / high * static_cast<double>(bins);
    histogram.counts[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bins - 1)))] += 1;
  }
  return histogram;
}

Histogram noise_by_spacing(const TriangleMesh& snapshot) {
  std::vector<float> noise = values_of(snapshot, "noise");
  const std::vector<float> spacing = values_of(snapshot, "spacing");
  if (noise.empty() || spacing.size() != noise.size()) return {};
  for (std::size_t s = 0; s < noise.size(); ++s) noise[s] = spacing[s] > 0 ? noise[s] / spacing[s] : 0;
  constexpr double shown = 0.995, least = 0.1; // a few samples far beyond all others must not press these into one bin
  std::vector<float> copy = noise;
  return histogram_of(noise, std::max(static_cast<double>(quantile(copy, shown)), least));
}

/// The triangles whose mark is 0.
TriangleMesh without(const TriangleMesh& snapshot, std::string_view mark) {
  TriangleMesh rest;
  const Attribute* column = find_attribute(snapshot.triangle_attributes, mark);
  if (column == nullptr) return rest;
  std::vector<std::uint32_t> number(snapshot.vertices.size(), no_index);
  for (std::size_t i = 0; i < snapshot.triangles.size(); ++i) {
    if (attribute_value(*column, i) != 0) continue;
    rest.triangles.push_back(snapshot.triangles[i]);
    for (std::uint32_t& v : rest.triangles.back()) {
      if (number[v] == no_index) {
        number[v] = static_cast<std::uint32_t>(rest.vertices.size());
        rest.vertices.push_back(snapshot.vertices[v]);
      }
      v = number[v];
    }
  }
  return rest;
}

} // namespace

void PageObserver::product(std::string_view stage, const TriangleMesh& snapshot) {
  if (next_.wants_products()) next_.product(stage, snapshot);
  if (stage == "samples") products_.noise = noise_by_spacing(snapshot);
  if (stage == "poles") {
    products_.poles = sorted_values(snapshot);
    products_.inside_poles = poles_with(snapshot, Label::inside);
    products_.outside_poles = poles_with(snapshot, Label::outside);
  }
  if (stage == "tetrahedra") products_.tetrahedra = sorted_values(snapshot);
  if (stage == "surface") products_.left_out = without(snapshot, "kept");
  if (stage == "mesh") {
    products_.unsupported.clear();
    if (const Attribute* marked = find_attribute(snapshot.triangle_attributes, "unsupported"))
      for (std::size_t i = 0; i < marked->rows(); ++i)
        products_.unsupported.push_back(attribute_value(*marked, i) != 0);
  }
}

void PageObserver::finished(const PointCloud& cloud, const Result& result) {
  std::vector<Vec3> points, outliers;
  std::vector<float> confidence;
  const bool told = result.inlier.size() == cloud.points.size();
  for (std::size_t row = 0; row < cloud.points.size(); ++row) {
    if (!is_finite(cloud.points[row])) continue;
    (told && !result.inlier[row] ? outliers : points).push_back(cloud.points[row]);
    if (told) confidence.push_back(result.confidence[row]);
  }
  products_.point_count = points.size();
  products_.outlier_count = outliers.size();
  products_.points = evenly(std::span<const Vec3>(points), most_points);
  products_.outliers = evenly(std::span<const Vec3>(outliers), most_points);
  products_.confidence = told ? histogram_of(confidence, 1) : Histogram();
}

} // namespace eigencrust
