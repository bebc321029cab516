// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The triangulation that tells how far it is.
#pragma once

#include <eigencrust/stages.h>

namespace eigencrust {

/// As in stages.h. \param checkpoint is called by the thread that called this, now and then; may throw
Tetrahedralization tetrahedralize(Samples samples, const Threads& threads, const std::function<void()>& beside,
                                  const Checkpoint& checkpoint);

} // namespace eigencrust
