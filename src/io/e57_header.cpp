// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/e57_header.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <pugixml.hpp>
#include <set>

#include "io/text.h"

namespace eigencrust::io {
namespace {

constexpr const char* xml_remedy = "the file does not follow ASTM E2807; export it again with another program";

class XmlReader {
 public:
  explicit XmlReader(const E57Pages& pages) : pages_(pages) {
    const std::string_view xml = pages.xml();
    const pugi::xml_parse_result result = document_.load_buffer(xml.data(), xml.size());
    if (!result)
      pages.fail_at(pages.xml_offset() + static_cast<std::uint64_t>(result.offset),
                    std::string("the XML section cannot be read (") + result.description() + ")", xml_remedy);
  }

  std::vector<E57Scan> read() {
    const pugi::xml_node root = document_.child("e57Root");
    if (!root) pages_.fail_at(pages_.xml_offset(), "the XML section has no element e57Root", xml_remedy);
    std::vector<E57Scan> scans;
    for (const pugi::xml_node node : root.child("data3D").children())
      if (node.type() == pugi::node_element) scans.push_back(read_scan(node));
    if (scans.empty())
      pages_.fail_at(place(root), "the file holds no scan", "use a file that holds points (data3D), not images alone");
    return scans;
  }

 private:
  /// Logical offset of an element, for messages.
  [[nodiscard]] std::uint64_t place(const pugi::xml_node& node) const {
    return pages_.xml_offset() + static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(0, node.offset_debug()));
  }
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& cause) const {
    pages_.fail_at(place(node), cause, xml_remedy);
  }

  E57Scan read_scan(const pugi::xml_node& node) {
    E57Scan scan;
    scan.xml = place(node);
    if (const pugi::xml_node pose = node.child("pose")) read_pose(pose, scan);
    const pugi::xml_node points = node.child("points");
    if (!points) fail(node, "a scan without the element points");
    scan.records = read_unsigned(points, "recordCount");
    constexpr std::uint64_t most = 0xfffffff0;
    if (scan.records > most) fail(points, "a scan of more than 4294967280 points");
    scan.file_offset = read_unsigned(points, "fileOffset");
    for (const pugi::xml_node codec : points.child("codecs").children())
      if (codec.type() == pugi::node_element && !codec.child("bitPackCodec"))
        fail(codec, "the points are coded in a way that is not known");
    add_fields(points.child("prototype"), 0, scan.fields);
    if (scan.fields.empty()) fail(points, "the points have no prototype");
    if (scan.fields.size() > 0x7fff) fail(points, "the points have more than 32767 fields");
    std::set<std::string_view> names;
    for (const E57Field& f : scan.fields)
      if (!names.insert(f.name).second) fail(points, "the points have two fields " + shown(f.name));
    return scan;
  }

  void read_pose(const pugi::xml_node& node, E57Scan& scan) {
    Pose pose;
    if (const pugi::xml_node t = node.child("translation"))
      pose.translation = {read_real(t.child("x"), 0), read_real(t.child("y"), 0), read_real(t.child("z"), 0)};
    if (const pugi::xml_node r = node.child("rotation"))
      scan.has_bad_rotation = !set_rotation(pose, read_real(r.child("w"), 0), read_real(r.child("x"), 0),
                                            read_real(r.child("y"), 0), read_real(r.child("z"), 0));
    scan.pose = pose;
  }

  /// The columns in the order of their streams: the leaves of the prototype, depth first.
  void add_fields(const pugi::xml_node& prototype, int depth, std::vector<E57Field>& fields) {
    constexpr int deepest = 16; // none is known to go beyond 1
    if (depth > deepest) fail(prototype, "the prototype of the points is nested too deeply");
    for (const pugi::xml_node node : prototype.children()) {
      if (node.type() != pugi::node_element) continue;
      const std::string_view type = node.attribute("type").value();
      if (type == "Structure" || type == "Vector")
        add_fields(node, depth + 1, fields);
      else
        fields.push_back(read_field(node, type));
    }
  }

  E57Field read_field(const pugi::xml_node& node, std::string_view type) {
    E57Field f;
    f.name = node.name();
    f.xml = place(node);
    if (type == "Float") {
      const bool is_single = std::string_view(node.attribute("precision").value()) == "single";
      f.kind = is_single ? E57Field::Kind::float32 : E57Field::Kind::float64;
    } else if (type == "String") {
      f.kind = E57Field::Kind::text;
    } else if (type == "Integer" || type == "ScaledInteger") {
      f.kind = type == "Integer" ? E57Field::Kind::integer : E57Field::Kind::scaled;
      f.minimum = read_integer(node, "minimum", std::numeric_limits<std::int64_t>::min());
      f.maximum = read_integer(node, "maximum", std::numeric_limits<std::int64_t>::max());
      if (f.minimum > f.maximum) fail(node, "field " + shown(f.name) + " has a minimum above its maximum");
      f.scale = read_real_attribute(node, "scale", 1);
      f.offset = read_real_attribute(node, "offset", 0);
    } else {
      fail(node, "field " + shown(f.name) + " has the type " + shown(type));
    }
    return f;
  }

  double read_real(const pugi::xml_node& node, double absent) const {
    const std::string_view text = trim_lines(node.child_value());
    double value = 0; // an element without text means 0
    if (!node) return absent;
    if (!text.empty() && (!parse(text, value) || !std::isfinite(value)))
      fail(node, shown(text) + " is no finite number");
    return value;
  }
  double read_real_attribute(const pugi::xml_node& node, const char* name, double absent) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    double value = absent;
    if (attribute && (!parse(trim_lines(attribute.value()), value) || !std::isfinite(value)))
      fail(node, shown(attribute.value()) + " as " + name + " is no finite number");
    return value;
  }
  std::int64_t read_integer(const pugi::xml_node& node, const char* name, std::int64_t absent) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    std::int64_t value = absent;
    if (attribute && !parse(trim_lines(attribute.value()), value))
      fail(node, shown(attribute.value()) + " as " + name + " is no whole number");
    return value;
  }
  std::uint64_t read_unsigned(const pugi::xml_node& node, const char* name) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    std::uint64_t value = 0;
    if (!parse(trim_lines(attribute.value()), value))
      fail(node, shown(attribute.value()) + " as " + name + " is no whole number");
    return value;
  }

  static std::string_view trim_lines(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r\n"), last = text.find_last_not_of(" \t\r\n");
    return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
  }

  const E57Pages& pages_;
  pugi::xml_document document_;
};

} // namespace

unsigned E57Field::bits() const {
  switch (kind) {
    case Kind::integer:
    case Kind::scaled:
      return static_cast<unsigned>(
          std::bit_width(static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum)));
    case Kind::float32:
      return 32;
    case Kind::float64:
      return 64;
    case Kind::text:
      break;
  }
  return 0;
}

std::vector<E57Scan> read_e57_header(const E57Pages& pages) { return XmlReader(pages).read(); }

} // namespace eigencrust::io
