// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/page.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include <eigencrust/error.h>

#include "clouds.h"
#include "page/base64.h"
#include "page/view_mesh.h"
#include "shapes.h"

namespace eigencrust {
namespace {

using nlohmann::json;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string base64_of(std::string_view text) { return base64(std::as_bytes(std::span(text))); }

/// Sound input only.
std::string from_base64(std::string_view text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

/// What the script element with this id holds.
std::string data_of(const std::string& page, const std::string& id) {
  const std::size_t element = page.find("<script id=\"" + id + "\"");
  if (element == std::string::npos) throw std::runtime_error("no element " + id);
  const std::size_t begin = page.find('>', element) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

constexpr const char* viewer = "before<!--eigencrust:data-->after";

std::string page_of(const Result& result, const PageProducts& products) {
  std::ostringstream out;
  write_page(out, viewer, result, products);
  return out.str();
}

/// A run that is watched.
struct Watched {
  PageObserver observer{*default_observer()};
  Result result;

  explicit Watched(const std::vector<Vec3>& points, Options options = {}) {
    PointCloud cloud;
    cloud.points = points;
    options.point_results = true;
    result = reconstruct(cloud, options, observer);
    observer.finished(cloud, result);
  }
  [[nodiscard]] const PageProducts& products() const { return observer.products(); }
};

double marked_share(const TriangleMesh& mesh, const std::vector<std::uint8_t>& marked) {
  double part = 0, whole = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const double area = norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
    whole += area;
    if (marked[i]) part += area;
  }
  return part / whole;
}

TEST(Base64, IsThatOfTheStandard) { // RFC 4648, section 10
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xff\xfe\xfd"), "//79");
}

TEST(ViewMesh, SmallOnesStay) {
  const TriangleMesh mesh = shapes::torus(1, 0.4, 30, 20);
  const ViewMesh view = view_mesh(mesh, mesh.triangles.size());
  EXPECT_EQ(view.mesh.vertices, mesh.vertices);
  EXPECT_EQ(view.mesh.triangles, mesh.triangles);
  EXPECT_EQ(view.triangle.back() + 1, mesh.triangles.size());
}

TEST(ViewMesh, LargeOnesBecomeSmallAndStayWhereTheyAre) {
  const TriangleMesh mesh = shapes::torus(1, 0.4, 300, 200);
  const std::size_t most = mesh.triangles.size() / 10;
  const ViewMesh view = view_mesh(mesh, most);
  EXPECT_LE(view.mesh.triangles.size(), most);
  EXPECT_GT(view.mesh.triangles.size(), most / 2) << "more was taken away than had to be";
  ASSERT_EQ(view.triangle.size(), view.mesh.triangles.size());
  for (std::size_t i = 0; i < view.triangle.size(); ++i) {
    ASSERT_LT(view.triangle[i], mesh.triangles.size());
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT(
          distance(view.mesh.vertices[view.mesh.triangles[i][k]], mesh.vertices[mesh.triangles[view.triangle[i]][k]]),
          0.12);
  }
}

TEST(Evenly, TakesFirstAndLastAndNoMore) {
  std::vector<int> all(1001);
  for (int i = 0; i < 1001; ++i) all[static_cast<std::size_t>(i)] = i;
  EXPECT_EQ(evenly(std::span<const int>(all), 5), (std::vector{0, 250, 500, 750, 1000}));
  EXPECT_EQ(evenly(std::span<const int>(all), 1001), all);
}

TEST(PageObserver, SeesWhatTheResultDoesNotKeep) {
  std::vector<Vec3> points = clouds::sphere(2000);
  points.push_back({4, 4, 4});
  const Watched run(points);
  const PageProducts& p = run.products();
  EXPECT_EQ(p.outliers, (std::vector<Vec3>{{4, 4, 4}}));
  EXPECT_EQ(p.point_count, 2000u);
  EXPECT_GT(p.poles.count, 1000u);
  EXPECT_TRUE(std::is_sorted(p.poles.values.begin(), p.poles.values.end()));
  EXPECT_GT(p.poles.inside, 0u);
  EXPECT_LT(p.poles.inside, p.poles.count);
  EXPECT_THAT(p.tetrahedra.values, SizeIs(2000));
  for (const Vec3& pole : p.inside_poles) EXPECT_LT(norm(pole), 0.5);
  double samples = 0;
  for (const double n : p.noise.counts) samples += n;
  EXPECT_EQ(samples, 2001);
  ASSERT_EQ(p.unsupported.size(), run.result.mesh.triangles.size());
  EXPECT_NEAR(marked_share(run.result.mesh, p.unsupported), run.result.report.unsupported_area, 1e-9);
}

TEST(PageObserver, WhatWasLeftOutIsKept) {
  std::vector<Vec3> points = clouds::sphere(2000);
  for (const Vec3& p : clouds::sphere(300)) points.push_back(0.2 * p + Vec3{5, 0, 0});
  Options options;
  options.components.kind = KeepComponents::Kind::largest;
  const Watched run(points, options);
  ASSERT_EQ(run.result.report.dropped_components.size(), 1u);
  const TriangleMesh& left_out = run.products().left_out;
  EXPECT_EQ(left_out.triangles.size(), run.result.report.dropped_components[0].triangles);
  EXPECT_EQ(left_out.vertices.size(), run.result.report.dropped_components[0].vertices);
  for (const Vec3& v : left_out.vertices) EXPECT_NEAR(distance(v, {5, 0, 0}), 0.2, 1e-6);
}

TEST(PageObserver, WhatWasTrimmedIsLeftOut) {
  std::vector<Vec3> bowl;
  for (const Vec3& p : clouds::sphere(3000))
    if (p.z < 0.3) bowl.push_back(p);
  Options options;
  options.trim = true;
  const Watched run(bowl, options);
  EXPECT_THAT(run.products().unsupported, Each(0));
  EXPECT_EQ(run.products().unsupported.size(), run.result.mesh.triangles.size());
  double unsupported = 0;
  for (const StageReport& stage : run.result.report.stages)
    for (const auto& [name, count] : stage.counts)
      if (name == "unsupported") unsupported = count;
  EXPECT_GT(unsupported, 0);
  EXPECT_GE(static_cast<double>(run.products().left_out.triangles.size()), unsupported);
}

TEST(Page, HoldsReportAndPlaces) {
  Watched run(clouds::sphere(800));
  run.result.report.files = {{"</script><b>.ply", "abc", 800, {}, 0}};
  const std::string page = page_of(run.result, run.products());
  EXPECT_TRUE(page.starts_with("before<script"));
  EXPECT_TRUE(page.ends_with("after"));
  const json report = json::parse(data_of(page, "report"));
  EXPECT_EQ(report, json::parse(to_json(run.result.report)));
  const json scene = json::parse(data_of(page, "scene"));
  const TriangleMesh& mesh = run.result.mesh;
  EXPECT_EQ(scene["mesh"]["shown"], mesh.triangles.size());
  EXPECT_EQ(scene["buffers"]["mesh.places"]["count"], mesh.vertices.size());
  const std::string bytes = from_base64(data_of(page, "mesh.places"));
  ASSERT_EQ(bytes.size(), 6 * mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    std::array<std::uint16_t, 3> n{};
    std::memcpy(n.data(), bytes.data() + 6 * v, 6);
    const json& said = scene["buffers"]["mesh.places"];
    const auto at = [&](std::size_t k) { return said["low"][k].get<double>() + n[k] * said["step"][k].get<double>(); };
    EXPECT_LT(distance({at(0), at(1), at(2)}, mesh.vertices[v]), 5e-5);
  }
  const std::string triangles = from_base64(data_of(page, "mesh.triangles"));
  ASSERT_EQ(triangles.size(), 12 * mesh.triangles.size());
  EXPECT_EQ(std::memcmp(triangles.data(), mesh.triangles.data(), triangles.size()), 0);
  EXPECT_THAT(from_base64(data_of(page, "picture.front")), HasSubstr("PNG"));
}

TEST(Page, OfAResultWithoutProducts) {
  const Watched run(clouds::sphere(300));
  const std::string page = page_of(run.result, {});
  const json scene = json::parse(data_of(page, "scene"));
  EXPECT_TRUE(scene["values"]["poles"].is_null());
  EXPECT_FALSE(scene["buffers"].contains("mesh.invented"));
  EXPECT_EQ(scene["outliers"]["all"], 0);
}

TEST(Page, NeedsAPlaceInTheViewer) {
  std::ostringstream out;
  EXPECT_THROW(write_page(out, "<html></html>", Result(), {}), Error);
  EXPECT_EQ(out.str(), "");
}

} // namespace
} // namespace eigencrust
