// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// numpy arrays in, copied once, and views of what the library owns out.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::python {

namespace py = pybind11;

/// The one copy: an (N,3) array of float32 or float64 in any memory order.
std::vector<Vec3> copy_points(const py::array& array);
/// Anything that eigencrust._arrays.as_points takes. \throws Error{input} naming `what`
std::vector<Vec3> to_points(const py::object& points, const char* what);
/// Points that may be None: then there are none.
std::vector<Vec3> to_optional_points(const py::object& points, const char* what);

/// A one-dimensional array of whole numbers from 0 to `most`, as many as `size` if that is given.
/// \throws Error{input} naming `what`
std::vector<std::uint32_t> to_indices(const py::object& array, const char* what, std::optional<std::size_t> size,
                                      std::uint64_t most);
/// A one-dimensional array of finite numbers, as many as `size`; None: there are none. \throws Error{input}
std::vector<float> to_floats(const py::object& array, const char* what, std::size_t size);
/// Bytes that are labels, flags or counts; None: there are none where `optional`. \throws Error{input}
std::vector<std::uint8_t> to_bytes(const py::object& array, const char* what, std::size_t size, std::uint8_t most,
                                   bool optional = false);

/// A read-only array over memory that lives as long as `owner`.
py::array view_memory(const py::dtype& type, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
                      const void* data, py::handle owner);

/// Numbers one after another.
template <class T>
py::array view(const std::vector<T>& values, py::handle owner) {
  return view_memory(py::dtype::of<T>(), {static_cast<py::ssize_t>(values.size())}, {sizeof(T)}, values.data(), owner);
}
/// (N,3) coordinates.
py::array view(const std::vector<Vec3>& points, py::handle owner);
/// Indices as uint32; 2^32-1 stands for none.
template <class Tag>
py::array view(const std::vector<Index<Tag>>& values, py::handle owner) {
  return view_memory(py::dtype::of<std::uint32_t>(), {static_cast<py::ssize_t>(values.size())}, {sizeof(Index<Tag>)},
                     values.data(), owner);
}
/// (N,k) indices.
template <class T, std::size_t k>
py::array view(const std::vector<std::array<T, k>>& values, py::handle owner) {
  static_assert(sizeof(T) == sizeof(std::uint32_t));
  return view_memory(py::dtype::of<std::uint32_t>(),
                     {static_cast<py::ssize_t>(values.size()), static_cast<py::ssize_t>(k)}, {sizeof(T) * k, sizeof(T)},
                     values.data(), owner);
}
/// Labels as uint8: 0 unlabelled, 1 inside, 2 outside.
py::array view(const std::vector<Label>& labels, py::handle owner);
/// 0 and 1 as bool.
py::array view_flags(const std::vector<std::uint8_t>& flags, py::handle owner);
/// One member of each struct of an array.
template <class Struct, class Member>
py::array view_member(const std::vector<Struct>& values, const Member Struct::*member, py::handle owner) {
  const void* first = values.empty() ? nullptr : &(values.front().*member);
  const auto n = static_cast<py::ssize_t>(values.size());
  if constexpr (std::is_same_v<Member, Vec3>)
    return view_memory(py::dtype::of<double>(), {n, 3}, {sizeof(Struct), sizeof(double)}, first, owner);
  else if constexpr (std::is_arithmetic_v<Member>)
    return view_memory(py::dtype::of<Member>(), {n}, {sizeof(Struct)}, first, owner);
  else
    return view_memory(py::dtype::of<std::uint32_t>(), {n}, {sizeof(Struct)}, first, owner);
}

/// An array that owns these values, which are moved.
template <class T>
py::array own(std::vector<T> values) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const py::capsule owner(kept.get(), [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return view(*kept.release(), owner);
}
py::array own_flags(std::vector<std::uint8_t> flags);

// Columns by name.
std::vector<Attribute> to_attributes(const py::object& columns, std::size_t rows, const char* of);
py::dict view(const std::vector<Attribute>& attributes, py::handle owner);

} // namespace eigencrust::python
