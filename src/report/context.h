// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What every chapter is given beside its input.
#pragma once

#include <eigencrust/options.h>

#include "parallel/threads.h"
#include "report/run.h"

namespace eigencrust {

struct Context {
  const Options& options;
  Run& run;
  const Threads& threads;
};

} // namespace eigencrust
