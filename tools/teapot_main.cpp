// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// eigencrust-teapot: Bézier patches as a mesh.
#include <CLI/CLI.hpp>
#include <iostream>

#include <eigencrust/error.h>
#include <eigencrust/io.h>

#include "bezier_patches.h"
#include "command.h"

namespace {

using namespace eigencrust;
using namespace eigencrust::tools;

constexpr const char* about =
    "Turns a file of bicubic Bézier patches into triangles, to measure distances against.\n"
    "\n"
    "Example:\n"
    "  eigencrust-teapot -o teapot.ply --subdivisions 32";

} // namespace

int main(int argc, char** argv) {
  std::string input = "examples/teapot_patches.txt", output;
  std::uint32_t subdivisions = 32;
  unsigned threads = 0;
  bool outer = false;
  CLI::App app(about, "eigencrust-teapot");
  app.add_option("PATCHES", input, "file of patches")->capture_default_str();
  app.add_option("-o,--output", output, "mesh to write (ply, obj, off, stl, glb, 3mf)")->required();
  app.add_option("--subdivisions", subdivisions, "squares along each side of a patch, 1 to 1024")
      ->capture_default_str();
  app.add_flag("--outer-only", outer, "leave out what lies inside other parts and cannot be seen from outside");
  app.add_option("--threads", threads, "0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  return run_command(app, argc, argv, [&] {
    if (!can_write_mesh(output))
      throw Error(ErrorKind::usage, output, "no mesh format of that extension can be written", "use .ply");
    TriangleMesh mesh = tessellate(read_bezier_patches(input), subdivisions);
    if (outer) mesh = outer_part(mesh, 256, 0.02, threads);
    WriteOptions write;
    write.coordinates = CoordinateType::float64;
    write_mesh(output, mesh, write);
  });
}
