// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What orient and classify share: the cloud goes out with more columns than it came in with.
#pragma once

#include "method.h"

namespace eigencrust::cli {

/// Takes the place of the attribute of that name, in upper or lower case, or comes last.
void set_attribute(PointCloud& cloud, Attribute attribute);

/// Writes run.cloud, the report and the summary. \return the exit status
int write_points(MethodRun& run, const Request& request, bool drop_outliers);

} // namespace eigencrust::cli
