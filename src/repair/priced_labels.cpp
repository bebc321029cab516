// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/priced_labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/tetrahedron.h"
#include "samples/scales.h"

namespace eigencrust {

PricedLabels::PricedLabels(const Tetrahedralization& t, const VertexStars& stars, const Energy& energy,
                           SampleLengthsView spacing, std::vector<float> price, TetrahedronLabels& labels,
                           const Threads& threads)
    : t_(t),
      stars_(stars),
      energy_(energy),
      spacing_(spacing),
      price_(std::move(price)),
      labels_(labels),
      inside_(t.positions.size()) {
  price_.raw().resize(t.positions.size(), 0.0f); // the cube's corners have none
  for_each_index(threads, inside_.size(), [&](std::size_t at) {
    const VertexIndex s{static_cast<std::uint32_t>(at)};
    for (const TetrahedronIndex i : stars_[s]) inside_[s] += labels_[i] == Label::inside;
  });
}

void PricedLabels::turn(TetrahedronIndex i) {
  journal_.push_back({i, cost_});
  cost_ += cost_of(i);
  flip(i);
}

double PricedLabels::cost_of(TetrahedronIndex i) const {
  const TetrahedronIndex one[] = {i};
  double cost = energy_.change(t_, labels_.labels(), one);
  for (std::size_t k = 0; k < 4; ++k) {
    const TetrahedronIndex n = t_.neighbours[i][k];
    if (n.valid()) cost += labels_[n] == labels_[i] ? price_of_length(i, k) : -price_of_length(i, k);
    const VertexIndex s = t_.tetrahedra[i][k];
    const std::uint32_t inside = labels_[i] == Label::inside ? inside_[s] - 1 : inside_[s] + 1;
    const bool comes = inside > 0 && inside < star_size(s);
    if (comes != on_surface(s)) cost += static_cast<double>(comes ? -price_[s] : price_[s]);
  }
  return cost;
}

double PricedLabels::price_of_length(TetrahedronIndex i, std::size_t k) const {
  const auto& face = face_opposite[k];
  double longest = 0, spacing = 0;
  for (std::size_t j = 0; j < face.size(); ++j) {
    const VertexIndex a = t_.tetrahedra[i][face[j]], b = t_.tetrahedra[i][face[(j + 1) % face.size()]];
    longest = std::max(longest, squared_norm(t_.positions[a] - t_.positions[b]));
    spacing += t_.is_corner(a) ? 0 : static_cast<double>(spacing_[t_.sample(a)]) / static_cast<double>(face.size());
  }
  if (!(spacing > 0)) return 0; // of the cube
  // The energy knows the shape of a triangle and not its size. A long one costs as many such lengths as it has more.
  return std::max(0.0, std::sqrt(longest) / (longest_edge * spacing) - 1);
}

void PricedLabels::flip(TetrahedronIndex i) {
  labels_.turn(i);
  for (const VertexIndex s : t_.tetrahedra[i]) inside_[s] += labels_[i] == Label::inside ? 1u : ~0u;
}

bool PricedLabels::is_simple(TetrahedronIndex i) const {
  const Label label = labels_[i];
  std::array<std::size_t, 4> across{}; // of its triangles on the surface
  std::size_t count = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const TetrahedronIndex n = t_.neighbours[i][k];
    if (!n.valid()) return false;
    if (labels_[n] != label) across[count++] = k;
  }
  // They are a disc, and with nothing else does it touch the surface: no vertex beside one triangle, no edge beside
  // two.
  if (count == 1) return !on_surface(t_.tetrahedra[i][across[0]]);
  if (count == 2) return rest_of_ring(i, across[0], across[1], label);
  return count == 3;
}

std::vector<TetrahedronIndex> PricedLabels::turned_since(std::size_t then) const {
  std::vector<TetrahedronIndex> turned;
  for (std::size_t k = then; k < journal_.size(); ++k) turned.push_back(journal_[k].tetrahedron);
  std::sort(turned.begin(), turned.end());
  // Twice is not at all.
  std::vector<TetrahedronIndex> odd;
  for (std::size_t k = 0, end = 0; k < turned.size(); k = end) {
    while (end < turned.size() && turned[end] == turned[k]) ++end;
    if ((end - k) % 2 == 1) odd.push_back(turned[k]);
  }
  return odd;
}

void PricedLabels::back_to(std::size_t then) {
  for (; journal_.size() > then; journal_.pop_back()) {
    flip(journal_.back().tetrahedron);
    cost_ = journal_.back().cost_before;
  }
}

std::int64_t PricedLabels::back_with_euler(std::size_t then) {
  std::int64_t euler = 0;
  while (journal_.size() > then) {
    euler += euler_change(journal_.back().tetrahedron);
    back_to(journal_.size() - 1);
  }
  return euler;
}

/// Vertices - edges + triangles of the surface, after it is turned less before.
std::int64_t PricedLabels::euler_change(TetrahedronIndex i) const {
  const Label label = labels_[i], other = other_side(label);
  std::int64_t change = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const VertexIndex s = t_.tetrahedra[i][k];
    const std::uint32_t others = label == Label::inside ? star_size(s) - inside_[s] : inside_[s];
    change += others == 0 ? 1 : others + 1 == star_size(s) ? -1 : 0;
    const TetrahedronIndex n = t_.neighbours[i][k];
    if (n.valid()) change += labels_[n] == label ? 1 : -1;
    for (std::size_t j = 0; j < k; ++j)
      change -= rest_of_ring(i, j, k, label) ? 1 : rest_of_ring(i, j, k, other) ? -1 : 0;
  }
  return change;
}

/// Do all other tetrahedra around the edge of vertices a and b have that label?
bool PricedLabels::rest_of_ring(TetrahedronIndex i, std::size_t a, std::size_t b, Label label) const {
  const VertexIndex p = t_.tetrahedra[i][a], q = t_.tetrahedra[i][b];
  for (std::size_t way = 0; way < 4; ++way) {
    if (way == a || way == b) continue;
    TetrahedronIndex from = i, here = t_.neighbours[i][way];
    // Onward across the face at the edge that was not entered by, until back, or at the cube.
    while (here.valid() && here != i) {
      if (labels_[here] != label) return false;
      const TetrahedronIndex entered = from;
      from = here;
      for (std::size_t k = 0; k < 4; ++k) {
        const VertexIndex s = t_.tetrahedra[from][k];
        if (s == p || s == q || t_.neighbours[from][k] == entered) continue;
        here = t_.neighbours[from][k];
      }
    }
    if (here == i) return true;
  }
  return true;
}

} // namespace eigencrust
