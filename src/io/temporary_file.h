// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The file beside a target that takes its place when it is finished.
#pragma once

#include <sys/stat.h>

#include <filesystem>

namespace eigencrust::io {

/// An open, locked file in the target's folder. Its lock tells other runs, on other hosts too, that it is in use; those
/// whose lock is free were left by runs that were killed, and go when the next one is created in that folder.
class TemporaryFile {
 public:
  /// \param replaced the file that is in the target's place, or null: its permissions and, where the system allows it,
  ///                 its owner are kept. Set-user and set-group bits are not.
  /// \throws Error{input}
  TemporaryFile(std::filesystem::path target, const struct stat* replaced);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  /// Removes the file unless it is in its place.
  ~TemporaryFile();

  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Takes the target's place, also after a power failure where the system can promise that. Needs no memory unless it
  /// fails. \throws Error{input}
  void put_in_place();

 private:
  bool create(mode_t mode);
  [[nodiscard]] bool lock() const;

  std::filesystem::path target_, folder_, path_;
  int descriptor_ = -1;
  int slot_ = -1; ///< where a signal handler finds the name
  bool in_place_ = false;
};

/// Every temporary name ends so; none of another program does.
inline constexpr const char* temporary_suffix = ".eigencrust-tmp";

} // namespace eigencrust::io
