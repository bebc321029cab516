// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/render.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "geometry/mesh_topology.h"
#include "render/camera.h"
#include "render/canvas.h"
#include "render/framing.h"

namespace eigencrust {
namespace {

constexpr double margin = 0.92; ///< share of the picture's width or height that the object fills at zoom 1

void check(const RenderOptions& o) {
  const auto refuse = [](const char* cause, const char* remedy) {
    throw Error(ErrorKind::usage, "render", cause, remedy);
  };
  if (std::min(o.width, o.height) < 16 || std::max(o.width, o.height) > 16384)
    refuse("the picture's size is out of range", "choose 16 to 16384 pixels");
  if (!(o.zoom > 0) || !std::isfinite(o.zoom)) refuse("the zoom is not positive", "choose a number around 1");
  if (!(o.point_size > 0 && o.point_size <= 1000)) refuse("the point size is out of range", "choose 0 to 1000 pixels");
  if (!is_finite(o.clip_normal) || !is_finite(o.clip_point))
    refuse("the clip plane is not finite", "give a point and a normal");
}

/// Positive on the side of the clip plane that is cut away.
double clip_value(const RenderOptions& o, const Vec3& p) { return dot(p - o.clip_point, o.clip_normal); }

/// Linear light of a color of bytes.
LinearColor linear(const std::array<std::uint8_t, 3>& c) {
  return {to_linear(c[0] / 255.0), to_linear(c[1] / 255.0), to_linear(c[2] / 255.0)};
}

/// Attributes red, green and blue with one value per row: bytes, 16-bit numbers, or fractions of 1.
std::optional<std::vector<LinearColor>> find_colors(const std::vector<Attribute>& attributes, std::size_t rows) {
  std::vector<LinearColor> colors(rows);
  const char* const names[] = {"red", "green", "blue"};
  for (std::size_t c = 0; c < 3; ++c) {
    const Attribute* a = find_attribute(attributes, names[c]);
    if (a == nullptr || a->is_list || a->rows() != rows) return std::nullopt;
    const bool fraction = a->type == ScalarType::float32 || a->type == ScalarType::float64;
    const double whole = fraction ? 1 : a->type == ScalarType::uint16 ? 65535 : 255;
    for (std::size_t i = 0; i < rows; ++i) {
      const double value = attribute_value(*a, i) / whole;
      colors[i][c] = std::isfinite(value) ? to_linear(value) : 0;
    }
  }
  return colors;
}

/// Attributes nx, ny, nz with one value per row.
std::optional<std::vector<Vec3>> find_normals(const std::vector<Attribute>& attributes, std::size_t rows) {
  std::vector<Vec3> normals(rows);
  const std::pair<const char*, double Vec3::*> names[] = {{"nx", &Vec3::x}, {"ny", &Vec3::y}, {"nz", &Vec3::z}};
  for (const auto& [name, axis] : names) {
    const Attribute* a = find_attribute(attributes, name);
    if (a == nullptr || a->is_list || a->rows() != rows) return std::nullopt;
    for (std::size_t i = 0; i < rows; ++i) normals[i].*axis = attribute_value(*a, i);
  }
  return normals;
}

/// Light sent to the camera by a matt surface with the unit normal n in the view's axes (n.z >= 0): a
/// soft key light from the upper left, a weak one from the right, and the sky.
double brightness(const Vec3& n) {
  const auto lit = [&](const Vec3& light, double wrap) {
    return std::max(0.0, (dot(n, light) / norm(light) + wrap) / (1 + wrap));
  };
  return 1.1 * lit({-0.6, 0.7, 0.7}, 0.12) + 0.2 * lit({0.9, 0.05, 0.4}, 0.1) + 0.14 + 0.07 * n.y;
}

LinearColor shaded(const LinearColor& color, double light) {
  const auto k = static_cast<float>(light);
  return {k * color[0], k * color[1], k * color[2]};
}

/// A triangle is drawn when its corners are finite and not all of them are cut away.
bool visible(const TriangleMesh& mesh, const Triangle& t, const RenderOptions& o) {
  bool kept = false;
  for (const std::uint32_t v : t) {
    if (!is_finite(mesh.vertices[v])) return false;
    kept = kept || clip_value(o, mesh.vertices[v]) <= 0;
  }
  return kept;
}

/// Corners of what is seen of a mesh, where the clip plane cuts the sides included.
std::vector<Vec3> seen_corners(const TriangleMesh& mesh, const RenderOptions& o) {
  std::vector<Vec3> corners;
  std::vector<std::uint8_t> taken(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    if (!visible(mesh, t, o)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = t[k];
      const Vec3 &a = mesh.vertices[v], &b = mesh.vertices[t[(k + 1) % 3]];
      const double fa = clip_value(o, a), fb = clip_value(o, b);
      if (fa <= 0 && std::exchange(taken[v], 1) == 0) corners.push_back(a);
      if ((fa < 0 && fb > 0) || (fa > 0 && fb < 0)) corners.push_back(a + (fa / (fa - fb)) * (b - a));
    }
  }
  return corners;
}

std::vector<ScreenTriangle> screen_triangles(const TriangleMesh& mesh, const RenderOptions& o, const View& view) {
  const auto by_vertex = o.use_colors ? find_colors(mesh.vertex_attributes, mesh.vertices.size()) : std::nullopt;
  const auto by_triangle = o.use_colors ? find_colors(mesh.triangle_attributes, mesh.triangles.size()) : std::nullopt;
  const LinearColor front = linear(o.front), back = linear(o.back);
  std::vector<ScreenTriangle> result;
  result.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (!visible(mesh, t, o)) continue;
    const std::array<Vec3, 3> p{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    Vec3 normal = view.to_view(cross(p[1] - p[0], p[2] - p[0]));
    const double length = norm(normal);
    if (!(length > 0)) continue;
    ScreenTriangle s;
    s.front = normal.z >= 0;
    normal = ((s.front ? 1 : -1) / length) * normal;
    const double light = brightness(normal);
    for (std::size_t k = 0; k < 3; ++k) {
      s.corner[k] = view.to_pixels(p[k]);
      s.clip[k] = clip_value(o, p[k]);
      s.color[k] = !s.front ? back : by_vertex ? (*by_vertex)[t[k]] : by_triangle ? (*by_triangle)[i] : front;
      s.color[k] = shaded(s.color[k], light);
    }
    result.push_back(s);
  }
  return result;
}

std::vector<std::uint32_t> seen_points(const TriangleMesh& mesh, const RenderOptions& o) {
  std::vector<std::uint32_t> seen;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (is_finite(mesh.vertices[v]) && clip_value(o, mesh.vertices[v]) <= 0) seen.push_back(v);
  return seen;
}

/// Points take the light of their normal where they have one (in the colour of the back when it points
/// away), else are the brighter the nearer they are.
std::vector<ScreenDisc> screen_discs(const TriangleMesh& mesh, std::span<const std::uint32_t> seen,
                                     const RenderOptions& o, const View& view) {
  const auto colors = o.use_colors ? find_colors(mesh.vertex_attributes, mesh.vertices.size()) : std::nullopt;
  const auto normals = find_normals(mesh.vertex_attributes, mesh.vertices.size());
  const LinearColor front = linear(o.front), back = linear(o.back);
  std::vector<ScreenDisc> discs(seen.size());
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    discs[i].centre = view.to_pixels(mesh.vertices[seen[i]]);
    lowest = std::min(lowest, discs[i].centre.z);
    highest = std::max(highest, discs[i].centre.z);
  }
  const double range = std::max(highest - lowest, 1e-9);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    discs[i].color = colors ? (*colors)[seen[i]] : front;
    if (normals) {
      const Vec3 n = view.to_view((*normals)[seen[i]]);
      const double length = norm(n);
      if (length > 0 && std::isfinite(length)) {
        if (n.z < 0) discs[i].color = back;
        discs[i].color = shaded(discs[i].color, brightness(((n.z < 0 ? -1 : 1) / length) * n));
        continue;
      }
    }
    if (!colors) discs[i].color = shaded(front, 0.35 + 0.6 * (discs[i].centre.z - lowest) / range);
  }
  return discs;
}

/// Makes the middle of what is seen, which is not nothing, that of the picture.
/// \return the scale at which it just fits
double frame(View& view, std::span<const Vec3> seen) {
  view.centre = seen[0]; // a first origin close by: no digits are lost far from zero
  Box3 box;
  for (const Vec3& p : seen) box.add(view.to_view(p - view.centre));
  const Vec3 middle = box.centre(), size = box.max - box.min;
  view.centre = view.centre + middle.x * view.right + middle.y * view.up + middle.z * view.back;
  // What is seen edge-on or is a single point still has its depth as a measure.
  const double fit = std::max({size.x / view.width, size.y / view.height, 1e-3 * size.z / view.width});
  return fit > 0 ? margin / fit : 1;
}

/// The places that the frame must hold. \throws Error{input} when nothing is seen
std::vector<Vec3> seen_places(const TriangleMesh& mesh, const RenderOptions& o) {
  require_valid_indices(mesh, "render");
  std::vector<Vec3> places;
  if (!mesh.triangles.empty())
    places = seen_corners(mesh, o);
  else
    for (const std::uint32_t v : seen_points(mesh, o)) places.push_back(mesh.vertices[v]);
  if (mesh.triangles.empty() && o.framing == Framing::bulk) places = bulk_of(std::move(places));
  if (places.empty())
    throw Error(ErrorKind::input, "render", "nothing finite is left to draw", "check the input and the clip plane");
  return places;
}

Image draw(const TriangleMesh& mesh, const RenderOptions& o, const View& view, const Threads& threads) {
  if (!mesh.triangles.empty()) {
    const std::vector<ScreenTriangle> triangles = screen_triangles(mesh, o, view);
    return finish(draw_triangles(triangles, o.width, o.height, o.wireframe ? 1 : 0, threads), o.background, threads);
  }
  const std::vector<ScreenDisc> discs = screen_discs(mesh, seen_points(mesh, o), o, view);
  return finish(draw_discs(discs, o.width, o.height, o.point_size, threads), o.background, threads);
}

} // namespace

Image render(const TriangleMesh& mesh, const RenderOptions& options) {
  check(options);
  View view = make_view(options);
  view.scale = options.zoom * frame(view, seen_places(mesh, options));
  return draw(mesh, options, view, Threads());
}

std::vector<Image> render_alike(const std::vector<TriangleMesh>& meshes, const RenderOptions& options) {
  return render_sides(meshes, {options});
}

std::vector<Image> render_sides(const std::vector<TriangleMesh>& meshes, const std::vector<RenderOptions>& sides) {
  for (const RenderOptions& options : sides) check(options);
  std::vector<Image> images;
  if (meshes.empty() || sides.empty()) return images;
  std::vector<Vec3> places;
  for (const TriangleMesh& mesh : meshes) {
    const std::vector<Vec3> more = seen_places(mesh, sides[0]);
    places.insert(places.end(), more.begin(), more.end());
  }
  std::vector<View> views;
  double scale = std::numeric_limits<double>::infinity();
  for (const RenderOptions& options : sides) {
    views.push_back(make_view(options));
    scale = std::min(scale, frame(views.back(), places));
  }
  const Threads threads;
  for (const TriangleMesh& mesh : meshes)
    for (std::size_t i = 0; i < sides.size(); ++i) {
      views[i].scale = sides[i].zoom * scale;
      images.push_back(draw(mesh, sides[i], views[i], threads));
    }
  return images;
}

RenderOptions seen_from(const std::string& side, RenderOptions options) {
  struct NamedSide {
    const char* name;
    double azimuth, elevation;
  };
  constexpr std::array<NamedSide, 7> known{{{"front", 0, 0},
                                            {"right", 90, 0},
                                            {"back", 180, 0},
                                            {"left", 270, 0},
                                            {"top", 0, 90},
                                            {"bottom", 0, -90},
                                            {"corner", 30, 20}}};
  std::string names;
  for (const NamedSide& s : known) {
    if (side == s.name) {
      options.azimuth = s.azimuth;
      options.elevation = s.elevation;
      return options;
    }
    names += (names.empty() ? "" : ", ") + std::string(s.name);
  }
  throw Error(ErrorKind::usage, "render", "'" + side + "' is no view", "use " + names);
}

} // namespace eigencrust
