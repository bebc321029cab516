// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points as CGAL's exact predicates take them.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <eigencrust/types.h>

namespace eigencrust {

using ExactPredicates = CGAL::Exact_predicates_inexact_constructions_kernel;

inline ExactPredicates::Point_3 to_cgal(const Vec3& p) { return {p.x, p.y, p.z}; }

} // namespace eigencrust
