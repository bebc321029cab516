// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// `-` and what else is no file that can be read twice.
#pragma once

#include <string>

namespace eigencrust::cli {

/// Is this a name of standard output: -, /dev/stdout, /dev/fd/1?
bool is_standard_output(const std::string& path);

/// A file that stays as long as this does. What comes through `-` or a pipe is copied into a file without a name in
/// $TMPDIR, for readers look at it more than once.
class ReadableFile {
 public:
  /// \throws Error{input}
  explicit ReadableFile(const std::string& path);
  ~ReadableFile();
  ReadableFile(const ReadableFile&) = delete;
  ReadableFile& operator=(const ReadableFile&) = delete;

  /// To be opened; for people it is the path that was given.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Calls work; errors that name path() name the one that was given instead.
  template <class Work>
  auto reading(Work&& work) const;

 private:
  [[noreturn]] void rename_place_and_throw() const;

  std::string given_, path_;
  int descriptor_ = -1;
};

template <class Work>
auto ReadableFile::reading(Work&& work) const {
  if (descriptor_ < 0) return work();
  try {
    return work();
  } catch (...) {
    rename_place_and_throw();
  }
}

} // namespace eigencrust::cli
