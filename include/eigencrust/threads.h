// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The threads that a stage may use.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>

namespace eigencrust {

/// How many threads work at the same time. Blocks may run blocks of their own.
class Threads {
 public:
  /// \param count number of threads including the caller's; 0: one per core. There are never more than cores
  /// \param check called before each block by the thread that takes it, so from several at once; throws where the
  /// work is to end, for example because it was cancelled
  explicit Threads(unsigned count = 0, std::function<void()> check = {});
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  /// How many there are.
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
