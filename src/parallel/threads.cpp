// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/threads.h"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/scalable_allocator.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <eigencrust/error.h>

#include "parallel/hand_over.h"

namespace eigencrust {
namespace {

/// Keeps the exception of the smallest block.
class FirstError {
 public:
  void take(std::size_t block) {
    const std::lock_guard lock(mutex_);
    if (block >= block_) return;
    block_ = block;
    error_ = std::current_exception();
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr error_;
  std::size_t block_ = std::numeric_limits<std::size_t>::max();
};

/// The blocks of one run. The library promises that each begins after the run did and ends before it does; two blocks
/// have no order.
class Blocks {
 public:
  Blocks(void (*call)(void*, std::size_t), void* function, const std::function<void()>& check)
      : call_(call), function_(function), check_(check) {
    begun_.give();
  }

  void take(std::size_t block) {
    begun_.take();
    if (!stopped_ && goes_on(block)) {
      try {
        call_(function_, block);
      } catch (...) {
        error_.take(block); // the other blocks go on: which of several exceptions is seen must not depend on time
      }
    }
    ended_.give();
  }
  /// All have ended.
  void finish() {
    ended_.take();
    error_.rethrow();
  }

 private:
  bool goes_on(std::size_t block) {
    try {
      if (check_) check_();
      return true;
    } catch (...) {
      error_.take(block);
      stopped_ = true;
      return false;
    }
  }

  void (*call_)(void*, std::size_t);
  void* function_;
  const std::function<void()>& check_;
  std::atomic<bool> stopped_ = false; ///< by the check, which may depend on time
  HandOver begun_, ended_;
  FirstError error_;
};

/// What the library calls.
struct TakeBlock {
  Blocks* blocks;
  EIGENCRUST_UNSEEN_BY_THREAD_SANITIZER void operator()(std::size_t block) const { blocks->take(block); }
};

/// How many of `wanted` threads the system gives beside this one. Asked before the library does: where it is refused
/// one, it fails, and fewer would do as well.
unsigned available_threads(unsigned wanted) {
  std::vector<std::thread> team;
  try {
    team.reserve(wanted);
    while (team.size() < wanted) team.emplace_back([] {});
  } catch (const std::system_error&) {
    // No more of them.
  } catch (const std::bad_alloc&) {
    // The same.
  }
  for (std::thread& thread : team) thread.join();
  return static_cast<unsigned>(team.size());
}

/// Arenas between their uses. A worker that comes late leaves an arena after its owner did and ends it then, so on a
/// busy machine an arena made for each run costs kilobytes that the library's allocator never gives to the next.
class SpareArenas {
 public:
  std::unique_ptr<tbb::task_arena> take(int threads) {
    {
      const std::lock_guard lock(mutex_);
      for (auto spare = spares_.begin(); spare != spares_.end(); ++spare) {
        if ((*spare)->max_concurrency() != threads) continue;
        std::unique_ptr<tbb::task_arena> arena = std::move(*spare);
        spares_.erase(spare);
        return arena;
      }
      spares_.reserve(++made_); // so that giving back cannot fail
    }
    return std::make_unique<tbb::task_arena>(threads);
  }
  void give_back(std::unique_ptr<tbb::task_arena> arena) {
    const std::lock_guard lock(mutex_);
    spares_.push_back(std::move(arena));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<tbb::task_arena>> spares_;
  std::size_t made_ = 0;
};

/// Never destroyed: at the end of a process the library may be gone before.
SpareArenas& spare_arenas() {
  static auto* const spares = new SpareArenas;
  return *spares;
}

/// The library opens its allocator at its first use, where it is not linked already, and where that meets an error
/// without memory for its text dlopen of glibc 2.36 crashes. This asks for it to be linked, and does nothing.
void need_allocator() { scalable_free(nullptr); }

} // namespace

struct Threads::Impl {
  std::function<void()> check;
  unsigned count;
  unsigned running; ///< never more than cores, of which the library would complain on stderr
  std::unique_ptr<tbb::task_arena> arena;

  Impl(unsigned n, unsigned cores, std::function<void()> before_each)
      : check(std::move(before_each)),
        count(n > 0 ? n : cores),
        running(1 + available_threads(std::min(count, cores) - 1)),
        arena(spare_arenas().take(static_cast<int>(running))) {}
  ~Impl() { spare_arenas().give_back(std::move(arena)); }
};

Threads::Threads(unsigned count, std::function<void()> check) {
  need_allocator();
  impl_ = std::make_unique<Impl>(count, static_cast<unsigned>(tbb::info::default_concurrency()), std::move(check));
}
Threads::~Threads() = default;

unsigned Threads::size() const { return impl_->count; }

void Threads::run_erased(std::size_t blocks, void (*call)(void*, std::size_t), void* function) const {
  if (impl_->running == 1 || blocks <= 1) {
    for (std::size_t b = 0; b < blocks; ++b) {
      if (impl_->check) impl_->check();
      call(function, b);
    }
    return;
  }
  Blocks all(call, function, impl_->check);
  // Isolated: who waits for these blocks takes no others, which may be long or use the same tables.
  impl_->arena->execute([&] {
    tbb::this_task_arena::isolate(
        [&] { tbb::parallel_for(std::size_t{0}, blocks, TakeBlock{&all}, tbb::simple_partitioner()); });
  });
  all.finish();
}

} // namespace eigencrust
