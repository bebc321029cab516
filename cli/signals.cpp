// SPDX-License-Identifier: GPL-3.0-or-later
#include "signals.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <exception>
#include <initializer_list>
#include <new>
#include <string_view>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "disk_memory.h"
#include "messages.h"

namespace eigencrust::cli {
namespace {

// A signal handler can reach nothing but what has static storage, and may call next to nothing.
volatile std::sig_atomic_t signals_seen = 0;
volatile std::sig_atomic_t committing = 0;
volatile std::sig_atomic_t status_when_done = -1; ///< of the process, once its files are there
timer_t deadline{};
volatile std::sig_atomic_t has_deadline = 0;
volatile std::sig_atomic_t has_run_out = 0; ///< operator new found no memory

constexpr long patience_in_nanoseconds = 300'000'000;

void write_all(std::initializer_list<std::string_view> pieces) {
  for (const std::string_view piece : pieces)
    [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, piece.data(), piece.size());
}

/// \param status that of `kind`, as text
[[noreturn]] void end_with(std::string_view text, ErrorKind kind, std::string_view status) {
  remove_temporaries();
  if (status_when_done >= 0) _exit(status_when_done);
  if (speaks_json())
    write_all({"{\"event\":\"error\",\"text\":\"", text, "\"}\n{\"event\":\"finished\",\"status\":", status, "}\n"});
  else // on a terminal a bar may stand in the line
    write_all({isatty(STDERR_FILENO) != 0 ? "\n" : "", "eigencrust: error: ", text, "\n"});
  _exit(static_cast<int>(kind));
}

[[noreturn]] void end_now() { end_with("cancelled (signal); start again to finish", ErrorKind::cancelled, "130"); }

bool is_about_memory() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return true;
  } catch (...) {
    return false;
  }
}

void on_no_memory() {
  has_run_out = 1;
  throw std::bad_alloc();
}

/// Where no exception may pass: destructors of the JSON library take memory, and so do tasks of other threads and
/// listings of folders. Where what was thrown cannot be asked for, it is remembered whether memory ran out.
[[noreturn]] void on_terminate() {
  if (std::current_exception() != nullptr ? is_about_memory() : has_run_out != 0)
    end_with(memory_is_exhausted(), ErrorKind::memory, "4");
  end_with("an exception was not caught (internal); report this as a fault of the program", ErrorKind::guarantee, "6");
}

void on_signal(int) {
  const int kept = errno;
  signals_seen = signals_seen + 1;
  if (committing == 0) {
    if (signals_seen > 1 || status_when_done >= 0 || has_deadline == 0) end_now();
    const itimerspec wait{{}, {0, patience_in_nanoseconds}};
    if (timer_settime(deadline, 0, &wait, nullptr) != 0) end_now();
  }
  errno = kept;
}

void on_deadline(int) {
  if (committing == 0) end_now();
}

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

bool is_ignored(int number) {
  struct sigaction action {};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

} // namespace

void catch_interrupts() {
  std::set_terminate(on_terminate);
  std::set_new_handler(on_no_memory);
  handle(SIGXFSZ, SIG_IGN);
  handle(SIGALRM, on_deadline);
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  has_deadline = timer_create(CLOCK_MONOTONIC, &event, &deadline) == 0;
  for (const int number : {SIGINT, SIGTERM, SIGQUIT, SIGXCPU}) handle(number, on_signal);
  for (const int number : {SIGHUP, SIGPIPE})
    if (!is_ignored(number)) handle(number, on_signal);
}

bool interrupted() { return signals_seen > 0; }

Commit::Commit() { committing = 1; }
Commit::~Commit() { committing = 0; }
void Commit::done(int status) { status_when_done = status; }
int status_of_files() { return status_when_done; }
void forget_files() { status_when_done = -1; }

} // namespace eigencrust::cli
