// SPDX-License-Identifier: GPL-3.0-or-later
#include "points.h"

#include <algorithm>
#include <cctype>
#include <iostream>

namespace eigencrust::cli {
namespace {

bool same_name(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  });
}

void keep_rows(PointCloud& cloud, const std::vector<std::uint32_t>& rows) {
  for (Attribute& attribute : cloud.attributes) attribute = gather(attribute, rows);
  for (auto* index : {&cloud.scan_index, &cloud.sensor_of}) {
    if (index->empty()) continue;
    for (std::size_t i = 0; i < rows.size(); ++i) (*index)[i] = (*index)[rows[i]]; // rows increase
    index->resize(rows.size());
  }
  for (std::size_t i = 0; i < rows.size(); ++i) cloud.points[i] = cloud.points[rows[i]];
  cloud.points.resize(rows.size());
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

int write_points(MethodRun& run, const Request& request, bool drop_outliers) {
  const Report& report = run.result.report;
  std::vector<std::uint32_t> inliers;
  for (std::uint32_t row = 0; row < run.result.inlier.size(); ++row)
    if (run.result.inlier[row]) inliers.push_back(row);
  if (drop_outliers) keep_rows(run.cloud, inliers);
  if (!run.cloud.scan_index.empty()) { // as reconstruct writes it with the vertices
    run.cloud.attributes.push_back(make_attribute("scan_index", run.cloud.scan_index));
    run.cloud.scan_index.clear();
  }
  run.finish([&](OutputFiles& files) { return files.add_point_cloud(request.output, run.cloud, run.write_options()); });
  if (!request.quiet) {
    std::cout << printable(request.output) << ": " << grouped(run.cloud.points.size()) << " points in " << run.cost()
              << "\n  " << grouped(inliers.size()) << " inliers, "
              << grouped(report.points - report.nonfinite - inliers.size()) << " outliers";
    if (report.nonfinite > 0) std::cout << ", " << grouped(report.nonfinite) << " not finite";
    std::cout << (drop_outliers ? "; only the inliers are written\n" : "\n");
  }
  return run.status();
}

} // namespace eigencrust::cli
