// SPDX-License-Identifier: GPL-3.0-or-later
#include <dirent.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <ctime>

#include "pause_threads.h"

namespace eigencrust::cli {
namespace {

std::atomic<bool> paused = false;
static_assert(std::atomic<bool>::is_always_lock_free); // a signal handler may use it

extern "C" void stand_still(int) {
  const int error = errno;
  constexpr timespec moment{0, 50'000};
  while (paused.load(std::memory_order_acquire)) nanosleep(&moment, nullptr);
  errno = error;
}

void take_signal() {
  struct sigaction action {};
  action.sa_handler = stand_still;
  action.sa_flags = SA_RESTART;
  sigaction(SIGURG, &action, nullptr);
}

struct Others {
  std::array<pid_t, 1024> thread;
  std::size_t count = 0;
};

Others other_threads() {
  Others others;
  const auto own = static_cast<pid_t>(syscall(SYS_gettid));
  DIR* const folder = opendir("/proc/self/task");
  if (folder == nullptr) return others;
  while (const dirent* const entry = readdir(folder)) {
    const pid_t thread = static_cast<pid_t>(std::strtol(entry->d_name, nullptr, 10)); // 0: no thread
    if (thread > 0 && thread != own && others.count < others.thread.size()) others.thread[others.count++] = thread;
  }
  closedir(folder);
  return others;
}

} // namespace

OtherThreadsPaused::OtherThreadsPaused() {
  [[maybe_unused]] static const bool taken = (take_signal(), true);
  const Others others = other_threads();
  paused.store(true, std::memory_order_release);
  for (std::size_t k = 0; k < others.count; ++k) syscall(SYS_tgkill, getpid(), others.thread[k], SIGURG);
}

OtherThreadsPaused::~OtherThreadsPaused() { paused.store(false, std::memory_order_release); }

} // namespace eigencrust::cli
