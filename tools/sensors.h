// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the virtual scanner stands and which rays it sends.
#pragma once

#include <cstdint>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::tools {

enum class Projection : std::uint8_t {
  pinhole, ///< all rays start in `position`
  parallel ///< all rays run along target - position
};

/// A grid of rays. Row 0 is the upper one, column 0 the left one.
struct Sensor {
  Projection projection = Projection::pinhole;
  Vec3 position;                           ///< of the pinhole; centre of the plane from which parallel rays start
  Vec3 target;                             ///< what the middle of the grid looks at
  Vec3 up{0, 0, 1};                        ///< replaced by another axis when it is parallel to the line of sight
  std::uint32_t columns = 400, rows = 400; ///< rays, each 1 to 65536
  double field_of_view = 40;               ///< pinhole: degrees across the columns, (0, 180); rays fill square cells
  double spacing = 0.01;                   ///< parallel: distance of neighbouring rays, > 0
};

struct Ray {
  Vec3 origin;
  Vec3 direction; ///< unit length
};

/// Turns a checked Sensor into rays.
class RayGrid {
 public:
  /// \throws Error{usage} for a sensor out of the ranges above
  explicit RayGrid(const Sensor& sensor);

  [[nodiscard]] std::uint64_t size() const { return std::uint64_t{sensor_.columns} * sensor_.rows; }
  /// Ray `index` in row-major order.
  [[nodiscard]] Ray ray(std::uint64_t index) const;

 private:
  Sensor sensor_;
  Vec3 forward_, right_, down_; ///< unit vectors
  double cell_;                 ///< side of a cell: length (parallel), or at distance 1 (pinhole)
};

/// `count` unit vectors spread evenly over the sphere, the poles of the spiral along `up`
/// (Swinbank and Purser 2006).
std::vector<Vec3> fibonacci_directions(std::uint32_t count, const Vec3& up = {0, 0, 1});

/// `count` unit vectors at `elevation` degrees above the horizon, the first at `azimuth` degrees.
std::vector<Vec3> ring_directions(std::uint32_t count, double elevation, double azimuth = 0,
                                  const Vec3& up = {0, 0, 1});

/// A sensor in the direction `direction` from `target` that has the sphere around `target` in view.
/// \param distance  from target to sensor, > radius
/// \param resolution rays across and down
Sensor aim_pinhole(const Vec3& target, const Vec3& direction, double radius, double distance, std::uint32_t resolution,
                   const Vec3& up);
/// The same with parallel rays `spacing` apart.
/// \throws Error{usage} when the sphere would take more than 65536 rays across
Sensor aim_parallel(const Vec3& target, const Vec3& direction, double radius, double distance, double spacing,
                    const Vec3& up);

/// Six square views of rays × rays from a place, which together see all around.
std::vector<Sensor> all_around(const Vec3& place, std::uint32_t rays);

} // namespace eigencrust::tools
