// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <eigencrust/io.h>

#include "support.h"
#include "zip_bytes.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string six = raw_bytes<double>({1, 2, 3, 4, 5, 6});
const std::string six_points = npy_file("<f8", "(2, 3)", six);

class IoNpz : public ::testing::Test {
 protected:
  PointCloud read(const std::string& bytes, const char* name = "a.npz") {
    notes_ = {};
    write_bytes(folder_ / name, bytes);
    return read_point_cloud(folder_ / name, {}, &notes_);
  }
  std::string error(const std::string& bytes, const char* name = "a.npz") {
    return error_of([&] { read(bytes, name); });
  }
  std::string npy_error(const std::string& bytes) { return error(bytes, "a.npy"); }

  TempDir folder_;
  ReadNotes notes_;
};

TEST_F(IoNpz, OrdersAndTypesOfOneArray) {
  const auto expect = [&](const std::string& bytes) {
    EXPECT_THAT(read(bytes, "a.npy").points, ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}));
  };
  expect(six_points);
  expect(npy_file("<f8", "(2, 3)", raw_bytes<double>({1, 4, 2, 5, 3, 6}), true));
  expect(npy_file("<f4", "(2, 3)", raw_bytes<float>({1, 2, 3, 4, 5, 6})));
  expect(npy_file("<f4", "(2,3)", raw_bytes<float>({1, 4, 2, 5, 3, 6}), true));
  expect(npy_file("<f2", "(2, 3)", raw_bytes<std::uint16_t>({0x3c00, 0x4000, 0x4200, 0x4400, 0x4500, 0x4600})));
  expect(npy_file("<i8", "(2L, 3L)", raw_bytes<std::int64_t>({1, 2, 3, 4, 5, 6})));
  expect(npy_file("|u1", "(2, 3)", "\1\2\3\4\5\6"));
  expect(npy_file(">i2", "(2, 3)", std::string("\0\1\0\2\0\3\0\4\0\5\0\6", 12)));
  // The notation of Python leaves room: other quotes, order and blanks, no comma at the end.
  expect(npy_with_header(R"( {"shape":( 2 ,3 ),"fortran_order" : False,"descr":"<f8"} )", six));
  // Version 2 has four bytes for the length of the header.
  std::string second = six_points;
  second[6] = '\2';
  second.insert(10, std::string(2, '\0'));
  expect(second);
  EXPECT_THAT(read(npy_file("<f8", "(0, 3)", ""), "a.npy").points, IsEmpty());
}

// Signs, subnormal and infinite numbers, and NaN: 1 11110 1111111111 is -65504, 0 00000 0000000001 is 2^-24.
TEST_F(IoNpz, HalfPrecision) {
  const std::string bytes =
      npy_file("<f2", "(2, 3)", raw_bytes<std::uint16_t>({0xfbff, 0x0001, 0x8400, 0x7c00, 0xfc00, 0x7e00}));
  const PointCloud cloud = read(bytes, "a.npy");
  EXPECT_EQ(cloud.points[0], (Vec3{-65504, 0x1p-24, -0x1p-14}));
  EXPECT_EQ(cloud.points[1].x, INFINITY);
  EXPECT_EQ(cloud.points[1].y, -INFINITY);
  EXPECT_TRUE(std::isnan(cloud.points[1].z));
}

TEST_F(IoNpz, FurtherColumnsOfOneArray) {
  const PointCloud cloud = read(npy_file("<f4", "(1, 5)", raw_bytes<float>({1, 2, 3, 4, 5})), "a.npy");
  EXPECT_EQ(cloud.attributes.size(), 2u);
  EXPECT_EQ(attribute_value(*find_attribute(cloud.attributes, "column5"), 0), 5);
}

TEST_F(IoNpz, ArraysByName) {
  const std::string sensors = npy_file("<f4", "(2, 3)", raw_bytes<float>({7, 8, 9, 7, 8, 9}));
  const std::string bytes = zip_file({{"sensor_position.npy", sensors},
                                      {"label.npy", npy_file("<i8", "(2,)", raw_bytes<std::int64_t>({5, -6}))},
                                      {"readme.txt", "not an array"},
                                      {"points.npy", six_points},
                                      {"normals.npy", npy_file("<f8", "(2, 3)", six, true)},
                                      {"uv.npy", npy_file("<f4", "(2, 2)", raw_bytes<float>({1, 2, 3, 4}))},
                                      {"name.npy", npy_file("<U4", "(2,)", std::string(32, 'a'))},
                                      {"faces.npy", npy_file("<i4", "(1, 3)", std::string(12, '\0'))}});
  const PointCloud cloud = read(bytes);
  EXPECT_THAT(cloud.points, ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}));
  std::string names;
  for (const Attribute& a : cloud.attributes) names += a.name + " ";
  EXPECT_EQ(names, "label nx ny nz uv_0 uv_1 ");
  EXPECT_EQ(attribute_value(*find_attribute(cloud.attributes, "label"), 1), -6);
  EXPECT_EQ(attribute_value(*find_attribute(cloud.attributes, "ny"), 1), 4); // columns 1 2, 3 4, 5 6
  EXPECT_EQ(attribute_value(*find_attribute(cloud.attributes, "uv_1"), 1), 4);
  EXPECT_THAT(cloud.sensors, ElementsAre(Sensor{{7, 8, 9}, false})); // the same place: one sensor
  EXPECT_THAT(cloud.sensor_of, ElementsAre(0, 0));
  EXPECT_THAT(notes_.notes,
              ElementsAre(HasSubstr("'name' of shape (2,) left out"), HasSubstr("'faces' of shape (1, 3)")));
}

TEST_F(IoNpz, OneSensorForAllPoints) {
  for (const char* shape : {"(3,)", "(1, 3)"}) {
    const PointCloud cloud = read(
        zip_file({{"points.npy", six_points}, {"sensor_position.npy", npy_file("<f8", shape, six.substr(0, 24))}}));
    EXPECT_THAT(cloud.sensors, ElementsAre(Sensor{{1, 2, 3}, false}));
    EXPECT_THAT(cloud.sensor_of, ElementsAre(0, 0));
  }
  EXPECT_THAT(error(zip_file(
                  {{"points.npy", npy_file("<f8", "(1, 3)", six.substr(0, 24))}, {"sensor_position.npy", six_points}})),
              HasSubstr("array 'sensor_position': there are 2 positions for 1 point"));
}

// numpy.savez without names calls the array arr_0.
TEST_F(IoNpz, ASingleArrayNeedsNoName) {
  EXPECT_EQ(read(zip_file({{"arr_0.npy", six_points}})).points.size(), 2u);
  EXPECT_THAT(error(zip_file({{"a.npy", six_points}, {"b.npy", six_points}})),
              HasSubstr("no array is named 'points' among 'a', 'b'"));
  EXPECT_THAT(error(zip_file({{"a.txt", "x"}})), HasSubstr("holds no array of NumPy"));
  EXPECT_THAT(error(zip_file({})), HasSubstr("holds no array of NumPy"));
  EXPECT_THAT(error(zip_file({{"points.npy", six_points}, {"points.npy", six_points}})), HasSubstr("is there twice"));
}

TEST_F(IoNpz, KindsOfMembers) {
  EXPECT_EQ(read(zip_file({{"points.npy", six_points, deflate_stored(six_points), 8}})).points[1].z, 6);
  // The end record is found behind which a comment stands, even one that looks like it.
  const std::string zeros = npy_file("|i1", "(100, 3)", std::string(300, '\0'));
  EXPECT_EQ(read(zip_file({{"points.npy", zeros, deflate_stored(zeros), 8}}, "a comment PK\5\6")).points.size(), 100u);
  EXPECT_EQ(read(zip_file({{.name = "points.npy", .content = six_points, .large = true}})).points[1].z, 6);
}

TEST_F(IoNpz, DamagedArchives) {
  const ZipTestMember good{"points.npy", six_points};
  const auto changed = [&](auto&& change) {
    ZipTestMember member = good;
    change(member);
    return error(zip_file({member}));
  };
  EXPECT_THAT(changed([](auto& m) { m.crc_change = 1; }), HasSubstr("its checksum is wrong, it begins at byte 0"));
  EXPECT_THAT(changed([](auto& m) { m.method = 12; }), HasSubstr("is compressed by method 12"));
  EXPECT_THAT(changed([](auto& m) { m.flags = 1; }), HasSubstr("is encrypted"));
  EXPECT_THAT(changed([](auto& m) { m.size_change = 1; }), HasSubstr("cannot unpack from"));
  const auto deflated = [&](std::uint64_t size_change, const std::string& packed) {
    ZipTestMember member = good;
    member.method = 8;
    member.packed = packed;
    member.size_change = size_change;
    return error(zip_file({member}));
  };
  const std::string packed = deflate_stored(six_points);
  EXPECT_THAT(deflated(0, packed), "");
  EXPECT_THAT(deflated(1, packed), HasSubstr("is damaged, it begins"));
  EXPECT_THAT(deflated(std::uint64_t{0} - 1, packed), HasSubstr("is damaged, it begins"));
  EXPECT_THAT(deflated(0, packed.substr(0, 60)), HasSubstr("is damaged, it begins"));
  EXPECT_THAT(deflated(0, "\7" + packed), HasSubstr("is damaged, it begins")); // a block of unknown type
  EXPECT_THAT(deflated(4000000, packed), HasSubstr("cannot unpack from"));
  const std::string whole = zip_file({good});
  EXPECT_THAT(error(whole.substr(0, whole.size() - 1)), HasSubstr("has no directory: the file ends"));
  EXPECT_THAT(error(whole.substr(1)), HasSubstr("a.npz")); // all places are off by one
  std::string far = zip_file({{.name = "points.npy", .content = six_points, .large = true}});
  far.replace(far.size() - 22 - 20 + 8, 8, raw_bytes<std::uint64_t>({~std::uint64_t{0}}));
  EXPECT_THAT(error(far), HasSubstr("end record is not where it should be"));
}

// What small files may unpack to is bounded: 1 MiB and 100 times the size of the file.
TEST_F(IoNpz, Bombs) {
  // A deflate stream of zeros, one fixed block: the literal 0 (8 bits: 00110000), then the length 258 (code 285:
  // 11000101) at distance 1 (code 0: 00000), 13 bits each, then the end (7 bits 0). Huffman codes go in from their
  // upper bit.
  const auto run = [](std::size_t copies) {
    std::vector<std::uint64_t> bits = {1, 1, 0};
    const auto code = [&](std::initializer_list<int> values) {
      for (const int v : values) bits.push_back(static_cast<std::uint64_t>(v));
    };
    code({0, 0, 1, 1, 0, 0, 0, 0});
    for (std::size_t i = 0; i < copies; ++i) code({1, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0});
    code({0, 0, 0, 0, 0, 0, 0});
    return pack_bits(bits, 1);
  };
  const std::string little(1 + 258 * 10, '\0');
  // Not an array, but unpacked without fault.
  EXPECT_THAT(error(zip_file({{"points.npy", little, run(10), 8}})), HasSubstr("this is no array of NumPy"));
  const std::size_t copies = 80000; // 21 MB from 130 kB: 158 times
  EXPECT_THAT(error(zip_file({{"points.npy", std::string(1 + 258 * copies, '\0'), run(copies), 8}})),
              HasSubstr("unpacks to 20640001 bytes, too much for a file of this size"));
}

TEST_F(IoNpz, MistakesInTheHeaderOfAnArray) {
  EXPECT_THAT(npy_error("\x93NUMPX" + std::string(20, '\0')), HasSubstr("no array of NumPy at byte 0"));
  EXPECT_THAT(npy_error(six_points.substr(0, 40)), HasSubstr("ends within its header at byte 40"));
  std::string version = six_points;
  version[6] = '\4';
  EXPECT_THAT(npy_error(version), HasSubstr("version 4 of the npy format is not known at byte 6"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(2, 4)", six)), HasSubstr("promises more values than there are"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(1, 3)", six)), HasSubstr("24 bytes more than its shape (1, 3) says"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(0, 3)", six)), HasSubstr("48 bytes more"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(6148914691236517206, 3)", six)), HasSubstr("promises more values")); // 2^64/3
  EXPECT_THAT(npy_error(npy_file("<f8", "(99999999999999999999, 3)", six)), HasSubstr("header is malformed"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(-2, 3)", six)), HasSubstr("header is malformed"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(2 3)", six)), HasSubstr("header is malformed"));
  EXPECT_THAT(npy_error(npy_with_header("{'descr': '<f8'}", six)), HasSubstr("does not tell descr, fortran_order"));
  EXPECT_THAT(npy_error(npy_with_header("{'descr': '<f8", six)), HasSubstr("header is malformed at byte"));
  EXPECT_THAT(npy_error(npy_with_header("{'other': '<f8'}", six)), HasSubstr("header is malformed"));
  EXPECT_THAT(npy_error(npy_with_header("", six)), HasSubstr("header is malformed at byte 10"));
  EXPECT_THAT(npy_error(npy_with_header("{'descr': [('x', '<f8')], ", six)), HasSubstr("a table of named fields"));
  EXPECT_THAT(npy_error(npy_file("|O", "(2, 3)", six)), HasSubstr("'|O' is not one of numbers"));
  EXPECT_THAT(npy_error(npy_file("<c8", "(2, 3)", six)), HasSubstr("'<c8' is not one of numbers"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(6,)", six)), HasSubstr("shape (6,) is not that of points"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(3, 2)", six)), HasSubstr("shape (3, 2) is not that of points"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(1, 2, 3)", six)), HasSubstr("is not that of points"));
  EXPECT_THAT(npy_error(npy_file("<f8", "()", six.substr(0, 8))), HasSubstr("shape () is not that of points"));
  EXPECT_THAT(npy_error(npy_file("<f8", "(9000000000000000000, 0)", "")), HasSubstr("is not that of points"));
  EXPECT_THAT(error(zip_file({{"points.npy", npy_file("<f8", "(2, 4)", six)}})),
              HasSubstr("array 'points': the shape (2, 4) promises more"));
  // Arrays that are not needed may be of any shape.
  EXPECT_EQ(read(zip_file({{"points.npy", six_points},
                           {"a.npy", npy_file("<f8", "(9000000000000000000, 0)", "")},
                           {"b.npy", npy_file("<f8", "()", six.substr(0, 8))}}))
                .attributes.size(),
            0u);
}

TEST_F(IoNpz, KnownByTheirContent) {
  EXPECT_EQ(read(six_points, "a.dat").points.size(), 2u);
  EXPECT_EQ(read(zip_file({{"points.npy", six_points}}), "a.xyz").points.size(), 2u);
}

} // namespace
} // namespace eigencrust
