// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/page.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include <eigencrust/error.h>
#include <eigencrust/render.h>
#include <eigencrust/report.h>

#include "page/base64.h"
#include "page/view_mesh.h"

namespace eigencrust {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view place_for_data = "<!--eigencrust:data-->";
constexpr std::size_t most_triangles = 250000; // of each mesh in the view: a page of 10 MB that still turns smoothly

/// A script element that holds data; the browser does not run it.
void add_data(std::ostream& out, const std::string& id, const char* type, std::string_view text) {
  out << "<script id=\"" << id << "\" type=\"" << type << "\">" << text << "</script>\n";
}

/// What ends a script element in the middle of it would be a `<`; JSON has it in strings only.
std::string within_script(const std::string& json) {
  std::string text;
  for (const char c : json)
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  return text;
}

template <class T>
std::string text_of(const std::vector<T>& values) {
  return base64(std::as_bytes(std::span(values)));
}

/// The page's buffers, each an element of its own, and what a script must know of them.
class Buffers {
 public:
  explicit Buffers(std::ostream& out) : out_(out) {}

  /// Places as 16-bit numbers within their own box: finer than a pixel.
  void add(const std::string& id, const std::vector<Vec3>& places) {
    Box3 box;
    for (const Vec3& p : places) box.add(p);
    if (places.empty()) box.add({0, 0, 0});
    const Vec3 size = box.max - box.min;
    constexpr double most = 65535;
    std::vector<std::uint16_t> numbers;
    numbers.reserve(3 * places.size());
    const auto number = [](double value, double low, double length) {
      return static_cast<std::uint16_t>(length > 0 ? std::lround((value - low) / length * most) : 0);
    };
    for (const Vec3& p : places)
      numbers.insert(numbers.end(),
                     {number(p.x, box.min.x, size.x), number(p.y, box.min.y, size.y), number(p.z, box.min.z, size.z)});
    said_[id] = {{"count", places.size()},
                 {"low", {box.min.x, box.min.y, box.min.z}},
                 {"step", {size.x / most, size.y / most, size.z / most}}};
    add_data(out_, id, "text/plain", text_of(numbers));
  }
  /// Places that may be far from all others, from `middle` on, which is what the view turns around.
  void add_scattered(const std::string& id, const std::vector<Vec3>& places, const Vec3& middle) {
    std::vector<float> numbers;
    numbers.reserve(3 * places.size());
    for (const Vec3& p : places)
      for (const double x : {p.x - middle.x, p.y - middle.y, p.z - middle.z}) numbers.push_back(static_cast<float>(x));
    said_[id] = {{"count", places.size()}, {"low", {middle.x, middle.y, middle.z}}, {"step", nullptr}};
    add_data(out_, id, "text/plain", text_of(numbers));
  }
  void add(const std::string& id, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    said_[id] = {{"count", triangles.size()}};
    add_data(out_, id, "text/plain", text_of(triangles));
  }
  void add(const std::string& id, const std::vector<std::uint8_t>& bytes) {
    said_[id] = {{"count", bytes.size()}};
    add_data(out_, id, "text/plain", text_of(bytes));
  }
  [[nodiscard]] const Json& said() const { return said_; }

 private:
  std::ostream& out_;
  Json said_ = Json::object();
};

double area_of(const TriangleMesh& mesh, std::size_t i) {
  const auto& [a, b, c] = mesh.triangles[i];
  return norm(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a])) / 2;
}

std::vector<double> support_of(const TriangleMesh& mesh) {
  std::vector<double> support;
  const Attribute* column = find_attribute(mesh.triangle_attributes, "support");
  for (std::size_t i = 0; column != nullptr && i < column->rows(); ++i) support.push_back(attribute_value(*column, i));
  return support;
}

Json json_of(const SortedValues& v) {
  if (v.count == 0) return {};
  return {{"values", v.values}, {"count", v.count}, {"inside", v.inside}};
}

Json json_of(const Histogram& h) {
  if (h.counts.empty()) return {};
  return {{"low", h.low}, {"high", h.high}, {"counts", h.counts}};
}

/// Area by support.
Histogram support_by_area(const TriangleMesh& mesh, const std::vector<double>& support) {
  constexpr std::size_t bins = 20;
  Histogram histogram{0, 1, {}};
  if (support.size() != mesh.triangles.size() || support.empty()) return histogram;
  histogram.counts.assign(bins, 0);
  for (std::size_t i = 0; i < support.size(); ++i) {
    const double place = std::clamp(support[i] * static_cast<double>(bins), 0.0, static_cast<double>(bins - 1));
    histogram.counts[static_cast<std::size_t>(place)] += area_of(mesh, i);
  }
  return histogram;
}

/// Mesh and marks, small enough for the view.
Json add_mesh(Buffers& buffers, const TriangleMesh& mesh, const std::vector<double>& support,
              const std::vector<std::uint8_t>& unsupported) {
  const ViewMesh view = view_mesh(mesh, most_triangles);
  buffers.add("mesh.places", view.mesh.vertices);
  buffers.add("mesh.triangles", view.mesh.triangles);
  std::vector<std::uint8_t> bytes, marks;
  for (const std::uint32_t i : view.triangle) {
    if (!support.empty()) bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(support[i], 0., 1.))));
    if (!unsupported.empty()) marks.push_back(unsupported[i]);
  }
  if (!bytes.empty()) buffers.add("mesh.support", bytes);
  if (!marks.empty()) buffers.add("mesh.invented", marks);
  return {{"shown", view.mesh.triangles.size()}, {"all", mesh.triangles.size()}};
}

/// The mesh for pictures, what was invented in a colour of its own.
TriangleMesh painted(const TriangleMesh& mesh, const std::vector<std::uint8_t>& unsupported) {
  TriangleMesh picture{mesh.vertices, mesh.triangles, {}, {}};
  if (unsupported.size() != mesh.triangles.size()) return picture;
  for (std::size_t i = 0; i < unsupported.size(); ++i) {
    if (!unsupported[i]) continue;
    for (std::uint32_t& v : picture.triangles[i]) {
      picture.vertices.push_back(mesh.vertices[v]);
      v = static_cast<std::uint32_t>(picture.vertices.size() - 1);
    }
  }
  constexpr std::array<double, 3> measured{222, 205, 178}, invented{235, 125, 35};
  const char* const names[] = {"red", "green", "blue"};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> column(picture.vertices.size(), measured[c]);
    std::fill(column.begin() + static_cast<std::ptrdiff_t>(mesh.vertices.size()), column.end(), invented[c]);
    picture.vertex_attributes.push_back(make_attribute(names[c], ScalarType::uint8, column));
  }
  return picture;
}

/// Six pictures for those who print.
void add_pictures(std::ostream& out, const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return;
  RenderOptions look;
  look.width = 480;
  look.height = 400;
  look.up = {0, 0, 1};
  const std::array<const char*, 6> names{"front", "back", "left", "right", "top", "bottom"};
  std::vector<RenderOptions> sides;
  for (const char* name : names) sides.push_back(seen_from(name, look));
  const std::vector<Image> images = render_sides({mesh}, sides);
  for (std::size_t i = 0; i < names.size(); ++i)
    add_data(out, std::string("picture.") + names[i], "text/plain", text_of(encode_png(images[i])));
}

} // namespace

void write_page(std::ostream& out, std::string_view viewer, const Result& result, const PageProducts& products) {
  const std::size_t at = viewer.find(place_for_data);
  if (at == std::string_view::npos)
    throw Error(ErrorKind::input, "viewer.html", "the viewer has no place for the data",
                "build it again with scripts/viewer.sh");
  out << viewer.substr(0, at);
  add_data(out, "report", "application/json", within_script(to_json(result.report)));
  const std::vector<double> support = support_of(result.mesh);
  Buffers buffers(out);
  Json scene;
  scene["mesh"] = add_mesh(buffers, result.mesh, support, products.unsupported);
  const ViewMesh left_out = view_mesh(products.left_out, most_triangles);
  buffers.add("left_out.places", left_out.mesh.vertices);
  buffers.add("left_out.triangles", left_out.mesh.triangles);
  scene["left_out"] = {{"shown", left_out.mesh.triangles.size()}, {"all", products.left_out.triangles.size()}};
  buffers.add("points", products.points);
  scene["points"] = {{"shown", products.points.size()}, {"all", products.point_count}};
  Box3 box;
  for (const Vec3& v : result.mesh.vertices) box.add(v);
  const Vec3 middle = box.empty() ? Vec3{} : box.centre();
  buffers.add_scattered("outliers", products.outliers, middle);
  scene["outliers"] = {{"shown", products.outliers.size()}, {"all", products.outlier_count}};
  buffers.add_scattered("poles.inside", products.inside_poles, middle);
  buffers.add_scattered("poles.outside", products.outside_poles, middle);
  scene["values"] = {{"poles", json_of(products.poles)}, {"tetrahedra", json_of(products.tetrahedra)}};
  scene["histograms"] = {{"support", json_of(support_by_area(result.mesh, support))},
                         {"noise", json_of(products.noise)},
                         {"confidence", json_of(products.confidence)}};
  scene["buffers"] = buffers.said();
  add_data(out, "scene", "application/json", within_script(scene.dump()));
  add_pictures(out, painted(result.mesh, products.unsupported));
  out << viewer.substr(at + place_for_data.size());
}

} // namespace eigencrust
