// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From input rows to samples.
#pragma once

#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// The sample of each row, duplicates included; invalid for rows that are not finite.
std::vector<SampleIndex> samples_of_rows(const PointCloud& cloud, const Tetrahedralization& tetrahedralization);

} // namespace eigencrust
