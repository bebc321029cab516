// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far one surface is from another: the ruler of every benchmark.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// Triangles in a bounding volume hierarchy for nearest-point and ray queries; both are safe to call
/// from several threads at once.
class TriangleTree {
 public:
  /// Degenerate triangles are allowed. \throws Error{input} when there is no triangle, or one names a
  /// vertex that is missing or not finite.
  /// \param threads that build it; 0: one per core
  explicit TriangleTree(const TriangleMesh& mesh, unsigned threads = 1);
  ~TriangleTree();
  /// Moves.
  TriangleTree(TriangleTree&&) noexcept;
  /// Moves.
  TriangleTree& operator=(TriangleTree&&) noexcept;

  /// The nearest place of the mesh.
  struct Nearest {
    double distance;        ///< exact point-to-triangle distance (up to rounding)
    Vec3 point;             ///< on the mesh
    std::uint32_t triangle; ///< that it lies on
  };
  /// The nearest place to a point.
  [[nodiscard]] Nearest nearest(const Vec3& query) const;

  /// What a ray meets first.
  struct Hit {
    double distance = -1;       ///< along the ray in units of |direction|; negative: no hit
    std::uint32_t triangle = 0; ///< that was hit
    /// Was anything hit?
    [[nodiscard]] bool valid() const { return distance >= 0; }
  };
  /// First triangle hit by origin + t·direction with t > 0.
  [[nodiscard]] Hit first_hit(const Vec3& origin, const Vec3& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Summary of a set of distances; quantiles are linear between ranks, what is not finite is left out.
struct DistanceStatistics {
  std::uint64_t count = 0; ///< how many finite distances
  /// In the unit of the coordinates; q90: 90 % are not larger.
  double mean = 0, rms = 0, median = 0, q90 = 0, q95 = 0, q99 = 0, max = 0;
};
/// Mean, quantiles and maximum; what is not finite is left out.
DistanceStatistics summarize(std::vector<double> distances);

/// Distance of each point to the surface of `mesh`; NaN for a point that is not finite.
std::vector<double> distances_to_surface(std::span<const Vec3> points, const TriangleMesh& mesh, unsigned threads = 0);
/// Distance of each point to the nearest of `targets`; NaN for a point that is not finite.
/// \throws Error{input} when no target is finite.
std::vector<double> distances_to_points(std::span<const Vec3> points, std::span<const Vec3> targets,
                                        unsigned threads = 0);

/// `count` points spread over the surface proportionally to area; the same for the same seed.
/// triangle_of, when given, receives the triangle of each point; points come in the order of triangles.
/// \throws Error{input} when the mesh has no area.
std::vector<Vec3> sample_surface(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed,
                                 std::vector<std::uint32_t>* triangle_of = nullptr);

/// Volume of the intersection over volume of the union of two closed meshes, by integrating along
/// `columns` × `columns` lines parallel to z (winding numbers, so that orientation and nested shells
/// count; a point is inside where the winding number is not 0). Error about 1/columns.
/// \throws Error{input} when a mesh is empty or some line leaves it more or less often than it enters.
double volume_iou(const TriangleMesh& a, const TriangleMesh& b, std::uint32_t columns = 512, unsigned threads = 0);

/// How two meshes are compared.
struct CompareOptions {
  std::size_t samples = 100'000; ///< on each surface
  std::uint64_t seed = 1;        ///< of the points on the surfaces
  double threshold = 0;          ///< of the F-score; 0: 1 % of the reference's diagonal
  unsigned threads = 0;          ///< 0: all cores
};
/// How far a mesh is from a reference.
struct Comparison {
  DistanceStatistics to_reference;   ///< mesh -> reference
  DistanceStatistics from_reference; ///< reference -> mesh
  double hausdorff = 0;              ///< larger of the two maxima (of the samples)
  /// Distance up to which a point counts as found; share of the mesh, and of the reference, that is; their harmonic
  /// mean.
  double threshold = 0, precision = 0, recall = 0, f_score = 0;
  /// Mean of |n·n'| over the nearest points, both directions; and of n·n' with sign.
  double normal_consistency = 0, oriented_normal_consistency = 0;
  double volume_iou = -1; ///< -1 unless both are closed
};
/// How far a mesh is from a reference, measured between points spread over both. \throws Error{input} for a mesh
/// without area, Error{usage} without samples
Comparison compare(const TriangleMesh& mesh, const TriangleMesh& reference, const CompareOptions& options = {});

} // namespace eigencrust
