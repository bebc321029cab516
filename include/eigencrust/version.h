// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The library's version. The number itself is typed once, in CMakeLists.txt.
#pragma once

namespace eigencrust {

/// MAJOR.MINOR.PATCH
const char* version();

} // namespace eigencrust
