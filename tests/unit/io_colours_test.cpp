// SPDX-License-Identifier: GPL-3.0-or-later
// Colours in every form that files have: what is written is what viewers expect, and the columns stay.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Columns = std::vector<Attribute>;

Attribute column(std::string name, ScalarType type, std::vector<double> values) {
  return make_attribute(std::move(name), type, values);
}

Columns three(const std::array<const char*, 3>& names, ScalarType type,
              const std::array<std::array<double, 2>, 3>& values) {
  Columns columns;
  for (std::size_t k = 0; k < 3; ++k) columns.push_back(column(names[k], type, {values[k][0], values[k][1]}));
  return columns;
}

/// Two points; the second is 40, 80, 160 of 255 in each of them.
std::vector<Columns> all_forms() {
  std::vector<Columns> forms;
  const std::array<std::array<double, 2>, 3> bytes{{{0, 40}, {255, 80}, {7, 160}}},
      words{{{0, 40 * 257}, {65535, 80 * 257}, {7 * 257, 160 * 257}}},
      shares{{{0, 40 / 255.0}, {1, 80 / 255.0}, {7 / 255.0, 160 / 255.0}}};
  forms.push_back(three({"red", "green", "blue"}, ScalarType::uint8, bytes));
  forms.push_back(three({"red", "green", "blue"}, ScalarType::uint16, bytes)); // 8-bit values in 16-bit fields
  forms.push_back(three({"red", "green", "blue"}, ScalarType::uint16, words));
  forms.push_back(three({"R", "G", "B"}, ScalarType::float64, words));
  forms.push_back(three({"R", "G", "B"}, ScalarType::uint8, bytes));
  forms.push_back(three({"diffuse_red", "diffuse_green", "diffuse_blue"}, ScalarType::uint8, bytes));
  forms.push_back(three({"Rf", "Gf", "Bf"}, ScalarType::float64, shares));
  forms.push_back(three({"red", "green", "blue"}, ScalarType::float32, shares));
  forms.push_back(three({"red", "green", "blue"}, ScalarType::float32, bytes));
  const double first = 0x00ff07, second = 40 * 65536 + 80 * 256 + 160;
  forms.push_back({column("rgb", ScalarType::uint32, {first, second})});
  forms.push_back({column("rgb", ScalarType::float64, {first, second})});
  Attribute bits = column("rgb", ScalarType::float32, {0, 0}); // the float with these bits, as PCL writes
  const std::array<std::uint32_t, 2> packed = {0x00ff07, 40 * 65536 + 80 * 256 + 160};
  std::memcpy(bits.values.data(), packed.data(), 8);
  forms.push_back({bits});
  return forms;
}

TriangleMesh mesh_with(const Columns& columns) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 0}};
  mesh.vertex_attributes = columns;
  return mesh;
}

void expect_colours(const Columns& read) {
  for (const auto& [name, first, second] :
       {std::tuple{"red", 0, 40}, std::tuple{"green", 255, 80}, std::tuple{"blue", 7, 160}}) {
    const Attribute* channel = find_attribute(read, name);
    ASSERT_NE(channel, nullptr) << name;
    EXPECT_EQ(channel->type, ScalarType::uint8);
    EXPECT_EQ(attribute_value(*channel, 0), first) << name;
    EXPECT_EQ(attribute_value(*channel, 1), second) << name;
  }
}

TEST(IoColours, EveryFormComesOutInEveryFormat) {
  const TempDir folder;
  for (const Columns& columns : all_forms()) {
    SCOPED_TRACE(columns[0].name + " " + std::to_string(static_cast<int>(columns[0].type)));
    for (const char* name : {"a.ply", "a.obj", "a.off"}) {
      write_mesh(folder / name, mesh_with(columns));
      expect_colours(read_mesh(folder / name).vertex_attributes);
    }
    const PointCloud cloud{{{0, 0, 0}, {1, 0, 0}}, columns, {}};
    for (const char* name : {"c.ply", "c.pcd", "c.obj", "c.xyz", "c.csv"}) {
      write_point_cloud(folder / name, cloud);
      expect_colours(read_point_cloud(folder / name).attributes);
    }
    EXPECT_THAT(read_bytes(folder / "a.ply"), HasSubstr("property uchar red\n"));
  }
}

TEST(IoColours, LasStretchesThemTo16Bits) {
  const TempDir folder;
  for (const Columns& columns : all_forms()) {
    SCOPED_TRACE(columns[0].name + " " + std::to_string(static_cast<int>(columns[0].type)));
    write_point_cloud(folder / "c.las", PointCloud{{{0, 0, 0}, {1, 0, 0}}, columns, {}});
    const PointCloud back = read_point_cloud(folder / "c.las");
    for (const auto& [name, first, second] :
         {std::tuple{"red", 0, 40}, std::tuple{"green", 255, 80}, std::tuple{"blue", 7, 160}}) {
      const Attribute* channel = find_attribute(back.attributes, name);
      ASSERT_NE(channel, nullptr) << name;
      EXPECT_EQ(channel->type, ScalarType::uint16);
      EXPECT_EQ(attribute_value(*channel, 0), 257 * first) << name;
      EXPECT_EQ(attribute_value(*channel, 1), 257 * second) << name;
    }
  }
}

TEST(IoColours, TheOriginalColumnsStayInPcdAndLas) {
  const TempDir folder;
  // 8-bit values in 16-bit fields, and the names of another program.
  for (const Columns& columns :
       {three({"red", "green", "blue"}, ScalarType::uint16, {{{0, 40}, {255, 80}, {7, 160}}}),
        three({"diffuse_red", "diffuse_green", "diffuse_blue"}, ScalarType::uint8, {{{0, 40}, {255, 80}, {7, 160}}})})
    for (const char* name : {"c.pcd", "c.las"}) {
      write_point_cloud(folder / name, PointCloud{{{0, 0, 0}, {1, 0, 0}}, columns, {}});
      const PointCloud back = read_point_cloud(folder / name);
      for (const Attribute& column : columns) {
        const Attribute* original = find_attribute(
            back.attributes,
            column.name + (column.name == "red" || column.name == "green" || column.name == "blue" ? "_original" : ""));
        ASSERT_NE(original, nullptr) << name << " " << column.name;
        EXPECT_EQ(original->type, column.type);
        EXPECT_EQ(original->values, column.values);
      }
    }
}

TEST(IoColours, TheOriginalColumnsStay) {
  const TempDir folder;
  for (const Columns& columns : all_forms()) {
    const WriteResult result = write_mesh(folder / "a.ply", mesh_with(columns));
    const Columns back = read_mesh(folder / "a.ply").vertex_attributes;
    const bool plain = columns[0].name == "red" && columns[0].type == ScalarType::uint8;
    EXPECT_EQ(back.size(), plain ? 3 : 3 + columns.size());
    for (const Attribute& column : columns) {
      const bool taken = !plain && (column.name == "red" || column.name == "green" || column.name == "blue");
      const Attribute* original = find_attribute(back, column.name + (taken ? "_original" : ""));
      ASSERT_NE(original, nullptr) << column.name;
      EXPECT_EQ(original->type, column.type);
      EXPECT_EQ(original->values, column.values);
    }
    EXPECT_EQ(result.warnings.size(), !plain && columns[0].name == "red" ? 3u : 0u); // of the new names
  }
}

TEST(IoColours, AlphaAndSignedBytes) {
  const TempDir folder;
  Columns columns = three({"red", "green", "blue"}, ScalarType::uint8, {{{0, 40}, {255, 80}, {7, 0}}});
  columns[2] = column("blue", ScalarType::int8, {7, -96}); // 160 declared as a signed byte
  columns.push_back(column("alpha", ScalarType::float32, {1, 0.2}));
  write_mesh(folder / "a.off", mesh_with(columns));
  EXPECT_THAT(read_bytes(folder / "a.off"), HasSubstr("1 0 0 40 80 160 51\n"));
  write_mesh(folder / "a.ply", mesh_with(columns));
  expect_colours(read_mesh(folder / "a.ply").vertex_attributes);
  EXPECT_EQ(attribute_value(*find_attribute(read_mesh(folder / "a.ply").vertex_attributes, "alpha"), 1), 51);
}

TEST(IoColours, WhatIsNoColourIsLeftAlone) {
  const TempDir folder;
  for (const Columns& columns :
       {three({"r", "g", "b"}, ScalarType::float64, {{{-1, 2}, {3, 4}, {5, 6}}}),
        three({"r", "g", "b"}, ScalarType::float64, {{{1e6, 2}, {3, 4}, {5, 6}}}),
        Columns{column("red", ScalarType::uint8, {1, 2})}, Columns{column("rgb", ScalarType::uint8, {1, 2})}}) {
    EXPECT_THAT(write_mesh(folder / "a.ply", mesh_with(columns)).warnings, IsEmpty());
    EXPECT_EQ(read_mesh(folder / "a.ply").vertex_attributes.size(), columns.size());
  }
  // Colours that are not known are white.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  write_mesh(folder / "a.off",
             mesh_with(three({"r", "g", "b"}, ScalarType::float64, {{{nan, 40}, {nan, 80}, {nan, 160}}})));
  EXPECT_THAT(read_bytes(folder / "a.off"), HasSubstr("0 0 0 255 255 255 255\n1 0 0 40 80 160 255\n"));
}

} // namespace
} // namespace eigencrust
