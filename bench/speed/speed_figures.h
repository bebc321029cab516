// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What was measured of a cloud, and the figures that are made of it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "speed_cases.h"

namespace eigencrust::bench {

/// Middle value, the mean of the two middle ones of an even number; NaN without any.
double median(std::span<const double> values);

struct CgalTimes {
  std::vector<double> seconds; ///< of the insertion, one per run
  std::uint64_t tetrahedra = 0, peak_memory_bytes = 0;
};

/// The command on one number of threads; vectors have one entry per run.
struct WholeTimes {
  unsigned threads = 1;
  std::vector<double> seconds, user_seconds; ///< of the process
  /// In order; the last, "other", is what is in no stage: starting, reading, hashing, writing.
  std::vector<std::pair<std::string, std::vector<double>>> stages;
  std::uint64_t peak_memory_bytes = 0;
  std::uint64_t pole_steps = 0, tetrahedron_steps = 0; ///< of the solvers, on the finest level

  /// Median seconds of that stage; 0 when it was not run.
  [[nodiscard]] double stage_seconds(const std::string& name) const;
  /// Median over the runs of the sum of all stages after "delaunay"; "other" is not among them.
  [[nodiscard]] double seconds_after_delaunay() const;
};

struct SpeedOutcome {
  SpeedCase item;
  std::string skipped, error; ///< why there is nothing, or not all; empty: all there
  std::uint64_t points = 0;
  CgalTimes cgal;
  std::vector<WholeTimes> whole; ///< one per number of threads

  [[nodiscard]] bool measured() const { return skipped.empty() && error.empty(); }
  /// These seconds in medians of CGAL's.
  [[nodiscard]] double ratio(double seconds) const { return seconds / median(cgal.seconds); }
  [[nodiscard]] double per_point(double value) const { return value / static_cast<double>(points); }
};

/// How seconds per point of the generated clouds grow with their size, the smallest of at least 100,000 points
/// being 1 (the smallest of all, if all are smaller).
struct Growth {
  std::string name;
  std::uint64_t points = 0;
  unsigned threads = 1;
  double cgal = 1;     ///< seconds per point of CGAL's triangulation
  double delaunay = 1; ///< of our own stage of that name
  double rest = 1;     ///< of the whole without that stage
  /// The rest's growth without that of the triangulation, which every method has.
  [[nodiscard]] double rest_to_cgal() const { return rest / cgal; }
};
std::vector<Growth> growth_of(const std::vector<SpeedOutcome>& outcomes);

} // namespace eigencrust::bench
