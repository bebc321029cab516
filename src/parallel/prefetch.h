// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Memory that is needed soon.
#pragma once

namespace eigencrust {

/// Asks the processor to fetch it meanwhile. Changes nothing but time.
template <class T>
inline void prefetch(const T& soon) {
#ifdef __GNUC__
  __builtin_prefetch(&soon);
#endif
}

} // namespace eigencrust
