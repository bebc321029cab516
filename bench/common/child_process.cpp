// SPDX-License-Identifier: GPL-3.0-or-later
#include "child_process.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include <eigencrust/error.h>

namespace eigencrust::bench {
namespace {

[[noreturn]] void fail(const std::string& program, const std::string& cause) {
  throw Error(ErrorKind::guarantee, program, cause, "look at what it printed");
}

double seconds_of(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

/// Reads to the end and closes.
std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  close(descriptor);
  return text;
}

/// In the child: becomes the program, with stdout in the pipe.
[[noreturn]] void become(char* const* arguments, const int (&ends)[2]) {
  dup2(ends[1], STDOUT_FILENO);
  close(ends[0]);
  close(ends[1]);
  execv(arguments[0], arguments);
  _exit(127);
}

} // namespace

ChildRun run_child(const std::vector<std::string>& command) {
  std::vector<std::string> words = command; // exec wants them writable
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  int ends[2];
  if (pipe(ends) != 0) fail(command[0], std::string("no pipe: ") + std::strerror(errno));

  ChildRun run;
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child < 0) fail(command[0], std::string("no new process: ") + std::strerror(errno));
  if (child == 0) become(arguments.data(), ends);
  close(ends[1]);
  run.output = read_all(ends[0]);
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0)
    if (errno != EINTR) fail(command[0], std::string("cannot wait for it: ") + std::strerror(errno));
  run.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  if (WIFSIGNALED(status)) fail(command[0], "ended by signal " + std::to_string(WTERMSIG(status)));
  if (WEXITSTATUS(status) == 127) fail(command[0], "could not be run");
  if (WEXITSTATUS(status) != 0) fail(command[0], "ended with status " + std::to_string(WEXITSTATUS(status)));
  run.user_seconds = seconds_of(usage.ru_utime);
  run.system_seconds = seconds_of(usage.ru_stime);
  run.peak_memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  return run;
}

} // namespace eigencrust::bench
