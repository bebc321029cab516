// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sheets of samples that the labels leave out (not in the paper; docs/decisions/0050).
#pragma once

#include <eigencrust/report.h>

#include "repair/moves.h"

namespace eigencrust {

/// Samples side by side of which all lie outside, on no surface, though there is little noise: of a
/// wall whose other side was not scanned, behind which nothing is solid then. Where they are taken in one by one later,
/// what is around them is torn.
PassedSheetsReport passed_sheets(const Moves& moves);

} // namespace eigencrust
