// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Columns of values whose type is known at run time only.
#pragma once

#include <eigencrust/types.h>

namespace eigencrust {

/// Each value becomes the nearest one of the type.
void convert_to(Attribute& attribute, ScalarType type);

} // namespace eigencrust
