// SPDX-License-Identifier: GPL-3.0-or-later
#include "points.h"

#include <algorithm>
#include <cctype>
#include <ostream>

#include "selection.h"

namespace eigencrust::cli {
namespace {

bool same_name(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  });
}

} // namespace

void set_attribute(PointCloud& cloud, Attribute attribute) {
  auto& all = cloud.attributes;
  const auto has_name = [&](const Attribute& other) { return same_name(other.name, attribute.name); };
  const auto found = std::find_if(all.begin(), all.end(), has_name);
  if (found == all.end()) {
    all.push_back(std::move(attribute));
    return;
  }
  all.erase(std::remove_if(found + 1, all.end(), has_name), all.end());
  *found = std::move(attribute);
}

void add_keep_option(OptionTable& app, std::string& keep) {
  app.add_option("--keep", keep, "Write these rows only: inliers or outliers")->one_of({"inliers", "outliers"});
}

Options options_for_points(const Request& request) {
  Options options = effective_options(request);
  options.point_results = true;
  options.surface = SurfaceKind::automatic; // noisy samples may be eased: no vertex has to be a row
  return options;
}

int write_points(MethodRun& run, const Request& request, const std::string& keep) {
  const Report& report = run.result.report;
  std::vector<std::uint32_t> inliers, others;
  for (std::uint32_t row = 0; row < run.result.inlier.size(); ++row)
    if (run.result.inlier[row])
      inliers.push_back(row);
    else if (is_finite(run.cloud.points[row]))
      others.push_back(row);
  if (!keep.empty()) keep_rows(run.cloud, keep == "inliers" ? inliers : others);
  if (!run.cloud.scan_index.empty()) { // as reconstruct writes it with the vertices
    run.cloud.attributes.push_back(make_attribute("scan_index", run.cloud.scan_index));
    run.cloud.scan_index.clear();
  }
  run.finish([&](OutputFiles& files, const std::string& path, const WriteOptions& how) {
    return files.add_point_cloud(path, run.cloud, how);
  });
  std::ostream& out = run.summary();
  out << printable(request.output) << ": " << grouped(run.cloud.points.size()) << " points in " << run.cost() << "\n"
      << run.selection() << "  " << grouped(inliers.size()) << " inliers, "
      << grouped(report.points - report.nonfinite - inliers.size()) << " outliers";
  if (report.nonfinite > 0) out << ", " << grouped(report.nonfinite) << " not finite";
  out << (keep.empty() ? "\n" : "; only the " + keep + " are written\n");
  return run.status();
}

} // namespace eigencrust::cli
