// SPDX-License-Identifier: GPL-3.0-or-later
#include "heap.h"

#include <atomic>
#include <cstdint> // and whether this is the GNU C library

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace eigencrust::cli {

#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)

namespace {

// The heap grows in steps of 4 MB of addresses, not of memory: a large page has to lie within one.
constexpr int growth = 1 << 22;

// What was given back to the system comes again with small pages: all of the heap is looked at where its end moved.
std::uintptr_t begin_of_heap = 0;
std::atomic<std::uintptr_t> last_end = 0;

std::uintptr_t end_of_heap() { return reinterpret_cast<std::uintptr_t>(sbrk(0)); }

} // namespace

void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_TOP_PAD, growth);
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  begin_of_heap = end_of_heap() / page * page;
}

void enlarge_new_pages() {
  const std::uintptr_t end = end_of_heap();
  if (begin_of_heap == 0 || last_end.load(std::memory_order_relaxed) == end) return;
  last_end.store(end, std::memory_order_relaxed);
  madvise(reinterpret_cast<void*>(begin_of_heap), end - begin_of_heap, MADV_HUGEPAGE);
}

#else

void keep_freed_memory() {}
void enlarge_new_pages() {}

#endif

} // namespace eigencrust::cli
