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
        {"range_images/capture0001.pcd", 307200, 249647, {{-1.7228200435638428, -1.1952769756317139, 1.5119999647140503}, {1.223436951637268, 0.7809628844261169, 3.1570000648498535}}, 1, 0},
        {"range_images/milk_cartoon_all_small_clorox.pcd", 307200, 241407, {{-1.0607999563217163, -0.21966859698295593, -2.062999963760376}, {1.152493953704834, 0.8692334294319153, -0.5009999871253967}}, 1, 0},
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
    {"formats/pcd/missingheader.pcd", "missingheader.pcd:1"}};

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

} // namespace
} // namespace eigencrust
