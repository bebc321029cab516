// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How the C library's heap gets its pages from the system (docs/decisions/0022).
#pragma once

namespace eigencrust::cli {

/// Freed arrays stay with the process. Stage after stage takes arrays of the same size, and fresh pages are slow. All
/// threads share them: what one frees another may need. To be called first of all.
void keep_freed_memory();

/// Asks for large pages where the heap has grown since the last call: fewer of them have to be fetched and found.
/// For several threads at once. Does nothing where the system gives none.
void enlarge_new_pages();

} // namespace eigencrust::cli
