// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/render.h>

#include <algorithm>

#include "command.h"

namespace eigencrust::cli {
namespace {

/// A file with triangles is drawn as a mesh, any other cloud as points.
TriangleMesh read_anything(const std::string& path, bool as_points) {
  // Formats that may hold triangles; where there are none, the vertices are drawn. A pipe is read but once.
  if (!as_points && can_write_mesh(path)) return read_mesh(path);
  PointCloud cloud = read_point_cloud(path);
  TriangleMesh points;
  points.vertices = std::move(cloud.points);
  points.vertex_attributes = std::move(cloud.attributes);
  return points;
}

} // namespace

int render_verb(const Arguments& arguments) {
  std::vector<std::string> inputs;
  std::string output, up = "y", clip_normal, clip_point;
  bool as_points = false, no_colors = false, own_frame = false;
  RenderOptions options;
  CLI::App app("A picture of a mesh or a cloud without a display. Back faces are red, so that inside-out is seen.",
               "eigencrust render");
  app.add_option("MESH", inputs, "Mesh or point cloud; several are put side by side, in one frame")
      ->required()
      ->type_name(file_to_read);
  app.add_option("-o,--output", output, "PNG to write")->required()->type_name(file_to_write);
  app.add_option("--width", options.width, "Pixels")->capture_default_str();
  app.add_option("--height", options.height, "Pixels")->capture_default_str();
  app.add_option("--azimuth", options.azimuth, "Where the camera stands around the up axis, degrees")
      ->capture_default_str();
  app.add_option("--elevation", options.elevation, "Degrees above the horizon")->capture_default_str();
  app.add_option("--roll", options.roll, "Degrees around the viewing direction")->capture_default_str();
  app.add_option("--zoom", options.zoom, "1: the whole object fits")->capture_default_str();
  app.add_option("--up", up, "Axis that points up: x, y, z, -x, -y or -z")
      ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}))
      ->capture_default_str();
  app.add_option("--point-size", options.point_size, "Pixels, for clouds")->capture_default_str();
  app.add_option("--clip-normal", clip_normal, "x,y,z: cut away what lies on this side of the plane");
  app.add_option("--clip-point", clip_point, "x,y,z of a point of that plane [origin]");
  app.add_flag("--wireframe", options.wireframe, "Draw the edges");
  app.add_flag("--own-frame", own_frame, "Of several: let each fit its picture by itself");
  app.add_flag("--points", as_points, "Draw the vertices of a mesh as points");
  app.add_flag("--no-colors", no_colors, "Ignore red, green and blue");
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  const double sign = up.front() == '-' ? -1 : 1;
  options.up = up.back() == 'x' ? Vec3{sign, 0, 0} : up.back() == 'y' ? Vec3{0, sign, 0} : Vec3{0, 0, sign};
  if (!clip_normal.empty()) options.clip_normal = parse_point(clip_normal);
  if (!clip_point.empty()) options.clip_point = parse_point(clip_point);
  options.use_colors = !no_colors;
  std::string extension = std::filesystem::path(output).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".png")
    throw Error(ErrorKind::usage, output, "pictures are written as PNG only", "end the name in .png");
  std::vector<Image> pictures;
  std::vector<TriangleMesh> meshes;
  for (const std::string& input : inputs) {
    meshes.push_back(read_anything(input, as_points));
    if (!own_frame) continue;
    pictures.push_back(render(meshes.back(), options));
    meshes.clear();
  }
  if (!own_frame) pictures = render_alike(meshes, options);
  write_png(output, beside(pictures));
  return 0;
}

} // namespace eigencrust::cli
