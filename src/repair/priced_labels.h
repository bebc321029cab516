// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Labels with what it costs to change them, and a way back.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "settle/energy.h"

namespace eigencrust {

/// Every tetrahedron turned is written down and may be turned back exactly.
class PricedLabels {
 public:
  /// \param price   of each sample that is not on the surface, in units of the energy
  /// \param spacing of each sample
  PricedLabels(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Energy& energy,
               SampleLengthsView spacing, std::vector<float> price, TetrahedronLabels& labels, const Threads& threads);

  Label operator[](TetrahedronIndex i) const { return labels_[i]; }
  [[nodiscard]] const Labels& all() const { return labels_.labels(); }
  /// To the other side.
  void turn(TetrahedronIndex i);
  /// What turning it would add to the cost.
  [[nodiscard]] double cost_of(TetrahedronIndex i) const;

  /// Where all stars are discs: are they after it is turned, and pieces and handles the same? (A simple point, as in
  /// digital topology.) Not where it lies at the cube.
  [[nodiscard]] bool is_simple(TetrahedronIndex i) const;

  /// What turning it would add to the Euler characteristic of the surface.
  [[nodiscard]] std::int64_t euler_change(TetrahedronIndex i) const;

  /// Energy, prices of the samples and of long triangles, less those of the beginning.
  [[nodiscard]] double cost() const { return cost_; }
  [[nodiscard]] double price(VertexIndex s) const { return static_cast<double>(price_[s]); }
  /// Has the sample tetrahedra of both sides around it?
  [[nodiscard]] bool on_surface(VertexIndex s) const { return inside_[s] > 0 && inside_[s] < star_size(s); }

  /// A point in time, for the following.
  [[nodiscard]] std::size_t now() const { return journal_.size(); }
  [[nodiscard]] std::vector<TetrahedronIndex> turned_since(std::size_t then) const;
  /// Turns back what was turned since.
  void back_to(std::size_t then);
  /// The same. \return by how much that changes the Euler characteristic of the surface
  std::int64_t back_with_euler(std::size_t then);

 private:
  struct Turn {
    TetrahedronIndex tetrahedron;
    double cost_before;
  };

  [[nodiscard]] std::uint32_t star_size(VertexIndex s) const {
    return static_cast<std::uint32_t>(stars_.begin[s.value + 1] - stars_.begin[s.value]);
  }
  void flip(TetrahedronIndex i);
  [[nodiscard]] double price_of_length(TetrahedronIndex i, std::size_t k) const;
  [[nodiscard]] bool rest_of_ring(TetrahedronIndex i, std::size_t a, std::size_t b, Label label) const;

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Energy& energy_;
  SampleLengthsView spacing_;
  IndexedArray<VertexIndex, float> price_; ///< 0 for the corners of the cube
  TetrahedronLabels& labels_;
  IndexedArray<VertexIndex, std::uint32_t> inside_; ///< tetrahedra of the star
  std::vector<Turn> journal_;
  double cost_ = 0;
};

} // namespace eigencrust
