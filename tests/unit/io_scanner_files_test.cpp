// SPDX-License-Identifier: GPL-3.0-or-later
// Every real file of the scanner formats: points (those that are finite), bounds and sensors as an
// independent script found them, or why the file is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::HasSubstr;

struct Good {
  const char* path;
  std::size_t points, finite;
  Box3 bounds;
  std::size_t scans, sensors;
};
class IoScannerFiles : public ::testing::TestWithParam<Good> {};

TEST_P(IoScannerFiles, ReadRight) {
  const Good& expected = GetParam();
  const auto path = data_path(expected.path);
  EIGENCRUST_NEED_DATA(path);
  const PointCloud cloud = read_point_cloud(path);
  EXPECT_EQ(cloud.points.size(), expected.points);
  Box3 bounds;
  std::size_t finite = 0;
  for (const Vec3& p : cloud.points) {
    if (!is_finite(p)) continue;
    bounds.add(p);
    ++finite;
  }
  EXPECT_EQ(finite, expected.finite);
  EXPECT_EQ(bounds.min, expected.bounds.min);
  EXPECT_EQ(bounds.max, expected.bounds.max);
  for (const Attribute& attribute : cloud.attributes) EXPECT_EQ(attribute.rows(), cloud.points.size());
  std::uint32_t scans = cloud.points.empty() ? 0 : 1;
  for (const std::uint32_t scan : cloud.scan_index) scans = std::max(scans, scan + 1);
  EXPECT_EQ(scans, expected.scans);
  EXPECT_EQ(cloud.sensors.size(), expected.sensors);
  EXPECT_EQ(cloud.sensor_of.size(), expected.sensors == 0 ? 0 : cloud.points.size());
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(
    All, IoScannerFiles,
    ::testing::ValuesIn(std::vector<Good>{
        {"formats/e57/A4.e57", 4, 4, {{-44.95220184326172, -1.3493000268936157, -0.607699990272522}, {-44.30009841918945, -0.8859999775886536, 0.3693999946117401}}, 1, 0},
        {"formats/e57/A4_moved.e57", 4, 4, {{-44.11943817138672, 0.7053030729293823, -0.607699990272522}, {-43.46733474731445, 1.1686031818389893, 0.3693999946117401}}, 1, 0},
        {"formats/e57/A_B.e57", 6, 6, {{-44.95220184326172, -1.3493000268936157, -0.607699990272522}, {-42.63949966430664, 2.057800054550171, 0.666700005531311}}, 2, 0},
        {"formats/e57/A_B_different_dims.e57", 2, 2, {{83.19784545898438, 537.2703247070312, 4.590275764465332}, {84.17402648925781, 538.4684448242188, 4.628726005554199}}, 2, 0},
        {"formats/e57/A_merged_B.e57", 6, 6, {{-44.95220184326172, -1.3493000268936157, -0.607699990272522}, {-42.63949966430664, 2.057800054550171, 0.666700005531311}}, 1, 0},
        {"formats/e57/A_moved_B.e57", 6, 6, {{-44.11943817138672, 0.7053028345108032, -0.607699990272522}, {-42.63949966430664, 2.057800054550171, 0.666700005531311}}, 2, 0},
        {"formats/e57/B2.e57", 2, 2, {{-42.64229965209961, 1.8725999593734741, 0.5101000070571899}, {-42.63949966430664, 2.057800054550171, 0.666700005531311}}, 1, 0},
        {"formats/e57/ColourRepresentation.e57", 153, 153, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, 1, 0},
        {"formats/e57/ColouredCubeDouble.e57", 7680, 7680, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, 1, 0},
        {"formats/e57/ColouredCubeFloat.e57", 7680, 7680, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, 1, 0},
        {"formats/e57/InvalidCVHeader.e57", 0, 0, {}, 0, 0},
        {"formats/e57/ZeroPoints.e57", 0, 0, {}, 0, 0},
        {"formats/e57/ZeroPointsInvalid.e57", 0, 0, {}, 0, 0},
        {"formats/e57/bunnyDouble.e57", 30571, 30571, {{-0.094689, 0.040011, -0.061873}, {0.061008999999999994, 0.187321, 0.058799}}, 1, 0},
        {"formats/e57/bunnyInt32.e57", 30571, 30571, {{-0.094689, 0.040011, -0.061873}, {0.061008999999999994, 0.187321, 0.058799}}, 1, 0},
        {"formats/e57/testWithNormals.e57", 2, 2, {{1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}}, 1, 0},
        {"formats/e57/translationWithoutRotation.e57", 4, 4, {{4.0, 5.0, 6.0}, {5.0, 6.0, 6.0}}, 1, 1},
        {"formats/ptx/1.2-with-color.ptx", 1065, 1065, {{635619.85, 848899.7, 406.59}, {638982.55, 853535.43, 586.38}}, 1, 0},
        {"formats/ptx/complex-transform.ptx", 4, 4, {{-3.0344073807900003, -3.173781036324, -1.825114624726}, {-3.034359790078, -3.168529920986, -1.822068350012}}, 1, 1},
        {"formats/ptx/multiple-and-transform.ptx", 8, 8, {{636699.38, 848991.01, 425.39}, {637012.24, 849106.66, 446.39}}, 2, 1},
        {"formats/ptx/no-color.ptx", 15, 15, {{635795.24, 848991.01, 408.6}, {637012.24, 849390.78, 446.39}}, 1, 0},
        {"formats/pcd/autzen-utm.pcd", 1065, 1065, {{493994.87, 4877429.62, 123.93}, {494993.68, 4878817.0200000005, 178.73}}, 1, 0},
        {"formats/pcd/utm17_comma.pcd", 10, 10, {{289814.15, 4320978.61, 170.58}, {289818.5, 4320980.59, 170.76}}, 1, 0},
        {"formats/pcd/utm17_space.pcd", 10, 10, {{289814.15, 4320978.61, 170.58}, {289818.5, 4320980.59, 170.76}}, 1, 0},
        {"formats/pcd/utm17_tab.pcd", 10, 10, {{289814.15, 4320978.61, 170.58}, {289818.5, 4320980.59, 170.76}}, 1, 0},
        {"formats/las/1.2-with-color.las", 1065, 1065, {{635619.85, 848899.7000000001, 406.59000000000003}, {638982.55, 853535.43, 586.38}}, 1, 0},
        {"formats/las/100-points.las", 100, 100, {{635717.85, 848953.74, 409.19}, {638944.9500000001, 853483.3, 530.61}}, 1, 0},
        {"formats/las/4_6_crop.las", 23875, 23875, {{1639600.0, 1454500.02, 7077.92}, {1639799.98, 1454700.0, 7139.7}}, 1, 0},
        {"formats/las/bad_vlr_count.las", 10, 10, {{289814.15, 4320978.61, 170.58}, {289818.5, 4320980.59, 170.76}}, 1, 0},
        {"formats/las/extrabytes.las", 1065, 1065, {{635619.85, 848899.7000000001, 406.59000000000003}, {638982.55, 853535.43, 586.38}}, 1, 0},
        {"formats/las/gps-time-nan.las", 1, 1, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, 1, 0},
        {"formats/las/interesting.las", 1065, 1065, {{635619.85, 848899.7000000001, 406.59000000000003}, {638982.55, 853535.43, 586.38}}, 1, 0},
        {"formats/las/no-points.las", 0, 0, {}, 0, 0},
        {"formats/las/prec3.las", 110, 110, {{636034.83, 848941.72, 407.32}, {637177.98, 849442.38, 496.19}}, 1, 0},
        {"formats/las/simple.las", 1065, 1065, {{635619.85, 848899.7000000001, 406.59000000000003}, {638982.55, 853535.43, 586.38}}, 1, 0},
        {"formats/las/simple1_4.las", 22600, 22600, {{1.0, 1.0, 44.0}, {226.00000000000003, 100.00000000000003, 254.0}}, 1, 0},
        {"formats/las/spurious.las", 1065, 1065, {{-124.0687348, 44.0500086, 123.93}, {-123.0625001, 44.062497199999996, 178.73}}, 1, 0},
        {"formats/las/synthetic_test.las", 1, 1, {{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}}, 1, 0},
        {"formats/las/test1_4.las", 1000, 1000, {{1694038.4456374517, 1816492.7062700584, 5592.7499174683535}, {1694539.677014474, 1816497.9762624602, 5599.069686751426}}, 1, 0},
        {"formats/las/utm15.las", 1, 1, {{470692.44, 4602888.9, 16.0}, {470692.44, 4602888.9, 16.0}}, 1, 0},
        {"formats/las/vegetation_1_3.las", 10683, 10683, {{-98451.205, -55975.417, -81460.091}, {-98447.447, -55969.405, -81455.203}}, 1, 0},
        {"ignatius/99.npz", 10000, 10000, {{-0.28094682212417316, -0.2613720421202847, -0.4072239596882981}, {0.3085198445424935, 0.3286612912130486, 0.4203093736450354}}, 1, 8},
        {"reconbench/anchor_mvs.npz", 3000, 3000, {{-37.51860379458233, -23.471559451559692, -32.08193675904631}, {37.527743840290356, 23.472213928766866, 32.00229557372171}}, 1, 10},
        {"reconbench/gargoyle_mvs.npz", 3000, 3000, {{-34.582719389881866, -37.24606006383558, -25.819623477811955}, {31.966514324402, 37.22891478514069, 26.79611349932095}}, 1, 10},
        {"reconbench/lordquas_mvs.npz", 3000, 3000, {{-18.419247032004325, -37.460760198173816, -17.498084789147033}, {18.415821014518066, 36.89121073982383, 17.0245350185508}}, 1, 10},
        {"reconbench/anchor_points.npz", 100000, 100000, {{-55.875, -43.65625, -51.6875}, {59.625, 48.0625, 50.59375}}, 1, 0},
        {"range_images/capture0001.pcd", 307200, 249647, {{-1.7228200435638428, -1.1952769756317139, 1.5119999647140503}, {1.223436951637268, 0.7809628844261169, 3.1570000648498535}}, 1, 1},
        {"range_images/milk_cartoon_all_small_clorox.pcd", 307200, 241407, {{-1.0607999563217163, -0.21966859698295593, -2.062999963760376}, {1.152493953704834, 0.8692334294319153, -0.5009999871253967}}, 1, 1},
    }));
// clang-format on

struct Refused {
  const char* path;
  const char* said;
};
const std::vector<Refused> refused_files = {
    {"formats/e57/bad-crc.e57", "checksum of page 0 is wrong, at byte 0"},
    {"formats/e57/empty.e57", "holds no scan at byte 88"},
    {"formats/e57/test filename äöü.e57", "holds no scan at byte 88"},
    {"formats/e57/测试点云.e57", "holds no scan at byte 88"},
    {"formats/e57/PinholeImageWithDistortionParameters.e57", "holds no scan at byte 1268"},
    {"formats/pcd/missingheader.pcd", "missingheader.pcd:1"},
    {"formats/las/garbage_nVariableLength.las", "promises 719 points of 20 bytes, but the file ends at byte 14601 ("},
    {"formats/las/simple.laz", "compressed (LAZ), which is not read, at byte 104"},
    {"ignatius/99_3dt.npz", "no array is named 'points' among 'vertices'"}};

TEST(IoScannerFilesRefused, NamePlaceAndCause) {
  EIGENCRUST_NEED_DATA(data_path("formats/e57"));
  for (const Refused& file : refused_files)
    EXPECT_THAT(error_of([&] { read_point_cloud(data_path(file.path)); }), HasSubstr(file.said)) << file.path;
}

TEST(IoScannerFilesValues, SensorsAndColumns) {
  EIGENCRUST_NEED_DATA(data_path("formats/ptx"));
  const PointCloud two = read_point_cloud(data_path("formats/ptx/multiple-and-transform.ptx"));
  EXPECT_EQ(two.sensors[0].place, (Vec3{600000, 800000, 400}));
  EXPECT_EQ(two.sensor_of[3], 0u);
  EXPECT_EQ(two.sensor_of[4], PointCloud::no_sensor);

  const PointCloud shifted = read_point_cloud(data_path("formats/e57/translationWithoutRotation.e57"));
  EXPECT_EQ(shifted.sensors[0].place, (Vec3{4, 5, 6}));

  const PointCloud dims = read_point_cloud(data_path("formats/e57/A_B_different_dims.e57"));
  EXPECT_NEAR(attribute_value(*find_attribute(dims.attributes, "intensity"), 0), 0.75964826, 1e-7);
  EXPECT_TRUE(std::isnan(attribute_value(*find_attribute(dims.attributes, "intensity"), 1)));
  EXPECT_NE(find_attribute(dims.attributes, "red"), nullptr);

  const PointCloud kinect =
      read_point_cloud(data_path("range_images/capture0001.pcd"), {.pcd_viewpoint = PcdViewpoint::sensor});
  EXPECT_EQ(kinect.sensors[0].place, (Vec3{0, 0, 0}));

  // Both bunnies hold the same points, one as doubles, one in millionths.
  const PointCloud a = read_point_cloud(data_path("formats/e57/bunnyDouble.e57"));
  const PointCloud b = read_point_cloud(data_path("formats/e57/bunnyInt32.e57"));
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) ASSERT_LT(distance(a.points[i], b.points[i]), 1e-6) << i;
}

// First and last record as an independent script unpacked them.
TEST(IoScannerFilesValues, ColumnsOfLas) {
  EIGENCRUST_NEED_DATA(data_path("formats/las/extrabytes.las"));
  ReadNotes notes;
  const PointCloud cloud = read_point_cloud(data_path("formats/las/extrabytes.las"), {}, &notes);
  EXPECT_THAT(notes.notes, ::testing::ElementsAre("7 bytes of each point without a description left out"));
  const auto value = [&](const char* name, std::size_t row) {
    return attribute_value(*find_attribute(cloud.attributes, name), row);
  };
  EXPECT_EQ(value("intensity", 0), 143);
  EXPECT_EQ(value("Intensity", 1064), 116);
  EXPECT_EQ(value("Time", 0), 245380);
  EXPECT_EQ(value("Colors", 2), 88);
  EXPECT_EQ(value("Flags", 1), 1);
  EXPECT_EQ(value("return_number", 0), 1);
  EXPECT_EQ(value("number_of_returns", 0), 1);
  EXPECT_EQ(value("scan_direction_flag", 0), 1);
  EXPECT_EQ(value("scan_angle_rank", 0), -9);
  EXPECT_EQ(value("user_data", 1064), 124);
  EXPECT_EQ(value("point_source_id", 1064), 7334);
  EXPECT_EQ(value("gps_time", 1064), 249773.20172406783);
  EXPECT_EQ(value("blue", 1064), 136);

  const PointCloud modern = read_point_cloud(data_path("formats/las/simple1_4.las"));
  EXPECT_EQ(attribute_value(*find_attribute(modern.attributes, "green"), 0), 26624);
  const PointCloud without_time = read_point_cloud(data_path("formats/las/gps-time-nan.las"));
  EXPECT_TRUE(std::isnan(attribute_value(*find_attribute(without_time.attributes, "gps_time"), 0)));
}

} // namespace
} // namespace eigencrust
