// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What orient and outliers share: the cloud goes out with more columns than it came in with.
#pragma once

#include "method.h"

namespace eigencrust::cli {

/// Takes the place of the attribute of that name, in upper or lower case, or comes last.
void set_attribute(PointCloud& cloud, Attribute attribute);

/// Which rows are written: all, inliers or outliers.
void add_keep_option(OptionTable& app, std::string& keep);

/// No mesh is kept, so none is fitted a second time: what is said of points looks at a fitted surface of its own.
Options options_for_points(const Request& request);

/// Writes run.cloud, the report and the summary. \param keep as the option says; empty: all
/// \return the exit status
int write_points(MethodRun& run, const Request& request, const std::string& keep);

} // namespace eigencrust::cli
