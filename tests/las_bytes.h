// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Small LAS files made by hand.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "e57_bytes.h"

namespace eigencrust {

struct LasTestFile {
  unsigned minor = 2;
  std::uint8_t format = 0;
  std::uint16_t record_bytes = 20;
  std::vector<std::string> records{}; ///< of the points
  std::string variable_records{};     ///< between the header and the points
  std::uint32_t variable_count = 0;
  double scale = 0.5;
  std::uint16_t header_size = 0; ///< 0: as the version has it

  [[nodiscard]] std::string bytes() const {
    const std::size_t size = header_size != 0 ? header_size : minor == 3 ? 235 : minor == 4 ? 375 : 227;
    std::string b(size, '\0');
    const auto put = [&](std::size_t at, auto value) { std::memcpy(b.data() + at, &value, sizeof value); };
    std::memcpy(b.data(), "LASF", 4);
    put(24, std::uint8_t{1});
    put(25, static_cast<std::uint8_t>(minor));
    put(94, static_cast<std::uint16_t>(size));
    put(96, static_cast<std::uint32_t>(size + variable_records.size()));
    put(100, variable_count);
    put(104, format);
    put(105, record_bytes);
    put(107, static_cast<std::uint32_t>(minor == 4 ? 0 : records.size()));
    for (int axis = 0; axis < 3; ++axis) {
      put(131 + 8 * static_cast<std::size_t>(axis), scale);
      put(155 + 8 * static_cast<std::size_t>(axis), 100.0 * (axis + 1));
    }
    if (size >= 375) put(247, static_cast<std::uint64_t>(records.size()));
    b += variable_records;
    for (const std::string& record : records) b += record;
    return b;
  }
};

/// The head of a variable length record.
inline std::string las_record(std::string user, std::uint16_t id, const std::string& content) {
  user.resize(16, '\0');
  return std::string(2, '\0') + user + raw_bytes<std::uint16_t>({id, static_cast<std::uint16_t>(content.size())}) +
         std::string(32, '\0') + content;
}

/// One description of extra bytes.
inline std::string las_extra(std::uint8_t type, std::uint8_t options, std::string name,
                             std::initializer_list<double> scale = {1, 1, 1},
                             std::initializer_list<double> shift = {0, 0, 0}) {
  name.resize(32, '\0');
  return std::string(2, '\0') + raw_bytes<std::uint8_t>({type, options}) + name + std::string(76, '\0') +
         raw_bytes<double>(scale) + raw_bytes<double>(shift) + std::string(32, '\0');
}

} // namespace eigencrust
