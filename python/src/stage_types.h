// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What Python holds of the stages beside the library's own types.
#pragma once

#include <eigencrust/stages.h>

#include "bindings.h"

namespace eigencrust::python {

/// A partition with the component of every node, where the stage tells it.
struct SolvedPartition : Partition {
  std::vector<std::uint32_t> component;
};

struct SightLines {
  std::vector<SightLine> lines;
};

} // namespace eigencrust::python
