// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The files that tell the scan of each point and the sensor of each scan, once their bytes are in memory.
#pragma once

#include <vector>

#include <eigencrust/types.h>

#include "io/file_content.h"

namespace eigencrust::io {

/// As read_scan_index() in io.h; bytes or text by the file's name.
std::vector<std::uint32_t> read_scan_index(const FileContent& file, std::size_t points);
/// As read_scan_sensors() in io.h.
void read_scan_sensors(const FileContent& file, PointCloud& cloud);

} // namespace eigencrust::io
