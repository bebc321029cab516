// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <eigencrust/error.h>
#include <eigencrust/render.h>

#include "bindings.h"

namespace eigencrust::python {
namespace {

using Colour = std::array<std::uint8_t, 3>;

Vec3 vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

py::array array_of(Image image) {
  const auto height = static_cast<py::ssize_t>(image.height), width = static_cast<py::ssize_t>(image.width);
  return own(std::move(image.rgb)).reshape({height, width, py::ssize_t{3}});
}

Image image_of(const py::array_t<std::uint8_t, py::array::c_style>& pixels) {
  if (pixels.ndim() != 3 || pixels.shape(2) != 3)
    throw Error(ErrorKind::input, "picture", "it is no array (height, width, 3) of uint8",
                "take what render() returns");
  Image image{static_cast<std::uint32_t>(pixels.shape(1)), static_cast<std::uint32_t>(pixels.shape(0)), {}};
  image.rgb.assign(pixels.data(), pixels.data() + pixels.size());
  return image;
}

/// \throws Error{usage}
Framing framing_of(const std::string& frame) {
  if (frame == "bulk") return Framing::bulk;
  if (frame == "all") return Framing::all;
  throw Error(ErrorKind::usage, "frame", "'" + frame + "' is not known", "use bulk or all");
}

} // namespace

void bind_pictures(py::module_& module) {
  const RenderOptions standard;
  module.def(
      "render",
      [](const std::vector<std::shared_ptr<TriangleMesh>>& objects, std::uint32_t width, std::uint32_t height,
         double azimuth, double elevation, double roll, double zoom, const std::array<double, 3>& up,
         const std::string& view, const std::string& frame, double point_size, const std::array<double, 3>& clip_normal,
         const std::array<double, 3>& clip_point, bool wireframe, bool use_colors, Colour front, Colour back,
         Colour background) {
        RenderOptions o;
        o.width = width;
        o.height = height;
        o.azimuth = azimuth;
        o.elevation = elevation;
        o.roll = roll;
        o.zoom = zoom;
        o.up = vector_of(up);
        o.point_size = point_size;
        o.clip_normal = vector_of(clip_normal);
        o.clip_point = vector_of(clip_point);
        o.wireframe = wireframe;
        o.use_colors = use_colors;
        o.front = front;
        o.back = back;
        o.background = background;
        o.framing = framing_of(frame);
        if (!view.empty()) o = seen_from(view, o);
        Image image;
        {
          const py::gil_scoped_release unlocked;
          if (objects.size() == 1) {
            image = render(*objects[0], o);
          } else {
            std::vector<TriangleMesh> meshes;
            for (const auto& object : objects) meshes.push_back(*object);
            image = beside(render_alike(meshes, o));
          }
        }
        return array_of(std::move(image));
      },
      py::arg("objects"), py::kw_only(), py::arg("width") = standard.width, py::arg("height") = standard.height,
      py::arg("azimuth") = standard.azimuth, py::arg("elevation") = standard.elevation, py::arg("roll") = standard.roll,
      py::arg("zoom") = standard.zoom, py::arg("up") = std::array<double, 3>{0, 1, 0}, py::arg("view") = "",
      py::arg("frame") = "bulk", py::arg("point_size") = standard.point_size,
      py::arg("clip_normal") = std::array<double, 3>{}, py::arg("clip_point") = std::array<double, 3>{},
      py::arg("wireframe") = standard.wireframe, py::arg("use_colors") = standard.use_colors,
      py::arg("front") = standard.front, py::arg("back") = standard.back, py::arg("background") = standard.background);
  module.def("encode_png", [](const py::array_t<std::uint8_t, py::array::c_style>& pixels) {
    const std::vector<std::byte> bytes = encode_png(image_of(pixels));
    return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  });
  module.def("write_png",
             [](const std::filesystem::path& path, const py::array_t<std::uint8_t, py::array::c_style>& pixels) {
               write_png(path, image_of(pixels));
             });
}

} // namespace eigencrust::python
