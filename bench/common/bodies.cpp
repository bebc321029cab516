// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <eigencrust/validate.h>

#include "shapes.h"

namespace eigencrust::bench {
namespace {

constexpr double pi = std::numbers::pi;

double volume_of(const TriangleMesh& mesh) { return validate(mesh, {.self_intersections = false}).volume; }

std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

/// Flat rectangle o + [0,1] a + [0,1] b in na × nb squares, facing along a × b.
TriangleMesh rectangle(const Vec3& o, const Vec3& a, const Vec3& b, unsigned na, unsigned nb) {
  TriangleMesh mesh = shapes::grid(na, nb);
  for (Vec3& p : mesh.vertices) p = o + (p.x / na) * a + (p.y / nb) * b;
  return mesh;
}

/// The box [-half, half] in squares of about `cell`.
TriangleMesh fine_box(const Vec3& half, double cell) {
  const auto squares = [cell](double length) {
    return std::max(1u, static_cast<unsigned>(std::lround(length / cell)));
  };
  const Vec3 x{2 * half.x, 0, 0}, y{0, 2 * half.y, 0}, z{0, 0, 2 * half.z};
  const Vec3 low = -1.0 * half;
  const unsigned nx = squares(x.x), ny = squares(y.y), nz = squares(z.z);
  TriangleMesh mesh = shapes::joined(rectangle(low, y, x, ny, nx), rectangle(low + z, x, y, nx, ny));
  mesh = shapes::joined(std::move(mesh), rectangle(low, z, y, nz, ny));
  mesh = shapes::joined(std::move(mesh), rectangle(low + x, y, z, ny, nz));
  mesh = shapes::joined(std::move(mesh), rectangle(low, x, z, nx, nz));
  return shapes::joined(std::move(mesh), rectangle(low + y, z, x, nz, nx));
}

/// Without the triangles whose middle is inside another body, and the vertices that then belong to none.
TriangleMesh without(const TriangleMesh& mesh, const std::function<bool(const Vec3&)>& inside_other) {
  TriangleMesh rest;
  std::vector<std::uint32_t> number(mesh.vertices.size(), SampleIndex::none);
  for (const auto& t : mesh.triangles) {
    if (inside_other((1.0 / 3) * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]))) continue;
    for (const std::uint32_t v : t) {
      if (number[v] != SampleIndex::none) continue;
      number[v] = static_cast<std::uint32_t>(rest.vertices.size());
      rest.vertices.push_back(mesh.vertices[v]);
    }
    rest.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  return rest;
}

} // namespace

double bumpy_radius(const Vec3& u) {
  return 1 + 0.1 / 3 * (std::sin(6 * u.x + 1) + std::sin(5 * u.y + 2) + std::sin(7 * u.z));
}

Vec3 on_bumpy_sphere(const Vec3& p, const Vec3& centre) {
  const Vec3 u = (1 / norm(p - centre)) * (p - centre);
  return centre + bumpy_radius(u) * u;
}

Truth bumpy_sphere(const Vec3& centre, unsigned levels) {
  TriangleMesh mesh = shapes::icosphere(levels, 1, centre);
  for (Vec3& p : mesh.vertices) p = on_bumpy_sphere(p, centre);
  const double volume = volume_of(mesh);
  const auto inside = [centre](const Vec3& p) {
    const double r = distance(p, centre);
    return r == 0 || r < bumpy_radius((1 / r) * (p - centre));
  };
  return {shared(std::move(mesh)), volume, 1, 0, inside};
}

Truth torus(double major, double minor, const Vec3& centre) {
  const auto inside = [=](const Vec3& p) {
    const Vec3 q = p - centre;
    return std::hypot(std::hypot(q.x, q.y) - major, q.z) < minor;
  };
  return {shared(shapes::moved(shapes::torus(major, minor, 768, 384), centre)), 2 * pi * pi * major * minor * minor, 1,
          1, inside};
}

Truth nested_spheres(double outer, double inner) {
  const auto inside = [=](const Vec3& p) { return norm(p) < outer && norm(p) > inner; };
  const double volume = 4 * pi / 3 * (outer * outer * outer - inner * inner * inner);
  return {shared(shapes::hollow_sphere(7, outer, inner)), volume, 2, 0, inside};
}

Truth ball_with_sheet(double thickness) {
  const double h = thickness;
  const Vec3 half{1.5, 0.5 * h, 1.5};
  const auto in_ball = [](const Vec3& p) { return norm(p) < 1; };
  const auto in_sheet = [half](const Vec3& p) {
    return std::abs(p.x) < half.x && std::abs(p.y) < half.y && std::abs(p.z) < half.z;
  };
  const double cell = 0.01; // of the order of the sphere's edges
  TriangleMesh mesh =
      shapes::joined(without(shapes::icosphere(7), in_sheet), without(fine_box(half, std::min(cell, h / 4)), in_ball));
  // Ball and plate have the slab |y| < h/2 of the ball in common: ∫ π (1 - y²) dy.
  const double volume = 4 * pi / 3 + 9 * h - pi * (h - h * h * h / 12);
  return {shared(std::move(mesh)), volume, 1, 0, [=](const Vec3& p) { return in_ball(p) || in_sheet(p); }};
}

Truth side_by_side(const Truth& a, const Truth& b) {
  return {shared(shapes::joined(*a.mesh, *b.mesh)), a.volume + b.volume, a.components + b.components, a.genus + b.genus,
          [in_a = a.inside, in_b = b.inside](const Vec3& p) { return in_a(p) || in_b(p); }};
}

Truth truth_of(TriangleMesh mesh) {
  const MeshSummary summary = validate(mesh, {.self_intersections = false});
  if (summary.volume < 0) mesh = shapes::flipped(std::move(mesh));
  return {shared(std::move(mesh)),
          std::abs(summary.volume),
          static_cast<std::uint32_t>(summary.components),
          summary.genus,
          {}};
}

} // namespace eigencrust::bench
