// SPDX-License-Identifier: GPL-3.0-or-later
// What must not matter: order of rows, threads, position, unit, orientation; and what must be kept.
#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <gmock/gmock.h>

#include <cstring>
#include <limits>
#include <map>

#include "clouds.h"

namespace eigencrust {
namespace {

using clouds::Points;

Result reconstructed(const Points& points, unsigned threads = 0, Preset preset = Preset::robust) {
  Options options = Options::of(preset);
  options.threads = threads;
  return reconstruct(clouds::cloud_of(points), options);
}

/// A noisy sphere with outliers: every stage has something to decide.
Points noisy_cloud() {
  return clouds::joined(clouds::jittered(clouds::sphere(3000), 0.02, 1), clouds::random_box(60, 2, 2));
}

template <class Rows>
std::string bytes_of(const Rows& rows) {
  if (rows.empty()) return {};
  return {reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(rows[0])};
}

TEST(Invariance, AnyNumberOfThreadsGivesTheSameBytes) {
  for (const Preset preset : {Preset::robust, Preset::paper}) {
    const Result one = reconstructed(noisy_cloud(), 1, preset);
    for (const unsigned threads : {2u, 3u}) {
      const Result other = reconstructed(noisy_cloud(), threads, preset);
      EXPECT_EQ(bytes_of(other.mesh.vertices), bytes_of(one.mesh.vertices));
      EXPECT_EQ(bytes_of(other.mesh.triangles), bytes_of(one.mesh.triangles));
      EXPECT_EQ(other.labels.raw(), one.labels.raw());
      EXPECT_EQ(other.report.partitions.front().eigenvalue, one.report.partitions.front().eigenvalue);
      EXPECT_EQ(other.report.partitions.back().residual, one.report.partitions.back().residual);
    }
  }
}

TEST(Invariance, OrderOfTheRowsDoesNotMatter) {
  for (const Points& points : {noisy_cloud(), clouds::cube_surface(9)}) {
    const Result reference = reconstructed(points);
    for (const std::uint64_t seed : {1u, 2u}) {
      const Result other = reconstructed(clouds::shuffled(points, seed));
      // Not only the same set: vertices and triangles come in the same order too.
      EXPECT_EQ(other.mesh.vertices, reference.mesh.vertices);
      EXPECT_EQ(other.mesh.triangles, reference.mesh.triangles);
      EXPECT_EQ(clouds::triangle_set(other.mesh), clouds::triangle_set(reference.mesh));
    }
  }
}

TEST(Invariance, PowersOfTwoAndExactShiftsGiveTheSameTriangles) {
  // Rounded to multiples of 2^-20, so that a shift by 2^20 and a scale by 2^k lose no bit.
  Points points = noisy_cloud();
  for (Vec3& p : points)
    p = {std::round(p.x * 0x1p20) * 0x1p-20, std::round(p.y * 0x1p20) * 0x1p-20, std::round(p.z * 0x1p20) * 0x1p-20};
  const Result reference = reconstructed(points);
  for (const double factor : {0x1p-20, 0x1p10}) {
    const Result other = reconstructed(clouds::moved(points, {}, factor));
    EXPECT_EQ(other.mesh.triangles, reference.mesh.triangles) << factor;
  }
  const Result far = reconstructed(clouds::moved(points, {0x1p20, -0x1p20, 0x1p19}));
  EXPECT_EQ(far.mesh.triangles, reference.mesh.triangles);
}

TEST(Invariance, RotationScaleAndShiftKeepTopologyAndVolume) {
  const Points torus = clouds::jittered(clouds::torus(1, 0.4, 90, 40), 0.003, 3);
  const MeshSummary reference = reconstructed(torus).report.mesh;
  EXPECT_EQ(reference.genus, 1);
  const double c = std::cos(0.7), s = std::sin(0.7);
  Points turned;
  for (const Vec3& p : torus) {
    const Vec3 q{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    turned.push_back(7.3 * Vec3{q.x, c * q.y - s * q.z, s * q.y + c * q.z} + Vec3{12, -4, 5});
  }
  const MeshSummary m = reconstructed(turned).report.mesh;
  EXPECT_EQ(m.components, reference.components);
  EXPECT_EQ(m.genus, reference.genus);
  EXPECT_NEAR(m.volume / std::pow(7.3, 3) / reference.volume, 1, 1e-3);
  EXPECT_NEAR(m.area / std::pow(7.3, 2) / reference.area, 1, 1e-3);
}

TEST(Invariance, AMillionUnitsAwayWithASpacingOfAThousandth) {
  // As in a national grid: coordinates 1e6, spacing 1e-3.
  const Points points = clouds::moved(clouds::jittered(clouds::sphere(2500), 0.01, 4), {1e6, 2e6, 1e6}, 0.0145);
  const Result result = reconstructed(points);
  EXPECT_LT(result.report.spacing, 1.2e-3);
  EXPECT_EQ(result.report.mesh.genus, 0);
  EXPECT_EQ(result.report.mesh.components, 1u);
  EXPECT_THAT(result.report.broken_guarantees, testing::IsEmpty());
  EXPECT_NEAR(result.report.mesh.volume / (4 * std::numbers::pi / 3 * std::pow(0.0145, 3)), 1, 0.03);
}

TEST(Invariance, VerticesAreRowsOfTheInputBitForBit) {
  const Points points = clouds::moved(noisy_cloud(), {1e3 / 3, -1e3 / 7, 0.1});
  Options options;
  options.surface = SurfaceKind::samples;
  const Result result = reconstruct(clouds::cloud_of(points), options);
  const Attribute* source = find_attribute(result.mesh.vertex_attributes, "source_index");
  ASSERT_NE(source, nullptr);
  ASSERT_EQ(source->rows(), result.mesh.vertices.size());
  for (std::size_t v = 0; v < result.mesh.vertices.size(); ++v) {
    std::uint32_t row = 0;
    std::memcpy(&row, source->values.data() + v * sizeof row, sizeof row);
    ASSERT_LT(row, points.size());
    EXPECT_EQ(std::memcmp(&result.mesh.vertices[v], &points[row], sizeof(Vec3)), 0);
  }
}

TEST(Invariance, DuplicatesAndRowsThatAreNotFiniteChangeNothing) {
  const Points clean = noisy_cloud();
  Points dirty = clean;
  for (std::size_t i = 0; i < 200; ++i) dirty.push_back(clean[11 * i]);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  dirty.insert(dirty.begin() + 100, {nan, 0, 0});
  dirty.insert(dirty.begin() + 200, {0, std::numeric_limits<double>::infinity(), 0});
  const Result a = reconstructed(clean), b = reconstructed(dirty);
  EXPECT_EQ(b.mesh.vertices, a.mesh.vertices);
  EXPECT_EQ(b.mesh.triangles, a.mesh.triangles);
  EXPECT_EQ(b.report.duplicates, 200u);
  EXPECT_EQ(b.report.nonfinite, 2u);
  EXPECT_EQ(b.report.points, clean.size() + 202);
}

TEST(Invariance, AttributesFollowTheirPoints) {
  PointCloud cloud = clouds::cloud_of(noisy_cloud());
  const std::size_t n = cloud.points.size();
  std::vector<double> doubles(n), bytes(n);
  for (std::size_t i = 0; i < n; ++i) {
    doubles[i] = 0.1 * static_cast<double>(i);
    bytes[i] = static_cast<double>(i % 251);
  }
  cloud.attributes = {make_attribute("time", ScalarType::float64, doubles),
                      make_attribute("red", ScalarType::uint8, bytes)};
  Attribute list;
  list.name = "echoes";
  list.type = ScalarType::uint16;
  list.is_list = true;
  list.offsets = {0};
  for (std::size_t i = 0; i < n; ++i) { // row i: i mod 3 entries of value i
    for (std::size_t k = 0; k < i % 3; ++k) {
      const auto value = static_cast<std::uint16_t>(i);
      const auto* raw = reinterpret_cast<const std::byte*>(&value);
      list.values.insert(list.values.end(), raw, raw + sizeof value);
    }
    list.offsets.push_back(list.offsets.back() + i % 3);
  }
  cloud.attributes.push_back(list);
  const Result result = reconstruct(cloud);
  const auto& attributes = result.mesh.vertex_attributes;
  const Attribute *source = find_attribute(attributes, "source_index"), *time = find_attribute(attributes, "time"),
                  *red = find_attribute(attributes, "red"), *echoes = find_attribute(attributes, "echoes");
  ASSERT_TRUE(source && time && red && echoes);
  EXPECT_EQ(time->type, ScalarType::float64);
  EXPECT_EQ(red->type, ScalarType::uint8);
  ASSERT_EQ(echoes->offsets.size(), result.mesh.vertices.size() + 1);
  for (std::size_t v = 0; v < result.mesh.vertices.size(); ++v) {
    std::uint32_t row = 0;
    std::memcpy(&row, source->values.data() + 4 * v, 4);
    double value = 0;
    std::memcpy(&value, time->values.data() + 8 * v, 8);
    EXPECT_EQ(value, doubles[row]);
    EXPECT_EQ(std::to_integer<int>(red->values[v]), static_cast<int>(bytes[row]));
    ASSERT_EQ(echoes->offsets[v + 1] - echoes->offsets[v], row % 3);
    if (row % 3 == 0) continue;
    std::uint16_t echo = 0;
    std::memcpy(&echo, echoes->values.data() + 2 * echoes->offsets[v], 2);
    EXPECT_EQ(echo, static_cast<std::uint16_t>(row));
  }
}

TEST(Invariance, OneRunTwiceIsTheSame) {
  const Result a = reconstructed(noisy_cloud()), b = reconstructed(noisy_cloud());
  EXPECT_EQ(bytes_of(a.mesh.vertices), bytes_of(b.mesh.vertices));
  EXPECT_EQ(bytes_of(a.mesh.triangles), bytes_of(b.mesh.triangles));
}

} // namespace
} // namespace eigencrust
