// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The files that COLMAP writes beside a fused cloud: which images saw each point, and where they were taken.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <eigencrust/types.h>

#include "io/file_content.h"

namespace eigencrust::io {

/// Places of the cameras, -R^T t, in the order of the file. \param file images.bin or images.txt, by its name
std::vector<Vec3> read_colmap_images(const FileContent& file);

/// Gives each point the camera, of those that saw it, which is nearest to their mean direction; ties go to
/// the one named first. Points that none saw have no sensor.
/// \param file the visibility (.vis): how many points, then for each how many images and their numbers
/// \throws Error{input} when it does not go with the points or the cameras
void set_colmap_sensors(PointCloud& cloud, const FileContent& file, const std::vector<Vec3>& cameras);

/// images.bin or images.txt in the folder of the cloud or in its folder sparse.
std::optional<std::filesystem::path> find_colmap_images(const std::filesystem::path& cloud);

} // namespace eigencrust::io
