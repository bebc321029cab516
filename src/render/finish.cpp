// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/canvas.h"

namespace eigencrust {
namespace {

constexpr int directions = 8; ///< each with its opposite
constexpr int steps = 7;

struct Offset {
  std::int32_t x, y;
  double length;
};

/// Where to look for what rises around a pixel: along each direction at growing distances.
std::vector<Offset> occlusion_pattern(double radius) {
  std::vector<Offset> pattern;
  for (int d = 0; d < directions; ++d)
    for (int s = 1; s <= steps; ++s) {
      const double angle = std::numbers::pi * (d + 0.5) / directions;
      const double reach = 1.5 * std::pow(std::max(radius / 1.5, 1.0), double(s - 1) / (steps - 1));
      const double x = std::round(reach * std::cos(angle)), y = std::round(reach * std::sin(angle));
      pattern.push_back({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), std::hypot(x, y)});
    }
  return pattern;
}

/// Depths of a picture with nothing around it.
class DepthMap {
 public:
  explicit DepthMap(const Canvas& canvas) : canvas_(canvas) {}
  [[nodiscard]] float at(std::int64_t x, std::int64_t y) const {
    if (x < 0 || y < 0 || x >= canvas_.width || y >= canvas_.height) return -std::numeric_limits<float>::infinity();
    return canvas_.depth[static_cast<std::size_t>(y) * canvas_.width + static_cast<std::size_t>(x)];
  }

 private:
  const Canvas& canvas_;
};

/// Share of the sky over a pixel that the surface around it hides: the mean over directions of how far
/// the horizons ahead and behind rise together. A tilted plane rises on one side as much as it falls on
/// the other and hides nothing.
double occlusion(const DepthMap& depths, std::int64_t x, std::int64_t y, std::span<const Offset> pattern,
                 double radius) {
  const double here = depths.at(x, y);
  double sum = 0;
  for (int d = 0; d < directions; ++d) {
    double ahead = -1, behind = -1; // sines of the horizon's height
    for (int s = 0; s < steps; ++s) {
      const Offset& o = pattern[static_cast<std::size_t>(d * steps + s)];
      const auto rise = [&](std::int64_t sign) {
        const double step = depths.at(x + sign * o.x, y + sign * o.y) - here;
        if (!(step > -1e30)) return -1.0;
        const double sine = step / std::hypot(step, o.length);
        // What is far in front is another part of the body: it hides less, in the end nothing.
        const double near = std::clamp(1.5 - step / (2 * radius), 0.0, 1.0);
        return sine > 0 ? sine * near : sine;
      };
      ahead = std::max(ahead, rise(1));
      behind = std::max(behind, rise(-1));
    }
    sum += std::max(0.0, (ahead + behind) / 2);
  }
  return sum / directions;
}

} // namespace

float to_linear(double srgb) {
  const double c = std::clamp(srgb, 0.0, 1.0);
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4)); // IEC 61966-2-1
}

double to_srgb(float linear) {
  const double c = std::clamp(static_cast<double>(linear), 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

Image finish(const Canvas& canvas, const std::array<std::uint8_t, 3>& background, const Threads& threads) {
  const std::size_t pixels = static_cast<std::size_t>(canvas.width) * canvas.height;
  Image image{canvas.width, canvas.height, std::vector<std::uint8_t>(3 * pixels)};
  LinearColor behind;
  for (std::size_t c = 0; c < 3; ++c) behind[c] = to_linear(background[c] / 255.0);
  const double radius = std::max(4.0, 0.04 * std::min(canvas.width, canvas.height));
  const std::vector<Offset> pattern = occlusion_pattern(radius);
  const DepthMap depths(canvas);
  for_each_index(
      threads, canvas.height,
      [&](std::size_t y) {
        for (std::size_t x = 0; x < canvas.width; ++x) {
          const std::size_t p = y * canvas.width + x;
          std::uint8_t* out = &image.rgb[3 * p];
          if (canvas.coverage[p] == 0) {
            std::copy(background.begin(), background.end(), out);
            continue;
          }
          const double hidden =
              occlusion(depths, static_cast<std::int64_t>(x), static_cast<std::int64_t>(y), pattern, radius);
          const auto light = static_cast<float>(std::max(0.2, 1 - 1.25 * hidden));
          for (std::size_t c = 0; c < 3; ++c) {
            const float value = light * canvas.color[p][c] + (1 - canvas.coverage[p]) * behind[c];
            out[c] = static_cast<std::uint8_t>(255 * to_srgb(value) + 0.5);
          }
        }
      },
      8);
  return image;
}

} // namespace eigencrust
