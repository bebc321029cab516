// SPDX-License-Identifier: GPL-3.0-or-later
// Read by the leak sanitizer alone.

/// lib3mf 1.8.1 lets go of a source of libzip, 160 bytes for each file that it writes: all frames of those leaks lie
/// within the packaged libzip.
extern "C" const char* __lsan_default_suppressions() { return "leak:libzip.so\n"; } // NOLINT: the sanitizer's name
