// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.h"

#include <cmath>
#include <cstring>

#include <eigencrust/error.h>

namespace eigencrust::python {
namespace {

template <class T>
void copy_rows(const py::array& array, std::vector<Vec3>& points) {
  const auto* base = static_cast<const char*>(array.data());
  const py::ssize_t row = array.strides(0), column = array.strides(1);
  const auto read = [](const char* at) { // memory of others need not be aligned
    T value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const char* at = base + static_cast<py::ssize_t>(i) * row;
    points[i] = {read(at), read(at + column), read(at + 2 * column)};
  }
}

py::object helper(const char* name) { return py::module_::import("eigencrust._arrays").attr(name); }

ScalarType scalar_type(const py::dtype& type) {
  const auto size = type.itemsize();
  switch (type.kind()) {
    case 'i':
      return size == 1 ? ScalarType::int8 : size == 2 ? ScalarType::int16 : ScalarType::int32;
    case 'f':
      return size == 4 ? ScalarType::float32 : ScalarType::float64;
    default:
      return size == 1 ? ScalarType::uint8 : size == 2 ? ScalarType::uint16 : ScalarType::uint32;
  }
}

py::dtype dtype_of(ScalarType type) {
  switch (type) {
    case ScalarType::int8:
      return py::dtype::of<std::int8_t>();
    case ScalarType::uint8:
      return py::dtype::of<std::uint8_t>();
    case ScalarType::int16:
      return py::dtype::of<std::int16_t>();
    case ScalarType::uint16:
      return py::dtype::of<std::uint16_t>();
    case ScalarType::int32:
      return py::dtype::of<std::int32_t>();
    case ScalarType::uint32:
      return py::dtype::of<std::uint32_t>();
    case ScalarType::float32:
      return py::dtype::of<float>();
    case ScalarType::float64:
      break;
  }
  return py::dtype::of<double>();
}

void check_size(const char* what, std::size_t found, std::optional<std::size_t> wanted) {
  if (wanted && found != *wanted)
    throw Error(ErrorKind::input, what,
                "it has " + std::to_string(found) + " entries where " + std::to_string(*wanted) + " are needed",
                "give one entry for each");
}

} // namespace

std::vector<Vec3> copy_points(const py::array& array) {
  std::vector<Vec3> points(static_cast<std::size_t>(array.shape(0)));
  if (array.itemsize() == sizeof(float))
    copy_rows<float>(array, points);
  else
    copy_rows<double>(array, points);
  return points;
}

std::vector<Vec3> to_points(const py::object& points, const char* what) {
  return copy_points(helper("as_points")(points, what).cast<py::array>());
}

std::vector<Vec3> to_optional_points(const py::object& points, const char* what) {
  if (points.is_none()) return {};
  return to_points(helper("as_places")(points, what), what);
}

std::vector<std::uint32_t> to_indices(const py::object& array, const char* what, std::optional<std::size_t> size,
                                      std::uint64_t most) {
  const auto numbers = helper("as_integers")(array, what).cast<py::array_t<std::int64_t>>();
  check_size(what, static_cast<std::size_t>(numbers.size()), size);
  std::vector<std::uint32_t> result(static_cast<std::size_t>(numbers.size()));
  const auto values = numbers.unchecked<1>();
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::int64_t value = values(static_cast<py::ssize_t>(i));
    if (value < 0 || static_cast<std::uint64_t>(value) > most)
      throw Error(
          ErrorKind::input, what,
          "entry " + std::to_string(i) + " is " + std::to_string(value) + ", not between 0 and " + std::to_string(most),
          "number from 0");
    result[i] = static_cast<std::uint32_t>(value);
  }
  return result;
}

std::vector<float> to_floats(const py::object& array, const char* what, std::size_t size) {
  if (array.is_none()) return {};
  const auto numbers = helper("as_numbers")(array, what).cast<py::array_t<double>>();
  check_size(what, static_cast<std::size_t>(numbers.size()), size);
  const auto values = numbers.unchecked<1>();
  std::vector<float> result(static_cast<std::size_t>(numbers.size()));
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = static_cast<float>(values(static_cast<py::ssize_t>(i)));
    if (!std::isfinite(result[i]))
      throw Error(ErrorKind::input, what, "entry " + std::to_string(i) + " is not finite", "give finite numbers");
  }
  return result;
}

std::vector<std::uint8_t> to_bytes(const py::object& array, const char* what, std::size_t size, std::uint8_t most,
                                   bool optional) {
  if (optional && array.is_none()) return {};
  const std::vector<std::uint32_t> numbers = to_indices(array, what, size, most);
  return {numbers.begin(), numbers.end()};
}

py::array view_memory(const py::dtype& type, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
                      const void* data, py::handle owner) {
  py::array array(type, std::move(shape), std::move(strides), data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array view(const std::vector<Vec3>& points, py::handle owner) {
  return view_memory(py::dtype::of<double>(), {static_cast<py::ssize_t>(points.size()), 3},
                     {sizeof(Vec3), sizeof(double)}, points.data(), owner);
}

py::array view(const std::vector<Label>& labels, py::handle owner) {
  return view_memory(py::dtype::of<std::uint8_t>(), {static_cast<py::ssize_t>(labels.size())}, {1}, labels.data(),
                     owner);
}

py::array view_flags(const std::vector<std::uint8_t>& flags, py::handle owner) {
  return view_memory(py::dtype::of<bool>(), {static_cast<py::ssize_t>(flags.size())}, {1}, flags.data(), owner);
}

py::array own_flags(std::vector<std::uint8_t> flags) {
  return own(std::move(flags)).attr("view")(py::dtype::of<bool>()).cast<py::array>();
}

std::vector<Attribute> to_attributes(const py::object& columns, std::size_t rows, const char* of) {
  std::vector<Attribute> attributes;
  if (columns.is_none()) return attributes;
  for (const py::handle column : helper("as_columns")(columns, rows, of)) {
    const auto parts = column.cast<py::tuple>();
    const auto values = parts[1].cast<py::array>();
    Attribute attribute;
    attribute.name = parts[0].cast<std::string>();
    attribute.type = scalar_type(values.dtype());
    const auto* bytes = static_cast<const std::byte*>(values.data());
    attribute.values.assign(bytes, bytes + values.nbytes());
    if (!parts[2].is_none()) {
      attribute.is_list = true;
      attribute.count_type = ScalarType::uint32;
      const auto offsets = parts[2].cast<py::array_t<std::uint64_t>>();
      attribute.offsets.assign(offsets.data(), offsets.data() + offsets.size());
    }
    attributes.push_back(std::move(attribute));
  }
  return attributes;
}

py::dict view(const std::vector<Attribute>& attributes, py::handle owner) {
  py::dict columns;
  for (const Attribute& attribute : attributes) {
    const py::dtype type = dtype_of(attribute.type);
    const auto size = static_cast<py::ssize_t>(size_of(attribute.type));
    const auto count = static_cast<py::ssize_t>(attribute.values.size()) / size;
    py::object values = view_memory(type, {count}, {size}, attribute.values.data(), owner);
    if (attribute.is_list) values = helper("ListColumn")(values, view(attribute.offsets, owner));
    columns[py::cast(attribute.name)] = values;
  }
  return columns;
}

} // namespace eigencrust::python
