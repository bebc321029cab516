// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A run as one HTML page that people can look at: the report, the mesh and the cloud to turn, and what became of both.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <eigencrust/eigencrust.h>
#include <eigencrust/observer.h>
#include <eigencrust/types.h>

namespace eigencrust {

/// Values in increasing order, evenly picked by rank where they are many. NaN is left out.
struct SortedValues {
  std::vector<float> values;           ///< in increasing order
  std::uint64_t count = 0, inside = 0; ///< of all of them; inside are those below 0
};

/// How many values lie in each of the equal parts of [low, high]; the last part has those beyond it, too.
struct Histogram {
  double low = 0, high = 0;   ///< of the first and of the last bar
  std::vector<double> counts; ///< empty: there is nothing to count
};

/// What a run makes on its way and its result does not keep, as far as a page shows it. All empty with methods that do
/// not make it.
struct PageProducts {
  SortedValues poles, tetrahedra;                ///< their values in the first vector, and in the second stage
  std::vector<Vec3> inside_poles, outside_poles; ///< circumcentres, evenly picked where they are many
  Histogram noise;                               ///< of the samples: standard deviation by their own spacing
  TriangleMesh left_out;                         ///< the triangles of pieces that were dropped and of what was trimmed
  std::vector<std::uint8_t> unsupported; ///< of each triangle of the mesh: 1 where the samples do not bear it out
  std::vector<Vec3> points, outliers;    ///< of the cloud, evenly picked where they are many
  std::uint64_t point_count = 0, outlier_count = 0; ///< of all of them
  Histogram confidence;                             ///< of the points
};

/// Gathers what a page shows from the stages' products; passes everything on to another observer.
class PageObserver : public Observer {
 public:
  /// \param next what it passes on what it is told
  explicit PageObserver(Observer& next) : next_(next) {}
  void stage_begins(std::string_view stage) override { next_.stage_begins(stage); }
  void progress(double fraction) override { next_.progress(fraction); }
  void stage_ends(std::string_view stage, double seconds) override { next_.stage_ends(stage, seconds); }
  bool cancelled() override { return next_.cancelled(); }
  bool wants_products() override { return true; }
  void product(std::string_view stage, const TriangleMesh& snapshot) override;
  /// To be called when the result is there: what became of the points. Outliers are told from others where
  /// options.point_results is set.
  void finished(const PointCloud& cloud, const Result& result);

  /// What was collected.
  [[nodiscard]] const PageProducts& products() const { return products_; }

 private:
  Observer& next_;
  PageProducts products_;
};

/// Writes the page: the viewer (scripts/viewer.sh makes it) with the report and what it shows put in where it says so.
/// Meshes and clouds of more than 250,000 triangles or points are made smaller for the view alone, and the page says
/// so. \param viewer the text of viewer.html \throws Error{input} for a viewer without a place for the data
void write_page(std::ostream& out, std::string_view viewer, const Result& result, const PageProducts& products);

} // namespace eigencrust
