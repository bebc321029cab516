// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap.h"

#include <array>
#include <cstring>
#include <limits>
#include <span>

#include "io/bytes.h"
#include "io/pose.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr const char* images_remedy = "export the sparse model anew";
constexpr const char* vis_remedy =
    "put the .vis file there that was written with the cloud, or rename it if its sensors do not matter";

/// \return false when the seven numbers are no pose
bool add_camera(const std::array<double, 7>& q_and_t, std::vector<Vec3>& cameras) {
  const auto& [qw, qx, qy, qz, tx, ty, tz] = q_and_t;
  Pose pose;
  if (!set_rotation(pose, qw, qx, qy, qz)) return false;
  cameras.push_back(-tx * pose.rows[0] - ty * pose.rows[1] - tz * pose.rows[2]);
  return is_finite(cameras.back());
}

std::vector<Vec3> read_binary_images(const FileContent& file) {
  constexpr std::size_t head = 64, observation = 24; // id, pose, camera; x, y and the point's number
  const std::string_view bytes = file.bytes();
  const auto fail_end = [&] { file.fail_at_byte(bytes.size(), "the list of images ends early,", images_remedy); };
  if (bytes.size() < 8) fail_end();
  const auto count = value_at<std::uint64_t>(bytes, 0);
  std::vector<Vec3> cameras;
  std::size_t at = 8;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (bytes.size() - at < head) fail_end();
    std::array<double, 7> pose{};
    std::memcpy(pose.data(), bytes.data() + at + 4, sizeof pose);
    if (!add_camera(pose, cameras))
      file.fail_at_byte(at + 4, "the pose of image " + std::to_string(i) + " is none,", images_remedy);
    const std::size_t name_end = bytes.find('\0', at + head);
    if (name_end == std::string_view::npos || bytes.size() - name_end - 1 < 8) fail_end();
    const auto observations = value_at<std::uint64_t>(bytes, name_end + 1);
    at = name_end + 9;
    if (observations > (bytes.size() - at) / observation) fail_end();
    at += observations * observation;
  }
  return cameras;
}

/// Two lines per image: number, pose, camera, name; then what it saw, perhaps nothing.
std::vector<Vec3> read_text_images(const FileContent& file) {
  std::vector<Vec3> cameras;
  LineScanner lines(file);
  Fields words;
  while (lines.next()) {
    split_words(lines.line(), words);
    if (words.empty() || words[0].starts_with('#')) continue;
    std::array<double, 7> pose{};
    bool good = words.size() >= 9;
    for (std::size_t k = 0; good && k < pose.size(); ++k) good = parse(words[k + 1], pose[k]);
    if (!good || !add_camera(pose, cameras))
      lines.fail("the line is no image: number, qw qx qy qz, tx ty tz, camera, name", images_remedy);
    lines.next();
  }
  return cameras;
}

/// Which of the cameras is nearest to the mean direction in which they lie?
std::uint32_t choose_camera(const Vec3& p, std::span<const std::uint32_t> seen_by, const std::vector<Vec3>& cameras) {
  const auto direction = [&](std::uint32_t camera) {
    const Vec3 d = cameras[camera] - p;
    const double length = norm(d);
    return length > 0 ? (1 / length) * d : Vec3{};
  };
  Vec3 sum;
  for (const std::uint32_t camera : seen_by) sum = sum + direction(camera);
  std::uint32_t best = PointCloud::no_sensor;
  double largest = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t camera : seen_by) {
    const double cosine = dot(sum, direction(camera));
    if (cosine <= largest) continue;
    largest = cosine;
    best = camera;
  }
  return best;
}

} // namespace

std::vector<Vec3> read_colmap_images(const FileContent& file) {
  const bool is_text = equal_ignoring_case(std::filesystem::path(file.name()).extension().string(), ".txt");
  return is_text ? read_text_images(file) : read_binary_images(file);
}

void set_colmap_sensors(PointCloud& cloud, const FileContent& file, const std::vector<Vec3>& cameras) {
  const std::string_view bytes = file.bytes();
  if (bytes.size() < 8) file.fail_at_byte(bytes.size(), "the file ends before its count,", vis_remedy);
  if (const auto count = value_at<std::uint64_t>(bytes, 0); count != cloud.points.size())
    file.fail("the file speaks of " + plural(count, "point") + ", the cloud has " + std::to_string(cloud.points.size()),
              vis_remedy);
  std::vector<std::uint32_t> sensor_of(cloud.points.size(), PointCloud::no_sensor), seen_by;
  std::size_t at = 8;
  for (std::size_t i = 0; i < sensor_of.size(); ++i) {
    const std::size_t left = (bytes.size() - at) / 4;
    const std::uint32_t n = left > 0 ? value_at<std::uint32_t>(bytes, at) : 0;
    if (left == 0 || n > left - 1)
      file.fail_at_byte(bytes.size(), "the file ends within point " + std::to_string(i) + ",", vis_remedy);
    seen_by.resize(n);
    if (n > 0) std::memcpy(seen_by.data(), bytes.data() + at + 4, 4 * std::size_t{n});
    for (const std::uint32_t image : seen_by)
      if (image >= cameras.size())
        file.fail_at_byte(at,
                          "point " + std::to_string(i) + " names image " + std::to_string(image) + " of " +
                              std::to_string(cameras.size()) + ",",
                          vis_remedy);
    at += 4 + 4 * std::size_t{n};
    if (is_finite(cloud.points[i])) sensor_of[i] = choose_camera(cloud.points[i], seen_by, cameras);
  }
  if (at != bytes.size()) file.fail_at_byte(at, "the file goes on behind the last point,", vis_remedy);
  cloud.sensor_of = std::move(sensor_of);
  cloud.sensors.clear();
  for (const Vec3& place : cameras) cloud.sensors.push_back({place, false});
}

std::optional<std::filesystem::path> find_colmap_images(const std::filesystem::path& cloud) {
  const std::filesystem::path folder = cloud.parent_path();
  std::error_code ignored;
  for (const auto& place : {folder, folder / "sparse"})
    for (const char* name : {"images.bin", "images.txt"})
      if (std::filesystem::is_regular_file(place / name, ignored)) return place / name;
  return std::nullopt;
}

} // namespace eigencrust::io
