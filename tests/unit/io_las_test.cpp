// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <eigencrust/io.h>

#include "las_bytes.h"
#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// x y z = 2 -4 6, that is 101 198 303 with scale 0.5 and offsets 100 200 300; intensity 40000.
std::string head() { return raw_bytes<std::int32_t>({2, -4, 6}) + raw_bytes<std::uint16_t>({40000}); }

/// Formats 0 to 5: return 2 of 5, direction 1, edge 0; class 17, key point; angle -90, user 7, source 500.
std::string old_point(std::uint8_t flags = 17 | 1 << 6) {
  return head() + raw_bytes<std::uint8_t>({2 | 5 << 3 | 1 << 6, flags}) + raw_bytes<std::int8_t>({-90}) + "\7" +
         raw_bytes<std::uint16_t>({500});
}
/// Formats 6 to 10: return 9 of 15; overlap, channel 2, edge 1; class 200, user 7, angle -30000, source 500.
std::string new_point(std::uint8_t flags = 1 << 3 | 2 << 4 | 1 << 7) {
  return head() + raw_bytes<std::uint8_t>({9 | 15 << 4, flags, 200, 7}) + raw_bytes<std::int16_t>({-30000}) +
         raw_bytes<std::uint16_t>({500}) + raw_bytes<double>({12.5});
}
const std::string gps_time = raw_bytes<double>({12.5});
const std::string colour = raw_bytes<std::uint16_t>({1, 2, 65535});
const std::string wave = std::string(29, 'w');

class IoLas : public ::testing::Test {
 protected:
  PointCloud read(const std::string& bytes) {
    notes_ = {};
    write_bytes(folder_ / "a.las", bytes);
    return read_point_cloud(folder_ / "a.las", {}, &notes_);
  }
  std::string error(const std::string& bytes) {
    return error_of([&] { read(bytes); });
  }
  static double value(const PointCloud& cloud, const char* name, std::size_t row = 0) {
    const Attribute* attribute = find_attribute(cloud.attributes, name);
    if (attribute == nullptr) throw std::runtime_error(std::string("no attribute ") + name);
    return attribute_value(*attribute, row);
  }

  TempDir folder_;
  ReadNotes notes_;
};

// Each format with its sizes by the specification; two equal points, so that rows do not slip.
TEST_F(IoLas, AllPointFormats) {
  const std::vector<std::string> points = {old_point(),
                                           old_point() + gps_time,
                                           old_point() + colour,
                                           old_point() + gps_time + colour,
                                           old_point() + gps_time + wave,
                                           old_point() + gps_time + colour + wave,
                                           new_point(),
                                           new_point() + colour,
                                           new_point() + colour + "ir",
                                           new_point() + wave,
                                           new_point() + colour + "ir" + wave};
  for (std::uint8_t format = 0; format < points.size(); ++format) {
    SCOPED_TRACE(static_cast<int>(format));
    const std::string& point = points[format];
    LasTestFile las{.minor = format < 6 ? 2u : 4u, .format = format, .records = {point, point}};
    las.record_bytes = static_cast<std::uint16_t>(point.size());
    const PointCloud cloud = read(las.bytes());
    EXPECT_THAT(cloud.points, ElementsAre(Vec3{101, 198, 303}, Vec3{101, 198, 303}));
    EXPECT_THAT(notes_.notes, IsEmpty());
    EXPECT_EQ(value(cloud, "intensity", 1), 40000);
    EXPECT_EQ(value(cloud, "return_number", 1), format < 6 ? 2 : 9);
    EXPECT_EQ(value(cloud, "number_of_returns"), format < 6 ? 5 : 15);
    EXPECT_EQ(value(cloud, "scan_direction_flag"), format < 6 ? 1 : 0);
    EXPECT_EQ(value(cloud, "edge_of_flight_line"), format < 6 ? 0 : 1);
    EXPECT_EQ(value(cloud, "classification", 1), format < 6 ? 17 : 200);
    EXPECT_EQ(value(cloud, "key_point"), format < 6 ? 1 : 0);
    EXPECT_EQ(value(cloud, "synthetic"), 0);
    if (format >= 6) {
      EXPECT_EQ(value(cloud, "overlap") + 10 * value(cloud, "scanner_channel"), 21);
    }
    EXPECT_EQ(value(cloud, format < 6 ? "scan_angle_rank" : "scan_angle", 1), format < 6 ? -90 : -30000);
    EXPECT_EQ(value(cloud, "user_data"), 7);
    EXPECT_EQ(value(cloud, "point_source_id", 1), 500);
    const bool has_time = format != 0 && format != 2;
    EXPECT_EQ(find_attribute(cloud.attributes, "gps_time") != nullptr, has_time);
    if (has_time) {
      EXPECT_EQ(value(cloud, "gps_time", 1), 12.5);
    }
    const bool has_colour = point.find(colour) != std::string::npos;
    EXPECT_EQ(find_attribute(cloud.attributes, "red") != nullptr, has_colour);
    if (has_colour) {
      EXPECT_EQ(value(cloud, "blue", 1), 65535);
    }
    EXPECT_EQ(find_attribute(cloud.attributes, "nir") != nullptr, format == 8 || format == 10);
    if (format == 8 || format == 10) {
      EXPECT_EQ(value(cloud, "nir", 1), 'i' + 256 * 'r');
    }
  }
}

// Withheld means deleted. Version 1.0 had no flags: there bit 7 is part of the class.
TEST_F(IoLas, WithheldPointsAreLeftOut) {
  LasTestFile las{.records = {old_point(0x80), old_point()}};
  EXPECT_EQ(read(las.bytes()).points.size(), 1u);
  EXPECT_THAT(notes_.notes, ElementsAre("1 point marked as withheld left out"));
  las.minor = 0;
  EXPECT_EQ(value(read(las.bytes()), "classification"), 128);
  const LasTestFile modern{
      .minor = 4, .format = 6, .record_bytes = 30, .records = {new_point(), new_point(4), new_point()}};
  EXPECT_EQ(read(modern.bytes()).points.size(), 2u);
}

// All that a description can say: 7 bytes without meaning; an unsigned 64-bit number; a scaled pair of int16
// (type 14 = 10 + 4); a float called intensity; one byte that nothing describes.
TEST_F(IoLas, ExtraBytes) {
  const std::string descriptions = las_extra(0, 7, "skipped") + las_extra(7, 0, "time") +
                                   las_extra(14, 8 | 16, "pair", {0.5, 2, 1}, {10, 20, 0}) +
                                   las_extra(9, 0, "intensity") + las_extra(23, 0, "triple");
  const std::string extra = "skipped" + raw_bytes<std::uint64_t>({1ull << 63}) + raw_bytes<std::int16_t>({-4, 3}) +
                            raw_bytes<float>({0.25f}) + raw_bytes<std::uint16_t>({7, 8, 65000}) + "?";
  LasTestFile las{.records = {old_point() + extra, old_point() + extra}};
  las.record_bytes = static_cast<std::uint16_t>(20 + extra.size());
  las.variable_records = las_record("other", 4, "abc") + las_record("LASF_Spec", 4, descriptions);
  las.variable_count = 2;
  const PointCloud cloud = read(las.bytes());
  EXPECT_THAT(notes_.notes, ElementsAre("8 bytes of each point without a description left out"));
  EXPECT_EQ(value(cloud, "time", 1), 0x1p63);
  const Attribute& pair = *find_attribute(cloud.attributes, "pair");
  EXPECT_TRUE(pair.is_list);
  EXPECT_THAT(pair.offsets, ElementsAre(0, 2, 4));
  EXPECT_EQ(attribute_value(pair, 2), -4 * 0.5 + 10);
  EXPECT_EQ(attribute_value(pair, 3), 3 * 2 + 20);
  EXPECT_EQ(value(cloud, "intensity"), 40000);
  EXPECT_EQ(value(cloud, "intensity_2", 1), 0.25);
  const Attribute& triple = *find_attribute(cloud.attributes, "triple");
  EXPECT_EQ(triple.type, ScalarType::uint16);
  EXPECT_EQ(attribute_value(triple, 5), 65000);

  // One byte too few for the last of them: what fits is read.
  las.records = {(old_point() + extra).substr(0, 20 + extra.size() - 2)};
  las.record_bytes = static_cast<std::uint16_t>(las.records[0].size());
  const PointCloud shorter = read(las.bytes());
  EXPECT_EQ(value(shorter, "intensity_2"), 0.25);
  EXPECT_EQ(find_attribute(shorter.attributes, "triple"), nullptr);
  EXPECT_THAT(notes_.notes, ElementsAre("extra bytes 'triple' do not fit into the points: left out"));
}

TEST_F(IoLas, VariableRecordsNeedNotBeSound) {
  LasTestFile las{.records = {old_point()}};
  las.variable_count = 4000000000u;
  EXPECT_EQ(read(las.bytes()).points.size(), 1u);
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("promises 4000000000 variable length records, there is room for 0")));
  las.variable_records = las_record("a", 1, "xyz") + las_record("b", 2, "long").substr(0, 56);
  EXPECT_EQ(read(las.bytes()).points.size(), 1u);
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("there is room for 1")));
}

TEST_F(IoLas, KnownByItsContent) {
  write_bytes(folder_ / "a.xyz", LasTestFile{.records = {old_point()}}.bytes());
  EXPECT_EQ(read_point_cloud(folder_ / "a.xyz").points.size(), 1u);
  EXPECT_THAT(error_of([&] { read_mesh(folder_ / "a.xyz"); }), HasSubstr("holds points, not a mesh"));
}

TEST_F(IoLas, CompressedPointsAreRefused) {
  LasTestFile las{.format = 0x83, .record_bytes = 34};
  EXPECT_THAT(error(las.bytes()), HasSubstr("compressed (LAZ), which is not read, at byte 104"));
  las.variable_records = las_record("copc", 1, std::string(160, '\0'));
  las.variable_count = 1;
  EXPECT_THAT(error(las.bytes()), HasSubstr("compressed (COPC)"));
  las.format = 0; // the record tells it, too
  las.variable_records = las_record("laszip encoded", 22204, "");
  EXPECT_THAT(error(las.bytes()), HasSubstr("compressed (LAZ)"));
}

TEST_F(IoLas, MistakesInTheHeader) {
  const LasTestFile good{.records = {old_point(), old_point()}};
  const auto changed = [&](std::size_t at, auto value) {
    std::string bytes = good.bytes();
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return error(bytes);
  };
  EXPECT_THAT(error("1 2 3\n"), HasSubstr("does not begin with LASF"));
  EXPECT_THAT(error(good.bytes().substr(0, 226)), HasSubstr("ends within its header, at byte 226"));
  EXPECT_THAT(error(good.bytes().substr(0, 227 + 39)), HasSubstr("promises 2 points of 20 bytes, but the file ends"));
  EXPECT_THAT(changed(24, std::uint8_t{2}), HasSubstr("LAS version 2.2 is not known, at byte 24"));
  EXPECT_THAT(changed(25, std::uint8_t{5}), HasSubstr("LAS version 1.5"));
  EXPECT_THAT(changed(94, std::uint16_t{226}), HasSubstr("a header of 226 bytes is too short, at byte 94"));
  EXPECT_THAT(changed(96, std::uint32_t{100}), HasSubstr("begin at byte 100, within the header"));
  EXPECT_THAT(changed(96, std::uint32_t{4000000000u}), HasSubstr("but the file ends at byte 267"));
  EXPECT_THAT(changed(104, std::uint8_t{11}), HasSubstr("point format 11 is not known"));
  EXPECT_THAT(changed(105, std::uint16_t{19}), HasSubstr("19 bytes are too few for points of format 0"));
  EXPECT_THAT(changed(107, std::uint32_t{0xffffffff}), HasSubstr("promises 4294967295 points"));
  EXPECT_THAT(changed(131, 0.0), HasSubstr("a scale of the coordinates is 0"));
  EXPECT_THAT(changed(139, 0.0 / 0.0), HasSubstr("the scale of the coordinates is not finite"));
  EXPECT_THAT(changed(171, 1 / 0.0), HasSubstr("the offset of the coordinates is not finite"));
  LasTestFile modern{.minor = 4, .records = {old_point()}};
  std::string bytes = modern.bytes();
  const auto lie = std::uint64_t{1} << 62;
  std::memcpy(bytes.data() + 247, &lie, 8);
  EXPECT_THAT(error(bytes), HasSubstr("promises 4611686018427387904 points"));
}

} // namespace
} // namespace eigencrust
