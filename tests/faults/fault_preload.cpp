// SPDX-License-Identifier: GPL-3.0-or-later
// Preloaded into the command, makes the machine fail at a chosen moment. From main() on it counts calls of the system
// that open, read, write, flush, rename and remove files, and allocations; the environment says what happens to which:
//   EIGENCRUST_FAULT_CALL=K        the K-th call fails with EIGENCRUST_FAULT_ERRNO (a number, 5 by default: EIO)
//   EIGENCRUST_FAULT_ALLOCATION=K  the K-th allocation of 1 byte or more fails, and all that follow for
//                                  EIGENCRUST_FAULT_LENGTH allocations (1 by default)
//   EIGENCRUST_FAULT_SIGNAL=S      the K-th call raises this signal before it is done, instead of failing
//   EIGENCRUST_FAULT_COUNT=FILE    at the end the numbers of calls and allocations are written there
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<bool> active{false};
std::atomic<long> calls{0}, allocations{0};
long failing_call = 0, failing_allocation = 0, failing_length = 1;
int failing_errno = EIO, failing_signal = 0;
char count_file[4096];

long number(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atol(text);
}

/// The library's own function of that name, behind this one.
template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// Counts a call. \return true: it is to fail, and errno is set
bool call_fails() {
  if (!active) return false;
  if (++calls != failing_call) return false;
  if (failing_signal != 0) {
    raise(failing_signal);
    return false;
  }
  errno = failing_errno;
  return true;
}

bool allocation_fails(std::size_t size) {
  if (!active || size == 0) return false;
  const long k = ++allocations;
  if (failing_allocation == 0 || k < failing_allocation || k >= failing_allocation + failing_length) return false;
  errno = ENOMEM;
  return true;
}

void write_counts() {
  active = false;
  if (count_file[0] == 0) return;
  char text[100];
  const int size = std::snprintf(text, sizeof text, "%ld %ld\n", calls.load(), allocations.load());
  const int file = open(count_file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file >= 0 && write(file, text, static_cast<std::size_t>(size)) == size) close(file);
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

int counted_main(int argc, char** argv, char** environment) {
  failing_call = number("EIGENCRUST_FAULT_CALL", 0);
  failing_allocation = number("EIGENCRUST_FAULT_ALLOCATION", 0);
  failing_length = number("EIGENCRUST_FAULT_LENGTH", 1);
  failing_errno = static_cast<int>(number("EIGENCRUST_FAULT_ERRNO", EIO));
  failing_signal = static_cast<int>(number("EIGENCRUST_FAULT_SIGNAL", 0));
  if (const char* file = std::getenv("EIGENCRUST_FAULT_COUNT")) std::strncpy(count_file, file, sizeof count_file - 1);
  active = true;
  const int status = real_main(argc, argv, environment);
  write_counts();
  return status;
}

} // namespace

extern "C" {

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(), void (*rtld_fini)(),
                      void* stack_end) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  real_main = main;
  return next<Start>("__libc_start_main")(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0) {
    va_list rest;
    va_start(rest, flags);
    mode = va_arg(rest, mode_t);
    va_end(rest);
  }
  if (call_fails()) return -1;
  static const auto real = next<int (*)(const char*, int, mode_t)>("open");
  return real(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0) {
    va_list rest;
    va_start(rest, flags);
    mode = va_arg(rest, mode_t);
    va_end(rest);
  }
  if (call_fails()) return -1;
  static const auto real = next<int (*)(const char*, int, mode_t)>("open64");
  return real(path, flags, mode);
}

#define EIGENCRUST_FAULT_WRAP(result, name, parameters, arguments, failed) \
  result name parameters {                                                 \
    if (call_fails()) return failed;                                       \
    static const auto real = next<result(*) parameters>(#name);            \
    return real arguments;                                                 \
  }

EIGENCRUST_FAULT_WRAP(ssize_t, read, (int file, void* data, std::size_t size), (file, data, size), -1)
EIGENCRUST_FAULT_WRAP(ssize_t, write, (int file, const void* data, std::size_t size), (file, data, size), -1)
EIGENCRUST_FAULT_WRAP(int, fsync, (int file), (file), -1)
EIGENCRUST_FAULT_WRAP(int, close, (int file), (file), -1)
EIGENCRUST_FAULT_WRAP(int, flock, (int file, int operation), (file, operation), -1)
EIGENCRUST_FAULT_WRAP(int, rename, (const char* from, const char* to), (from, to), -1)
EIGENCRUST_FAULT_WRAP(int, fstat, (int file, struct stat* status) noexcept, (file, status), -1)
EIGENCRUST_FAULT_WRAP(int, stat, (const char* path, struct stat* status) noexcept, (path, status), -1)
EIGENCRUST_FAULT_WRAP(int, access, (const char* path, int mode) noexcept, (path, mode), -1)
EIGENCRUST_FAULT_WRAP(int, fchmod, (int file, mode_t mode) noexcept, (file, mode), -1)
EIGENCRUST_FAULT_WRAP(int, mkdir, (const char* path, mode_t mode) noexcept, (path, mode), -1)

// glibc's own names of its allocator: dlsym() would allocate.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept { return allocation_fails(size) ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) noexcept {
  return allocation_fails(count * size) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) noexcept {
  return allocation_fails(size) ? nullptr : __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return allocation_fails(size) ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) noexcept {
  if (allocation_fails(size)) return ENOMEM;
  *result = __libc_memalign(alignment, size);
  return *result == nullptr ? ENOMEM : 0;
}

} // extern "C"
