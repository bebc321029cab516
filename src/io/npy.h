// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One array of NumPy ("The .npy format", NEP 1): a header in Python's notation, then the values.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <eigencrust/types.h>

#include "io/file_content.h"

namespace eigencrust::io {

class NpyArray {
 public:
  /// \param bytes of the whole array; they must outlive it
  /// \param member its name within an archive, for messages; empty when it is the file
  /// \throws Error{input} naming the byte when the header is malformed or the values do not fill the shape
  NpyArray(const FileContent& file, std::string_view bytes, std::string member = {});

  [[nodiscard]] const std::vector<std::uint64_t>& shape() const { return shape_; }
  /// (3, 4), say
  [[nodiscard]] std::string shape_text() const;
  /// Of the first dimension; the number of values of each row is columns(). Single values have no rows.
  [[nodiscard]] std::uint64_t rows() const { return shape_.empty() ? 0 : shape_[0]; }
  /// 1 for arrays of one dimension, 0 for those of more than two.
  [[nodiscard]] std::uint64_t columns() const;
  /// False for text, objects, complex numbers and the like.
  [[nodiscard]] bool is_numeric() const { return kind_ != 0; }
  [[nodiscard]] const std::string& type_text() const { return descr_; }

  /// The values of one column under that name; 16-bit floats become float32, 64-bit integers float64.
  /// The array must be numeric and have such a column.
  [[nodiscard]] Attribute column(std::uint64_t k, std::string name) const;
  /// Three columns as points.
  [[nodiscard]] std::vector<Vec3> points(std::uint64_t first_column = 0) const;

  [[noreturn]] void fail(const std::string& cause, const std::string& remedy) const;

 private:
  [[noreturn]] void fail_at(std::size_t byte, const std::string& cause, const std::string& remedy) const;
  void read_header(std::string_view text, std::size_t begin);
  void read_descr();
  void check_size(std::size_t begin) const;

  const FileContent& file_;
  std::string member_, descr_;
  std::string_view bytes_, data_;
  std::vector<std::uint64_t> shape_;
  char kind_ = 0; ///< b, i, u or f
  std::size_t item_ = 0;
  bool swap_ = false, fortran_ = false;
};

} // namespace eigencrust::io
