// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The tetrahedra around one sample, with what is adjacent to what among them.
#pragma once

#include <eigencrust/types.h>
#include <vector>

namespace eigencrust {

/// Filled again for one sample after the other, so that nothing is allocated in the loop.
/// Tetrahedra are named by their place in the star, which follows their index.
class Star {
 public:
  static constexpr std::uint32_t none = no_index;

  Star(const Tetrahedralization& tetrahedralization, const VertexStars& stars)
      : t_(tetrahedralization), stars_(stars) {}

  void fill(VertexIndex sample);
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(tetrahedra_.size()); }
  [[nodiscard]] TetrahedronIndex operator[](std::uint32_t i) const { return tetrahedra_[i]; }
  /// The other three vertices; neighbour k lies across the face of the sample and the two others.
  [[nodiscard]] const std::array<VertexIndex, 3>& others(std::uint32_t i) const { return others_[i]; }
  [[nodiscard]] const std::array<std::uint32_t, 3>& neighbours(std::uint32_t i) const { return neighbours_[i]; }

  /// Numbers the face-connected sets of tetrahedra with equal `label`; component[i] is no_index for
  /// other labels. With `edge` valid only tetrahedra at that edge count, joined across faces that hold
  /// it. \return how many sets
  std::uint32_t components(const Labels& labels, Label label, VertexIndex edge, std::vector<std::uint32_t>& component);

 private:
  const Tetrahedralization& t_;
  const VertexStars& stars_;
  std::span<const TetrahedronIndex> tetrahedra_;
  std::vector<std::array<VertexIndex, 3>> others_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<std::uint32_t> stack_;
};

} // namespace eigencrust
