// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A picture of a mesh or a cloud without a display.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// What of a cloud has to fit the picture.
enum class Framing : std::uint8_t {
  bulk, ///< all but points that lie apart, unless these are a tenth of the size at most
  all
};

/// What a picture shows, and how large.
struct RenderOptions {
  std::uint32_t width = 1200, height = 900; ///< pixels, 16 to 16384
  double azimuth = 30;                      ///< degrees: where the camera stands around the up axis (0: x to the right)
  double elevation = 20;                    ///< degrees above the horizon
  double roll = 0;                          ///< degrees that the camera turns clockwise around its line of sight
  double zoom = 1;                          ///< 1: what is seen of the object just fits the picture
  Framing framing = Framing::bulk;          ///< meshes are framed whole
  Vec3 up{0, 1, 0};                         ///< which axis points up
  double point_size = 2;                    ///< pixels, for clouds
  /// Keep what lies at dot(p - clip_point, clip_normal) <= 0; zero normal: no clipping (a cutaway).
  Vec3 clip_normal, clip_point;
  bool wireframe = false; ///< draw the triangles' edges
  bool use_colors = true; ///< red/green/blue attributes where there are any
  /// Red, green, blue of outer sides, inner sides and the rest.
  std::array<std::uint8_t, 3> front{222, 205, 178}, back{196, 58, 64}, background{255, 255, 255};
};

/// A picture.
struct Image {
  std::uint32_t width = 0, height = 0; ///< pixels
  std::vector<std::uint8_t> rgb;       ///< 3 × width × height, rows from the top
};

/// Flat-shaded orthographic picture, 3 × 3 supersampled; back faces in `back`, so that a surface turned
/// inside out is seen at once. A mesh without triangles is drawn as points: in the light of their
/// normals (nx, ny, nz) where there are any, else the brighter the nearer. Hollows and creases are
/// darkened. The same pixels for any number of threads.
/// \throws Error{usage} for options out of range, Error{input} when nothing finite is left to draw.
Image render(const TriangleMesh& mesh, const RenderOptions& options = {});

/// Pictures of several objects in one frame: same scale, same place. What fits the picture at zoom 1 is all of them
/// together. \throws as render(), also when nothing of one of them is left to draw
std::vector<Image> render_alike(const std::vector<TriangleMesh>& meshes, const RenderOptions& options = {});

/// Pictures of the objects from several sides, all at one scale: those of the first object by side, then those of the
/// second ... \param sides differ in azimuth, elevation and roll; each has the picture's size and the zoom.
/// \throws as render_alike()
std::vector<Image> render_sides(const std::vector<TriangleMesh>& meshes, const std::vector<RenderOptions>& sides);

/// Options to look from a side, as on a drawing: front, back, left, right, top, bottom, or corner (the default view).
/// The front is where x runs to the right and the up axis up. \throws Error{usage}
RenderOptions seen_from(const std::string& side, RenderOptions options);

/// Puts pictures one below the other. \throws Error{usage} unless all have one width.
Image stacked(const std::vector<Image>& images);

/// Puts pictures side by side, for comparisons. \throws Error{usage} unless all have one height.
Image beside(const std::vector<Image>& images);

/// The bytes of a PNG. \throws Error{input} for a picture whose rows do not fit its size
std::vector<std::byte> encode_png(const Image& image);

/// Writes a PNG, atomically. \throws Error{input}
void write_png(const std::filesystem::path& path, const Image& image);

} // namespace eigencrust
