// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Nearest samples (nanoflann's k-d tree).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

/// k-d tree over points that outlive it; queries may run in parallel.
class PointTree {
 public:
  explicit PointTree(std::span<const Vec3> points);
  ~PointTree();
  PointTree(PointTree&&) noexcept;

  /// The k nearest points (fewer if there are fewer), nearest first; a point of the set finds itself.
  /// \return how many were found
  std::size_t nearest(const Vec3& query, std::size_t k, std::uint32_t* index, double* squared_distance) const;

  /// All points at distance <= radius, in no particular order.
  std::vector<std::uint32_t> within(const Vec3& query, double radius) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Distance of each point to the nearest other one; empty with fewer than two points. Points are distinct.
std::vector<double> nearest_other(std::span<const Vec3> points, const Threads& threads);

} // namespace eigencrust
