// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Meshes whose every figure is known, for tests. Closed ones are oriented outward.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust::shapes {

/// Vertices and triangles of `next` after those of `mesh`, not joined. Attributes are not kept.
inline TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& next) {
  const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), next.vertices.begin(), next.vertices.end());
  for (const auto& t : next.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return mesh;
}

/// The same surface turned inside out.
inline TriangleMesh flipped(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// factor · p + shift for every vertex p.
inline TriangleMesh moved(TriangleMesh mesh, const Vec3& shift, double factor = 1) {
  for (Vec3& p : mesh.vertices) p = factor * p + shift;
  return mesh;
}

/// Three vertices of its own for every triangle, as an STL file has them.
inline TriangleMesh unmerged(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// The corner tetrahedron of the unit cube: volume 1/6, area 3/2 + sqrt(3)/2.
inline TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, {}, {}};
}

/// Axis-aligned box of 8 vertices and 12 triangles.
inline TriangleMesh box(const Vec3& lo, const Vec3& hi) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i)
    mesh.vertices.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Sphere from the icosahedron: 20 · 4^levels triangles, vertices on the sphere.
inline TriangleMesh icosphere(unsigned levels, double radius = 1, const Vec3& centre = {}) {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (unsigned level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto split = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, fresh] =
          middle.try_emplace(std::minmax({a, b}), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (fresh) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return place->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = split(a, b), bc = split(b, c), ca = split(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& p : mesh.vertices) p = (radius / norm(p)) * p + centre;
  return mesh;
}

/// Two spheres around one centre, the inner one facing inward: a ball with a cavity.
inline TriangleMesh hollow_sphere(unsigned levels, double outer, double inner) {
  return joined(icosphere(levels, outer), flipped(icosphere(levels, inner)));
}

/// Torus around the z axis: genus 1, volume close to 2 π² R r², area close to 4 π² R r.
inline TriangleMesh torus(double major, double minor, unsigned around, unsigned across) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < around; ++i)
    for (unsigned j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double ring = major + minor * std::cos(v);
      mesh.vertices.push_back({ring * std::cos(u), ring * std::sin(u), minor * std::sin(v)});
    }
  for (unsigned i = 0; i < around; ++i)
    for (unsigned j = 0; j < across; ++j) {
      const unsigned i1 = (i + 1) % around, j1 = (j + 1) % across;
      const std::uint32_t a = i * across + j, b = i1 * across + j, c = i1 * across + j1, d = i * across + j1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

/// Flat square [0, nx] × [0, ny] at z = 0 facing +z: open, one boundary loop.
inline TriangleMesh grid(unsigned nx, unsigned ny) {
  TriangleMesh mesh;
  for (unsigned j = 0; j <= ny; ++j)
    for (unsigned i = 0; i <= nx; ++i) mesh.vertices.push_back({double(i), double(j), 0});
  for (unsigned j = 0; j < ny; ++j)
    for (unsigned i = 0; i < nx; ++i) {
      const std::uint32_t a = j * (nx + 1) + i, b = a + 1, d = a + nx + 1, c = d + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

/// Strip of `segments` squares whose ends are joined after half a turn: one side, one boundary loop.
inline TriangleMesh moebius_strip(unsigned segments, double width = 0.4) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < segments; ++i) {
    const double u = 2 * std::numbers::pi * i / segments;
    for (const double side : {-0.5, 0.5}) {
      const double ring = 1 + side * width * std::cos(u / 2);
      mesh.vertices.push_back({ring * std::cos(u), ring * std::sin(u), side * width * std::sin(u / 2)});
    }
  }
  for (unsigned i = 0; i < segments; ++i) {
    const bool last = i + 1 == segments;
    const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
  }
  return mesh;
}

/// Two tetrahedra that have exactly the edge 0-1 in common: four triangles meet there.
inline TriangleMesh two_tetrahedra_sharing_an_edge() {
  return {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {0.5, 0.5, 0.5}, {-1, 0, 0.5}, {-0.5, -0.5, 0.5}},
          {{0, 3, 2}, {0, 1, 3}, {0, 2, 1}, {1, 2, 3}, {0, 5, 4}, {0, 1, 5}, {0, 4, 1}, {1, 4, 5}},
          {},
          {}};
}

/// Two tetrahedra that have exactly vertex 0 in common (a bow tie).
inline TriangleMesh two_tetrahedra_sharing_a_vertex() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}},
          {},
          {}};
}

} // namespace eigencrust::shapes
