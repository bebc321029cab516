// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <eigencrust/io.h>

#include "e57_bytes.h"
#include "io/crc32c.h"
#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Notes = std::vector<std::string>;

const std::string single = " type=\"Float\" precision=\"single\"/>";
const std::string real = " type=\"Float\"/>";

std::string whole(const std::string& minimum, const std::string& maximum) {
  return " type=\"Integer\" minimum=\"" + minimum + "\" maximum=\"" + maximum + "\"/>";
}

/// Points as floats.
E57TestScan scan_of(const std::vector<Vec3>& points) {
  E57TestScan scan;
  scan.records = points.size();
  std::string x, y, z;
  for (const Vec3& p : points) {
    x += raw_bytes<float>({static_cast<float>(p.x)});
    y += raw_bytes<float>({static_cast<float>(p.y)});
    z += raw_bytes<float>({static_cast<float>(p.z)});
  }
  scan.fields = {{"<cartesianX" + single, x}, {"<cartesianY" + single, y}, {"<cartesianZ" + single, z}};
  return scan;
}

std::string pose(const std::string& rotation, const std::string& translation) {
  return "<pose type=\"Structure\">" + rotation + translation + "</pose>";
}
const std::string moved_by_1_2_3 =
    "<translation type=\"Structure\"><x type=\"Float\">1</x><y type=\"Float\"> 2e0\n</y><z type=\"Float\">3</z>"
    "</translation>";
/// A quarter turn about z, as a quaternion of length 2: x -> y, y -> -x.
const std::string quarter_turn =
    "<rotation type=\"Structure\"><w type=\"Float\">1.4142135623730951</w><x type=\"Float\"/><y type=\"Float\"/>"
    "<z type=\"Float\">1.4142135623730951</z></rotation>";

class IoE57 : public ::testing::Test {
 protected:
  PointCloud read(const std::string& bytes) {
    notes_ = {};
    const auto path = folder_ / "a.e57";
    std::filesystem::remove(path);
    write_bytes(path, bytes);
    return read_point_cloud(path, {}, &notes_);
  }
  std::string error(const std::string& bytes) {
    return error_of([&] { read(bytes); });
  }

  TempDir folder_;
  ReadNotes notes_;
};

TEST(IoCrc32c, IsThatOfTheRfc) {
  EXPECT_EQ(io::crc32c("123456789"), 0xe3069283u);
  EXPECT_EQ(io::crc32c(std::string(32, '\0')), 0x8a9136aau); // RFC 3720, B.4
  EXPECT_EQ(io::crc32c(std::string(32, '\xff')), 0x62a8ab43u);
  EXPECT_EQ(io::crc32c(""), 0u);
}

TEST_F(IoE57, FloatsAndDoubles) {
  const PointCloud cloud = read(e57_file({scan_of({{1, 2, 3}, {-0.5, 1e10, 0}})}));
  EXPECT_THAT(cloud.points, ElementsAre(Vec3{1, 2, 3}, Vec3{-0.5, 1e10, 0}));
  EXPECT_TRUE(cloud.attributes.empty());
  EXPECT_TRUE(cloud.scan_index.empty());
  EXPECT_TRUE(cloud.sensors.empty());
  EXPECT_TRUE(cloud.sensor_of.empty());
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("position is not known")));

  E57TestScan scan;
  scan.records = 1;
  scan.fields = {{"<cartesianZ" + real, raw_bytes<double>({0.1})},
                 {"<cartesianX" + real, raw_bytes<double>({4320978.61})},
                 {"<cartesianY" + real, raw_bytes<double>({-1e-300})}};
  EXPECT_THAT(read(e57_file({scan})).points, ElementsAre(Vec3{4320978.61, -1e-300, 0.1}));
}

// Whole numbers of 3, 10 and 64 bits and a constant one, of which nothing is stored; each is
// (stored + minimum) x scale + offset.
TEST_F(IoE57, BitPackedWholeNumbers) {
  E57TestScan scan;
  scan.records = 5;
  scan.fields = {
      {"<cartesianX type=\"ScaledInteger\" minimum=\"-3\" maximum=\"4\" scale=\"0.5\" offset=\"100\"/>",
       pack_bits({0, 7, 3, 1, 5}, 3)},
      {"<cartesianY" + whole("0", "1000"), pack_bits({1000, 0, 513, 2, 999}, 10)},
      {"<cartesianZ type=\"ScaledInteger\" minimum=\"7\" maximum=\"7\" scale=\"2\"/>", ""},
      {"<timeStamp type=\"Integer\"/>", pack_bits({1ull << 63, (1ull << 63) + 5, 0, 3, ~0ull}, 64)},
      {"<rowIndex" + whole("-70000", "70000"), pack_bits({0, 140000, 70000, 70001, 69999}, 18)},
  };
  for (const std::size_t first_packet : {1000u, 1u, 7u}) { // values may be split between packets, within bytes even
    scan.first_packet = first_packet;
    const PointCloud cloud = read(e57_file({scan}));
    EXPECT_THAT(cloud.points, ElementsAre(Vec3{98.5, 1000, 14}, Vec3{102, 0, 14}, Vec3{100, 513, 14}, Vec3{99, 2, 14},
                                          Vec3{101, 999, 14}));
    ASSERT_EQ(cloud.attributes.size(), 2u);
    EXPECT_EQ(cloud.attributes[0].name, "timeStamp");
    EXPECT_EQ(cloud.attributes[0].type, ScalarType::float64);
    EXPECT_EQ(attribute_value(cloud.attributes[0], 0), 0); // minimum -2^63
    EXPECT_EQ(attribute_value(cloud.attributes[0], 1), 5);
    EXPECT_EQ(attribute_value(cloud.attributes[0], 2), -0x1p63);
    EXPECT_EQ(cloud.attributes[1].type, ScalarType::int32);
    EXPECT_EQ(attribute_value(cloud.attributes[1], 1), 70000);
    EXPECT_EQ(attribute_value(cloud.attributes[1], 4), -1);
  }
}

TEST_F(IoE57, PosesMoveAndTurnAndTellTheSensors) {
  E57TestScan first = scan_of({{1, 0, 0}, {0, 1, 5}}), second = scan_of({{1, 1, 1}}), third = scan_of({{9, 9, 9}});
  first.before_points = pose(quarter_turn, moved_by_1_2_3);
  for (const auto& [name, x] : {std::pair{"X", 1.f}, std::pair{"Y", 0.f}, std::pair{"Z", 0.f}})
    first.fields.push_back({std::string("<nor:normal") + name + single, raw_bytes<float>({x, -x})});
  second.before_points = pose("", moved_by_1_2_3); // no rotation
  const PointCloud cloud = read(e57_file({first, second, third}));
  ASSERT_EQ(cloud.points.size(), 4u);
  const Vec3 expected[] = {{1, 3, 3}, {0, 2, 8}, {2, 3, 4}, {9, 9, 9}};
  for (int i = 0; i < 4; ++i) EXPECT_LT(distance(cloud.points[i], expected[i]), 1e-12) << i;
  EXPECT_EQ(cloud.points[2], (Vec3{2, 3, 4}));
  EXPECT_THAT(cloud.scan_index, ElementsAre(0, 0, 1, 2));
  EXPECT_THAT(cloud.sensors, ElementsAre(Sensor{{1, 2, 3}, false}, Sensor{{1, 2, 3}, false}));
  EXPECT_THAT(cloud.sensor_of, ElementsAre(0, 0, 1, PointCloud::no_sensor));
  const Attribute* nx = find_attribute(cloud.attributes, "nx");
  const Attribute* ny = find_attribute(cloud.attributes, "ny");
  ASSERT_TRUE(nx != nullptr && ny != nullptr);
  EXPECT_NEAR(attribute_value(*nx, 0), 0, 1e-7);
  EXPECT_NEAR(attribute_value(*ny, 0), 1, 1e-7);
  EXPECT_NEAR(attribute_value(*ny, 1), -1, 1e-7);
  EXPECT_TRUE(std::isnan(attribute_value(*nx, 2))); // the second scan has none
}

TEST_F(IoE57, IdentityPosesTellNothing) {
  E57TestScan scan = scan_of({{1, 2, 3}});
  scan.before_points = pose("<rotation type=\"Structure\"><w type=\"Float\">1</w></rotation>", "");
  EXPECT_TRUE(read(e57_file({scan})).sensors.empty());
  // Next to a scan that was moved, the identity is the place of the scan that the others were fitted to.
  E57TestScan other = scan_of({{4, 4, 4}});
  other.before_points = pose("", moved_by_1_2_3);
  EXPECT_THAT(read(e57_file({scan, other})).sensors, ElementsAre(Sensor{{0, 0, 0}, false}, Sensor{{1, 2, 3}, false}));
}

TEST_F(IoE57, RotationOfLengthZeroIsNone) {
  E57TestScan scan = scan_of({{1, 2, 3}});
  scan.before_points = pose("<rotation type=\"Structure\"/>", moved_by_1_2_3);
  EXPECT_THAT(read(e57_file({scan})).points, ElementsAre(Vec3{2, 4, 6}));
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("0 0 0 0")));
}

TEST_F(IoE57, InvalidPointsAreLeftOut) {
  E57TestScan scan = scan_of({{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}});
  scan.fields.push_back({"<cartesianInvalidState" + whole("0", "2"), pack_bits({0, 2, 1, 0}, 2)});
  scan.fields.push_back({"<intensity" + whole("0", "255"), pack_bits({10, 20, 30, 40}, 8)});
  const PointCloud cloud = read(e57_file({scan}));
  EXPECT_THAT(cloud.points, ElementsAre(Vec3{1, 1, 1}, Vec3{4, 4, 4}));
  ASSERT_EQ(cloud.attributes.size(), 1u);
  EXPECT_EQ(attribute_value(cloud.attributes[0], 1), 40);
  EXPECT_THAT(notes_.notes[0], HasSubstr("2 points marked as invalid"));
}

// range 2, azimuth 90 degrees, elevation 30 degrees: (0, sqrt 3, 1)
TEST_F(IoE57, SphericalCoordinates) {
  E57TestScan scan;
  scan.records = 2;
  scan.fields = {{"<sphericalRange" + real, raw_bytes<double>({2, 5})},
                 {"<sphericalAzimuth" + real, raw_bytes<double>({std::acos(0.0), 0})},
                 {"<sphericalElevation" + real, raw_bytes<double>({std::asin(0.5), 0})},
                 {"<sphericalInvalidState" + whole("0", "2"), pack_bits({0, 1}, 2)}};
  const PointCloud cloud = read(e57_file({scan}));
  ASSERT_EQ(cloud.points.size(), 1u);
  EXPECT_LT(distance(cloud.points[0], {0, std::sqrt(3.0), 1}), 1e-12);
}

TEST_F(IoE57, ColoursOfAllKinds) {
  const auto coloured = [](const std::string& type, const std::string& stream) {
    E57TestScan scan = scan_of({{0, 0, 0}, {1, 1, 1}});
    for (const char* channel : {"Red", "Green", "Blue"})
      scan.fields.push_back({std::string("<color") + channel + type, stream});
    return scan;
  };
  const auto check = [&](const E57TestScan& scan, ScalarType type, double second) {
    const PointCloud cloud = read(e57_file({scan}));
    const Attribute* green = find_attribute(cloud.attributes, "green");
    ASSERT_NE(green, nullptr);
    EXPECT_EQ(green->type, type);
    EXPECT_EQ(attribute_value(*green, 1), second);
  };
  check(coloured(whole("0", "255"), pack_bits({1, 200}, 8)), ScalarType::uint8, 200);
  check(coloured(whole("0", "65535"), pack_bits({1, 40000}, 16)), ScalarType::uint16, 40000);
  check(coloured(single, raw_bytes<float>({0, 1})), ScalarType::uint8, 255);
  check(coloured(single, raw_bytes<float>({0, 255})), ScalarType::uint8, 255);
}

TEST_F(IoE57, TextFieldsAndNestedPrototypes) {
  E57TestScan scan = scan_of({{1, 2, 3}});
  scan.fields[1].first = "<inner type=\"Structure\">" + scan.fields[1].first + "</inner>";
  scan.fields.insert(scan.fields.begin(), {"<note type=\"String\"/>", std::string("\6abc", 4)});
  scan.codecs = "<vectorChild type=\"Structure\"><bitPackCodec type=\"Structure\"/></vectorChild>";
  const PointCloud cloud = read(e57_file({scan}));
  EXPECT_THAT(cloud.points, ElementsAre(Vec3{1, 2, 3}));
  EXPECT_TRUE(cloud.attributes.empty());
  scan.codecs = "<vectorChild type=\"Structure\"><otherCodec type=\"Structure\"/></vectorChild>";
  EXPECT_THAT(error(e57_file({scan})), HasSubstr("coded in a way that is not known at byte "));
}

TEST_F(IoE57, ScansWithoutPoints) {
  E57TestScan none = scan_of({});
  EXPECT_TRUE(read(e57_file({none})).points.empty());
  const PointCloud cloud = read(e57_file({none, scan_of({{1, 2, 3}})}));
  EXPECT_THAT(cloud.points, ElementsAre(Vec3{1, 2, 3}));
  EXPECT_THAT(cloud.scan_index, ElementsAre(1));
  EXPECT_THAT(error(e57_file({})), HasSubstr("holds no scan at byte "));
}

TEST_F(IoE57, ChecksumsAreChecked) {
  std::string bytes = e57_file({scan_of(std::vector<Vec3>(200, {1, 2, 3}))});
  ASSERT_GT(bytes.size(), 2048u);
  bytes[1500] = static_cast<char>(bytes[1500] ^ 1);
  EXPECT_THAT(error(bytes), HasSubstr("the checksum of page 1 is wrong, at byte 1024"));
  EXPECT_THAT(error(bytes.substr(0, 1400)), HasSubstr("the file ends"));
}

// What a header claims is never believed beyond what the file bears out.
TEST_F(IoE57, ClaimsAreChecked) {
  E57TestScan scan = scan_of({{1, 2, 3}, {4, 5, 6}});
  scan.records = 3;
  EXPECT_THAT(error(e57_file({scan})), HasSubstr("'cartesianX' has only 8 bytes for 3 points"));
  scan.records = 4000000000;
  EXPECT_THAT(error(e57_file({scan})), HasSubstr("more than a file of this size"));

  // Constant columns take no bits.
  E57TestScan constant;
  constant.records = 100;
  for (const char* name : {"<cartesianX", "<cartesianY", "<cartesianZ"})
    constant.fields.push_back({name + whole("5", "5"), ""});
  EXPECT_EQ(read(e57_file({constant})).points.size(), 100u);
  constant.records = 5000;
  EXPECT_THAT(error(e57_file({constant})), HasSubstr("columns are all constant"));
  constant.records = 900;
  EXPECT_THAT(error(e57_file({constant, constant, constant, constant})), HasSubstr("columns are all constant"));

  // Many scans that name the same bytes.
  std::vector<E57TestScan> scans(2, scan_of(std::vector<Vec3>(2000, {1, 2, 3})));
  scans[1].shares_first = true;
  EXPECT_EQ(read(e57_file(scans)).points.size(), 4000u);
  scans.resize(40, scans[1]);
  for (std::size_t i = 1; i < scans.size(); ++i)
    for (auto& [element, stream] : scans[i].fields) stream.clear();
  EXPECT_THAT(error(e57_file(scans)), HasSubstr("share their bytes at byte 48"));

  std::string logical = e57_logical({scan_of({{1, 2, 3}})});
  logical[60] = 1; // of the length of the section
  EXPECT_THAT(error(seal_e57(logical)), HasSubstr("is not inside the file at byte 48"));
}

TEST_F(IoE57, BrokenXml) {
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string logical = e57_logical({scan_of({{1, 2, 3}})});
    const std::size_t at = logical.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return error(seal_e57(logical.replace(at, from.size(), to)));
  };
  EXPECT_THAT(changed("</data3D>", "<!data3D>"), HasSubstr("the XML section cannot be read"));
  EXPECT_THAT(changed("cartesianX", "cartesianx"), HasSubstr("without cartesian or spherical"));
  EXPECT_THAT(changed("cartesianX", "cartesianY"), HasSubstr("two fields 'cartesianY'"));
  EXPECT_THAT(changed("recordCount=\"1\"", "recordCount=\"x\""), HasSubstr("'x' as recordCount is no whole number"));
  EXPECT_THAT(changed("fileOffset=\"48\"", "fileOffset=\"99\""), HasSubstr("no binary section of points begins"));
  EXPECT_THAT(changed("type=\"Float\"", "type=\"Flour\""), HasSubstr("has the type 'Flour'"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a type=\"Structure\">";
  E57TestScan scan = scan_of({{1, 2, 3}});
  scan.fields[0].first = deep;
  EXPECT_FALSE(error(e57_file({scan})).empty());
  for (int i = 0; i < 100000; ++i) scan.fields[0].first += "</a>";
  EXPECT_THAT(error(e57_file({scan})), HasSubstr("nested too deeply"));
}

// The checksums are made right again, so that the layers behind them are reached.
TEST_F(IoE57, ChangedBytesNeverCrash) {
  E57TestScan scan = scan_of({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  scan.before_points = pose(quarter_turn, moved_by_1_2_3);
  scan.fields.push_back({"<intensity" + whole("0", "5"), pack_bits({1, 2, 3}, 3)});
  scan.fields.push_back({"<cartesianInvalidState" + whole("0", "1"), pack_bits({0, 1, 0}, 1)});
  const std::string good = e57_logical({scan, scan});
  std::uint64_t state = 1;
  const auto random = [&](std::size_t below) { // a 64-bit linear congruential generator (Knuth, MMIX)
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>(state >> 33) % below;
  };
  int errors = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string logical = good;
    for (std::size_t changes = 1 + random(3); changes > 0; --changes)
      logical[round % 2 == 0 ? random(230) : random(good.size())] =
          static_cast<char>(random(2) == 0 ? random(256) : '0' + random(10));
    try {
      const PointCloud cloud = read(seal_e57(logical));
      ASSERT_LE(cloud.points.size(), 6u);
      for (const Attribute& attribute : cloud.attributes) ASSERT_EQ(attribute.rows(), cloud.points.size());
    } catch (const Error& e) {
      ++errors;
      ASSERT_EQ(e.kind(), ErrorKind::input);
    }
  }
  EXPECT_GT(errors, 500);
}

} // namespace
} // namespace eigencrust
