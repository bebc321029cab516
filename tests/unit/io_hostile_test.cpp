// SPDX-License-Identifier: GPL-3.0-or-later
// Damaged files: whatever is cut off or changed, reading either works or throws an eigencrust::Error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <eigencrust/io.h>

#include "e57_bytes.h"
#include "las_bytes.h"
#include "scene_bytes.h"
#include "support.h"
#include "zip_bytes.h"

namespace eigencrust {
namespace {

struct Sample {
  const char* name; ///< its extension chooses the reader
  std::string bytes;
};

TriangleMesh small_mesh() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.0 / 3}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const char* name : {"red", "green", "blue"})
    mesh.vertex_attributes.push_back(make_attribute(name, ScalarType::uint8, std::vector<double>{1, 2, 3, 255}));
  Attribute list = make_attribute("list", ScalarType::int16, std::vector<double>{1, 2, 3});
  list.is_list = true;
  list.offsets = {0, 2, 2, 3, 3};
  mesh.vertex_attributes.push_back(list);
  return mesh;
}

void add_scanner_files(std::vector<Sample>& result) {
  result.push_back({"a.ptx",
                    "2\n1\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n1 2 3 .5 7 8 9\n0 0 0 .5 "
                    "0 0 0\n1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n4 5 6 .5\n"});
  const std::string pcd =
      "VERSION 0.7\nFIELDS x y z rgb l\nSIZE 4 4 4 4 1\nTYPE F F F U I\nCOUNT 1 1 1 1 2\nWIDTH 2\n"
      "HEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 2\nDATA ";
  result.push_back({"a.pcd", pcd + "ascii\n1 2 3 4 5 6\n7 8 nan 10 -11 12\n"});
  result.push_back({"b.pcd", pcd + "binary\n" + std::string(36, 'a')});
  result.push_back({"c.pcd", pcd + "binary_compressed\n" + std::string("\5\0\0\0\x24\0\0\0\0a\xe0\x1a\0", 13)});
  E57TestScan scan;
  scan.records = 2;
  for (const char* name : {"X", "Y", "Z"})
    scan.fields.push_back({std::string("<cartesian") + name + " type=\"Float\"/>", std::string(16, 'a')});
  result.push_back({"a.e57", e57_file({scan})});
  LasTestFile las{.minor = 4, .record_bytes = 23, .records = {std::string(23, 'a'), std::string(23, 'b')}};
  las.variable_records = las_record("LASF_Spec", 4, las_extra(12, 8, "pair") + las_extra(1, 0, "byte"));
  las.variable_count = 1;
  result.push_back({"a.las", las.bytes()});
}

std::vector<Sample> samples() {
  const TempDir folder;
  std::vector<Sample> result;
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl", "a.glb", "a.3mf"}) {
    write_mesh(folder / name, small_mesh());
    result.push_back({name, read_bytes(folder / name)});
  }
  write_point_cloud(folder / "a.csv", {small_mesh().vertices, {small_mesh().vertex_attributes[0]}, {}});
  result.push_back({"a.csv", read_bytes(folder / "a.csv")});
  result.push_back(
      {"b.ply",
       "ply\nformat ascii 1.0\ncomment c\nelement vertex 3\nproperty float x\nproperty double y\n"
       "property int z\nproperty list uchar short l\nelement face 2\nproperty list uchar int vertex_indices\n"
       "property uchar q\nend_header\n0 0 0 0\n1 0.5 0 2 7 8\n1e1 nan -1 1 9\n3 0 1 2 7\n4 0 1 2 0 8\n"});
  std::string big =
      "ply\nformat binary_big_endian 1.0\nelement face 1\nproperty list ushort uint vertex_index\n"
      "property list uchar float uv\nelement vertex 3\nproperty short x\nproperty char y\nproperty uchar "
      "z\nend_header\n";
  big += std::string("\0\3\0\0\0\0\0\0\0\1\0\0\0\2\1\0\0\0\0", 19) + "abcdefghijkl";
  result.push_back({"c.ply", big});
  result.push_back({"a.pts", "2\n1 2 3 -5 255 0 1\n4 5 6 7 8 9 10\n1\n1 2 3\n"});
  result.push_back({"b.pts", "# c\nd 1 1 1\np 1 2 3\np 4 5 6\n"});
  result.push_back({"b.stl",
                    "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                    "endfacet\nendsolid s\n"});
  result.push_back({"b.off", "COFF\n# c\n3 1 3\n0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n3 0 1 2\n"});
  result.push_back({"b.obj", "v 0 0 0 1 0 0\nv 1 0 \\\n0\nv 0 1 0 1\nf 1//1 2/2 -1\nf 3 2 1\n"});
  add_scanner_files(result);
  result.push_back({"a.txt", "# x y z r\n1 2 3 4\n-1e5;nan,3 255\n"});
  const std::string array = npy_file("<f4", "(2, 3)", std::string(24, 'a'));
  result.push_back({"a.npy", array});
  result.push_back({"a.npz", zip_file({{"points.npy", array, deflate_stored(array), 8},
                                       {"sensor_position.npy", npy_file("<f8", "(3,)", std::string(24, 'a'), true)},
                                       {"l.npy", npy_file("|u1", "(2,)", "12")}})});
  result.push_back({"b.npz", zip_file({{.name = "a.npy", .content = array, .large = true}})});
  result.push_back({"b.glb", glb_triangle(R"({"children":[1],"rotation":[0,1,0,1]},{"mesh":0,"scale":[1,2,-3]})")});
  result.push_back(
      {"b.3mf", three_mf_file("<model unit='inch'><resources><basematerials id='7'><base name='a' "
                              "displaycolor='#FF0000'/></basematerials><object id='1' pid='7' pindex='0'>" +
                              three_mf_mesh("p1='0'") +
                              "</object></resources><build><item objectid='1' transform='1 0 0 0 1 0 0 0 1 "
                              "0 0 10'/></build></model>")});
  result.push_back({"unknown", "1 2 3\n4 5 6\n"});
  return result;
}

class IoHostile : public ::testing::Test {
 protected:
  /// Reads as a cloud and as a mesh; anything but a result or an Error fails the test.
  void read(const Sample& sample, const std::string& bytes, const std::string& what) {
    const auto path = folder_ / sample.name;
    std::filesystem::remove(path); // some file systems flush a file that is cut short and written again
    write_bytes(path, bytes);
    try {
      const PointCloud cloud = read_point_cloud(path);
      for (const Attribute& attribute : cloud.attributes)
        ASSERT_EQ(attribute.rows(), cloud.points.size()) << sample.name << what;
      // Memory grows with the file, not with what the file claims.
      ASSERT_LE(cloud.points.size(), bytes.size()) << sample.name << what;
    } catch (const Error& error) {
      ++errors_;
      ASSERT_NE(error.kind(), ErrorKind::memory) << sample.name << what << error.what();
    }
    try {
      const TriangleMesh mesh = read_mesh(path);
      for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.vertices.size()) << sample.name << what;
      for (const Attribute& attribute : mesh.triangle_attributes)
        ASSERT_EQ(attribute.rows(), mesh.triangles.size()) << sample.name << what;
    } catch (const Error&) {
    }
  }

  int errors_ = 0;
  TempDir folder_;
};

TEST_F(IoHostile, SamplesThemselvesAreGood) {
  for (const Sample& sample : samples()) {
    errors_ = 0;
    read(sample, sample.bytes, "");
    EXPECT_EQ(errors_, 0) << sample.name;
  }
}

TEST_F(IoHostile, CutOffAnywhere) {
  for (const Sample& sample : samples())
    for (std::size_t size = 0; size < sample.bytes.size(); ++size)
      read(sample, sample.bytes.substr(0, size), " cut at " + std::to_string(size));
  EXPECT_GT(errors_, 1000);
}

TEST_F(IoHostile, ChangedBytes) {
  std::uint64_t state = 1;
  const auto random = [&](std::size_t below) { // a 64-bit linear congruential generator (Knuth, MMIX)
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>(state >> 33) % below;
  };
  const std::string likely = "0123456789-. \n\t,;#/\\eEnaif\"\r";
  for (const Sample& sample : samples())
    for (int round = 0; round < 300; ++round) {
      std::string bytes = sample.bytes;
      for (std::size_t changes = 1 + random(4); changes > 0; --changes) {
        const std::size_t place = random(bytes.size());
        switch (random(4)) {
          case 0:
            bytes[place] = static_cast<char>(random(256));
            break;
          case 1:
            bytes[place] = likely[random(likely.size())];
            break;
          case 2:
            bytes.insert(place, 1, likely[random(likely.size())]);
            break;
          default:
            bytes.erase(place, 1);
            if (bytes.empty()) bytes.assign(1, 'x');
        }
      }
      read(sample, bytes, " round " + std::to_string(round));
    }
  EXPECT_GT(errors_, 1000);
}

// Small files that ask for much: time and memory must follow the size of the file. Where they do not, this test takes
// longer than it may, or more memory than there is.
TEST_F(IoHostile, SmallFilesThatAskForMuch) {
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nproperty int z\n";
  std::string names, scans, letters, indices, uv;
  for (int i = 0; i < 30000; ++i) {
    names += "property int a\n";
    scans += "0\n";
    letters += ",a";
    indices += " 0";
    uv += " 1";
  }
  read({"a.ply", ""}, ply + names + "end_header\n1 2 3" + uv + "\n", " many equal names");
  read({"a.pts", ""}, scans + "1\n1 2 3\n", " many scans");
  read({"a.csv", ""}, "x,y,z" + letters + "\n", " a long header");
  // One polygon of 30000 corners and a list of 30000 values, which must not be copied for each triangle.
  read({"b.ply", ""},
       ply +
           "element face 1\nproperty list int int vertex_indices\nproperty list int int uv\nend_header\n1 2 3\n30000" +
           indices + " 30000" + uv + "\n",
       " a long polygon");
}

} // namespace
} // namespace eigencrust
