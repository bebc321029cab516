// SPDX-License-Identifier: GPL-3.0-or-later
// What a mesh is good for, in words.
#include <array>
#include <cstdio>
#include <vector>

#include <eigencrust/measures.h>

namespace eigencrust {
namespace {

std::string count(std::uint64_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// What keeps a mesh from being the surface of a body.
std::vector<std::string> obstacles(const MeshSummary& mesh) {
  std::vector<std::string> found;
  const auto add = [&](std::uint64_t n, const char* one, const char* many) {
    if (n > 0) found.push_back(count(n, one, many));
  };
  if (mesh.components == 0) found.emplace_back("no triangle");
  add(mesh.boundary_edges, "boundary edge", "boundary edges");
  add(mesh.nonmanifold_edges, "non-manifold edge", "non-manifold edges");
  add(mesh.nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices");
  add(mesh.inconsistent_edges, "inconsistent edge", "inconsistent edges");
  if (mesh.self_intersections > 0)
    found.push_back((mesh.all_self_intersections ? "" : "at least ") +
                    count(static_cast<std::uint64_t>(mesh.self_intersections), "crossing", "crossings"));
  if (found.empty() && !(mesh.volume > 0)) found.emplace_back(mesh.volume < 0 ? "triangles look inward" : "no volume");
  return found;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

} // namespace

std::string length_in_words(double length, double metres) {
  std::array<char, 48> text{};
  if (!(metres > 0)) {
    std::snprintf(text.data(), text.size(), "%.4g", length);
    return text.data();
  }
  const double value = length * metres;
  constexpr double least_in_metres = 1, millimetres = 1e3;
  if (value >= least_in_metres)
    std::snprintf(text.data(), text.size(), "%.4g m", value);
  else
    std::snprintf(text.data(), text.size(), "%.4g mm", millimetres * value);
  return text.data();
}

std::string printability(const MeshSummary& mesh, const MeshMeasures& measures, double metres) {
  if (const auto found = obstacles(mesh); !found.empty()) return "not printable: " + joined(found);
  std::vector<std::string> words = {"closed", "manifold"};
  words.emplace_back(mesh.self_intersections < 0 ? "crossings not looked for" : "no crossings");
  if (mesh.degenerate_triangles > 0)
    words.push_back(count(mesh.degenerate_triangles, "degenerate triangle", "degenerate triangles"));
  if (measures.thinnest_wall) words.push_back("thinnest wall " + length_in_words(*measures.thinnest_wall, metres));
  return "printable: " + joined(words);
}

} // namespace eigencrust
