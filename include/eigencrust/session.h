// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One cloud, labelled again and again as the user names points in space.
#pragma once

#include <memory>
#include <span>

#include <eigencrust/eigencrust.h>

namespace eigencrust {

/// Triangulates, follows the lines of sight and solves the first partition once; naming points outside or inside then
/// costs only what comes after. What is named spreads from the kept solution: each node of the pole graph that it
/// reaches takes the mean of its neighbours until nothing changes by more than a hundredth. reconstruct() solves
/// anew instead, so the two may differ where the evidence is even. The result depends on the points of the call
/// alone, not on those of calls before.
class Session {
 public:
  /// Points named in `options` count in every call of label(). \throws as reconstruct()
  explicit Session(PointCloud cloud, const Options& options = {}, Observer& observer = *default_observer());
  ~Session();
  /// Moves.
  Session(Session&&) noexcept;
  /// Moves.
  Session& operator=(Session&&) noexcept;

  /// The surface with these points known, in input coordinates. Result::tetrahedralization is empty, see below; the
  /// report's stages and seconds are those of this call. Self-intersections are counted only after smoothing; there
  /// are none before. Not to be called from two threads at once.
  /// \throws as reconstruct()
  Result label(std::span<const Vec3> outside_points, std::span<const Vec3> inside_points,
               Observer& observer = *default_observer());

  /// What Result::labels refer to.
  [[nodiscard]] const Tetrahedralization& tetrahedralization() const;
  /// The points.
  [[nodiscard]] const PointCloud& cloud() const;

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

} // namespace eigencrust
