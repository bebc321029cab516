// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The bytes of one input file, and the two ways to say where in it something is wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace eigencrust::io {

/// What to do about a file that ends too early.
inline constexpr const char* cut_off = "fetch the file again, it may be cut off or damaged";

/// A whole file in memory.
class FileContent {
 public:
  /// Reads until the end, so that pipes work too. \throws Error{input} when the file cannot be read.
  explicit FileContent(const std::filesystem::path& path);

  /// A file that is in memory already; `name` is for messages and for its extension.
  FileContent(std::string name, std::string_view bytes);

  [[nodiscard]] std::string_view bytes() const { return {data_.get(), size_}; }
  /// As the user wrote it: for messages.
  [[nodiscard]] const std::string& name() const { return name_; }

  /// \throws Error{input} with the place NAME:LINE
  [[noreturn]] void fail_at_line(std::uint64_t line, const std::string& cause, const std::string& remedy) const;
  /// \throws Error{input} with the place NAME, the offset being part of the cause
  [[noreturn]] void fail_at_byte(std::uint64_t offset, const std::string& cause, const std::string& remedy) const;
  /// \throws Error{input} with the place NAME
  [[noreturn]] void fail(const std::string& cause, const std::string& remedy) const;

 private:
  std::string name_;
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
};

} // namespace eigencrust::io
