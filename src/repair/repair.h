// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Labels whose surface is a manifold, without handles of noise (§3.5).
#pragma once

#include "settle/settle.h"

namespace eigencrust {

/// The stages manifold, handles and recover; with the paper's rule, or without a manifold, less.
TetrahedronLabels repair(const Scene& scene, const Evidence& evidence, Settled settled, const Context& context);

} // namespace eigencrust
