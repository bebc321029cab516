// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Point clouds and meshes from and to files. One file per format in src/io, one registry.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// What VIEWPOINT in a PCD file means: programs write the scanner's pose there, but some store points that
/// are already in world coordinates (the documented use), others points still to be moved by it.
enum class PcdViewpoint : std::uint8_t {
  automatic, ///< the sensor's position unless it is 0 0 0, the default of writers that know none; points stay
  sensor,    ///< the sensor's position, even at 0 0 0; points stay
  pose,      ///< points and normals are rotated and moved by it; its translation is the sensor's position
  none       ///< nothing
};

/// How a point cloud is read.
struct ReadOptions {
  /// Names of the columns of a text file in order ("x", "y", "z", any other name keeps that column as
  /// an attribute, "-" skips it). Empty: from the header line, else x y z and the rest as columns.
  std::vector<std::string> columns{};
  PcdViewpoint pcd_viewpoint = PcdViewpoint::automatic; ///< what VIEWPOINT means
  bool sensors = true; ///< false: what the file, and those beside it, say of sensors is left out
  double scale = 1;    ///< > 0; coordinates and places of sensors are multiplied with it,
  Vec3 shift{};        ///< then this is added to them
};

/// What a reader has to say, a sentence each, without the file's name.
struct ReadNotes {
  std::vector<std::string> notes;    ///< what was understood, and what could be read in two ways
  std::vector<std::string> warnings; ///< what was left out, or looks wrong
};

/// Reads a point cloud. Formats with a signature of their own (ply, e57, las, pcd, ptx, off, npy, npz, glb, 3mf) are
/// known by it; otherwise the format follows the extension (xyz, txt, asc, csv, pts, obj, stl; upper case too),
/// and the content where the extension says nothing. From a mesh its vertices are taken, those of an
/// STL once per distinct position.
/// Text numbers are read independently of the locale. NaN and infinite rows are kept; rows that a
/// scanner marked as empty (ptx, e57) or deleted (las) are not.
/// Sensors are taken from the poses of e57 and ptx scans, the VIEWPOINT of a pcd file, the array
/// sensor_position of an npz file, columns sx sy sz (or x_origin y_origin z_origin, or vp_x vp_y vp_z) of
/// any format, and from what COLMAP writes beside a ply file: NAME.ply.vis with images.bin or images.txt.
/// Points of which a coordinate means "no data" (-9999 and its like, far from all others) are left out. Points of pcd
/// files with HEIGHT > 1, of ptx and of ESRI grids get the attributes row and column: see find_grids().
/// \param notes  if given, gets what there is to say
/// \param sha256 if given, gets the digest of the bytes that were read; a pipe can be read only once
/// \throws Error{input} naming file and line (text) or byte offset (binary) when the file is missing,
///         truncated, malformed or of an unknown format; memory is never allocated by a count that the
///         file claims but does not hold.
PointCloud read_point_cloud(const std::filesystem::path& path, const ReadOptions& options = {},
                            ReadNotes* notes = nullptr, std::string* sha256 = nullptr);

/// The grids in which scanners or depth cameras saw their points: which point is beside which.
struct ScanGrids {
  std::vector<ScanGrid> sizes;     ///< one per scan
  std::vector<std::uint32_t> cell; ///< per point: row * columns + column in the grid of its scan, or no_index
};
/// From the attributes row and column, or rowIndex and columnIndex (in any case), of whole numbers from 0 on. Nothing
/// where there are none, they are no grid of at least 2 x 2, or two points of a scan share a cell.
std::optional<ScanGrids> find_grids(const PointCloud& cloud);

/// How far points reach.
struct Extent {
  Box3 bounds; ///< of the finite points
  Box3 bulk;   ///< the same without the outer 2 % on either side of each axis
};
/// Box of the finite points, and of their bulk.
Extent extent_of(std::span<const Vec3> points);
/// A sentence for each thing that is odd about several scans of one scene: sizes that differ as units do, no overlap.
/// \param names of the inputs, for the sentences; as many as there are extents
std::vector<std::string> compare_extents(std::span<const std::string> names, std::span<const Extent> extents);

/// The files beside `path` that read_point_cloud(path) reads as well, if they are there now.
std::vector<std::filesystem::path> companion_files(const std::filesystem::path& path);
/// NAME.offset.txt: what writing `path` may write beside it, or remove there.
std::filesystem::path offset_file(const std::filesystem::path& path);

/// What the file of a mesh says beside the mesh.
struct MeshNotes {
  double metres = 0;                ///< length of the coordinates' unit in metres; 0: the file does not tell
  std::vector<std::string> notes{}; ///< what was left out, a sentence each
};

/// Reads a mesh (ply, obj, off, stl, glb, 3mf); polygons are split into triangle fans. STL corners with equal
/// coordinates become one vertex. The scene of a GLB file is turned from y up, its format's way, to z up.
/// \param notes if given, gets what there is to say
/// \throws Error{input} as above, also for an index out of range.
TriangleMesh read_mesh(const std::filesystem::path& path, MeshNotes* notes = nullptr);

/// Appends `next` to `cloud` as one more scan: scan indices are shifted so that scans stay apart (a
/// cloud without scan index counts as one scan). Attributes are joined by name; rows of a file that
/// lacks one get NaN (floating point) or 0; differing types are widened to one that holds both. Sensors
/// are put behind one another.
void append_scan(PointCloud& cloud, PointCloud next);

/// Scan numbers from a file: raw bytes (.u8), or text with one number per row.
/// \throws Error{input} when there are not `points` of them.
std::vector<std::uint32_t> read_scan_index(const std::filesystem::path& path, std::size_t points);

/// Gives each point the sensor of its scan, in place of those that the cloud has. The file holds text, a row
/// per scan: scan,x,y,z or, for scans in order, x,y,z; or directions (parallel rays, surface -> scanner, of
/// any length) under a header that names dx, dy and dz. Points of scans without a row have no sensor.
/// \throws Error{input} naming the line, also for a scan beyond the last one and where rows without numbers
///         are not as many as the scans
void read_scan_sensors(const std::filesystem::path& path, PointCloud& cloud);

/// How wide the coordinates of a written file are.
enum class CoordinateType : std::uint8_t {
  automatic, ///< float32 where that keeps all vertices apart and within 1e-3 of `spacing`, else float64
  float32,
  float64
};

/// How a mesh or a cloud is written.
struct WriteOptions {
  CoordinateType coordinates = CoordinateType::automatic; ///< float32 or float64
  double spacing = 0;                                     ///< median sample spacing; 0: the median edge length is taken
  std::vector<std::string> comments;                      ///< written where the format has room for them
  std::string format{};                                   ///< "ply", "obj" ...; empty: that of the name's extension
  /// What was added to the coordinates of the input. Written as a comment; formats without any (stl, csv, las), and
  /// those that need an offset of their own, get a file NAME.offset.txt with the numbers that lead back.
  Vec3 shift{};
  double metres = 0; ///< length of the coordinates' unit in metres, for formats that tell it (glb, 3mf); 0: not known
};

/// What was written.
struct WriteResult {
  CoordinateType coordinates = CoordinateType::float64; ///< what was chosen
  Vec3 offset;                       ///< subtracted from the coordinates (STL and 3MF far from the origin)
  std::vector<std::string> warnings; ///< what the format could not hold
};

/// Writes a mesh (ply binary little-endian, obj, off, stl binary, glb, 3mf), atomically: into a temporary file
/// beside `path`, flushed, then renamed; on any failure the temporary is removed and `path` untouched.
/// Text formats use the shortest digits that read back as the same double.
/// PLY keeps every attribute under its own name and type (an attribute named x, y or z, or twice, gets
/// a suffix). OBJ, OFF, GLB and 3MF keep colours only, STL nothing; what is lost is listed in the warnings, unless the
/// program made it itself.
/// STL knows float32 only: where that would move a vertex by more than 1e-3 of the spacing the box's
/// centre is subtracted, reported as `offset` and written into NAME.offset.txt. So does 3MF; GLB has a place for it.
/// \throws Error{input} (unwritable, unknown extension), Error{guarantee} when float32 would make two
///         vertices equal even with an offset.
WriteResult write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const WriteOptions& options = {});

/// Writes a cloud with its attributes (ply, pcd, las, xyz/txt/asc/csv, obj), atomically as above. PCD is binary
/// (version 0.7); LAS 1.4 has what it has no field for as extra bytes; OBJ keeps places, colours and normals only.
WriteResult write_point_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                              const WriteOptions& options = {});

/// Is there a writer for this extension, or this format if one is given? For refusing a name before the work starts.
bool can_write_mesh(const std::filesystem::path& path, const std::string& format = {});
/// The same for point clouds.
bool can_write_point_cloud(const std::filesystem::path& path, const std::string& format = {});

/// Finds out now what write_file_atomically would find out in the end: is there a folder in which a file can be made,
/// with room for it? Leaves nothing behind. \throws Error{input}
void require_writable(const std::filesystem::path& path);

/// Writes any file atomically: `write` fills the stream of a temporary file in the same folder.
/// \throws Error{input} when it cannot be created, written or renamed; whatever `write` throws.
void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Files that appear together: each is written beside its place first, and only when all are finished they take their
/// places, which needs neither memory nor room on the disk. Those that did not, leave nothing.
class OutputFiles {
 public:
  OutputFiles();
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// \name Files to appear
  /// @{

  /// As write_mesh, write_point_cloud and write_file_atomically, but the file does not appear. Devices and pipes are
  /// written at once.
  WriteResult add_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const WriteOptions& options = {});
  WriteResult add_point_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                              const WriteOptions& options = {});
  void add(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
  /// @}

  /// \throws Error{input} naming the first file that cannot take its place; those before it have
  void put_in_place();

 private:
  /// The file with it beside `path`; where it is 0, one that an earlier run left there goes.
  void add_offset(const std::filesystem::path& path, const Vec3& offset, std::vector<std::string>& warnings);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Removes the temporaries of all files that are being written. Calls nothing that a signal handler may not; the
/// process should end after it.
void remove_temporaries() noexcept;

/// The file that symbolic links lead to; it need not exist.
std::filesystem::path follow_links(const std::filesystem::path& path);

/// Lower-case hexadecimal SHA-256 of the file's bytes.
std::string sha256_of_file(const std::filesystem::path& path);

} // namespace eigencrust
