// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Blocks of memory that come and go, gone through part by part and round again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

namespace eigencrust::cli {

/// Not for several threads at once.
class BlocksInTurn {
 public:
  struct Part {
    char* begin = nullptr;
    std::size_t size = 0;
  };

  void add(char* begin, std::size_t size) { size_of_.emplace(begin, size); }
  /// \return its size; 0: there is no such block
  std::size_t remove(char* begin) {
    const auto found = size_of_.find(begin);
    if (found == size_of_.end()) return 0;
    const std::size_t size = found->second;
    size_of_.erase(found);
    return size;
  }
  /// What follows the part given last, or of the block after it: within one block, so many bytes at most. Empty: there
  /// are no blocks.
  Part next(std::size_t most) {
    auto at = size_of_.lower_bound(block_);
    if (at == size_of_.end()) at = size_of_.begin();
    if (at == size_of_.end()) return {};
    // A block that went may have left its place to a smaller one.
    if (at->first != block_ || done_ >= at->second) {
      block_ = at->first;
      done_ = 0;
    }
    const Part part{at->first + done_, std::min(most, at->second - done_)};
    done_ += part.size;
    if (done_ == at->second) {
      block_ = at->first + at->second;
      done_ = 0;
    }
    return part;
  }

 private:
  std::map<char*, std::size_t> size_of_;
  char* block_ = nullptr; ///< whose turn it is
  std::size_t done_ = 0;  ///< of it
};

} // namespace eigencrust::cli
