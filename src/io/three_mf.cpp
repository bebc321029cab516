// SPDX-License-Identifier: GPL-3.0-or-later
// Writes 3MF (3MF Consortium, "3MF Core Specification" 1.3, "Materials and Properties Extension" 1.2) through lib3mf.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include <Model/COM/NMR_DLLInterfaces.h>
#include <eigencrust/error.h>

#include "io/attributes.h"
#include "io/colours.h"
#include "io/formats.h"
#include "io/offset_file.h"
#include "io/precision.h"
#include "io/text.h"
#include "io/three_mf.h"

namespace eigencrust::io {
namespace {

/// How vertices are told: whole numbers of 1e-6 of the vertices' unit, which is 10^-exponent of the mesh's.
struct Encoding {
  Vec3 offset;      ///< subtracted first
  int exponent = 0; ///< from 0 on

  [[nodiscard]] double factor() const { return std::pow(10.0, exponent); }
  [[nodiscard]] std::array<float, 3> operator()(const Vec3& p) const {
    const Vec3 q = factor() * (p - offset);
    return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
  }
};

/// What lib3mf prints of a coordinate: 32-bit floats, times a million, without what is behind the point.
std::int64_t printed(float value) { return static_cast<std::int64_t>(value * 1e6f); }

/// Does the encoding move vertices by no more than `allowed`, and keep different ones apart?
struct Fit {
  bool near = true, distinct = true;
};
Fit try_encoding(const std::vector<Vec3>& vertices, const Encoding& encoding, double allowed) {
  using Key = std::array<std::int64_t, 3>;
  constexpr float largest = 9e12f; // 64 bits hold it times a million
  Fit fit;
  std::vector<std::pair<Key, std::size_t>> keys(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto c = encoding(vertices[v]);
    const Vec3 exact = encoding.factor() * (vertices[v] - encoding.offset);
    Key& key = keys[v].first;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(std::abs(c[k]) < largest)) return {false, false};
      key[k] = printed(c[k]);
    }
    keys[v].second = v;
    const Vec3 moved{static_cast<double>(key[0]) / 1e6 - exact.x, static_cast<double>(key[1]) / 1e6 - exact.y,
                     static_cast<double>(key[2]) / 1e6 - exact.z};
    fit.near = fit.near && norm(moved) <= allowed * encoding.factor();
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (keys[i].first == keys[i - 1].first && vertices[keys[i].second] != vertices[keys[i - 1].second])
      fit.distinct = false;
  return fit;
}

/// As they are where that does; else with a finer unit of the vertices, then also from the box's centre.
Encoding choose_encoding(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result) {
  const double allowed = allowed_rounding * (options.spacing > 0 ? options.spacing : median_edge(mesh));
  constexpr double step = 1e-6; // of what is printed; √3 of it in space
  Encoding encoding;
  if (allowed > 0 && std::isfinite(allowed))
    encoding.exponent = std::clamp(static_cast<int>(std::ceil(std::log10(2 * step / allowed))), 0, 300);
  if (const Fit fit = try_encoding(mesh.vertices, encoding, allowed); fit.near && fit.distinct) return encoding;
  Box3 box;
  for (const Vec3& p : mesh.vertices) box.add(p);
  encoding.offset = box.empty() ? Vec3{} : box.centre();
  const Fit fit = try_encoding(mesh.vertices, encoding, allowed);
  if (!fit.distinct)
    throw Error(ErrorKind::guarantee, "3MF", "the 32-bit coordinates of 3MF would make different vertices equal",
                "write PLY, OBJ or OFF");
  if (encoding.offset != Vec3{})
    result.warnings.push_back(
        "3MF holds 32-bit coordinates only: this was subtracted from them (see the file .offset.txt beside it): " +
        three_numbers(encoding.offset));
  if (!fit.near) result.warnings.emplace_back("rounding to 32 bits moves vertices by more than 1/1000 of the spacing");
  return encoding;
}

/// What lib3mf gave, to be given back. Its functions return 0 when all went well.
template <class T>
class Handle {
 public:
  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (pointer_ != nullptr) NMR::lib3mf_release(pointer_);
  }
  T** fill() { return &pointer_; }
  T* get() const { return pointer_; }

 private:
  T* pointer_ = nullptr;
};

/// \param of the object that knows what went wrong
void require(NMR::PLib3MFBase* of, HRESULT status) {
  if (status == 0) return;
  DWORD code = 0;
  LPCSTR text = nullptr;
  if (of != nullptr) NMR::lib3mf_getlasterror(of, &code, &text);
  throw Error(ErrorKind::input, "3MF",
              "lib3mf cannot write the mesh: " + (text != nullptr ? std::string(text) : std::to_string(status)),
              "write PLY, OBJ or STL");
}

/// A file in memory, as the library wants it.
struct Memory {
  std::string bytes;
  std::size_t at = 0;

  static BOOL write(const BYTE* data, DWORD size, const void* user) {
    auto& memory = *static_cast<Memory*>(const_cast<void*>(user));
    if (memory.bytes.size() < memory.at + size) memory.bytes.resize(memory.at + size);
    std::memcpy(memory.bytes.data() + memory.at, data, size);
    memory.at += size;
    return 0;
  }
  static BOOL seek(ULONG64 position, void* user) {
    static_cast<Memory*>(user)->at = position;
    return 0;
  }
};

/// lib3mf does not escape what it writes as text.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : plain(text)) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

class Writer {
 public:
  Writer(const TriangleMesh& mesh, const WriteOptions& options, const Encoding& encoding, const ViewerColours* colours)
      : mesh_(mesh), options_(options), encoding_(encoding) {
    require(nullptr, NMR::lib3mf_createmodel(model_.fill()));
    require(nullptr, NMR::lib3mf_model_addmeshobject(model_.get(), object_.fill()));
    add_geometry();
    if (colours != nullptr) add_colours(*colours);
    add_item();
    add_texts();
  }

  std::string write() {
    Handle<NMR::PLib3MFModelWriter> writer;
    require(model_.get(), NMR::lib3mf_model_querywriter(model_.get(), "3mf", writer.fill()));
    Memory memory;
    require(writer.get(), NMR::lib3mf_writer_writetocallback(writer.get(), reinterpret_cast<void*>(&Memory::write),
                                                             reinterpret_cast<void*>(&Memory::seek), &memory));
    return std::move(memory.bytes);
  }

 private:
  void add_geometry() {
    std::vector<NMR::MODELMESHVERTEX> vertices(mesh_.vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
      std::ranges::copy(encoding_(mesh_.vertices[v]), vertices[v].m_fPosition);
    std::vector<NMR::MODELMESHTRIANGLE> triangles(mesh_.triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) std::ranges::copy(mesh_.triangles[t], triangles[t].m_nIndices);
    require(object_.get(),
            NMR::lib3mf_meshobject_setgeometry(object_.get(), vertices.data(), static_cast<DWORD>(vertices.size()),
                                               triangles.data(), static_cast<DWORD>(triangles.size())));
  }

  /// Each corner has the colour of its vertex.
  void add_colours(const ViewerColours& colours) {
    const auto colour = [&](std::uint32_t v) {
      return NMR::MODELMESHCOLOR_SRGB{colours.rgba[0][v], colours.rgba[1][v], colours.rgba[2][v],
                                      colours.has_alpha() ? colours.rgba[3][v] : std::uint8_t{255}};
    };
    std::vector<NMR::MODELMESH_TRIANGLECOLOR_SRGB> corners(mesh_.triangles.size());
    for (std::size_t t = 0; t < corners.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) corners[t].m_Colors[k] = colour(mesh_.triangles[t][k]);
    Handle<NMR::PLib3MFPropertyHandler> handler;
    require(object_.get(), NMR::lib3mf_meshobject_createpropertyhandler(object_.get(), handler.fill()));
    require(handler.get(), NMR::lib3mf_propertyhandler_setgradientcolorarray(handler.get(), corners.data()));
    // What has colours must say what it has where there are none.
    Handle<NMR::PLib3MFDefaultPropertyHandler> usual;
    NMR::MODELMESHCOLOR_SRGB first = colour(mesh_.triangles[0][0]);
    require(object_.get(), NMR::lib3mf_object_createdefaultpropertyhandler(object_.get(), usual.fill()));
    require(usual.get(), NMR::lib3mf_defaultpropertyhandler_setcolor(usual.get(), &first));
  }

  /// The unit, and what leads from the vertices' to it. Names that would be random are fixed: same mesh, same bytes.
  void add_item() {
    double factor = 1 / encoding_.factor();
    const auto unit = std::find_if(three_mf_units.begin(), three_mf_units.end(),
                                   [&](const ThreeMfUnit& u) { return u.metres == options_.metres; });
    DWORD number = NMR::MODELUNIT_MILLIMETER;
    if (unit != three_mf_units.end()) {
      number = static_cast<DWORD>(unit - three_mf_units.begin());
    } else if (options_.metres > 0) {
      number = NMR::MODELUNIT_METER;
      factor *= options_.metres;
    }
    require(model_.get(), NMR::lib3mf_model_setunit(model_.get(), number));
    NMR::MODELTRANSFORM transform{};
    for (std::size_t k = 0; k < 3; ++k) transform.m_fFields[k][k] = static_cast<float>(factor);
    Handle<NMR::PLib3MFModelBuildItem> item;
    require(model_.get(), NMR::lib3mf_model_addbuilditem(model_.get(), object_.get(),
                                                         factor == 1 ? nullptr : &transform, item.fill()));
    require(object_.get(), NMR::lib3mf_object_setuuidutf8(object_.get(), "e16e2c25-0000-4000-8000-000000000001"));
    require(item.get(), NMR::lib3mf_builditem_setuuidutf8(item.get(), "e16e2c25-0000-4000-8000-000000000002"));
    require(model_.get(), NMR::lib3mf_model_setbuilduuidutf8(model_.get(), "e16e2c25-0000-4000-8000-000000000003"));
  }

  void add_texts() {
    std::string text;
    for (const std::string& comment : options_.comments) text += (text.empty() ? "" : "; ") + escaped(comment);
    require(model_.get(), NMR::lib3mf_model_addmetadatautf8(model_.get(), "Application", "eigencrust"));
    if (!text.empty())
      require(model_.get(), NMR::lib3mf_model_addmetadatautf8(model_.get(), "Description", text.c_str()));
  }

  const TriangleMesh& mesh_;
  const WriteOptions& options_;
  const Encoding& encoding_;
  Handle<NMR::PLib3MFModel> model_;
  Handle<NMR::PLib3MFModelMeshObject> object_;
};

/// Does each side of a triangle run once that way, and once the other way in another triangle? What 3MF asks of bodies.
bool is_body(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> sides, reversed;
  sides.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) sides.push_back({t[k], t[(k + 1) % 3]});
  for (const auto& [from, to] : sides) reversed.push_back({to, from});
  std::sort(sides.begin(), sides.end());
  std::sort(reversed.begin(), reversed.end());
  return sides == reversed && std::adjacent_find(sides.begin(), sides.end()) == sides.end();
}

} // namespace

Body prepare_three_mf(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result) {
  constexpr std::size_t most = (std::size_t{1} << 31) - 1; // vertices and triangles each, by the specification
  if (mesh.vertices.size() > most || mesh.triangles.size() > most)
    throw Error(ErrorKind::input, "3MF", "3MF has no room for more than 2147483647 vertices or triangles", "write PLY");
  if (mesh.triangles.empty())
    throw Error(ErrorKind::input, "3MF", "3MF cannot hold a mesh without triangles", "write PLY");
  require_finite(mesh, "3MF");
  result.coordinates = CoordinateType::float32;
  auto colours = find_colours(mesh.vertex_attributes);
  warn_lost_attributes(mesh.vertex_attributes, "vertices", colours ? &*colours : nullptr, true, "3MF", result.warnings);
  warn_lost_attributes(mesh.triangle_attributes, "triangles", nullptr, false, "3MF", result.warnings);
  if (!is_body(mesh))
    result.warnings.emplace_back(
        "the mesh is not closed, manifold and oriented: 3MF is for bodies; programs that print will refuse or mend it");
  if (options.metres == 0)
    result.warnings.emplace_back("the unit is not known: 3MF says millimetres then; --unit tells that of the input");
  const Encoding encoding = choose_encoding(mesh, options, result);
  result.offset = encoding.offset;
  return [&mesh, options, encoding, colours](std::ostream& out) {
    const std::string bytes = Writer(mesh, options, encoding, colours ? &*colours : nullptr).write();
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  };
}

} // namespace eigencrust::io
