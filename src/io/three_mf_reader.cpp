// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the bodies of 3MF files: a zip archive that holds XML. Not through lib3mf, which has no bound for what a small
// file unpacks to, nor for how often its build repeats a part.
#include <cmath>
#include <map>
#include <pugixml.hpp>

#include "io/formats.h"
#include "io/frame.h"
#include "io/polygons.h"
#include "io/text.h"
#include "io/three_mf.h"
#include "io/vertex_rows.h"
#include "io/zip.h"

namespace eigencrust::io {
namespace {

constexpr const char* export_again =
    "the file does not follow the 3MF specification; export it again with another program";

/// Names in an archive count without case and leading slash.
std::string_view bare(std::string_view name) { return name.starts_with('/') ? name.substr(1) : name; }

/// The name of an element without the prefix of its namespace.
std::string_view local(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  return name.substr(name.find(':') + 1);
}

class Package {
 public:
  explicit Package(const FileContent& file)
      : file_(file), members_(read_zip_directory(file)), budget_(zip_budget(file.bytes().size())) {}

  /// The part that holds the model: named by the relations of the archive, else known by its ending.
  std::string model() {
    std::string name;
    if (const ZipMember* relations = find("_rels/.rels")) {
      const std::string text = unpack_zip_member(file_, *relations, budget_);
      pugi::xml_document document;
      if (document.load_buffer(text.data(), text.size()))
        for (const pugi::xml_node node : document.document_element().children())
          if (std::string_view(node.attribute("Type").value()).ends_with("/3dmodel") && name.empty())
            name = node.attribute("Target").value();
    }
    const ZipMember* member = find(name);
    for (const ZipMember& each : members_)
      if (member == nullptr && lower_case(each.name).ends_with(".model")) member = &each;
    if (member == nullptr) file_.fail("the archive holds no 3D model", export_again);
    return unpack_zip_member(file_, *member, budget_);
  }

 private:
  const ZipMember* find(std::string_view name) const {
    for (const ZipMember& member : members_)
      if (!name.empty() && equal_ignoring_case(bare(member.name), bare(name))) return &member;
    return nullptr;
  }

  const FileContent& file_;
  std::vector<ZipMember> members_;
  std::uint64_t budget_;
};

class ModelReader {
 public:
  ModelReader(const FileContent& file, std::string xml, MeshNotes& notes)
      : file_(file), notes_(notes), xml_(std::move(xml)), budget_(xml_.size()) {}

  TriangleMesh read() {
    const pugi::xml_parse_result result = document_.load_buffer_inplace(xml_.data(), xml_.size());
    if (!result) fail(std::string("its XML cannot be read (") + result.description() + ")");
    const pugi::xml_node model = document_.document_element();
    if (local(model) != "model") fail("its XML is no model");
    read_unit(model);
    for (const pugi::xml_node node : model.child("resources").children()) read_resource(node);
    std::size_t items = 0;
    for (const pugi::xml_node item : model.child("build").children("item")) {
      ++items;
      add_object(item, Frame{}, objects_.size());
    }
    if (items == 0) fail("it has nothing to build");
    if (elsewhere_ > 0)
      notes_.notes.push_back(plural(elsewhere_, "object") + " in other parts of the archive left out");
    rows_.give(mesh_);
    check_vertex_count(mesh_, file_);
    return std::move(mesh_);
  }

 private:
  struct Object {
    pugi::xml_node node;
    std::size_t order; ///< components are of objects that come before
  };
  using Colour = std::array<std::uint8_t, 4>;

  [[noreturn]] void fail(const std::string& cause) const {
    file_.fail("the 3D model is damaged: " + cause, export_again);
  }

  void take(std::uint64_t count) {
    if (count > budget_) file_.fail("the build repeats its parts too many times", "export one of them");
    budget_ -= count;
  }

  void read_unit(const pugi::xml_node& model) {
    const pugi::xml_attribute unit = model.attribute("unit");
    const std::string_view name = unit ? unit.value() : "millimeter";
    for (const ThreeMfUnit& known : three_mf_units)
      if (name == known.name) notes_.metres = known.metres;
    if (notes_.metres == 0) fail("its unit " + shown(name) + " is not known");
  }

  /// \param absent what a missing attribute means; none: it must be there
  std::uint64_t natural(const pugi::xml_node& node, const char* name, const std::uint64_t* absent = nullptr) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    std::uint64_t value = 0;
    if (!attribute && absent != nullptr) return *absent;
    if (!parse(attribute.value(), value))
      fail(std::string(name) + " of an element " + shown(node.name()) + " is no whole number");
    return value;
  }
  double number(const pugi::xml_node& node, const char* name) const {
    double value = 0;
    if (!parse(node.attribute(name).value(), value) || !std::isfinite(value))
      fail(std::string(name) + " of an element " + shown(node.name()) + " is no finite number");
    return value;
  }

  void read_resource(const pugi::xml_node& node) {
    const std::string_view kind = local(node);
    if (kind == "object")
      objects_.try_emplace(natural(node, "id"), Object{node, objects_.size()});
    else if (kind == "colorgroup")
      read_colours(node, "color", "color");
    else if (kind == "basematerials")
      read_colours(node, "base", "displaycolor");
  }

  void read_colours(const pugi::xml_node& group, std::string_view element, const char* attribute) {
    std::vector<Colour>& colours = colours_[natural(group, "id")];
    for (const pugi::xml_node node : group.children())
      if (local(node) == element) colours.push_back(read_colour(node.attribute(attribute).value()));
  }

  /// #RRGGBB or #RRGGBBAA; anything else is white.
  static Colour read_colour(std::string_view text) {
    Colour colour{255, 255, 255, 255};
    if ((text.size() != 7 && text.size() != 9) || text[0] != '#') return colour;
    for (std::size_t k = 0; 2 * k + 1 < text.size(); ++k) {
      unsigned byte = 0;
      for (const char c : text.substr(1 + 2 * k, 2)) {
        const bool letter = (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
        if (!letter && !is_digit(c)) return {255, 255, 255, 255};
        byte = 16 * byte + static_cast<unsigned>(letter ? (c | 32) - 'a' + 10 : c - '0');
      }
      colour[k] = static_cast<std::uint8_t>(byte);
    }
    return colour;
  }

  /// Twelve numbers, three of each axis, then three of the place.
  Frame read_frame(const pugi::xml_node& node) const {
    Frame frame;
    const pugi::xml_attribute attribute = node.attribute("transform");
    if (!attribute) return frame;
    Fields words;
    split_words(attribute.value(), words);
    std::array<double, 12> m{};
    bool sound = words.size() == m.size();
    for (std::size_t i = 0; sound && i < m.size(); ++i) sound = parse(words[i], m[i]) && std::isfinite(m[i]);
    if (!sound) fail("a transform is not twelve finite numbers");
    for (std::size_t i = 0; i < 3; ++i) frame.rows[i] = {m[i], m[3 + i], m[6 + i]};
    frame.place = {m[9], m[10], m[11]};
    return frame;
  }

  /// \param item names the object \param before only objects that come before may be named
  void add_object(const pugi::xml_node& item, const Frame& outer, std::size_t before) {
    take(1);
    for (const pugi::xml_attribute attribute : item.attributes())
      if (std::string_view(attribute.name()).ends_with(":path")) {
        ++elsewhere_;
        return;
      }
    const std::uint64_t id = natural(item, "objectid");
    const auto found = objects_.find(id);
    if (found == objects_.end() || found->second.order >= before)
      fail("object " + std::to_string(id) + " does not exist, or not before it is named");
    const Frame frame = outer * read_frame(item);
    if (!frame.finite()) fail("a transform leads to infinity");
    const auto& [node, order] = found->second;
    if (const pugi::xml_node mesh = node.child("mesh")) add_mesh(node, mesh, frame);
    if (depth_ == deepest) fail("its components are nested too deeply");
    ++depth_;
    for (const pugi::xml_node component : node.child("components").children("component"))
      add_object(component, frame, order);
    --depth_;
  }

  void add_mesh(const pugi::xml_node& object, const pugi::xml_node& mesh, const Frame& frame) {
    const std::size_t first = mesh_.vertices.size();
    for (const pugi::xml_node v : mesh.child("vertices").children("vertex")) {
      take(1);
      mesh_.vertices.push_back(frame({number(v, "x"), number(v, "y"), number(v, "z")}));
    }
    const std::size_t count = mesh_.vertices.size() - first;
    coloured_.assign(count, false);
    const bool mirrored = frame.determinant() < 0;
    for (const pugi::xml_node t : mesh.child("triangles").children("triangle")) {
      take(1);
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        constexpr std::array<const char*, 3> names = {"v1", "v2", "v3"};
        const std::uint64_t v = natural(t, names[k]);
        if (v >= count) fail("a triangle names vertex " + std::to_string(v) + " of " + std::to_string(count));
        corners[k] = static_cast<std::uint32_t>(first + v);
      }
      add_colours(object, t, corners, first);
      if (mirrored) std::swap(corners[1], corners[2]);
      mesh_.triangles.push_back(corners);
    }
  }

  /// Colours belong to corners; a vertex gets that of the first corner there.
  void add_colours(const pugi::xml_node& object, const pugi::xml_node& triangle,
                   const std::array<std::uint32_t, 3>& corners, std::size_t first) {
    if (colours_.empty()) return;
    const pugi::xml_node& from = triangle.attribute("pid") ? triangle : object;
    if (!from.attribute("pid")) return;
    const auto group = colours_.find(natural(from, "pid"));
    if (group == colours_.end()) return; // a texture, or another kind of property
    const std::uint64_t none = 0, usual = natural(object, "pindex", &none), p1 = natural(triangle, "p1", &usual);
    const std::array<std::uint64_t, 3> index = {p1, natural(triangle, "p2", &p1), natural(triangle, "p3", &p1)};
    for (std::size_t k = 0; k < 3; ++k) {
      if (index[k] >= group->second.size()) fail("a triangle names a colour that does not exist");
      if (coloured_[corners[k] - first]) continue;
      coloured_[corners[k] - first] = true;
      const Colour& colour = group->second[index[k]];
      rows_.set_colour(corners[k], colour, colour[3] != 255);
    }
  }

  static constexpr int deepest = 64; ///< no program is known to go beyond a few

  const FileContent& file_;
  MeshNotes& notes_;
  std::string xml_;
  std::uint64_t budget_; ///< vertices, triangles and parts that are still allowed: none takes less than a byte
  pugi::xml_document document_;
  std::map<std::uint64_t, Object> objects_;
  std::map<std::uint64_t, std::vector<Colour>> colours_;
  std::vector<bool> coloured_;
  std::uint64_t elsewhere_ = 0;
  int depth_ = 0;
  TriangleMesh mesh_;
  VertexRows rows_;
};

} // namespace

TriangleMesh read_three_mf(const FileContent& file, MeshNotes& notes) {
  return ModelReader(file, Package(file).model(), notes).read();
}

bool looks_like_three_mf(const FileContent& file) {
  constexpr std::size_t directory = 1 << 16; // of an archive, at its end; printers' files have few parts
  const std::string_view bytes = file.bytes();
  return bytes.starts_with("PK\3\4") &&
         bytes.substr(bytes.size() - std::min(bytes.size(), directory)).find("3D/3dmodel.model") !=
             std::string_view::npos;
}

} // namespace eigencrust::io
