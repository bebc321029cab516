// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parts of the module eigencrust._core.
#pragma once

#include <memory>

#include "arrays.h"

namespace eigencrust::python {

/// A PointCloud as it is, anything else as points. \throws Error{input}
std::shared_ptr<PointCloud> to_cloud(const py::object& points);

void bind_errors();
void bind_clouds(py::module_& module);
void bind_options(py::module_& module);
void bind_files(py::module_& module);
void bind_metrics(py::module_& module);
void bind_pictures(py::module_& module);
void bind_reconstruct(py::module_& module);
void bind_stage_types(py::module_& stages);
void bind_stages(py::module_& stages);

} // namespace eigencrust::python
