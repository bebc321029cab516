// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pictures in the making: triangles and discs with depth, then pixels. Colours are linear light.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <eigencrust/render.h>
#include <eigencrust/types.h>

#include "parallel/threads.h"

namespace eigencrust {

using LinearColor = std::array<float, 3>;

/// sRGB value in [0, 1] to linear light and back.
float to_linear(double srgb);
double to_srgb(float linear);

/// A triangle in pixel coordinates with the light it sends to the camera.
struct ScreenTriangle {
  std::array<Vec3, 3> corner;
  std::array<LinearColor, 3> color; ///< at the corners, already shaded
  std::array<double, 3> clip{};     ///< at the corners; drawn where the interpolated value is <= 0
  bool front = true;
};

/// A disc facing the camera.
struct ScreenDisc {
  Vec3 centre;
  LinearColor color;
};

/// What was drawn, per pixel.
struct Canvas {
  std::uint32_t width = 0, height = 0;
  std::vector<LinearColor> color; ///< times coverage
  std::vector<float> coverage;    ///< share of the pixel that is covered
  std::vector<float> depth;       ///< nearest depth in pixels; -infinity where nothing was drawn
};

/// \param edge_width of the wireframe in pixels; 0: none
Canvas draw_triangles(std::span<const ScreenTriangle> triangles, std::uint32_t width, std::uint32_t height,
                      double edge_width, const Threads& threads);
/// \param diameter in pixels
Canvas draw_discs(std::span<const ScreenDisc> discs, std::uint32_t width, std::uint32_t height, double diameter,
                  const Threads& threads);

/// Final pixels: creases and hollows darkened by what rises around them, over the background.
Image finish(const Canvas& canvas, const std::array<std::uint8_t, 3>& background, const Threads& threads);

} // namespace eigencrust
