// SPDX-License-Identifier: GPL-3.0-or-later
// Every file of the real data in a format that is read here: how many points and triangles it holds and
// how far they reach (computed beforehand by an independent script), or why it is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::HasSubstr;

struct Good {
  const char* path;
  std::size_t points, triangles;
  Box3 bounds;
};
class IoRealFiles : public ::testing::TestWithParam<Good> {};

TEST_P(IoRealFiles, ReadRight) {
  const auto path = data_path(GetParam().path);
  EIGENCRUST_NEED_DATA(path);
  const PointCloud cloud = read_point_cloud(path);
  EXPECT_EQ(cloud.points.size(), GetParam().points);
  Box3 bounds;
  for (const Vec3& p : cloud.points) bounds.add(p);
  EXPECT_EQ(bounds.min, GetParam().bounds.min);
  EXPECT_EQ(bounds.max, GetParam().bounds.max);
  for (const Attribute& attribute : cloud.attributes) EXPECT_EQ(attribute.rows(), cloud.points.size());
  if (path.extension() == ".pts") return;
  const TriangleMesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.vertices, cloud.points);
  EXPECT_EQ(mesh.triangles.size(), GetParam().triangles);
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(
    All, IoRealFiles,
    ::testing::ValuesIn(std::vector<Good>{
        {"armadillo/armadillo_standflip_raw.ply", 270750, 0, {{-0.2518117427825928, 0.003138147760182619, -0.2493198961019516}, {0.2546673119068146, 0.321502685546875, 0.25112390518188477}}},
        {"bunny/bun_zipper.ply", 35947, 69451, {{-0.09468989819288254, 0.03298740088939667, -0.061873599886894226}, {0.06100910156965256, 0.1873210072517395, 0.05879969894886017}}},
        {"bunny/bunny_raw.ply", 362272, 0, {{-0.11427690088748932, 0.023154258728027344, -0.06930025666952133}, {0.0613698773086071, 0.18794000148773193, 0.05911651626229286}}},
        {"castle/points.ply", 12683, 0, {{-8.567060470581055, -40.96321105957031, -3.285529375076294}, {6.847393035888672, 7.148025035858154, 2.1530935764312744}}},
        {"classics/cactus.3337.pts", 3337, 0, {{0.433945, 0.246789, 0.1}, {0.566055, 0.753211, 0.9}}},
        {"classics/hotdogs.pts", 1748, 0, {{-4.78036, -3.38529, -1.55841}, {7.13779, 6.94662, 2.13322}}},
        {"classics/knot.pts", 1281, 0, {{-9.336563, -8.893818, -6.737088}, {9.315571, 8.937094, 6.781146}}},
        {"dragon/dragon_stand_side_raw.ply", 792820, 0, {{-0.16379974782466888, 0.035768307745456696, -0.11547868698835373}, {0.09730295836925507, 0.23872517049312592, 0.04269014671444893}}},
        {"formats/obj/box.obj", 8, 12, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}},
        {"formats/obj/hyper_box.obj", 16, 24, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}},
        {"formats/off/ballA.off", 1900, 3796, {{-10.9128, -6.91992, -6.92778}, {2.9146, 6.92261, 6.92651}}},
        {"formats/off/comments.off", 8, 12, {{-1.632993, -1.632993, -1.154701}, {1.632993, 1.632993, 1.154701}}},
        {"formats/off/whitespace.off", 8, 12, {{-1.632993, -1.632993, -1.154701}, {1.632993, 1.632993, 1.154701}}},
        {"formats/ply/cube_blender_uv.ply", 24, 12, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}},
        {"formats/ply/empty.ply", 0, 0, {}},
        {"formats/ply/featuretype.ply", 5096, 3476, {{-2.5, -1.25, 0.0}, {2.5, 1.25, 1.375}}},
        {"formats/ply/issue_2421.ply", 1, 0, {{1.23457, 12345.6789, 1234567890.12345}, {1.23457, 12345.6789, 1234567890.12345}}},
        {"formats/ply/mesh.ply", 4, 2, {{1.0, 1.0, 0.0}, {2.0, 2.0, 2.0}}},
        {"formats/ply/mesh_fixed.ply", 4, 2, {{1.0, 1.0, 0.0}, {2.0, 2.0, 2.0}}},
        {"formats/ply/multi.ply", 4, 2, {{-1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}}},
        {"formats/ply/points_ascii.ply", 5, 0, {{-0.06449999660253525, 0.03597930073738098, 0.04043620079755783}, {-0.06274999678134918, 0.03672889992594719, 0.042594898492097855}}},
        {"formats/ply/points_ascii_with_lists.ply", 5, 0, {{-0.06449999660253525, 0.03597930073738098, 0.04043620079755783}, {-0.06274999678134918, 0.03672889992594719, 0.042594898492097855}}},
        {"formats/ply/points_bin.ply", 5, 0, {{-0.06449999660253525, 0.03597930073738098, 0.04043620079755783}, {-0.06274999678134918, 0.03672889992594719, 0.042594898492097855}}},
        {"formats/ply/points_emptyface.ply", 1024, 0, {{-138.55677795410156, -107.85254669189453, -42.19145965576172}, {126.95053100585938, 101.5431900024414, 125.6260757446289}}},
        {"formats/ply/simple_binary.ply", 3, 0, {{-1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}}},
        {"formats/ply/simple_text.ply", 3, 0, {{-1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}}},
        {"formats/ply/text_extradim.ply", 1, 0, {{-2.649440050125122, -13.095499992370605, 0.006401150021702051}, {-2.649440050125122, -13.095499992370605, 0.006401150021702051}}},
        {"formats/pts/autzen.pts", 10, 0, {{636102.840012, 848968.800003, 427.919998}, {636126.400009, 849345.199997, 512.139999}}},
        {"formats/pts/site_56_8.pts", 8, 0, {{6691.250667, 17.347517, -14.709473}, {6728.512429, 45.710979, 1203.033447}}},
        {"formats/pts/test.pts", 19, 0, {{-25.050461, -24.533554, -2.000961}, {3.980972, -2.006119, -0.010086}}},
        {"formats/stl/busted.STL", 1941, 3878, {{-5.3982648849487305, 18.30052375793457, -9.935678482055664}, {5.277234077453613, 29.685245513916016, -0.3632774353027344}}},
        {"formats/stl/empty.stl", 0, 0, {}},
        {"formats/stl/featuretype.STL", 2010, 3476, {{-2.5, -1.25, -2.7318480145066093e-16}, {2.5, 1.25, 1.375}}},
        {"formats/stl/multibody.stl", 20, 32, {{-0.51078958, -0.718809786, -0.0519321219}, {0.125242366, 0.369621955, 0.287995578}}},
        {"formats/stl/unit_cube.STL", 8, 12, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}},
        {"gargoyle/gargoyle.ply", 95435, 0, {{-34.25404739379883, -37.83924102783203, -27.121673583984375}, {34.73072814941406, 37.806575775146484, 26.74557113647461}}},
        {"hand/hand.off", 36619, 72958, {{-0.390468, -0.949176, -0.274323}, {0.420738, 0.922597, 0.429471}}},
        {"happy/happy_stand_side_raw.ply", 1817164, 0, {{-0.04695935919880867, 0.003375942585989833, -0.12954263389110565}, {0.05223923176527023, 0.24904078245162964, 0.09163449704647064}}},
        {"ignatius/ignatius_99_sensors.ply", 10000, 0, {{-0.28094682097435, -0.26137202978134155, -0.40722396969795227}, {0.3085198402404785, 0.3286612927913666, 0.4203093647956848}}},
        {"meshes/angel.obj", 16723, 33446, {{-75.1713, 0.0505, -86.3236}, {83.8114, 321.1518, 56.3205}}},
        {"meshes/armadillo.obj", 43243, 86482, {{-0.435275, -0.573402, -0.379481}, {0.403342, 0.426549, 0.38333}}},
        {"meshes/fandisk.18k.obj", 9445, 18886, {{-0.002292, 12.6111, -2.66676}, {4.8302, 17.8485, 0.003773}}},
        {"meshes/horse.ply", 48485, 96966, {{-0.042003002017736435, -0.09167049825191498, -0.07641799747943878}, {0.042003002017736435, 0.09167050570249557, 0.07641800493001938}}},
        {"reconbench/anchor.off", 49200, 98412, {{-37.52628708, -23.49953651, -32.09380341}, {37.53468704, 23.49896431, 32.01319504}}},
        {"reconbench/anchor_mvs_sensors.ply", 3000, 0, {{-37.51860427856445, -23.471559524536133, -32.08193588256836}, {37.52774429321289, 23.472213745117188, 32.002296447753906}}},
        {"reconbench/gargoyle_mvs_sensors.ply", 3000, 0, {{-34.58271789550781, -37.24605941772461, -25.819623947143555}, {31.966514587402344, 37.22891616821289, 26.796113967895508}}},
        {"reconbench/lordquas.off", 25702, 51400, {{-18.45334435, -37.51579285, -17.50663757}, {18.48830795, 37.51974487, 17.50755882}}},
        {"reconbench/lordquas_mvs_sensors.ply", 3000, 0, {{-18.419246673583984, -37.46076202392578, -17.498085021972656}, {18.415821075439453, 36.891212463378906, 17.024534225463867}}},
        {"scan_the_bunny/bunny1.obj", 3169, 5708, {{-0.380304, -0.499125, -0.003321}, {0.378948, 0.497251, 0.996679}}},
        {"scan_the_bunny/pointcloud_mvs_sensors.ply", 2381, 0, {{-0.38009998202323914, -0.4912988543510437, 0.016934704035520554}, {0.3766607940196991, 0.4960462152957916, 0.9959811568260193}}},
        {"scan_the_bunny/pointcloud_sensors.ply", 18279, 0, {{-0.3790198862552643, -0.4988883137702942, 0.007794302422553301}, {0.37720832228660583, 0.496843159198761, 0.9941655993461609}}}
    }));
// clang-format on

struct Refused {
  const char* path;
  const char* said;
};
class IoMalformedFiles : public ::testing::TestWithParam<Refused> {};

TEST_P(IoMalformedFiles, AreRefused) {
  const auto path = data_path(GetParam().path);
  EIGENCRUST_NEED_DATA(path);
  EXPECT_THAT(error_of([&] { read_point_cloud(path); }), HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(All, IoMalformedFiles,
                         ::testing::Values(Refused{"formats/obj/no_vertex.obj", "no vertex lines"},
                                           Refused{"formats/pts/bunny_8.pts",
                                                   "bunny_8.pts:10"}, // 9 rows, but the count says 8
                                           Refused{"formats/ply/no_vertex.ply", "no vertex element"},
                                           Refused{"formats/ply/sized_dims.ply", "no property 'z'"},
                                           Refused{"formats/ply/unsized_dims.ply", "no property 'z'"},
                                           Refused{"bunny/scan_index.u8", "format is not known"}));

std::string names_of(const PointCloud& cloud) {
  std::string names;
  for (const Attribute& attribute : cloud.attributes) names += attribute.name + ' ';
  return names;
}

TEST(IoRealAttributes, AreNamedAndTyped) {
  const auto sensors = data_path("reconbench/anchor_mvs_sensors.ply");
  EIGENCRUST_NEED_DATA(sensors);
  EXPECT_EQ(names_of(read_point_cloud(sensors)), "sx sy sz ");
  EXPECT_EQ(names_of(read_point_cloud(data_path("gargoyle/gargoyle.ply"))), "nx ny nz ");

  const PointCloud extra = read_point_cloud(data_path("formats/ply/text_extradim.ply"));
  EXPECT_EQ(names_of(extra), "nx ny nz red green blue alpha omg ");
  EXPECT_EQ(find_attribute(extra.attributes, "blue")->type, ScalarType::int8);
  EXPECT_EQ(attribute_value(*find_attribute(extra.attributes, "omg"), 0), 1234);

  const PointCloud pts = read_point_cloud(data_path("formats/pts/autzen.pts"));
  EXPECT_EQ(names_of(pts), "intensity red green blue ");
  EXPECT_EQ(attribute_value(pts.attributes[0], 2), 602);
  EXPECT_EQ(attribute_value(pts.attributes[3], 9), 100);

  // 0.752941 in the file: 192 of 255.
  const PointCloud bunny = read_point_cloud(data_path("scan_the_bunny/bunny1.obj"));
  EXPECT_EQ(names_of(bunny), "red green blue ");
  EXPECT_EQ(attribute_value(bunny.attributes[0], 0), 192);
}

TEST(IoRealScanIndex, CountsTheScans) {
  const auto path = data_path("bunny/scan_index.u8");
  EIGENCRUST_NEED_DATA(path);
  const std::vector<std::uint32_t> scans = read_scan_index(path, 362272);
  EXPECT_EQ(*std::max_element(scans.begin(), scans.end()), 9u);
  EXPECT_THAT(error_of([&] { read_scan_index(path, 362271); }), HasSubstr("362272 scan numbers"));
}

} // namespace
} // namespace eigencrust
