// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/render.h>

#include <algorithm>
#include <iterator>

#include "command.h"
#include "picture.h"
#include "standard_streams.h"

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

/// What the command line says of a picture.
struct RenderRequest {
  std::vector<std::string> inputs, views;
  std::string output, up = "y", frame = "bulk", clip_normal, clip_point;
  bool as_points = false, no_colors = false, own_frame = false;
  RenderOptions options;
};

void add_options(OptionTable& app, RenderRequest& r) {
  RenderOptions& options = r.options;
  app.begin_chapter("Picture");
  app.add_option("MESH", r.inputs, "Mesh or point cloud; several are put side by side, in one frame")
      ->required()
      ->type_name(file_to_read);
  app.add_option("-o,--output", r.output, "PNG to write")->required()->type_name(file_to_write);
  app.add_option("--width", options.width, "Pixels, of each of several pictures")->capture_default_str();
  app.add_option("--height", options.height, "Pixels, of each of several pictures")->capture_default_str();
  app.begin_chapter("Camera");
  app.add_option("--view", r.views,
                 "front, back, left, right, top, bottom or corner, instead of the two angles; several, front,top or "
                 "--view front --view top, are several pictures in one")
      ->delimiter(',')
      ->type_name("NAME");
  app.add_option("--azimuth", options.azimuth, "Where the camera stands around the up axis, degrees")
      ->capture_default_str();
  app.add_option("--elevation", options.elevation, "Degrees above the horizon")->capture_default_str();
  app.add_option("--roll", options.roll, "Degrees around the viewing direction")->capture_default_str();
  app.add_option("--zoom", options.zoom, "1: the whole object fits")->capture_default_str();
  app.add_option("--frame", r.frame, "What fits: bulk (of a cloud without points that lie apart) or all")
      ->one_of({"bulk", "all"})
      ->capture_default_str();
  app.add_option("--up", r.up, "Axis that points up: x, y, z, -x, -y or -z")
      ->one_of({"x", "y", "z", "-x", "-y", "-z"})
      ->capture_default_str();
  app.add_flag("--own-frame", r.own_frame, "Of several: let each fit its picture by itself");
  app.begin_chapter("Look");
  app.add_option("--point-size", options.point_size, "Pixels, for clouds")->capture_default_str();
  app.add_option("--clip-normal", r.clip_normal, "x,y,z: cut away what lies on this side of the plane")
      ->type_name("X,Y,Z");
  app.add_option("--clip-point", r.clip_point, "x,y,z of a point of that plane [origin]")->type_name("X,Y,Z");
  app.add_flag("--wireframe", options.wireframe, "Draw the edges");
  app.add_flag("--points", r.as_points, "Draw the vertices of a mesh as points");
  app.add_flag("--no-colors", r.no_colors, "Ignore red, green and blue");
}

/// \throws Error for what cannot be made or written, before anything is read
std::vector<RenderOptions> check_request(RenderRequest& r) {
  RenderOptions& options = r.options;
  const double sign = r.up.front() == '-' ? -1 : 1;
  options.up = r.up.back() == 'x' ? Vec3{sign, 0, 0} : r.up.back() == 'y' ? Vec3{0, sign, 0} : Vec3{0, 0, sign};
  if (!r.clip_normal.empty()) options.clip_normal = parse_point(r.clip_normal);
  if (!r.clip_point.empty()) options.clip_point = parse_point(r.clip_point);
  options.use_colors = !r.no_colors;
  options.framing = r.frame == "all" ? Framing::all : Framing::bulk;
  std::vector<RenderOptions> sides;
  for (const std::string& view : r.views) sides.push_back(seen_from(view, options));
  if (sides.empty()) sides.push_back(options);
  check_picture(r.output);
  return sides;
}

} // namespace

int render_verb(const Arguments& arguments) {
  RenderRequest request;
  OptionTable app("A picture of a mesh or a cloud without a display. Back faces are red, so that inside-out is seen.",
                  "eigencrust render");
  add_options(app, request);
  if (const Parsed parsed = parse(app, arguments); parsed.done) return parsed.status;
  const std::vector<RenderOptions> sides = check_request(request);
  std::vector<Image> pictures;
  std::vector<TriangleMesh> meshes;
  for (const std::string& input : request.inputs) {
    const ReadableFile file(input);
    meshes.push_back(file.reading([&] { return read_anything(file.path(), request.as_points); }));
    if (!request.own_frame) continue;
    std::vector<Image> own = render_sides(meshes, sides);
    std::move(own.begin(), own.end(), std::back_inserter(pictures));
    meshes.clear();
  }
  if (!request.own_frame) pictures = render_sides(meshes, sides);
  write_picture(request.output, pictures, request.inputs.size(), sides.size());
  return 0;
}

} // namespace eigencrust::cli
