// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the camera stands and how space maps to pixels.
#pragma once

#include <eigencrust/render.h>
#include <eigencrust/types.h>

namespace eigencrust {

/// Orthographic view. Axes are unit vectors; `back` points from the object to the camera.
struct View {
  Vec3 right, up, back;
  Vec3 centre;      ///< of what is seen; lies in the middle of the picture
  double scale = 1; ///< pixels per unit of length
  double width = 0, height = 0;

  /// Pixel coordinates (x to the right, y down, pixel centres at .5); z grows towards the camera.
  [[nodiscard]] Vec3 to_pixels(const Vec3& p) const {
    const Vec3 d = p - centre;
    return {width / 2 + scale * dot(d, right), height / 2 - scale * dot(d, up), scale * dot(d, back)};
  }
  /// A direction in the view's axes (x right, y up, z towards the camera).
  [[nodiscard]] Vec3 to_view(const Vec3& v) const { return {dot(v, right), dot(v, up), dot(v, back)}; }
};

/// Axes of the camera that `options` describe. \throws Error{usage}
View make_view(const RenderOptions& options);

} // namespace eigencrust
