// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The fitted surface beside screened Poisson's, noise by noise.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fit_scenes.h"
#include "surface_error.h"

namespace eigencrust::bench {

struct FitBenchOptions {
  std::filesystem::path data, work; ///< folder of the meshes; folder for clouds and meshes, kept
  std::string python;               ///< that knows Open3D
  std::size_t samples = 60'000;
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

/// Of one surface; lengths in spacings.
struct FitFigures {
  SurfaceError error;
  double edges = -1; ///< mean distance of points on the true sharp edges; negative: there are none
};
struct FitOutcome {
  std::string shape;
  double sigma = 0;
  FitFigures samples, fitted;
  std::optional<FitFigures> poisson; ///< best depth by the mean distance; none: there is no Open3D
  int depth = 0;
  std::int64_t crossings = 0, genus = 0, true_genus = 0;
  std::uint64_t components = 0;
};

FitOutcome run_fit_case(const FitShape& shape, double sigma, const FitBenchOptions& options);

/// A table in Markdown.
std::string to_markdown(const std::vector<FitOutcome>& outcomes);

} // namespace eigencrust::bench
