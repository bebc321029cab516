// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Samples that stand together on one side of the surface, in ever coarser clusters: wide fits need not look at each
/// sample.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/compressed_rows.h"
#include "parallel/threads.h"
#include "surface/fans.h"

namespace eigencrust {

struct SampleCluster {
  Vec3 mean;
  std::array<double, 6> spread{}; ///< covariance: xx, xy, xz, yy, yz, zz; length²
  double count = 0;               ///< of samples; 0: the cluster only leads on to others, from its mean

  void add(const SampleCluster& other);
  /// aᵀ C b
  [[nodiscard]] double covariance(const Vec3& a, const Vec3& b) const {
    const auto& s = spread;
    return a.x * (s[0] * b.x + s[1] * b.y + s[2] * b.z) + a.y * (s[1] * b.x + s[3] * b.y + s[4] * b.z) +
           a.z * (s[2] * b.x + s[4] * b.y + s[5] * b.z);
  }
};

struct ClusterLevel {
  /// What a search looks at, side by side.
  struct Place {
    Vec3 mean, normal;
    double extent = 0; ///< distance from its mean to those of its children, the largest
  };
  struct Child {
    Vec3 normal;
    SampleCluster cluster;
  };

  std::vector<SampleCluster> cluster;
  std::vector<Vec3> normal;                 ///< unit; 0: unknown
  CompressedRows<std::uint32_t> neighbours; ///< along the surface
  std::vector<std::uint32_t> parent;        ///< in the next level; empty in the last
  // Of the level below; empty in the first.
  std::vector<std::uint32_t> seed;        ///< from which the cluster was made
  CompressedRows<std::uint32_t> children; ///< which it joins
  std::vector<Place> place;               ///< of each cluster
  std::vector<Child> child;               ///< those of the children, in their order
};

/// Level 0 has a cluster for each vertex of the surface. Each next one joins every cluster of an independent set (which
/// is maximal) with its neighbours that look the same way: about a quarter as many, twice as far apart.
class ClusterPyramid {
 public:
  /// \param position, normal of each vertex \param vertex_of each sample; no_vertex: it belongs to none
  ClusterPyramid(const SurfaceFans& fans, std::span<const Vec3> position, std::vector<Vec3> normal,
                 std::span<const Vec3> samples, std::span<const std::uint32_t> vertex_of, const Threads& threads);

  static constexpr std::uint32_t no_vertex = 0xffffffff;
  static constexpr std::size_t most_levels = 6;
  [[nodiscard]] std::size_t levels() const { return levels_.size(); }
  [[nodiscard]] const ClusterLevel& operator[](std::size_t level) const { return levels_[level]; }
  /// \param level that of cluster c \param above as coarse or coarser
  [[nodiscard]] std::uint32_t ancestor(std::size_t level, std::uint32_t c, std::size_t above) const {
    for (; level < above; ++level) c = levels_[level].parent[c];
    return c;
  }
  /// New normals of the vertices; those of the clusters are the sums of their parts'.
  void set_normals(std::vector<Vec3> normal, const Threads& threads);

 private:
  static ClusterLevel coarser(ClusterLevel& fine, const Threads& threads);
  static void copy_normals(const ClusterLevel& fine, ClusterLevel& coarse, const Threads& threads);
  std::vector<ClusterLevel> levels_;
};

} // namespace eigencrust
