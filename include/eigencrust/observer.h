// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a run is watched and cancelled, and the threads it may use.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <type_traits>

#include <eigencrust/types.h>

namespace eigencrust {

/// Watches a reconstruction. The default does nothing. Calls come from the thread that called
/// reconstruct(), never from two threads at once; `cancelled` alone may be called from worker threads
/// and must be safe to call from several at once.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void stage_begins(std::string_view /*stage*/) {}
  /// \param fraction of the current stage in [0, 1], never decreasing within a stage
  virtual void progress(double /*fraction*/) {}
  virtual void stage_ends(std::string_view /*stage*/, double /*seconds*/) {}
  /// Return true to stop at the next check; reconstruct() then throws ErrorKind::cancelled.
  virtual bool cancelled() { return false; }
  /// Return true to be given the stages' products through `product`.
  virtual bool wants_products() { return false; }
  /// A stage's product as a mesh with named attributes (points when it has no triangles).
  virtual void product(std::string_view /*stage*/, const TriangleMesh& /*snapshot*/) {}
};

/// An observer that does nothing.
Observer* default_observer();

/// Throws Error{cancelled} naming the stage when the observer asks for it.
void throw_if_cancelled(Observer& observer, std::string_view stage);

/// A fixed team of worker threads. Not to be entered from one of its own blocks.
class Threads {
 public:
  /// \param count number of threads including the caller's; 0: one per core
  explicit Threads(unsigned count = 0);
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  [[nodiscard]] unsigned size() const;

  /// Calls work(block) once for each block in [0, blocks), in any order, from all threads. If blocks
  /// throw, the exception of the smallest block is rethrown after all have ended.
  template <class Work>
  void run(std::size_t blocks, Work&& work) const {
    using Function = std::remove_reference_t<Work>;
    run_erased(
        blocks, [](void* f, std::size_t block) { (*static_cast<Function*>(f))(block); },
        const_cast<void*>(static_cast<const void*>(&work)));
  }

 private:
  void run_erased(std::size_t blocks, void (*call)(void*, std::size_t), void* function) const;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace eigencrust
