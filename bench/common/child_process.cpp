// SPDX-License-Identifier: GPL-3.0-or-later
#include "child_process.h"

#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>

#include <eigencrust/error.h>

namespace eigencrust::bench {
namespace {

[[noreturn]] void fail(const std::string& program, const std::string& cause) {
  throw Error(ErrorKind::guarantee, program, cause, "look at what it printed");
}

double seconds_of(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

using Clock = std::chrono::steady_clock;
using Deadline = std::optional<Clock::time_point>; ///< none: never

/// Milliseconds until then, as poll() wants them; not all at once, for a deadline may be far.
int patience(const Deadline& deadline) {
  constexpr std::int64_t longest = 60'000;
  if (!deadline) return -1;
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(*deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left + 1, 0, longest));
}

bool passed(const Deadline& deadline) { return deadline && Clock::now() >= *deadline; }

/// Reads to the end, or until then, and closes.
std::string read_all(int descriptor, const Deadline& deadline) {
  std::string text;
  std::array<char, 4096> buffer{};
  while (!passed(deadline)) {
    pollfd ready{descriptor, POLLIN, 0};
    if (poll(&ready, 1, patience(deadline)) <= 0) continue; // too late, or interrupted
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  close(descriptor);
  return text;
}

/// Waits for the end of the child, which is killed when it is too late. \return whether it was
bool wait_for(pid_t child, const Deadline& deadline, const std::string& program, int& status, rusage& usage) {
  constexpr std::chrono::milliseconds nap(2); // between looks at a child that has closed its output
  bool killed = false;
  for (;;) {
    if (!killed && passed(deadline)) {
      kill(child, SIGKILL);
      killed = true;
    }
    const pid_t ended = wait4(child, &status, deadline && !killed ? WNOHANG : 0, &usage);
    if (ended == child) return killed;
    if (ended < 0 && errno != EINTR) fail(program, std::string("cannot wait for it: ") + std::strerror(errno));
    if (ended == 0) std::this_thread::sleep_for(nap);
  }
}

/// In the child: becomes the program, with stdout in the pipe.
[[noreturn]] void become(char* const* arguments, const int (&ends)[2], const ChildLimits& limits) {
  const rlimit space{limits.bytes, limits.bytes};
  if (limits.bytes > 0 && setrlimit(RLIMIT_AS, &space) != 0) _exit(127);
  const auto seconds = static_cast<rlim_t>(std::ceil(limits.processor_seconds));
  constexpr rlim_t grace = 5; // for one that does not end by the signal at the first limit
  const rlimit time{seconds, seconds + grace};
  if (seconds > 0 && setrlimit(RLIMIT_CPU, &time) != 0) _exit(127);
  dup2(ends[1], STDOUT_FILENO);
  close(ends[0]);
  close(ends[1]);
  execv(arguments[0], arguments);
  _exit(127);
}

} // namespace

ChildRun run_child(const std::vector<std::string>& command, const ChildLimits& limits) {
  std::vector<std::string> words = command; // exec wants them writable
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  int ends[2];
  if (pipe(ends) != 0) fail(command[0], std::string("no pipe: ") + std::strerror(errno));

  ChildRun run;
  const auto start = Clock::now();
  Deadline deadline;
  if (limits.seconds > 0)
    deadline = start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds));
  const pid_t child = fork();
  if (child < 0) fail(command[0], std::string("no new process: ") + std::strerror(errno));
  if (child == 0) become(arguments.data(), ends, limits);
  close(ends[1]);
  run.output = read_all(ends[0], deadline);
  int status = 0;
  rusage usage{};
  run.stopped = wait_for(child, deadline, command[0], status, usage);
  // The kernel counts by ticks what it limits: the time that it tells may be less.
  if (limits.processor_seconds > 0 && WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) run.stopped = true;
  run.wall_seconds = std::chrono::duration<double>(Clock::now() - start).count();

  if (!run.stopped) {
    if (WIFSIGNALED(status)) fail(command[0], "ended by signal " + std::to_string(WTERMSIG(status)));
    if (WEXITSTATUS(status) == 127) fail(command[0], "could not be run");
    if (WEXITSTATUS(status) != 0) fail(command[0], "ended with status " + std::to_string(WEXITSTATUS(status)));
  }
  run.user_seconds = seconds_of(usage.ru_utime);
  run.system_seconds = seconds_of(usage.ru_stime);
  run.peak_memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  return run;
}

} // namespace eigencrust::bench
