// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Normals and colours of vertices, where only some parts of a scene have them.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::io {

/// Collects what is known of single vertices; all others have no normal (NaN) and are white.
class VertexRows {
 public:
  /// \param normal of any length
  void set_normal(std::size_t vertex, const Vec3& normal) {
    normals_.resize(std::max(normals_.size(), 3 * (vertex + 1)), std::numeric_limits<float>::quiet_NaN());
    const double length = norm(normal);
    const Vec3 unit = length > 0 ? (1 / length) * normal : Vec3{};
    for (std::size_t k = 0; k < 3; ++k)
      normals_[3 * vertex + k] = static_cast<float>(k == 0 ? unit.x : k == 1 ? unit.y : unit.z);
  }
  /// \param alpha is it known?
  void set_colour(std::size_t vertex, const std::array<std::uint8_t, 4>& rgba, bool alpha) {
    colours_.resize(std::max(colours_.size(), vertex + 1), {255, 255, 255, 255});
    colours_[vertex] = rgba;
    alpha_ = alpha_ || alpha;
  }

  /// Appends nx, ny, nz, red, green, blue and alpha to the attributes of the mesh, as far as there are any.
  void give(TriangleMesh& mesh) {
    const std::size_t n = mesh.vertices.size();
    if (n == 0) return;
    std::vector<double> column(n);
    if (!normals_.empty()) {
      normals_.resize(3 * n, std::numeric_limits<float>::quiet_NaN());
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < n; ++i) column[i] = double{normals_[3 * i + k]};
        mesh.vertex_attributes.push_back(make_attribute(std::string("n") + "xyz"[k], ScalarType::float32, column));
      }
    }
    if (colours_.empty()) return;
    colours_.resize(n, {255, 255, 255, 255});
    constexpr std::array<const char*, 4> names = {"red", "green", "blue", "alpha"};
    for (std::size_t k = 0; k < (alpha_ ? 4u : 3u); ++k) {
      for (std::size_t i = 0; i < n; ++i) column[i] = colours_[i][k];
      mesh.vertex_attributes.push_back(make_attribute(names[k], ScalarType::uint8, column));
    }
  }

 private:
  std::vector<float> normals_; ///< three of each vertex
  std::vector<std::array<std::uint8_t, 4>> colours_;
  bool alpha_ = false;
};

} // namespace eigencrust::io
