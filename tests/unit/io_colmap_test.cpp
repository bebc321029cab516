// SPDX-License-Identifier: GPL-3.0-or-later
// What COLMAP writes beside a fused cloud.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <eigencrust/io.h>

#include "e57_bytes.h"
#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// One image: its number, pose, camera and name, and two observations.
std::string image(std::initializer_list<double> q_and_t, const std::string& name) {
  return raw_bytes<std::uint32_t>({77}) + raw_bytes<double>(q_and_t) + raw_bytes<std::uint32_t>({1}) + name + '\0' +
         raw_bytes<std::uint64_t>({2}) + std::string(48, 'o');
}

/// Cameras at (0, 0, 10), (4, 0, 10) and (-1, -2, -3): the first two look along +z without a turn; the third
/// is turned by a quarter about z (x -> y), so that t = -R c with c = (-1, -2, -3) is (-2, 1, 3).
std::string three_images() {
  const double half = std::sqrt(0.5);
  return raw_bytes<std::uint64_t>({3}) + image({1, 0, 0, 0, 0, 0, -10}, "a.jpg") +
         image({2, 0, 0, 0, -4, 0, -10}, "b.jpg") + image({half, 0, 0, half, -2, 1, 3}, "c.jpg");
}

/// Seen by none, by the first, by all, and by the first two of which the second is nearer to the mean.
const std::string visibility = raw_bytes<std::uint64_t>({3}) + raw_bytes<std::uint32_t>({0}) +
                               raw_bytes<std::uint32_t>({1, 0}) + raw_bytes<std::uint32_t>({3, 2, 1, 0});

class IoColmap : public ::testing::Test {
 protected:
  IoColmap() {
    std::filesystem::create_directory(folder_ / "sparse");
    write_bytes(folder_ / "fused.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                "end_header\n9 9 9\n0 0 0\n1 0 0\n");
    write_bytes(folder_ / "fused.ply.vis", visibility);
  }
  PointCloud read(const ReadOptions& options = {}) {
    notes_ = {};
    return read_point_cloud(folder_ / "fused.ply", options, &notes_);
  }
  std::string error() {
    return error_of([&] { read(); });
  }

  TempDir folder_;
  ReadNotes notes_;
};

TEST_F(IoColmap, CameraNearestToTheMeanDirection) {
  write_bytes(folder_ / "sparse/images.bin", three_images());
  const PointCloud cloud = read();
  ASSERT_EQ(cloud.sensors.size(), 3u);
  EXPECT_EQ(cloud.sensors[0].place, (Vec3{0, 0, 10}));
  EXPECT_EQ(cloud.sensors[1].place, (Vec3{4, 0, 10}));
  EXPECT_LT(distance(cloud.sensors[2].place, {-1, -2, -3}), 1e-12);
  // From (1, 0, 0) the unit directions are (-0.10, 0, 1.00), (0.29, 0, 0.96) and (-0.49, -0.49, -0.73); they
  // add up to (-0.30, -0.49, 1.23). Its products with them are 1.25, 1.09 and -0.50: the first.
  EXPECT_THAT(cloud.sensor_of, ElementsAre(PointCloud::no_sensor, 0, 0));
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("fused.ply.vis and")));
  EXPECT_THAT(read({.sensors = false}).sensors, IsEmpty());
}

TEST_F(IoColmap, TextAndTheSameFolder) {
  // The second line of an image may be empty. An image that only looks like a comment is one.
  write_bytes(folder_ / "images.txt",
              "# Image list\n#   IMAGE_ID, QW, ...\n5 1 0 0 0 0 0 -10 1 a.jpg\n1.5 2.5 -1\n\n"
              "4 2 0 0 0 -4 0 -10 1 b c.jpg\r\n\r\n9 0.7071067811865476 0 0 0.7071067811865476 -2 1 3 1 c.jpg\n");
  const PointCloud cloud = read();
  ASSERT_EQ(cloud.sensors.size(), 3u);
  EXPECT_EQ(cloud.sensors[1].place, (Vec3{4, 0, 10}));
  EXPECT_LT(distance(cloud.sensors[2].place, {-1, -2, -3}), 1e-12);
}

TEST_F(IoColmap, TiesGoToTheOneNamedFirst) {
  write_bytes(folder_ / "images.txt", "1 1 0 0 0 0 0 -10 1 a\n\n2 1 0 0 0 0 0 -20 1 b\n\n");
  write_bytes(folder_ / "fused.ply.vis", raw_bytes<std::uint64_t>({3}) + raw_bytes<std::uint32_t>({0}) +
                                             raw_bytes<std::uint32_t>({2, 1, 0}) + raw_bytes<std::uint32_t>({0}));
  // From the origin both lie straight along z.
  EXPECT_THAT(read().sensor_of, ElementsAre(PointCloud::no_sensor, 1, PointCloud::no_sensor));
}

TEST_F(IoColmap, WithoutImagesTheVisibilityIsNotUsed) {
  EXPECT_THAT(read().sensors, IsEmpty());
  EXPECT_THAT(notes_.notes, ElementsAre(HasSubstr("fused.ply.vis is not used")));
}

TEST_F(IoColmap, FilesThatDoNotFit) {
  const auto with_visibility = [&](const std::string& bytes) {
    std::filesystem::remove(folder_ / "fused.ply.vis");
    write_bytes(folder_ / "fused.ply.vis", bytes);
    return error();
  };
  const auto with_images = [&](const std::string& bytes) {
    std::filesystem::remove(folder_ / "sparse/images.bin");
    write_bytes(folder_ / "sparse/images.bin", bytes);
    return error();
  };
  const std::string images = three_images();
  EXPECT_EQ(with_images(images), "");
  EXPECT_THAT(with_visibility(visibility.substr(0, 7)), HasSubstr("ends before its count, at byte 7"));
  for (const std::size_t size : {8, 11, 12, 19, 35})
    EXPECT_THAT(with_visibility(visibility.substr(0, size)), HasSubstr("the file ends within point")) << size;
  EXPECT_THAT(with_visibility(visibility + "1"), HasSubstr("goes on behind the last point, at byte 36"));
  EXPECT_THAT(with_visibility("\4" + visibility.substr(1)), HasSubstr("speaks of 4 points, the cloud has 3"));
  EXPECT_THAT(with_visibility(visibility.substr(0, 8) + "\xff\xff\xff\xff" + visibility.substr(12)),
              HasSubstr("the file ends within point 0"));
  EXPECT_THAT(with_visibility(visibility.substr(0, 16) + "\3" + visibility.substr(17)),
              HasSubstr("point 1 names image 3 of 3, at byte 12"));
  write_bytes(folder_ / "fused.ply.vis", visibility);
  for (std::size_t size = 0; size < images.size(); ++size)
    EXPECT_THAT(with_images(images.substr(0, size)), HasSubstr("the list of images ends early")) << size;
  std::string bad = images;
  bad.replace(12, 32, std::string(32, '\0'));
  EXPECT_THAT(with_images(bad), HasSubstr("the pose of image 0 is none, at byte 12"));
  std::filesystem::remove(folder_ / "sparse/images.bin");
  write_bytes(folder_ / "images.txt", "# c\n1 1 0 0 0 0 0 x 1 a\n\n");
  EXPECT_THAT(error(), HasSubstr("images.txt:2"));
}

} // namespace
} // namespace eigencrust
