// SPDX-License-Identifier: GPL-3.0-or-later
#include "contest_pictures.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>
#include <eigencrust/render.h>

#include "data_folder.h"

namespace eigencrust::bench {
namespace {

constexpr std::uint32_t picture_size = 400; // pixels

/// A mesh; a file without triangles as its points.
TriangleMesh drawable(const std::string& file) {
  try {
    TriangleMesh mesh = read_mesh(file);
    if (!mesh.triangles.empty()) return mesh;
  } catch (const Error&) { // a cloud
  }
  TriangleMesh points;
  points.vertices = read_point_cloud(file).points;
  return points;
}

/// "x y" with a tenth of a pixel.
std::string place(double x, double y) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f %.1f", x, y);
  return text;
}

/// A panel 300 × 160 whose upper left corner is (left, 0).
std::string panel(const SortedValues& sorted, const char* title, double left) {
  constexpr double width = 280, height = 110, top = 30;
  const float widest = std::max(std::abs(sorted.values.front()), std::abs(sorted.values.back()));
  const double scale = widest > 0 ? height / 2 / static_cast<double>(widest) : 0, middle = top + height / 2;
  const std::size_t n = sorted.values.size(), step = 1 + n / 500; // hardly more places than pixels
  std::string svg = "<text x=\"" + std::to_string(static_cast<int>(left)) + "\" y=\"20\">" + title +
                    "</text><path class=\"zero\" d=\"M" + place(left, middle) + "L" + place(left + width, middle) +
                    "\"/><path class=\"curve\" d=\"";
  for (std::size_t i = 0; i < n; i += step) {
    const double x = left + width * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    svg += (i == 0 ? "M" : "L") + place(x, middle - scale * static_cast<double>(sorted.values[i]));
  }
  return svg + "\"/>";
}

} // namespace

void draw_contest(const ContestCase& item, const std::string& files, const std::filesystem::path& picture) {
  RenderOptions view = item.view;
  view.width = view.height = picture_size;
  view.point_size = 1;
  view.use_colors = false; // some programs write black ones
  std::vector<Image> images;
  for (const std::string& file : CLI::detail::split(files, ',')) images.push_back(render(drawable(file), view));
  write_png(picture, beside(images));
}

void draw_curves(const std::filesystem::path& cloud, const std::filesystem::path& picture, unsigned threads) {
  Options options = Options::of(Preset::paper);
  options.threads = threads;
  PageObserver observer(*default_observer());
  reconstruct(read_point_cloud(cloud), options, observer);
  write_text(picture.string(), curves_svg(observer.products().poles, observer.products().tetrahedra));
}

std::string curves_svg(const SortedValues& first, const SortedValues& second) {
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"600\" height=\"150\" viewBox=\"0 0 600 150\" "
      "font-family=\"sans-serif\" font-size=\"12\"><style>.zero{stroke:#999;fill:none}.curve{stroke:#246;fill:none;"
      "stroke-width:1.5}</style><rect width=\"600\" height=\"150\" fill=\"#fff\"/>";
  if (!first.values.empty()) svg += panel(first, "first eigenvector, one value per pole", 10);
  if (!second.values.empty()) svg += panel(second, "second eigenvector, one per tetrahedron left", 310);
  return svg + "</svg>\n";
}

} // namespace eigencrust::bench
