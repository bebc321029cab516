// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All other threads of the process stand still for a while.
#pragma once

namespace eigencrust::cli {

/// The other threads that there are when it is made stand still until it goes, each from the moment at which it gets
/// its signal: threads that start later go on, and nobody waits for those that are slow to stop. They may hold any
/// lock, that of `new` among them, so nothing may be allocated meanwhile. One at a time. SIGURG is taken for it, for
/// good, which does nothing to a process that does not know it; what it interrupts goes on afterwards, but for the few
/// system calls that end with EINTR.
class OtherThreadsPaused {
 public:
  OtherThreadsPaused();
  ~OtherThreadsPaused();
  OtherThreadsPaused(const OtherThreadsPaused&) = delete;
  OtherThreadsPaused& operator=(const OtherThreadsPaused&) = delete;
};

} // namespace eigencrust::cli
