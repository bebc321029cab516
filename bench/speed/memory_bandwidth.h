// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How fast this machine reads and writes memory, which bounds everything after the Delaunay.
#pragma once

namespace eigencrust::bench {

/// Bytes per second of a = b + s c over arrays much larger than the caches (the triad of McCalpin's STREAM, 1995:
/// 24 bytes counted per element), the best of several rounds.
double triad_bandwidth(unsigned threads);

} // namespace eigencrust::bench
