// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/attributes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "surface/scalar.h"

namespace eigencrust {
namespace {

/// Nearest value of the type: integers are rounded and clamped, NaN becomes 0.
template <class T>
T convert(double value) {
  if constexpr (std::is_integral_v<T>) {
    if (std::isnan(value)) return 0;
    constexpr auto lowest = static_cast<double>(std::numeric_limits<T>::lowest());
    constexpr auto largest = static_cast<double>(std::numeric_limits<T>::max());
    return static_cast<T>(std::clamp(std::nearbyint(value), lowest, largest));
  } else {
    return static_cast<T>(value);
  }
}

template <class T>
Attribute copy_of(std::string name, ScalarType type, std::span<const T> values) {
  const auto bytes = std::as_bytes(values);
  Attribute attribute;
  attribute.name = std::move(name);
  attribute.type = type;
  attribute.values.assign(bytes.begin(), bytes.end());
  return attribute;
}

} // namespace

void convert_to(Attribute& attribute, ScalarType type) {
  if (attribute.type == type) return;
  const std::size_t n = attribute.values.size() / size_of(attribute.type);
  std::vector<std::byte> values(n * size_of(type));
  with_scalar(type, [&]<class T>(std::type_identity<T>) {
    for (std::size_t i = 0; i < n; ++i) {
      const T value = convert<T>(load_as_double(attribute.type, attribute.values.data(), i));
      std::memcpy(values.data() + i * sizeof(T), &value, sizeof(T));
    }
  });
  attribute.values = std::move(values);
  attribute.type = type;
}

double attribute_value(const Attribute& attribute, std::size_t row) {
  return load_as_double(attribute.type, attribute.values.data(), row);
}

Attribute make_attribute(std::string name, ScalarType type, std::span<const double> values) {
  Attribute attribute = copy_of(std::move(name), ScalarType::float64, values);
  convert_to(attribute, type);
  return attribute;
}

Attribute make_attribute(std::string name, std::span<const std::uint32_t> values) {
  return copy_of(std::move(name), ScalarType::uint32, values);
}

Attribute derived_attribute(Attribute attribute) {
  attribute.derived = true;
  return attribute;
}

Attribute make_attribute(std::string name, std::span<const float> values) {
  return copy_of(std::move(name), ScalarType::float32, values);
}

Attribute gather(const Attribute& attribute, std::span<const std::uint32_t> rows) {
  Attribute result;
  result.name = attribute.name;
  result.type = attribute.type;
  result.is_list = attribute.is_list;
  result.count_type = attribute.count_type;
  result.derived = attribute.derived;
  const std::size_t size = size_of(attribute.type);
  if (!attribute.is_list) {
    result.values.resize(rows.size() * size);
    for (std::size_t i = 0; i < rows.size(); ++i)
      std::memcpy(result.values.data() + i * size, attribute.values.data() + rows[i] * size, size);
    return result;
  }
  result.offsets.reserve(rows.size() + 1);
  result.offsets.push_back(0);
  for (const std::uint32_t row : rows) {
    const auto begin = attribute.values.begin() + static_cast<std::ptrdiff_t>(attribute.offsets[row] * size);
    const auto end = attribute.values.begin() + static_cast<std::ptrdiff_t>(attribute.offsets[row + 1] * size);
    result.values.insert(result.values.end(), begin, end);
    result.offsets.push_back(result.values.size() / size);
  }
  return result;
}

const Attribute* find_attribute(const std::vector<Attribute>& attributes, std::string_view name) {
  for (const Attribute& attribute : attributes)
    if (attribute.name == name) return &attribute;
  return nullptr;
}

} // namespace eigencrust
