// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/sensor_columns.h"

#include <array>

#include "io/text.h"

namespace eigencrust::io {
namespace {

/// Names of columns by which programs tell where the sensor stood.
constexpr std::array<std::array<const char*, 3>, 6> usual_names = {{{"sx", "sy", "sz"},
                                                                    {"x_origin", "y_origin", "z_origin"},
                                                                    {"vp_x", "vp_y", "vp_z"},
                                                                    {"sensor_x", "sensor_y", "sensor_z"},
                                                                    {"scanner_x", "scanner_y", "scanner_z"},
                                                                    {"viewpoint_x", "viewpoint_y", "viewpoint_z"}}};

const Attribute* find_column(const PointCloud& cloud, const char* name) {
  for (const Attribute& attribute : cloud.attributes)
    if (!attribute.is_list && equal_ignoring_case(attribute.name, name)) return &attribute;
  return nullptr;
}

} // namespace

std::optional<SensorColumns> find_sensor_columns(const PointCloud& cloud) {
  for (const auto& names : usual_names) {
    std::array<const Attribute*, 3> columns{};
    for (std::size_t k = 0; k < 3; ++k) columns[k] = find_column(cloud, names[k]);
    if (columns[0] == nullptr || columns[1] == nullptr || columns[2] == nullptr) continue;
    SensorColumns found{columns[0]->name + " " + columns[1]->name + " " + columns[2]->name, {}};
    found.places.resize(cloud.points.size());
    for (std::size_t i = 0; i < found.places.size(); ++i)
      found.places[i] = {attribute_value(*columns[0], i), attribute_value(*columns[1], i),
                         attribute_value(*columns[2], i)};
    return found;
  }
  return std::nullopt;
}

} // namespace eigencrust::io
