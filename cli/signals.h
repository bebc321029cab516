// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Signals that ask the program to end: at once, and with nothing left behind.
#pragma once

namespace eigencrust::cli {

/// From here on SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU and SIGPIPE ask the running stage to stop. Where it has not
/// within 0.3 s (it waits for a pipe, say), or at a second signal, temporaries are removed and the process ends with
/// status 130. SIGXFSZ is ignored: the write that went too far says so. What was ignored from the start stays so for
/// SIGHUP and SIGPIPE (nohup). An exception that nobody can catch ends the process in the same way, with the status of
/// its kind.
void catch_interrupts();
bool interrupted();

/// While files take their places no signal ends the process: all of them, or none.
class Commit {
 public:
  Commit();
  ~Commit();
  Commit(const Commit&) = delete;
  Commit& operator=(const Commit&) = delete;
  /// The files are there. From now on a signal ends the process with this status.
  void done(int status);
};
/// The status that was given to Commit::done: nothing that fails later undoes the run. -1: no file is there.
int status_of_files();
/// Another verb begins.
void forget_files();

} // namespace eigencrust::cli
