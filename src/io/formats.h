// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The readers and writers of the single formats. Only registry.cpp calls them.
/// A reader that drops something, or could read it in two ways, says so in a sentence of `notes`.
#pragma once

#include <ostream>
#include <span>

#include <eigencrust/io.h>

#include "io/file_content.h"

namespace eigencrust::io {

// Readers. All throw Error{input} as io.h says.
PointCloud read_ply_cloud(const FileContent& file);
TriangleMesh read_ply_mesh(const FileContent& file);
PointCloud read_xyz(const FileContent& file, const ReadOptions& options, ReadNotes& notes);
PointCloud read_esri_grid(const FileContent& file, ReadNotes& notes);
/// The rows of an .xyz file under the name .pts; rows may begin with the letter p, after a header of
/// rows that begin with d, s or g (Hoppe's point files).
PointCloud read_lettered_xyz(const FileContent& file, const ReadOptions& options, ReadNotes& notes);
PointCloud read_pts(const FileContent& file, const ReadOptions& options, ReadNotes& notes);
PointCloud read_e57(const FileContent& file, std::vector<std::string>& notes);
PointCloud read_ptx(const FileContent& file, ReadNotes& notes);
PointCloud read_pcd(const FileContent& file, const ReadOptions& options, std::vector<std::string>& notes);
PointCloud read_las(const FileContent& file, std::vector<std::string>& notes);
PointCloud read_npy(const FileContent& file);
PointCloud read_npz(const FileContent& file, std::vector<std::string>& notes);
TriangleMesh read_obj(const FileContent& file);
TriangleMesh read_off(const FileContent& file);
TriangleMesh read_stl(const FileContent& file);
TriangleMesh read_glb(const FileContent& file, MeshNotes& notes);
TriangleMesh read_three_mf(const FileContent& file, MeshNotes& notes);

// Whether the file begins as no other format does.
bool looks_like_ptx(const FileContent& file);
bool looks_like_pcd(const FileContent& file);
bool looks_like_esri_grid(const FileContent& file);
bool looks_like_three_mf(const FileContent& file);

/// \throws Error{input} where the file is of a kind that other programs know: says which, and what to do
void reject_foreign(const FileContent& file);

/// What read_point_cloud and read_mesh do, once the bytes are there; the name's extension counts.
PointCloud read_cloud(const FileContent& file, const ReadOptions& options, ReadNotes& notes);
TriangleMesh read_mesh(const FileContent& file, MeshNotes& notes);

// Writers. They check and choose first (prepare), so that nothing is created in vain, and leave what
// they chose in `result`.
using Body = std::function<void(std::ostream&)>;
Body prepare_ply(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result);
Body prepare_ply(const PointCloud& cloud, const WriteOptions& options, WriteResult& result);
Body prepare_obj(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result);
Body prepare_obj(const PointCloud& cloud, const WriteOptions& options, WriteResult& result);
Body prepare_pcd(const PointCloud& cloud, const WriteOptions& options, WriteResult& result);
/// The sensor that VIEWPOINT of a PCD file tells: all points have the same one.
std::optional<Vec3> viewpoint_of(const PointCloud& cloud);
Body prepare_las(const PointCloud& cloud, const WriteOptions& options, WriteResult& result);
Body prepare_off(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result);
Body prepare_stl(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result);
Body prepare_glb(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result);
Body prepare_three_mf(const TriangleMesh& mesh, const WriteOptions& options, WriteResult& result);
/// \param separator between the fields; ',' writes the header line without a mark
Body prepare_xyz(const PointCloud& cloud, const WriteOptions& options, char separator, WriteResult& result);

} // namespace eigencrust::io
