// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as programs and people write them: separators, headers, counts, titles, words, values that are not known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include <eigencrust/io.h>

#include "support.h"

namespace eigencrust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class IoTables : public ::testing::Test {
 protected:
  PointCloud read(std::string_view name, std::string_view text, std::vector<std::string> columns = {}) {
    write_bytes(folder_ / name, text);
    notes_ = {};
    return read_point_cloud(folder_ / name, {std::move(columns)}, &notes_);
  }
  std::string error(std::string_view name, std::string_view text, std::vector<std::string> columns = {}) {
    return error_of([&] { read(name, text, std::move(columns)); });
  }
  /// The columns that an error tells to type.
  static std::vector<std::string> typed(const std::string& message) {
    const std::string mark = "--columns ";
    std::vector<std::string> names(1);
    for (std::size_t i = message.find(mark) + mark.size(); i < message.size() && !std::strchr(" ;:", message[i]); ++i)
      if (message[i] == ',')
        names.emplace_back();
      else
        names.back() += message[i];
    return names;
  }

  ReadNotes notes_;

 private:
  TempDir folder_;
};

std::vector<std::string> names_of(const PointCloud& cloud) {
  std::vector<std::string> names;
  for (const Attribute& a : cloud.attributes) names.push_back(a.name);
  return names;
}

const std::vector<Vec3> two_points = {{1.5, 2.5, 3.5}, {4.5, 5.5, 6.5}};

TEST_F(IoTables, HeadersAsProgramsWriteThem) {
  for (const char* text :
       {"X [m]\tY [m]\tZ [m]\n1.5\t2.5\t3.5\n4.5\t5.5\t6.5\n", // tabs, units
        "Node Number\tX Location (mm)\tY Location (mm)\tZ Location (mm)\n1\t1.5\t2.5\t3.5\n2\t4.5\t5.5\t6.5\n",
        "x(mm),y(mm),z(mm)\n1.5,2.5,3.5\n4.5,5.5,6.5\n",
        "\"Normals:0\",\"Normals:1\",\"Normals:2\",\"Points:0\",\"Points:1\",\"Points:2\"\n0,0,1,1.5,2.5,3.5\n0,0,1,4."
        "5,5.5,6.5\n",
        "\"Points_m_XYZ:0\",\"Points_m_XYZ:1\",\"Points_m_XYZ:2\",\"azimuth\"\n1.5,2.5,3.5,7\n4.5,5.5,6.5,7\n",
        "nodenumber,    x-coordinate,    y-coordinate,    z-coordinate,  pressure\n 1, 1.5E+00, 2.5, 3.5, 9\n 2, "
        "4.5,5.5,6.5,9\n",
        "OBJECTID;POINT_X;POINT_Y;POINT_Z\n1;1.5;2.5;3.5\n2;4.5;5.5;6.5\n",
        "Point,Easting,Northing,Height\n1,1.5,2.5,3.5\n2,4.5,5.5,6.5\n", "E;N;H\n1.5;2.5;3.5\n4.5;5.5;6.5\n",
        "pos_x pos_y pos_z\n1.5 2.5 3.5\n4.5 5.5 6.5\n", "# X Y Z Illuminance_(PCV)\n1.5 2.5 3.5 0\n4.5 5.5 6.5 0\n",
        "//X;Y;Z;Illuminance (PCV)\n2\n1.5;2.5;3.5;0\n4.5;5.5;6.5;0\n",
        "% Nodes:  2\n% x                 y              z           T (K)\n1.5  2.5  3.5  273\n4.5   5.5   6.5   273  "
        "\n",
        "X,Y,Z\n1.5 2.5 3.5\n4.5 5.5 6.5\n"}) // the header has another separator than the rows
    EXPECT_EQ(read("a.txt", text).points, two_points) << text;
}

TEST_F(IoTables, NamesAreKeptAndBlanksInFieldsDoNotSplit) {
  const PointCloud cloud = read("a.txt", "//X;Y;Z;Rf;Illuminance (PCV)\n1;2;3;0.5;7\n4;5;6;0.25;8\n");
  EXPECT_THAT(names_of(cloud), ElementsAre("Rf", "Illuminance (PCV)"));
  EXPECT_THAT(names_of(read("a.csv", "Slot ID,X,Y,Z,Tag\n1,1,2,3,0x1F\n1,4,5,6,0\n")), ElementsAre("Slot ID", "Tag"));
  EXPECT_THAT(names_of(read("a.txt", "% x  y  z  T (K)\n1 2 3 4\n")), ElementsAre("T (K)"));
  // A plain x counts for more than a longer name; what else would be one keeps its name.
  const PointCloud both = read("a.csv", "X (m),x,y,z\n9,1,2,3\n");
  EXPECT_THAT(both.points, ElementsAre(Vec3{1, 2, 3}));
  EXPECT_THAT(names_of(both), ElementsAre("X (m)"));
  EXPECT_THAT(read("a.csv", "x,y,z,Ori_x,dx,nx\n1,2,3,4,5,6\n").points, ElementsAre(Vec3{1, 2, 3}));
}

TEST_F(IoTables, ColumnsOfWordsAreLeftOutWithAWarningEach) {
  const PointCloud cloud = read("a.csv", "Name,X,Y,Z,Code,v\nP1,1,2,3,WALL,7\nP2,4,5,6,TREE TOP,8\n");
  EXPECT_THAT(cloud.points, ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}));
  EXPECT_THAT(names_of(cloud), ElementsAre("v"));
  EXPECT_THAT(notes_.warnings, ElementsAre("column 'Name' left out: 'P1' (line 2) is no number",
                                           "column 'Code' left out: 'WALL' (line 2) is no number"));
  EXPECT_THAT(read("a.csv", "Date,Time,X,Y,Z\n2021-03-04,10:22:00.001,1,2,3\n").points, ElementsAre(Vec3{1, 2, 3}));
  EXPECT_THAT(read("a.xyz", "1 2 3 seg0\n4 5 6 seg1\n").points, SizeIs(2));
  // A few words among numbers are values that are not known.
  const PointCloud few = read("a.csv", "x,y,z,v\n1,2,3,5\n1,2,4,6\n1,3,4,bad\n");
  EXPECT_TRUE(std::isnan(attribute_value(few.attributes.at(0), 2)));
  EXPECT_THAT(notes_.warnings, ElementsAre("column 'v': 1 value read as not known: 'bad' (line 4) is no number"));
  // A coordinate stays an error with its line.
  EXPECT_THAT(error("a.csv", "x,y,z\n1,2,3\n1,b,3\n"), HasSubstr("a.csv:3"));
}

TEST_F(IoTables, WordsForValuesThatAreNotKnown) {
  for (const char* word : {"-", "NULL", "N/A", "NA", "1.#QNAN", "-1.#IND00", "?", "#N/A"}) {
    const PointCloud cloud = read("a.txt", std::string("1 2 3 ") + word + "\n1 2 4 5\n");
    ASSERT_THAT(names_of(cloud), ElementsAre("column4")) << word;
    EXPECT_TRUE(std::isnan(attribute_value(cloud.attributes[0], 0))) << word;
    EXPECT_EQ(attribute_value(cloud.attributes[0], 1), 5);
    EXPECT_THAT(notes_.warnings, IsEmpty());
    EXPECT_THAT(notes_.notes, SizeIs(1));
  }
  EXPECT_TRUE(std::isnan(read("a.txt", "1 2 3\n1 NULL 4\n1 2 5\n").points.at(1).y));
  const PointCloud truth = read("a.csv", "x,y,z,valid\n1,2,3,False\n1,2,4,TRUE\n");
  EXPECT_EQ(truth.attributes.at(0).type, ScalarType::uint8);
  EXPECT_EQ(attribute_value(truth.attributes[0], 1), 1);
  const PointCloud colours = read("a.csv", "x,y,z,color\n1,2,3,#00ff20\n1,2,4,#010203\n");
  EXPECT_THAT(names_of(colours), ElementsAre("red", "green", "blue"));
  EXPECT_EQ(attribute_value(colours.attributes[1], 0), 255);
  EXPECT_EQ(attribute_value(colours.attributes[2], 1), 3);
}

TEST_F(IoTables, CountsAndTitles) {
  EXPECT_THAT(read("a.txt", "2\n1 2 3\n4 5 6\n").points, SizeIs(2));
  EXPECT_THAT(notes_.warnings, IsEmpty());
  EXPECT_THAT(read("a.txt", "3\n1 2 3\n4 5 6\n").points, SizeIs(2));
  EXPECT_THAT(notes_.warnings, ElementsAre(HasSubstr("3 points in its beginning, but 2 follow")));
  const PointCloud blocks = read("a.asc", "Cloud 1\n1 2 3\n4 5 6\nCloud 2\n7 8 9\n");
  EXPECT_THAT(blocks.points, SizeIs(3));
  EXPECT_THAT(blocks.scan_index, ElementsAre(0, 0, 1));
  EXPECT_THAT(read("a.txt", "2\n1 2 3\n4 5 6\n1\n7 8 9\n").scan_index, ElementsAre(0, 0, 1));
  EXPECT_THAT(read("a.txt", "Scanned in May 2021\n1 2 3\n4 5 6\n").scan_index, IsEmpty());
  // Without a title at first a line of words is a fault.
  EXPECT_THAT(error("a.txt", "1 2 3\nCloud 2\n4 5 6\n"), HasSubstr("a.txt:2"));
  // The same header again.
  EXPECT_THAT(read("a.csv", "x,y,z\n1,2,3\nx,y,z\n4,5,6\n").points, SizeIs(2));
  const PointCloud nodes = read("a.node", "2  3  1  0\n  1 1 2 3 7\n  2 4 5 6 8\n# Generated by tetgen\n");
  EXPECT_THAT(nodes.points, ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}));
  EXPECT_THAT(names_of(nodes), ElementsAre("id", "attribute1"));
  const PointCloud msms = read("a.vert",
                               "# MSMS solvent excluded surface\n#vertex #sphere density probe_r\n  2 25 3.00 1.50\n"
                               " 1 2 3 0 0 1 0 1 0 C_A\n 4 5 6 0 1 0 0 2 1 C_A\n");
  EXPECT_THAT(msms.points, ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}));
  EXPECT_THAT(names_of(msms), ElementsAre("nx", "ny", "nz", "face", "sphere", "type"));
}

TEST_F(IoTables, TextOf16Bits) {
  const std::string_view plain = "X\tY\tZ\r\n1.5\t2.5\t3.5\r\n4.5\t5.5\t6.5\r\n";
  for (const bool big : {false, true})
    for (const bool mark : {false, true}) {
      std::string wide = mark ? big ? "\xfe\xff" : "\xff\xfe" : "";
      for (const char c : plain) wide += big ? std::string{'\0', c} : std::string{c, '\0'};
      EXPECT_EQ(read("a.txt", wide).points, two_points) << big << mark;
    }
}

std::string rows_of(std::size_t rows, const std::function<std::string(std::size_t)>& row) {
  std::string text;
  for (std::size_t i = 0; i < rows; ++i) text += row(i) + "\n";
  return text;
}

std::string point_text(std::size_t i) {
  const double t = static_cast<double>(i);
  return std::to_string(512300 + std::cos(t)) + "," + std::to_string(5412300 + std::sin(3 * t)) + "," +
         std::to_string(340 + std::cos(7 * t));
}

TEST_F(IoTables, FirstColumnsThatAreNoCoordinates) {
  const std::string numbered =
      rows_of(50, [](std::size_t i) { return std::to_string(1001 + i) + "," + point_text(i) + ",10"; });
  const std::string counts = error("a.csv", numbered);
  EXPECT_THAT(counts, HasSubstr("column 1 counts 1001, 1002, 1003 ..."));
  EXPECT_THAT(typed(counts), ElementsAre("id", "x", "y", "z"));
  EXPECT_EQ(read("a.csv", numbered, typed(counts)).points[0].z, 341);

  // A code in words behind four numbers leaves one reading.
  const std::string coded =
      rows_of(50, [](std::size_t i) { return std::to_string(1001 + i) + "," + point_text(i) + ",TREE TOP"; });
  EXPECT_EQ(read("a.csv", coded).points[0].z, 341);
  EXPECT_THAT(notes_.warnings,
              ElementsAre(HasSubstr("columns 2, 3 and 4 are read as x, y and z"), HasSubstr("'column5' left out")));

  const std::string named = rows_of(
      50, [](std::size_t i) { return std::string("P").append(std::to_string(i)).append(",").append(point_text(i)); });
  EXPECT_THAT(error("a.csv", named), HasSubstr("column 1 holds words"));
  EXPECT_THAT(typed(error("a.csv", named)), ElementsAre("-", "x", "y", "z"));
  EXPECT_EQ(read("a.csv", named, typed(error("a.csv", named))).points[0].z, 341);

  const std::string grid = rows_of(60, [](std::size_t i) {
    return std::to_string(i / 20) + "," + std::to_string(i % 20) + "," + point_text(i) + ",1,2,3";
  });
  const std::string rows = error("a.xyz", grid);
  EXPECT_THAT(rows, HasSubstr("rows and columns of a grid"));
  EXPECT_THAT(typed(rows), ElementsAre("row", "column", "x", "y", "z", "red", "green", "blue"));
  const PointCloud cloud = read("a.xyz", grid, typed(rows));
  const auto grids = find_grids(cloud);
  ASSERT_TRUE(grids.has_value());
  EXPECT_THAT(grids->sizes, ElementsAre(ScanGrid{20, 3}));
  EXPECT_EQ(grids->cell.at(41), 41u);

  const std::string matrix = rows_of(30, [](std::size_t i) {
    std::string row;
    for (std::size_t k = 0; k < 40; ++k)
      row.append(k > 0 ? "," : "")
          .append(std::to_string(std::sin(0.2 * static_cast<double>(i)) + std::cos(0.15 * static_cast<double>(k))));
    return row;
  });
  EXPECT_THAT(error("a.csv", matrix), HasSubstr("a matrix of 40 x 30 heights is no list of points"));
  EXPECT_THAT(read("a.csv", matrix, {"x", "y", "z"}).points, SizeIs(30));
  // Typing the lines that the message names.
  EXPECT_THAT(read("a.csv", "ncols 40\nnrows 30\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + matrix).points,
              SizeIs(1200));
}

// What looks like the above and is none of it.
TEST_F(IoTables, CoordinatesThatLookLikeNumbersOfPoints) {
  const auto number = [](double v) { return std::to_string(v); };
  // Heights on whole coordinates with unit normals; a scan line; a list with many columns that are no heights.
  const std::string heights = rows_of(60, [&](std::size_t i) {
    const double a = 0.1 * static_cast<double>(i);
    return std::to_string(i / 10) + " " + std::to_string(i % 10) + " " + number(std::sin(a)) + " " +
           number(0.6 * std::cos(a)) + " " + number(0.6 * std::sin(a)) + " 0.8";
  });
  EXPECT_THAT(read("a.xyz", heights).points, SizeIs(60));
  EXPECT_THAT(
      read("a.xyz", rows_of(60, [&](std::size_t i) { return std::to_string(i) + " 0.5 " + number(std::sin(i)); }))
          .points,
      SizeIs(60));
  const std::string wide = rows_of(60, [&](std::size_t i) {
    const double a = 0.1 * static_cast<double>(i);
    return number(std::cos(a)) + " " + number(std::sin(a)) + " " + number(a) + " 12 14 16 0.7 0.1 0.2 0.3 0.4";
  });
  EXPECT_THAT(read("a.xyz", wide).points, SizeIs(60));
}

TEST_F(IoTables, HeadersWithoutCoordinatesSayWhatToType) {
  const std::string text = "Name,u,v,w\nP1,1,2,3\nP2,4,5,6\n";
  const std::string message = error("a.csv", text);
  EXPECT_THAT(message, HasSubstr("the header names no columns x, y and z: 'Name', 'u', 'v', 'w'"));
  EXPECT_THAT(typed(message), ElementsAre("-", "x", "y", "z"));
  EXPECT_THAT(read("a.csv", text, typed(message)).points, ElementsAre(Vec3{1, 2, 3}, Vec3{4, 5, 6}));
  const std::string degrees = "id,Longitude,Latitude,height,q\n1,8.4,49,345,1\n2,8.5,49.5,346,1\n";
  EXPECT_THAT(error("a.csv", degrees), HasSubstr("degrees are no lengths"));
  EXPECT_THAT(error("a.csv", "x y z\n1 2 3 4\n5 6 7 8\n"),
              HasSubstr("the header names 3 columns, but the rows have 4"));
}

TEST_F(IoTables, ColumnsAlwaysWork) {
  // Whatever stands before, between and beside them.
  for (const char* text : {"1001,1.5,2.5,3.5,TREE TOP\n1002,4.5,5.5,6.5,WALL\n",
                           "Title of all\nid,a,b,c,d\nP1,1.5,2.5,3.5,x\nP2,4.5,5.5,6.5,y\n",
                           "P1;1,5;2,5;3,5;\nP2;4,5;5,5;6,5;w\n", "2\na\t1.5\t2.5\t3.5\tb c\nd\t4.5\t5.5\t6.5\te f\n"})
    EXPECT_EQ(read("a.txt", text, {"-", "x", "y", "z", "-"}).points, two_points) << text;
}

TEST_F(IoTables, GridsOfEsri) {
  const std::string header = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n";
  const PointCloud cloud = read("a.asc", header + "1 2 3\n4 -9999 6\n");
  EXPECT_THAT(cloud.points, ElementsAre(Vec3{105, 215, 1}, Vec3{115, 215, 2}, Vec3{125, 215, 3}, Vec3{105, 205, 4},
                                        Vec3{125, 205, 6}));
  const auto grids = find_grids(cloud);
  ASSERT_TRUE(grids.has_value());
  EXPECT_THAT(grids->sizes, ElementsAre(ScanGrid{3, 2}));
  EXPECT_THAT(grids->cell, ElementsAre(0, 1, 2, 3, 5));
  EXPECT_THAT(notes_.notes, ElementsAre("1 cell without data left out", HasSubstr("ESRI grid of 3 x 2")));
  // The middles of the cells, upper case, rows of any length, another extension.
  const PointCloud middles =
      read("a.grd", "NCOLS 3\nNROWS 2\nXLLCENTER 100\nYLLCENTER 200\nCELLSIZE 10\n1 2\n3 4 5 6\n");
  EXPECT_EQ(middles.points.at(5), (Vec3{120, 200, 6}));
  EXPECT_THAT(error("a.asc", header + "1 2 3\n4 5\n"), HasSubstr("but only 5 follow"));
  EXPECT_THAT(error("a.asc", "ncols 3\nnrows 2\n1 2 3\n4 5 6\n"), HasSubstr("not complete"));
  EXPECT_THAT(error("a.asc", "ncols 3000000\nnrows 3000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n"),
              HasSubstr("too short"));
}

TEST_F(IoTables, ForeignFilesAreNamed) {
  EXPECT_THAT(error("a.ply", "\x1f\x8b\x08"), HasSubstr("this is a gzip archive ("));
  EXPECT_THAT(error("a.xyz", "%PDF-1.4\n"), HasSubstr("a PDF document"));
  EXPECT_THAT(error("a.xlsx", std::string("PK\3\4") + std::string(26, '\1') + "[Content_Types].xml"),
              HasSubstr("save the table as CSV"));
  EXPECT_THAT(error("a.ply", "version https://git-lfs.github.com/spec/v1\n"), HasSubstr("git lfs pull"));
  EXPECT_THAT(error("a.csv", "<!DOCTYPE html>\n<html>"), HasSubstr("a web page"));
  EXPECT_THAT(error("a.tif", std::string("II*\0", 4)), HasSubstr("gdal_translate"));
}

} // namespace
} // namespace eigencrust
