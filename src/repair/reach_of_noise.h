// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How large a handle or a piece noise makes, and what it is worth to be rid of it (docs/decisions/0027).
#pragma once

#include <cstdint>
#include <span>

#include "samples/sample_model.h"

namespace eigencrust {

/// No handle or piece of noise is wider, in spacings, however strong the noise: its samples fill a band, in which a
/// tunnel or a bridge is some tetrahedra wide. What costs more to close goes through something that is there: a bar, a
/// window.
constexpr double widest_reach = 5;

/// The radius of handles and pieces that noise makes at these samples, in spacings.
double reach_of_noise(const SampleModel& model, std::span<const std::uint32_t> samples);

/// g: what a handle or a piece of that radius less is worth. Closing it turns faces over a disc of that radius, two for
/// each sample, which cost about one each.
double worth_of_reach(double reach);

/// No set of tetrahedra that costs less than that is larger: each costs a good part of one.
std::uint64_t most_tetrahedra(double worth);

} // namespace eigencrust
