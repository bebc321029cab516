// SPDX-License-Identifier: GPL-3.0-or-later
// Looks into files for the command line tests:
//   probe json FILE POINTER   prints the value at /a/b/0; fails when the file is no JSON or has no such value
//   probe lines FILE          every line is a JSON object; prints how many there are
//   probe rows FILE           vertices of a mesh, one per line: x y z and the attributes under a line of names
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include <eigencrust/io.h>

namespace {

using nlohmann::json;

int print_value(const std::string& path, const std::string& pointer) {
  std::ifstream file(path);
  const json value = json::parse(file).at(json::json_pointer(pointer));
  std::cout << (value.is_string() ? value.get<std::string>() : value.dump()) << "\n";
  return 0;
}

int check_lines(const std::string& path) {
  std::ifstream file(path);
  int count = 0;
  for (std::string line; std::getline(file, line); ++count)
    if (!json::parse(line).is_object()) throw std::runtime_error("no object: " + line);
  std::cout << count << "\n";
  return 0;
}

int print_rows(const std::string& path) {
  const eigencrust::TriangleMesh mesh = eigencrust::read_mesh(path);
  std::printf("x y z");
  for (const auto& attribute : mesh.vertex_attributes) std::printf(" %s", attribute.name.c_str());
  std::printf("\n");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const eigencrust::Vec3& p = mesh.vertices[i];
    std::printf("%.9g %.9g %.9g", p.x, p.y, p.z);
    for (const auto& attribute : mesh.vertex_attributes)
      std::printf(" %.17g", eigencrust::attribute_value(attribute, i));
    std::printf("\n");
  }
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  const std::string task = argc > 2 ? argv[1] : "";
  try {
    if (task == "json" && argc == 4) return print_value(argv[2], argv[3]);
    if (task == "lines") return check_lines(argv[2]);
    if (task == "rows") return print_rows(argv[2]);
    std::cerr << "usage: probe json FILE POINTER | lines FILE | rows FILE\n";
  } catch (const std::exception& error) {
    std::cerr << "probe: " << argv[2] << ": " << error.what() << "\n";
  }
  return 1;
}
