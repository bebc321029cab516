// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <eigencrust/io.h>

#include "samples/check_cloud.h"
#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

std::vector<double> values(const Attribute& attribute) {
  std::vector<double> result;
  for (std::size_t i = 0; i < attribute.values.size() / size_of(attribute.type); ++i)
    result.push_back(attribute_value(attribute, i));
  return result;
}

Attribute list_of_int16(std::string name, const std::vector<std::vector<double>>& rows) {
  std::vector<double> all;
  std::vector<std::uint64_t> offsets{0};
  for (const auto& row : rows) {
    all.insert(all.end(), row.begin(), row.end());
    offsets.push_back(all.size());
  }
  Attribute list = make_attribute(std::move(name), ScalarType::int16, all);
  list.is_list = true;
  list.offsets = offsets;
  return list;
}

PointCloud cloud_of(std::size_t points, std::vector<Attribute> attributes = {}) {
  return {std::vector<Vec3>(points), std::move(attributes), {}};
}

TEST(IoAttributes, EveryTypeHoldsItsValues) {
  const std::vector<double> extremes = {-1e10, -1.5, 0.4, 2.6, 1e10, nan_value};
  const auto stored = [&](ScalarType type) { return values(make_attribute("a", type, extremes)); };
  // Integers are rounded and clamped: a conversion out of range would be undefined.
  EXPECT_THAT(stored(ScalarType::int8), ElementsAre(-128, -2, 0, 3, 127, 0));
  EXPECT_THAT(stored(ScalarType::uint8), ElementsAre(0, 0, 0, 3, 255, 0));
  EXPECT_THAT(stored(ScalarType::int16), ElementsAre(-32768, -2, 0, 3, 32767, 0));
  EXPECT_THAT(stored(ScalarType::uint16), ElementsAre(0, 0, 0, 3, 65535, 0));
  EXPECT_THAT(stored(ScalarType::int32), ElementsAre(-2147483648.0, -2, 0, 3, 2147483647.0, 0));
  EXPECT_THAT(stored(ScalarType::uint32), ElementsAre(0, 0, 0, 3, 4294967295.0, 0));
  EXPECT_EQ(stored(ScalarType::float32)[2], double{0.4f});
  EXPECT_TRUE(std::isnan(stored(ScalarType::float32)[5]));
  EXPECT_EQ(stored(ScalarType::float64)[2], 0.4);

  const std::vector<std::uint32_t> numbers = {4294967295u, 1};
  EXPECT_THAT(values(make_attribute("n", numbers)), ElementsAre(4294967295.0, 1));
  const std::vector<float> reals = {0.1f};
  EXPECT_EQ(make_attribute("f", reals).type, ScalarType::float32);
  EXPECT_EQ(make_attribute("f", reals).rows(), 1u);
}

TEST(IoAttributes, GatherTakesRowsInTheOrderAskedFor) {
  const std::vector<std::uint32_t> rows = {2, 0, 2};
  const Attribute scalar = make_attribute("a", ScalarType::uint16, std::vector<double>{7, 8, 9});
  EXPECT_THAT(values(gather(scalar, rows)), ElementsAre(9, 7, 9));
  const Attribute list = gather(list_of_int16("l", {{1, 2}, {}, {3}}), rows);
  EXPECT_THAT(values(list), ElementsAre(3, 1, 2, 3));
  EXPECT_THAT(list.offsets, ElementsAre(0u, 1u, 3u, 4u));
  EXPECT_TRUE(list.is_list);
  EXPECT_EQ(gather(scalar, {}).rows(), 0u);
}

TEST(IoAttributes, FindByName) {
  const std::vector<Attribute> attributes = {make_attribute("a", ScalarType::int8, std::vector<double>{1}),
                                             make_attribute("b", ScalarType::int8, std::vector<double>{2})};
  EXPECT_EQ(find_attribute(attributes, "b"), &attributes[1]);
  EXPECT_EQ(find_attribute(attributes, "c"), nullptr);
}

TEST(IoAppendScan, ScansStayApart) {
  PointCloud cloud;
  append_scan(cloud, cloud_of(2)); // nothing to keep apart yet
  EXPECT_THAT(cloud.scan_index, IsEmpty());
  append_scan(cloud, cloud_of(1));
  EXPECT_THAT(cloud.scan_index, ElementsAre(0, 0, 1));
  PointCloud several = cloud_of(2);
  several.scan_index = {5, 0};
  append_scan(cloud, several);
  EXPECT_THAT(cloud.scan_index, ElementsAre(0, 0, 1, 7, 2));
  append_scan(cloud, PointCloud{});
  EXPECT_EQ(cloud.points.size(), 5u);
  several.scan_index = {4294967295u, 0};
  EXPECT_THROW(append_scan(cloud, several), Error);
}

TEST(IoAppendScan, SensorsArePutBehindOneAnother) {
  const auto seen_by = [](std::size_t points, std::vector<Sensor> sensors, std::vector<std::uint32_t> of) {
    PointCloud cloud;
    cloud.points.resize(points);
    cloud.sensors = std::move(sensors);
    cloud.sensor_of = std::move(of);
    return cloud;
  };
  constexpr std::uint32_t none = PointCloud::no_sensor;
  const Sensor a{{1, 2, 3}, false}, b{{0, 0, 1}, true};
  PointCloud cloud = seen_by(2, {}, {});
  append_scan(cloud, seen_by(2, {a, b}, {1, none}));
  append_scan(cloud, seen_by(1, {}, {}));
  append_scan(cloud, seen_by(1, {a}, {0}));
  EXPECT_EQ(cloud.sensors, (std::vector<Sensor>{a, b, a}));
  EXPECT_EQ(cloud.sensor_of, (std::vector<std::uint32_t>{none, none, 1, none, none, 2}));
  PointCloud unknown = seen_by(1, {}, {});
  append_scan(unknown, seen_by(1, {}, {}));
  EXPECT_TRUE(unknown.sensor_of.empty());
}

TEST(IoAppendScan, GridsStayWithTheirScans) {
  const auto frame = [](ScanGrid grid, std::vector<std::uint32_t> cell) {
    PointCloud cloud;
    cloud.points.resize(cell.size());
    cloud.grids = {grid};
    cloud.cell = std::move(cell);
    return cloud;
  };
  PointCloud plain;
  plain.points.resize(1);
  PointCloud cloud = plain;
  append_scan(cloud, frame({3, 2}, {5, no_index}));
  append_scan(cloud, plain);
  append_scan(cloud, frame({2, 2}, {3}));
  EXPECT_EQ(cloud.grids, (std::vector<ScanGrid>{{}, {3, 2}, {}, {2, 2}}));
  EXPECT_THAT(cloud.cell, ElementsAre(no_index, 5u, no_index, no_index, 3u));
  EXPECT_NO_THROW(check_cloud(cloud));
  PointCloud many = plain; // of so many scans none is counted
  many.scan_index = {4000000000u};
  append_scan(many, frame({3, 2}, {5, 4}));
  EXPECT_TRUE(many.grids.empty());
  EXPECT_TRUE(many.cell.empty());
}

TEST(IoAppendScan, MissingAttributesAreNaNOrZero) {
  const auto one = [](const char* name, ScalarType type) { return make_attribute(name, type, std::vector<double>{7}); };
  PointCloud cloud = cloud_of(1, {one("real", ScalarType::float32), list_of_int16("list", {{1, 2}})});
  append_scan(cloud, cloud_of(1, {one("whole", ScalarType::uint8), one("double", ScalarType::float64)}));
  ASSERT_EQ(cloud.attributes.size(), 4u);
  for (const Attribute& attribute : cloud.attributes) EXPECT_EQ(attribute.rows(), 2u) << attribute.name;
  EXPECT_TRUE(std::isnan(attribute_value(cloud.attributes[0], 1)));
  EXPECT_THAT(cloud.attributes[1].offsets, ElementsAre(0u, 2u, 2u));
  EXPECT_THAT(values(cloud.attributes[2]), ElementsAre(0, 7));
  EXPECT_TRUE(std::isnan(attribute_value(cloud.attributes[3], 0)));
  EXPECT_EQ(attribute_value(cloud.attributes[3], 1), 7);
}

// For each pair of types the result must hold the extremes of both, exactly.
TEST(IoAppendScan, TypesAreWidenedWithoutLoss) {
  const std::vector<ScalarType> types = {ScalarType::int8,    ScalarType::uint8,  ScalarType::int16,
                                         ScalarType::uint16,  ScalarType::int32,  ScalarType::uint32,
                                         ScalarType::float32, ScalarType::float64};
  for (const ScalarType a : types)
    for (const ScalarType b : types) {
      const std::vector<double> extremes = {-1e10, 1e10, 0.1};
      PointCloud cloud = cloud_of(3, {make_attribute("v", a, extremes)});
      const PointCloud next = cloud_of(3, {make_attribute("v", b, extremes)});
      std::vector<double> expected = values(cloud.attributes[0]);
      for (const double v : values(next.attributes[0])) expected.push_back(v);
      append_scan(cloud, next);
      ASSERT_EQ(cloud.attributes.size(), 1u);
      EXPECT_EQ(values(cloud.attributes[0]), expected) << int(a) << " " << int(b);
      if (a == b) {
        EXPECT_EQ(cloud.attributes[0].type, a);
      }
    }
  PointCloud bytes = cloud_of(1, {make_attribute("v", ScalarType::uint8, std::vector<double>{255})});
  append_scan(bytes, cloud_of(1, {make_attribute("v", ScalarType::int8, std::vector<double>{-1})}));
  EXPECT_EQ(bytes.attributes[0].type, ScalarType::int16); // no wider than needed
}

TEST(IoAppendScan, AScalarJoinsAListAsAListOfOne) {
  PointCloud cloud = cloud_of(2, {make_attribute("v", ScalarType::uint16, std::vector<double>{8, 9})});
  append_scan(cloud, cloud_of(2, {list_of_int16("v", {{}, {-1, -2}})}));
  const Attribute& list = cloud.attributes[0];
  EXPECT_TRUE(list.is_list);
  EXPECT_EQ(list.type, ScalarType::int32);
  EXPECT_THAT(list.offsets, ElementsAre(0u, 1u, 2u, 2u, 4u));
  EXPECT_THAT(values(list), ElementsAre(8, 9, -1, -2));
}

} // namespace
} // namespace eigencrust
