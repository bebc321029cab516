// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Labels whose surface is a manifold, without handles of noise and spikes (§3.5).
#pragma once

#include "settle/settle.h"

namespace eigencrust {

/// The stages manifold, handles, recover and spikes, as the options say.
/// \param poles what the first stage settled
TetrahedronLabels repair(const Scene& scene, const Evidence& evidence, const PoleLabels& poles, Settled settled,
                         const Context& context);

} // namespace eigencrust
