// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <eigencrust/error.h>

#include "blocks_in_turn.h"
#include "disk_memory.h"
#include "heap.h"
#include "pause_threads.h"

namespace eigencrust::cli {
namespace {

// Of smaller arrays there are too many for a file each, and together they are small.
constexpr std::size_t least_block = std::size_t{1} << 20;
// The heap grows by so many larger ones that they see it soon.
constexpr std::size_t growing_block = std::size_t{1} << 12;
// Threads that look here and there into arrays in the system's memory fetch a gigabyte in 10 ms, in which the watch may
// not get a core at all: a part of what may be resident is left to that.
constexpr std::chrono::milliseconds between_looks(1);
constexpr double held_at_most = 0.75, held_after = 0.6; ///< of the bytes that may be resident
constexpr std::size_t given_back_at_once = std::size_t{1} << 25;

/// Blocks in files.
class Disk {
 public:
  void open(const std::string& folder, std::uint64_t resident);
  [[nodiscard]] bool is_open() const { return open_.load(std::memory_order_acquire); }
  /// nullptr: there is no room
  void* take(std::size_t bytes);
  /// \return whether it is one of them
  bool give_back(void* p);
  [[nodiscard]] std::uint64_t peak();
  /// Why there was no file (errno); 0: there always was one.
  [[nodiscard]] int error() const { return error_; }

 private:
  std::atomic<bool> open_ = false;
  std::atomic<int> error_ = 0;
  // Around all blocks there were: small arrays lie elsewhere, so nearly none has to be looked up.
  std::atomic<std::uintptr_t> begin_ = std::numeric_limits<std::uintptr_t>::max(), end_ = 0;
  std::mutex mutex_;
  std::string folder_;
  std::uint64_t resident_ = 0;
  std::atomic<std::uint64_t> file_number_ = 0;
  std::uint64_t lent_ = 0, peak_ = 0;
  BlocksInTurn blocks_;

  /// A file without a name, of so many bytes that are the process's own: none is missing when it is written.
  int new_file(std::size_t bytes);
  void keep_watch();
  bool let_go(std::uint64_t until_resident);
};

std::size_t page_size() {
  static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return size;
}

/// Bytes that the process holds in memory; 0 where the system does not tell. Cheap, for it is asked all the time, and
/// allocates nothing, for other threads may be paused.
std::uint64_t resident_bytes() {
  static const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  std::array<char, 128> text{}; // pages of addresses, of what is held, ...
  if (file < 0 || pread(file, text.data(), text.size() - 1, 0) <= 0) return 0;
  char* second = nullptr;
  std::strtoull(text.data(), &second, 10);
  return std::strtoull(second, nullptr, 10) * page_size();
}

int Disk::new_file(std::size_t bytes) {
  int file = -1;
  do { // one may be left of a process that was killed between the next two calls
    const std::string name =
        folder_ + "/eigencrust-memory-" + std::to_string(getpid()) + "-" + std::to_string(file_number_++);
    file = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (file >= 0) unlink(name.c_str());
  } while (file < 0 && (errno == EEXIST || errno == EINTR));
  int failed = EINTR; // threads are paused by a signal
  while (failed == EINTR) failed = file < 0 ? errno : posix_fallocate(file, 0, static_cast<off_t>(bytes));
  if (failed == 0) return file;
  if (file >= 0) close(file);
  error_ = failed;
  return -1;
}

void Disk::open(const std::string& folder, std::uint64_t resident) {
  const std::lock_guard lock(mutex_);
  if (open_) return;
  folder_ = folder;
  resident_ = resident;
  const int file = new_file(page_size());
  if (file < 0)
    throw Error(ErrorKind::usage, folder, std::string("no file can be made here: ") + std::strerror(error_),
                "name another folder with --temp-dir");
  close(file);
  open_ = true;
  std::thread(&Disk::keep_watch, this).detach();
}

void* Disk::take(std::size_t bytes) {
  const std::size_t size = (bytes + page_size() - 1) / page_size() * page_size();
  const int file = new_file(size); // which can take seconds while much is being written: the lock is for the watch
  if (file < 0) return nullptr;
  void* const block = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (block == MAP_FAILED) return nullptr;
  const auto address = reinterpret_cast<std::uintptr_t>(block);
  const std::lock_guard lock(mutex_);
  begin_ = std::min(begin_.load(), address);
  end_ = std::max(end_.load(), address + size);
  blocks_.add(static_cast<char*>(block), size);
  lent_ += size;
  peak_ = std::max(peak_, lent_);
  return block;
}

bool Disk::give_back(void* p) {
  const auto address = reinterpret_cast<std::uintptr_t>(p);
  if (address < begin_.load(std::memory_order_relaxed) || address >= end_.load(std::memory_order_relaxed)) return false;
  std::size_t size = 0;
  {
    const std::lock_guard lock(mutex_);
    size = blocks_.remove(static_cast<char*>(p));
    if (size == 0) return false;
    lent_ -= size;
  }
  munmap(p, size);
  return true;
}

/// Pages that are let go stay with the system while it has room, and come back when they are looked at.
/// \return whether any were there to go
bool Disk::let_go(std::uint64_t until_resident) {
  const std::lock_guard lock(mutex_);
  const OtherThreadsPaused paused; // they fetch pages several times as fast as they can go
  bool any = false;
  std::uint64_t looked_at = 0;
  for (std::uint64_t held = resident_bytes(); held > until_resident && looked_at < lent_;) {
    const auto [begin, size] = blocks_.next(given_back_at_once);
    madvise(begin, size, MADV_DONTNEED);
    const std::uint64_t before = std::exchange(held, resident_bytes());
    any = any || held < before; // other threads fetch pages meanwhile
    looked_at += size;
  }
  return any;
}

void Disk::keep_watch() {
  const auto most = static_cast<std::uint64_t>(held_at_most * static_cast<double>(resident_));
  const auto after = static_cast<std::uint64_t>(held_after * static_cast<double>(resident_));
  for (;;) {
    // What is not on the disk stays: to look for more of it at once would only slow down the work.
    const bool wait = resident_bytes() > most && !let_go(after);
    std::this_thread::sleep_for(wait ? 100 * between_looks : between_looks);
  }
}

std::uint64_t Disk::peak() {
  const std::lock_guard lock(mutex_);
  return peak_;
}

/// Blocks are given back until the very end of the process.
Disk& disk() {
  alignas(Disk) static std::byte room[sizeof(Disk)];
  static Disk* const made = new (room) Disk;
  return *made;
}

/// nullptr: there is none. Files begin at pages, so any alignment is theirs.
void* take(std::size_t bytes, std::size_t alignment) {
  if (bytes >= least_block && disk().is_open()) return disk().take(bytes);
  bytes = std::max<std::size_t>(bytes, 1);
  void* const p = alignment <= alignof(std::max_align_t)
                      ? std::malloc(bytes)
                      : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (bytes >= growing_block) enlarge_new_pages();
  return p;
}

void* take_or_throw(std::size_t bytes, std::size_t alignment) {
  for (;;) {
    if (void* const p = take(bytes, alignment)) return p;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

} // namespace

void lend_disk(const std::string& folder, std::uint64_t resident) {
#ifdef __GLIBC__
  malloc_trim(0); // what reading has left
#endif
  disk().open(folder, resident);
}

bool lies_in_memory(const std::string& folder) {
  struct statfs system {};
  return statfs(folder.c_str(), &system) == 0 && (system.f_type == TMPFS_MAGIC || system.f_type == RAMFS_MAGIC);
}

std::uint64_t peak_of_lent_disk() { return disk().peak(); }

const char* memory_is_exhausted() {
  if (disk().error() == 0)
    return "memory is exhausted (memory); give fewer points or let a disk take a part (--max-memory and --temp-dir), "
           "info forecasts what is needed";
  static std::array<char, 300> text;
  std::snprintf(text.data(), text.size(),
                "what exceeds --max-memory could not be put on the disk: %.100s (--temp-dir); free some space or name "
                "another folder",
                std::strerror(disk().error()));
  return text.data();
}

} // namespace eigencrust::cli

// The C++ standard lets a program replace these; all other forms call them.
void* operator new(std::size_t bytes) { return eigencrust::cli::take_or_throw(bytes, 1); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return eigencrust::cli::take_or_throw(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept {
  if (!eigencrust::cli::disk().give_back(p)) std::free(p);
}
void operator delete(void* p, std::size_t) noexcept { operator delete(p); }
void operator delete(void* p, std::align_val_t) noexcept { operator delete(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { operator delete(p); }
