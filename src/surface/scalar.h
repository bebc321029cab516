// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From the run-time type of an attribute to the C++ type of its values.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

#include <eigencrust/types.h>

namespace eigencrust {

/// Calls work(std::type_identity<T>{}) with the T that `type` stands for.
template <class Work>
decltype(auto) with_scalar(ScalarType type, Work&& work) {
  switch (type) {
    case ScalarType::int8:
      return work(std::type_identity<std::int8_t>{});
    case ScalarType::uint8:
      return work(std::type_identity<std::uint8_t>{});
    case ScalarType::int16:
      return work(std::type_identity<std::int16_t>{});
    case ScalarType::uint16:
      return work(std::type_identity<std::uint16_t>{});
    case ScalarType::int32:
      return work(std::type_identity<std::int32_t>{});
    case ScalarType::uint32:
      return work(std::type_identity<std::uint32_t>{});
    case ScalarType::float32:
      return work(std::type_identity<float>{});
    case ScalarType::float64:
      break;
  }
  return work(std::type_identity<double>{});
}

constexpr bool is_floating(ScalarType type) { return type == ScalarType::float32 || type == ScalarType::float64; }

/// Value number i of packed, possibly unaligned values.
template <class T>
T load(const std::byte* values, std::size_t i) {
  T value;
  std::memcpy(&value, values + i * sizeof(T), sizeof(T));
  return value;
}

/// Value number i of packed values of the given type, exactly.
inline double load_as_double(ScalarType type, const std::byte* values, std::size_t i) {
  return with_scalar(type, [&]<class T>(std::type_identity<T>) { return static_cast<double>(load<T>(values, i)); });
}

/// Reverses the bytes of each value of `size` bytes.
inline void swap_bytes(std::span<std::byte> values, std::size_t size) {
  if (size < 2) return;
  for (std::size_t begin = 0; begin + size <= values.size(); begin += size)
    for (std::size_t k = 0; k < size / 2; ++k) std::swap(values[begin + k], values[begin + size - 1 - k]);
}

} // namespace eigencrust
