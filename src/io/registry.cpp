// SPDX-License-Identifier: GPL-3.0-or-later
// The only place that knows which extension, and which content, means which format.
#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "evidence/sensor_rows.h"
#include "io/attributes.h"
#include "io/colmap.h"
#include "io/column_names.h"
#include "io/coordinate_checks.h"
#include "io/formats.h"
#include "io/grid_sensor.h"
#include "io/offset_file.h"
#include "io/sensor_columns.h"
#include "io/sha256.h"
#include "io/table_plan.h"
#include "io/text.h"
#include "io/text_encoding.h"

namespace eigencrust {
namespace {

using io::Body;
using io::FileContent;

using Notes = std::vector<std::string>;
using CloudReader = PointCloud (*)(const FileContent&, const ReadOptions&, ReadNotes&);
using MeshReader = TriangleMesh (*)(const FileContent&, MeshNotes&);
using MeshWriter = Body (*)(const TriangleMesh&, const WriteOptions&, WriteResult&);
using CloudWriter = Body (*)(const PointCloud&, const WriteOptions&, WriteResult&);

struct Format {
  std::string_view extension;
  CloudReader read_cloud;
  MeshReader read_mesh = nullptr;
  MeshWriter write_mesh = nullptr;
  CloudWriter write_cloud = nullptr;
};

PointCloud read_ply_points(const FileContent& file, const ReadOptions&, ReadNotes&) { return io::read_ply_cloud(file); }
PointCloud read_npy_points(const FileContent& file, const ReadOptions&, ReadNotes&) { return io::read_npy(file); }
PointCloud read_ptx_points(const FileContent& file, const ReadOptions&, ReadNotes& notes) {
  return io::read_ptx(file, notes);
}
PointCloud read_pcd_points(const FileContent& file, const ReadOptions& options, ReadNotes& notes) {
  return io::read_pcd(file, options, notes.notes);
}
PointCloud read_grid_points(const FileContent& file, const ReadOptions&, ReadNotes& notes) {
  return io::read_esri_grid(file, notes);
}

/// Formats that can be read in one way only, but have something to say.
template <PointCloud (*read)(const FileContent&, Notes&)>
PointCloud read_noted(const FileContent& file, const ReadOptions&, ReadNotes& notes) {
  return read(file, notes.notes);
}

/// Meshes that say nothing of themselves.
template <TriangleMesh (*read)(const FileContent&)>
TriangleMesh read_plain(const FileContent& file, MeshNotes&) {
  return read(file);
}

/// The vertices of a mesh.
template <MeshReader read>
PointCloud read_vertices(const FileContent& file, const ReadOptions&, ReadNotes& said) {
  MeshNotes notes;
  TriangleMesh mesh = read(file, notes);
  said.notes.insert(said.notes.end(), notes.notes.begin(), notes.notes.end());
  PointCloud cloud;
  cloud.points = std::move(mesh.vertices);
  cloud.attributes = std::move(mesh.vertex_attributes);
  return cloud;
}

template <char separator>
Body write_rows(const PointCloud& cloud, const WriteOptions& options, WriteResult& result) {
  return io::prepare_xyz(cloud, options, separator, result);
}

constexpr Format esri_grid = {"asc", read_grid_points}; ///< known by its first line alone

constexpr std::array<Format, 18> formats = {{
    {"ply", read_ply_points, read_plain<io::read_ply_mesh>, io::prepare_ply, io::prepare_ply},
    {"xyz", io::read_xyz, nullptr, nullptr, write_rows<' '>},
    {"txt", io::read_xyz, nullptr, nullptr, write_rows<' '>},
    {"asc", io::read_xyz, nullptr, nullptr, write_rows<' '>},
    {"csv", io::read_xyz, nullptr, nullptr, write_rows<','>},
    {"pts", io::read_pts},
    {"e57", read_noted<io::read_e57>},
    {"ptx", read_ptx_points},
    {"pcd", read_pcd_points, nullptr, nullptr, io::prepare_pcd},
    {"las", read_noted<io::read_las>, nullptr, nullptr, io::prepare_las},
    {"laz", read_noted<io::read_las>}, // which says why it cannot
    {"npz", read_noted<io::read_npz>},
    {"npy", read_npy_points},
    {"obj", read_vertices<read_plain<io::read_obj>>, read_plain<io::read_obj>, io::prepare_obj, io::prepare_obj},
    {"off", read_vertices<read_plain<io::read_off>>, read_plain<io::read_off>, io::prepare_off},
    {"stl", read_vertices<read_plain<io::read_stl>>, read_plain<io::read_stl>, io::prepare_stl},
    {"glb", read_vertices<io::read_glb>, io::read_glb, io::prepare_glb},
    {"3mf", read_vertices<io::read_three_mf>, io::read_three_mf, io::prepare_three_mf},
}};

const Format* find_format(std::string_view extension) {
  const auto found = std::find_if(formats.begin(), formats.end(),
                                  [&](const Format& f) { return io::equal_ignoring_case(f.extension, extension); });
  return found == formats.end() ? nullptr : &*found;
}

const Format* format_of(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return extension.empty() ? nullptr : find_format(std::string_view(extension).substr(1));
}

/// For writing: that of the name, unless another is asked for.
const Format* format_for_writing(const std::filesystem::path& path, const std::string& format) {
  return format.empty() ? format_of(path) : find_format(format);
}

/// Recognizes text formats by their first line that is no comment.
const Format* sniff_text(const FileContent& file) {
  io::LineScanner lines(file);
  io::Fields fields;
  while (lines.next_filled()) {
    const std::string_view line = lines.line();
    if (io::comment_text(line)) continue;
    io::split_fields(line, fields);
    std::uint64_t count = 0;
    if (fields.size() == 1 && io::is_digit(line[0]) && io::parse(fields[0], count)) return find_format("pts");
    double number = 0;
    if (fields.size() >= 3 && io::parse(fields[0], number) && io::parse(fields[1], number)) return find_format("xyz");
    if (io::find_axes(std::vector<std::string>(fields.begin(), fields.end()))) return find_format("xyz");
    for (const std::string_view keyword : {"v", "vn", "vt", "o", "g", "mtllib", "usemtl"})
      if (fields[0] == keyword) return find_format("obj");
    return nullptr;
  }
  return nullptr;
}

/// Formats that cannot be taken for another: their content counts for more than the extension.
const Format* sniff_signature(const FileContent& file) {
  const std::string_view bytes = file.bytes();
  if (bytes.starts_with("ASTM-E57")) return find_format("e57");
  if (bytes.starts_with("LASF")) return find_format("las");
  if (bytes.starts_with("\x93NUMPY")) return find_format("npy");
  if (bytes.starts_with("glTF")) return find_format("glb");
  if (bytes.starts_with("PK\3\4") || bytes.starts_with("PK\5\6"))
    return find_format(io::looks_like_three_mf(file) || format_of(file.name()) == find_format("3mf") ? "3mf" : "npz");
  std::string_view first = bytes.substr(0, std::min(bytes.find_first_of("\r\n"), bytes.size()));
  const std::string_view word = io::next_word(first);
  if (word == "ply") return find_format("ply");
  for (const std::string_view keyword : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"})
    if (word == keyword) return find_format("off");
  if (io::looks_like_pcd(file)) return find_format("pcd");
  if (io::looks_like_ptx(file)) return find_format("ptx");
  if (io::looks_like_esri_grid(file)) return &esri_grid;
  return nullptr;
}

/// What the file most likely is, where neither a signature nor the extension tells.
const Format* sniff(const FileContent& file) {
  const std::string_view bytes = file.bytes();
  std::string_view first = bytes.substr(0, std::min(bytes.find_first_of("\r\n"), bytes.size()));
  if (io::equal_ignoring_case(io::next_word(first), "solid")) return find_format("stl");
  if (bytes.size() >= 84) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])); };
    const std::uint64_t facets = byte(80) | byte(81) << 8 | byte(82) << 16 | byte(83) << 24;
    if (bytes.size() == 84 + 50 * facets) return find_format("stl");
  }
  if (bytes.substr(0, 4096).find('\0') != std::string_view::npos) return nullptr;
  return sniff_text(file);
}

/// \param mesh_wanted only formats that hold triangles will do
const Format& format_for_reading(const FileContent& file, bool mesh_wanted) {
  io::reject_foreign(file);
  const Format* format = sniff_signature(file);
  if (format == nullptr) format = format_of(file.name());
  if (format == nullptr) format = sniff(file);
  if (format == nullptr)
    file.fail(
        "the format is not known",
        "convert the file to ply, e57, las, ptx, pcd, pts, npz, npy, xyz, txt, asc, csv, obj, off, stl, glb or 3mf");
  if (mesh_wanted && format->read_mesh == nullptr)
    file.fail("the file holds points, not a mesh", "use a ply, obj, off, stl, glb or 3mf file");
  return *format;
}

/// The visibility that COLMAP writes beside a fused cloud; empty where there is none.
std::filesystem::path visibility_of(const std::filesystem::path& path) {
  const std::filesystem::path visibility = path.string() + ".vis";
  std::error_code ignored;
  return std::filesystem::is_regular_file(visibility, ignored) ? visibility : std::filesystem::path();
}

/// From the files that COLMAP writes beside a fused cloud.
void add_colmap_sensors(const std::filesystem::path& path, PointCloud& cloud, Notes& notes) {
  const std::filesystem::path visibility = visibility_of(path);
  if (visibility.empty()) return;
  const auto images = io::find_colmap_images(path);
  if (!images) {
    notes.push_back(visibility.filename().string() +
                    " is not used: there is no images.bin or images.txt, neither beside it nor in sparse");
    return;
  }
  io::set_colmap_sensors(cloud, FileContent(visibility), io::read_colmap_images(FileContent(*images)));
  notes.push_back(visibility.filename().string() + " and " + images->string() +
                  " tell the camera that saw each point; of several the one nearest to their mean direction");
}

void append(Notes& notes, Notes more) { notes.insert(notes.end(), more.begin(), more.end()); }

/// Scale and shift of the options.
void change_frame(PointCloud& cloud, const ReadOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale) || !is_finite(options.shift))
    throw Error(ErrorKind::usage, "reading", "scale or shift is no finite number, or the scale not above 0",
                "give finite numbers");
  if (options.scale == 1 && options.shift == Vec3{}) return;
  // Millimetres divided by 1000 are rounded once, multiplied with 0.001 twice.
  const double inverse = std::round(1 / options.scale);
  const bool divides = options.scale < 1 && 1 / inverse == options.scale;
  const auto scaled = [&](double v) { return divides ? v / inverse : v * options.scale; };
  const auto moved = [&](const Vec3& p) { return Vec3{scaled(p.x), scaled(p.y), scaled(p.z)} + options.shift; };
  for (Vec3& p : cloud.points) p = moved(p);
  for (Sensor& s : cloud.sensors)
    if (!s.at_infinity) s.place = moved(s.place);
}

[[noreturn]] void fail_memory(const std::filesystem::path& path) {
  throw Error(ErrorKind::memory, path.string(), "not enough memory for the file",
              "free memory or split the file into parts");
}

[[noreturn]] void fail_extension(const std::filesystem::path& path, bool mesh) {
  throw Error(
      ErrorKind::input, path.string(), "there is no writer for this file name's extension",
      mesh ? "use .ply, .obj, .off, .stl, .glb or .3mf" : "use .ply, .pcd, .las, .xyz, .txt, .asc, .csv or .obj");
}

/// Are the sensors among the attributes, so that they are written?
bool columns_tell_sensors(const PointCloud& cloud) {
  const auto columns = io::find_sensor_columns(cloud);
  if (!columns || cloud.sensor_of.size() != columns->places.size()) return false;
  for (std::size_t i = 0; i < cloud.sensor_of.size(); ++i) {
    const std::uint32_t s = cloud.sensor_of[i];
    const Vec3& place = columns->places[i];
    if (s == PointCloud::no_sensor ? is_finite(place) : cloud.sensors[s] != Sensor{place, false}) return false;
  }
  return true;
}

/// The shift as one more comment.
WriteOptions with_shift(WriteOptions options) {
  if (options.shift != Vec3{}) options.comments.push_back("shift " + io::three_numbers(options.shift));
  return options;
}

/// Do the comments of WriteOptions arrive in files of the format?
bool keeps_comments(const Format& format) {
  return format.extension != "stl" && format.extension != "csv" && format.extension != "las";
}

void check_mesh(const TriangleMesh& mesh) {
  io::check_attributes(mesh.vertex_attributes, mesh.vertices.size(), "vertex row");
  io::check_attributes(mesh.triangle_attributes, mesh.triangles.size(), "triangle");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= mesh.vertices.size())
        throw Error(ErrorKind::usage, "mesh",
                    "a triangle names vertex " + std::to_string(vertex) + " of " + std::to_string(mesh.vertices.size()),
                    "number the vertices from 0");
}

} // namespace

PointCloud io::read_cloud(const FileContent& original, const ReadOptions& options, ReadNotes& notes) {
  const std::optional<std::string> text = decode_utf16(original.bytes());
  const FileContent decoded(original.name(), text ? std::string_view(*text) : std::string_view());
  const FileContent& file = text ? decoded : original;
  PointCloud cloud = format_for_reading(file, false).read_cloud(file, options, notes);
  append(notes.warnings, drop_no_data(cloud));
  if (std::optional<ScanGrids> grids = find_grids(cloud)) {
    cloud.grids = std::move(grids->sizes);
    cloud.cell = std::move(grids->cell);
  }
  append(notes.warnings, doubt_coordinates(cloud.points));
  if (!options.sensors) {
    cloud.sensors.clear();
    cloud.sensor_of.clear();
  } else if (cloud.sensors.empty()) {
    if (const auto columns = find_sensor_columns(cloud)) {
      set_sensor_rows(cloud, columns->places);
      notes.notes.push_back(columns->names + " read as the sensor's position of each point");
    } else if (set_sensor_from_grid(cloud)) {
      notes.notes.emplace_back(
          "the points lie on rays from the origin through the pixels of their grid: sensor at (0, 0, 0)");
    }
  }
  return cloud;
}

TriangleMesh io::read_mesh(const FileContent& file, MeshNotes& notes) {
  return format_for_reading(file, true).read_mesh(file, notes);
}

std::vector<std::filesystem::path> companion_files(const std::filesystem::path& path) {
  const std::filesystem::path visibility = visibility_of(path);
  if (visibility.empty()) return {};
  std::vector<std::filesystem::path> files{visibility};
  if (const auto images = io::find_colmap_images(path)) files.push_back(*images);
  return files;
}

PointCloud read_point_cloud(const std::filesystem::path& path, const ReadOptions& options, ReadNotes* notes,
                            std::string* sha256) {
  try {
    ReadNotes unused;
    ReadNotes& said = notes == nullptr ? unused : *notes;
    const FileContent file(path);
    if (sha256 != nullptr) *sha256 = io::sha256_of(file);
    PointCloud cloud = io::read_cloud(file, options, said);
    if (options.sensors && cloud.sensors.empty()) add_colmap_sensors(path, cloud, said.notes);
    change_frame(cloud, options);
    return cloud;
  } catch (const std::bad_alloc&) {
    fail_memory(path);
  } catch (const std::length_error&) {
    fail_memory(path);
  }
}

TriangleMesh read_mesh(const std::filesystem::path& path, MeshNotes* notes) {
  try {
    MeshNotes unused;
    return io::read_mesh(FileContent(path), notes == nullptr ? unused : *notes);
  } catch (const std::bad_alloc&) {
    fail_memory(path);
  } catch (const std::length_error&) {
    fail_memory(path);
  }
}

WriteResult OutputFiles::add_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                                  const WriteOptions& options) {
  const Format* format = format_for_writing(path, options.format);
  if (format == nullptr || format->write_mesh == nullptr) fail_extension(path, true);
  check_mesh(mesh);
  WriteResult result;
  const WriteOptions commented = with_shift(options);
  const Body body = format->write_mesh(mesh, commented, result);
  const bool is_told = keeps_comments(*format) && result.offset == Vec3{};
  add_offset(path, is_told ? Vec3{} : result.offset - options.shift, result.warnings);
  add(path, body);
  return result;
}

WriteResult OutputFiles::add_point_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                                         const WriteOptions& options) {
  const Format* format = format_for_writing(path, options.format);
  if (format == nullptr || format->write_cloud == nullptr) fail_extension(path, false);
  io::check_attributes(cloud.attributes, cloud.points.size(), "point");
  WriteResult result;
  const WriteOptions commented = with_shift(options);
  const Body body = format->write_cloud(cloud, commented, result);
  if (!cloud.scan_index.empty()) result.warnings.emplace_back("the scan numbers of the points are not written");
  const bool has_viewpoint = format->extension == "pcd" && io::viewpoint_of(cloud);
  if (!cloud.sensors.empty() && !has_viewpoint && !columns_tell_sensors(cloud))
    result.warnings.emplace_back("the sensors of the points are not written");
  add_offset(path, keeps_comments(*format) ? Vec3{} : Vec3{} - options.shift, result.warnings);
  add(path, body);
  return result;
}

WriteResult write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const WriteOptions& options) {
  OutputFiles files;
  WriteResult result = files.add_mesh(path, mesh, options);
  files.put_in_place();
  return result;
}

WriteResult write_point_cloud(const std::filesystem::path& path, const PointCloud& cloud, const WriteOptions& options) {
  OutputFiles files;
  WriteResult result = files.add_point_cloud(path, cloud, options);
  files.put_in_place();
  return result;
}

bool can_write_mesh(const std::filesystem::path& path, const std::string& name) {
  const Format* format = format_for_writing(path, name);
  return format != nullptr && format->write_mesh != nullptr;
}

bool can_write_point_cloud(const std::filesystem::path& path, const std::string& name) {
  const Format* format = format_for_writing(path, name);
  return format != nullptr && format->write_cloud != nullptr;
}

} // namespace eigencrust
