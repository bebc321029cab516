// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are no point clouds, or none that is read here, known by how they begin: so that a message can name them.
#include <array>

#include "io/formats.h"
#include "io/text.h"

namespace eigencrust::io {
namespace {

struct Foreign {
  std::string_view begins;
  const char *kind, *remedy;
};

constexpr const char* as_points = "export the points from it as PLY, E57, LAS or text";
constexpr const char* unpack = "unpack it first";
constexpr const char* no_points = "it holds no points: choose another file";

constexpr std::array<Foreign, 32> kinds = {{
    {"\x1f\x8b", "a gzip archive", unpack},
    {"BZh", "a bzip2 archive", unpack},
    {"\xfd"
     "7zXZ",
     "an xz archive", unpack},
    {"7z\xbc\xaf", "a 7-Zip archive", unpack},
    {"Rar!", "a RAR archive", unpack},
    {"\x28\xb5\x2f\xfd", "a Zstandard archive", unpack},
    {"\xd0\xcf\x11\xe0", "a document or workbook of an old Microsoft Office", "save the table as CSV"},
    {"\x89PNG", "a picture (PNG)", "a depth image has to be turned into points with the camera's data first"},
    {"\xff\xd8\xff", "a picture (JPEG)", no_points},
    {"II*", "a picture (TIFF)", "heights of a GeoTIFF: gdal_translate -of XYZ in.tif out.xyz"},
    {"MM\0*", "a picture (TIFF)", "heights of a GeoTIFF: gdal_translate -of XYZ in.tif out.xyz"},
    {"%PDF", "a PDF document", no_points},
    {"\x89HDF", "an HDF5 file", "save its array of points as .npy"},
    {"CDF\x01", "a NetCDF file", "save its points as text"},
    {"MATLAB 5.0", "a MATLAB file", "save the points with writematrix(points, 'points.csv')"},
    {"\x80\x02", "a Python pickle", "save the array with numpy.save"},
    {"\x80\x03", "a Python pickle", "save the array with numpy.save"},
    {"\x80\x04", "a Python pickle", "save the array with numpy.save"},
    {"#ROSBAG", "a ROS bag", "save its clouds as PCD: rosrun pcl_ros bag_to_pcd"},
    {"\x89MCAP", "a ROS bag (MCAP)", "save its clouds as PCD"},
    {"\xd4\xc3\xb2\xa1", "a capture of network packets (pcap)", "export the points with the scanner's own viewer"},
    {"\x0a\x0d\x0d\x0a", "a capture of network packets (pcapng)", "export the points with the scanner's own viewer"},
    {"Kaydara FBX", "an FBX model", "convert it to PLY or OBJ"},
    {"BLENDER", "a Blender scene", "export it as PLY or OBJ"},
    {"ISO-10303-21", "a STEP model or IFC building", "it holds no points: tessellate it to STL or PLY"},
    {"DRACO", "a Draco model", "convert it to PLY"},
    {"AC10", "an AutoCAD drawing (DWG)", as_points},
    {"# vtk DataFile", "a VTK file", "save the points as PLY or CSV in ParaView"},
    {"<VTKFile", "a VTK file", "save the points as PLY or CSV in ParaView"},
    {"#VRML", "a VRML scene", "convert it to PLY or OBJ"},
    {"version https://git-lfs", "a pointer of Git LFS, and not the file itself", "fetch it: git lfs pull"},
    {"SQLite format 3", "a database (SQLite)", as_points},
}};

[[noreturn]] void reject(const FileContent& file, const std::string& kind, const std::string& remedy) {
  file.fail("this is " + kind, remedy);
}

} // namespace

void reject_foreign(const FileContent& file) {
  const std::string_view bytes = file.bytes();
  for (const Foreign& foreign : kinds)
    if (bytes.starts_with(foreign.begins)) reject(file, foreign.kind, foreign.remedy);
  std::string_view text = bytes.substr(0, std::min<std::size_t>(bytes.size(), 512));
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\xef\xbb\xbf"), text.size()));
  const std::string start = lower_case(text.substr(0, 40));
  if (start.starts_with("<!doctype html") || start.starts_with("<html"))
    reject(file, "a web page, and not the file that it tells of", "download the file itself");
  if (start.starts_with("<?xml") || start.starts_with("<landxml")) reject(file, "an XML document", as_points);
  const bool is_gltf = lower_case(file.name()).ends_with(".gltf");
  if (is_gltf && start.starts_with("{")) reject(file, "a glTF model in several files", "save it as one file (.glb)");
  if (start.starts_with("{\"") || start.starts_with("{\n") || start.starts_with("{\r"))
    reject(file, "a JSON document", as_points);
  if (text.starts_with("0\r\nSECTION") || text.starts_with("0\nSECTION") || text.starts_with("999\n"))
    reject(file, "an AutoCAD drawing (DXF)", as_points);
  // Archives that programs use as their own format; an .npz is one too.
  constexpr std::size_t member_name = 30; // where the header of an archive's first member has it
  if (!bytes.starts_with("PK\3\4") || bytes.size() <= member_name || looks_like_three_mf(file)) return;
  for (const auto& [member, kind, remedy] :
       {std::tuple{"[Content_Types].xml", "a workbook or document of Microsoft Office", "save the table as CSV"},
        std::tuple{"mimetype", "a document of LibreOffice", "save the table as CSV"},
        std::tuple{"doc.kml", "a KMZ file", as_points}})
    if (bytes.substr(member_name, 200).starts_with(member)) reject(file, kind, remedy);
}

} // namespace eigencrust::io
