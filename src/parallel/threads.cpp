// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel/threads.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>

namespace eigencrust {

struct Threads::Impl {
  // One job at a time. A job is handed out under the mutex; its blocks are taken from `next`.
  std::mutex mutex;
  std::condition_variable wake, done;
  std::vector<std::thread> workers;
  std::size_t generation = 0;
  unsigned busy = 0;
  bool stop = false;

  void (*call)(void*, std::size_t) = nullptr;
  void* function = nullptr;
  std::size_t blocks = 0;
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  std::size_t error_block = std::numeric_limits<std::size_t>::max();

  void take_blocks() {
    for (std::size_t b = next.fetch_add(1); b < blocks; b = next.fetch_add(1)) {
      try {
        call(function, b);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (b < error_block) {
          error_block = b;
          error = std::current_exception();
        }
      }
    }
  }

  void work() {
    std::size_t seen = 0;
    std::unique_lock lock(mutex);
    for (;;) {
      wake.wait(lock, [&] { return stop || generation != seen; });
      if (stop) return;
      seen = generation;
      lock.unlock();
      take_blocks();
      lock.lock();
      if (--busy == 0) done.notify_one();
    }
  }
};

Threads::Threads(unsigned count) : impl_(std::make_unique<Impl>()) {
  if (count == 0) count = std::max(1u, std::thread::hardware_concurrency());
  impl_->workers.reserve(count - 1);
  try {
    for (unsigned i = 1; i < count; ++i) impl_->workers.emplace_back([impl = impl_.get()] { impl->work(); });
  } catch (const std::system_error&) {
    // The system gives no more threads. Results do not depend on their number, so fewer will do.
  } catch (const std::bad_alloc&) {
    // The same; and those that run already must end with this object.
  }
}

Threads::~Threads() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stop = true;
  }
  impl_->wake.notify_all();
  for (std::thread& worker : impl_->workers) worker.join();
}

unsigned Threads::size() const { return static_cast<unsigned>(impl_->workers.size()) + 1; }

void Threads::run_erased(std::size_t blocks, void (*call)(void*, std::size_t), void* function) const {
  if (impl_->workers.empty() || blocks <= 1) {
    for (std::size_t b = 0; b < blocks; ++b) call(function, b);
    return;
  }
  Impl& job = *impl_;
  {
    const std::lock_guard lock(job.mutex);
    job.call = call;
    job.function = function;
    job.blocks = blocks;
    job.next = 0;
    job.error = nullptr;
    job.error_block = std::numeric_limits<std::size_t>::max();
    job.busy = static_cast<unsigned>(job.workers.size());
    ++job.generation;
  }
  job.wake.notify_all();
  job.take_blocks();
  std::unique_lock lock(job.mutex);
  job.done.wait(lock, [&] { return job.busy == 0; });
  if (job.error) std::rethrow_exception(std::exchange(job.error, nullptr));
}

} // namespace eigencrust
