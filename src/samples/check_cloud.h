// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Is the cloud what it says?
#pragma once

#include <eigencrust/types.h>

namespace eigencrust {

/// \throws Error{input} when an array of the cloud has the wrong length
void check_cloud(const PointCloud& cloud);

} // namespace eigencrust
