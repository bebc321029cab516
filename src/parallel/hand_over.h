// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the thread sanitizer cannot see: libtbb is built without it, so that the order that it keeps between threads
/// has to be said. Without that sanitizer nothing of this does anything.
#pragma once

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define EIGENCRUST_THREAD_SANITIZER
#endif
#elif defined(__SANITIZE_THREAD__)
#define EIGENCRUST_THREAD_SANITIZER
#endif

#ifdef EIGENCRUST_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
/// Of a function that reads what was handed over before it can say so.
#define EIGENCRUST_UNSEEN_BY_THREAD_SANITIZER __attribute__((no_sanitize("thread"), noinline))
#else
#define EIGENCRUST_UNSEEN_BY_THREAD_SANITIZER
#endif

namespace eigencrust {

/// A place where threads hand over to others: what was done before a give() is seen after a take() that follows it.
/// It orders nothing by itself: somebody else keeps the order that it tells of.
class HandOver {
 public:
#ifdef EIGENCRUST_THREAD_SANITIZER
  void give() { __tsan_release(this); }
  void take() { __tsan_acquire(this); }
#else
  void give() {}
  void take() {}
#endif
};

} // namespace eigencrust
