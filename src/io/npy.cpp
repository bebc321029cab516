// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/npy.h"

#include <bit>
#include <cmath>

#include "io/attributes.h"
#include "io/bytes.h"
#include "io/text.h"
#include "surface/scalar.h"

namespace eigencrust::io {
namespace {

constexpr const char* damaged = "fetch the file again, or save the array anew with numpy.save";

/// Python's notation of the header: a dictionary of strings, truth values, and tuples of whole numbers.
class Notation {
 public:
  explicit Notation(std::string_view text) : text_(text) {}

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] bool at_end() {
    skip_blanks();
    return position_ == text_.size();
  }
  bool take(char c) {
    skip_blanks();
    if (position_ == text_.size() || text_[position_] != c) return false;
    ++position_;
    return true;
  }
  bool take_string(std::string& value) {
    skip_blanks();
    if (position_ == text_.size() || (text_[position_] != '\'' && text_[position_] != '"')) return false;
    const std::size_t end = text_.find(text_[position_], position_ + 1);
    if (end == std::string_view::npos) return false;
    value = text_.substr(position_ + 1, end - position_ - 1);
    position_ = end + 1;
    return true;
  }
  bool take_truth(bool& value) {
    skip_blanks();
    for (const auto& [word, meaning] : {std::pair{"True", true}, std::pair{"False", false}})
      if (text_.substr(position_).starts_with(word)) {
        position_ += std::string_view(word).size();
        value = meaning;
        return true;
      }
    return false;
  }
  bool take_shape(std::vector<std::uint64_t>& shape) {
    constexpr std::size_t most_dimensions = 64;
    if (!take('(')) return false;
    shape.clear();
    while (!take(')')) {
      skip_blanks();
      const std::size_t begin = position_;
      while (position_ < text_.size() && is_digit(text_[position_])) ++position_;
      std::uint64_t extent = 0;
      if (!parse(text_.substr(begin, position_ - begin), extent) || shape.size() == most_dimensions) return false;
      shape.push_back(extent);
      take('L'); // Python 2 wrote it behind long numbers
      if (!take(',') && (position_ == text_.size() || text_[position_] != ')')) return false;
    }
    return true;
  }

 private:
  void skip_blanks() {
    while (position_ < text_.size() && (is_blank(text_[position_]) || text_[position_] == '\n')) ++position_;
  }

  std::string_view text_;
  std::size_t position_ = 0;
};

/// IEEE 754 binary16: sign, five bits of exponent, ten of the fraction.
float half_to_float(std::uint16_t bits) {
  const int exponent = bits >> 10 & 0x1f, fraction = bits & 0x3ff;
  float size = std::ldexp(static_cast<float>(exponent == 0 ? fraction : fraction + 1024), std::max(exponent, 1) - 25);
  if (exponent == 0x1f)
    size = fraction == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  return (bits & 0x8000) != 0 ? -size : size;
}

NumberKind number_kind(char kind) {
  return kind == 'f' ? NumberKind::real : kind == 'i' ? NumberKind::whole : NumberKind::natural;
}

} // namespace

NpyArray::NpyArray(const FileContent& file, std::string_view bytes, std::string member)
    : file_(file), member_(std::move(member)), bytes_(bytes) {
  constexpr std::string_view magic = "\x93NUMPY";
  if (!bytes.starts_with(magic) || bytes.size() < 10) fail_at(0, "this is no array of NumPy", damaged);
  const unsigned version = value_at<std::uint8_t>(bytes, 6);
  if (version < 1 || version > 3)
    fail_at(6, "version " + std::to_string(version) + " of the npy format is not known", damaged);
  const std::size_t begin = version == 1 ? 10 : 12;
  if (bytes.size() < begin) fail_at(bytes.size(), "the array ends within its header", damaged);
  const std::size_t length = version == 1 ? value_at<std::uint16_t>(bytes, 8) : value_at<std::uint32_t>(bytes, 8);
  if (length > bytes.size() - begin) fail_at(bytes.size(), "the array ends within its header", damaged);
  read_header(bytes.substr(begin, length), begin);
  data_ = bytes.substr(begin + length);
  read_descr();
  check_size(begin + length);
}

void NpyArray::read_header(std::string_view text, std::size_t begin) {
  Notation notation(text);
  bool has_descr = false, has_order = false, has_shape = false, good = notation.take('{');
  while (good && !notation.take('}')) {
    std::string key;
    good = notation.take_string(key) && notation.take(':');
    if (!good) break;
    if (key == "descr") {
      has_descr = true;
      if (notation.take('[')) fail("the array is a table of named fields", "save the fields as arrays of their own");
      good = notation.take_string(descr_);
    } else if (key == "fortran_order") {
      has_order = good = notation.take_truth(fortran_);
    } else if (key == "shape") {
      has_shape = good = notation.take_shape(shape_);
    } else {
      good = false;
    }
    // A comma stands between the entries, and may stand behind the last.
    if (good && !notation.take(',')) {
      good = notation.take('}');
      break;
    }
  }
  if (!good || !notation.at_end()) fail_at(begin + notation.position(), "the array's header is malformed", damaged);
  if (!has_descr || !has_order || !has_shape)
    fail_at(begin, "the array's header does not tell descr, fortran_order and shape", damaged);
}

/// Byte order, kind and size: <f8, say.
void NpyArray::read_descr() {
  if (descr_.size() != 3 || std::string_view("<>|=").find(descr_[0]) == std::string_view::npos) return;
  const std::size_t item = is_digit(descr_[2]) ? static_cast<std::size_t>(descr_[2] - '0') : 0;
  const char kind = descr_[1];
  const bool whole = (kind == 'i' || kind == 'u') && (item == 1 || item == 2 || item == 4 || item == 8);
  const bool real = kind == 'f' && (item == 2 || item == 4 || item == 8);
  if (!whole && !real && !(kind == 'b' && item == 1)) return;
  kind_ = kind;
  item_ = item;
  swap_ = descr_[0] == '>' && item > 1;
}

void NpyArray::check_size(std::size_t begin) const {
  if (!is_numeric()) return;
  std::uint64_t values = 1;
  const std::uint64_t most = data_.size() / item_;
  bool empty = false, fits = true;
  for (const std::uint64_t extent : shape_) empty = empty || extent == 0;
  for (const std::uint64_t extent : shape_) {
    fits = fits && (empty || values <= most / extent);
    if (fits && !empty) values *= extent;
  }
  if (empty) values = 0;
  if (!fits)
    fail_at(bytes_.size(), "the shape " + shape_text() + " promises more values than there are: the array ends",
            damaged);
  if (values * item_ != data_.size())
    fail_at(begin + values * item_,
            "the array has " + plural(data_.size() - values * item_, "byte") + " more than its shape " + shape_text() +
                " says",
            damaged);
}

std::string NpyArray::shape_text() const {
  std::string text = "(";
  for (std::size_t i = 0; i < shape_.size(); ++i) text += (i > 0 ? ", " : "") + std::to_string(shape_[i]);
  return text + (shape_.size() == 1 ? ",)" : ")");
}

std::uint64_t NpyArray::columns() const { return shape_.size() == 1 ? 1 : shape_.size() == 2 ? shape_[1] : 0; }

Attribute NpyArray::column(std::uint64_t k, std::string name) const {
  const std::uint64_t n = rows(), width = columns();
  std::vector<std::byte> values(n * item_);
  for (std::uint64_t i = 0; i < n; ++i)
    std::memcpy(values.data() + i * item_, data_.data() + (fortran_ ? k * n + i : i * width + k) * item_, item_);
  if (swap_) swap_bytes(values, item_);
  Attribute attribute;
  attribute.name = std::move(name);
  attribute.type = attribute_type(number_kind(kind_), item_);
  if (kind_ == 'f' && item_ == 2) {
    attribute.values.resize(n * sizeof(float));
    for (std::uint64_t i = 0; i < n; ++i) {
      const float value = half_to_float(load<std::uint16_t>(values.data(), i));
      std::memcpy(attribute.values.data() + i * sizeof value, &value, sizeof value);
    }
    return attribute;
  }
  if (kind_ != 'f' && item_ == 8)
    for (std::uint64_t i = 0; i < n; ++i) {
      const double value = kind_ == 'i' ? static_cast<double>(load<std::int64_t>(values.data(), i))
                                        : static_cast<double>(load<std::uint64_t>(values.data(), i));
      std::memcpy(values.data() + i * sizeof value, &value, sizeof value);
    }
  attribute.values = std::move(values);
  return attribute;
}

std::vector<Vec3> NpyArray::points(std::uint64_t first_column) const {
  std::vector<Vec3> points(rows());
  std::uint64_t k = first_column;
  for (double Vec3::*const axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const Attribute values = column(k++, {});
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i].*axis = load_as_double(values.type, values.values.data(), i);
  }
  return points;
}

void NpyArray::fail(const std::string& cause, const std::string& remedy) const {
  file_.fail((member_.empty() ? "" : "array " + shown(member_) + ": ") + cause, remedy);
}

void NpyArray::fail_at(std::size_t byte, const std::string& cause, const std::string& remedy) const {
  if (member_.empty()) file_.fail_at_byte(byte, cause, remedy);
  fail(cause + " at byte " + std::to_string(byte) + " of it", remedy);
}

} // namespace eigencrust::io
