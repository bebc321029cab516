// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include "counter_random.h"
#include "sampling.h"
#include "shapes.h"

namespace eigencrust::bench {
namespace {

constexpr double pi = std::numbers::pi;
constexpr unsigned fine = 720; // corners of a circle in the mesh of the truth: 0.001 % of its area are missing

unsigned steps(double length, double spacing) {
  return std::max(1u, static_cast<unsigned>(std::lround(length / spacing)));
}

/// Rings that follow each other, all of as many points or a single one (on the axis), joined by triangles that
/// face outward where the rings run counter-clockwise seen from the end.
TriangleMesh loft(const std::vector<std::vector<Vec3>>& rings, bool closed) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> first;
  for (const auto& ring : rings) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.insert(mesh.vertices.end(), ring.begin(), ring.end());
  }
  for (std::size_t i = 0; i + (closed ? 0 : 1) < rings.size(); ++i) {
    const std::size_t next = (i + 1) % rings.size();
    const auto na = static_cast<std::uint32_t>(rings[i].size()), nb = static_cast<std::uint32_t>(rings[next].size());
    for (std::uint32_t j = 0; j < std::max(na, nb); ++j) {
      const std::uint32_t a = first[i] + j % na, b = first[i] + (j + 1) % na;
      const std::uint32_t c = first[next] + j % nb, d = first[next] + (j + 1) % nb;
      if (a != b) mesh.triangles.push_back({a, b, d});
      if (c != d) mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

/// Closed mesh with the volume and area of the formula.
Truth formula_truth(TriangleMesh mesh, double volume, double area) {
  Truth truth = truth_of(std::move(mesh));
  truth.volume = volume;
  truth.area = area;
  return truth;
}

/// Adds a ring of samples about `spacing` apart; `sharp`: they follow each other along an edge.
void add_ring(Part& part, double radius, double spacing, bool turned, bool sharp,
              const std::function<Vec3(double cosine, double sine)>& place) {
  const unsigned n = radius > 0 ? std::max(6u, steps(2 * pi * radius, spacing)) : 1;
  const auto first = static_cast<std::uint32_t>(part.samples.size());
  for (unsigned j = 0; j < n; ++j) {
    const double u = 2 * pi * (j + (turned ? 0.5 : 0)) / n;
    part.samples.push_back(place(radius * std::cos(u), radius * std::sin(u)));
    if (sharp && n > 1) part.sharp_edges.push_back({first + j, first + (j + 1) % n});
  }
}

/// Does the profile turn by more than 20° at its point i?
bool is_corner(std::span<const ProfilePoint> profile, std::size_t i) {
  const std::size_t n = profile.size();
  const ProfilePoint a = profile[(i + n - 1) % n], b = profile[i], c = profile[(i + 1) % n];
  const double in = std::atan2(b.height - a.height, b.radius - a.radius);
  const double out = std::atan2(c.height - b.height, c.radius - b.radius);
  return std::cos(out - in) < std::cos(pi / 9);
}

std::vector<Vec3> circle(double radius, double height) {
  if (radius == 0) return {{0, 0, height}};
  std::vector<Vec3> ring;
  for (unsigned j = 0; j < fine; ++j)
    ring.push_back({radius * std::cos(2 * pi * j / fine), radius * std::sin(2 * pi * j / fine), height});
  return ring;
}

/// The lattice of block_part: coordinates along each axis, and which cells are solid.
class Lattice {
 public:
  Lattice(std::span<const Block> blocks, double spacing) {
    for (int k = 0; k < 3; ++k) {
      std::vector<double> cuts;
      for (const Block& b : blocks) cuts.insert(cuts.end(), {axis(b.low, k), axis(b.high, k)});
      std::sort(cuts.begin(), cuts.end());
      cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const unsigned n = steps(cuts[i + 1] - cuts[i], spacing);
        for (unsigned j = 0; j < n; ++j) lines_[k].push_back(cuts[i] + (cuts[i + 1] - cuts[i]) * j / n);
      }
      lines_[k].push_back(cuts.back());
    }
    solid_.assign(cells(0) * cells(1) * cells(2), false);
    for (std::size_t i = 0; i < cells(0); ++i)
      for (std::size_t j = 0; j < cells(1); ++j)
        for (std::size_t l = 0; l < cells(2); ++l) solid_[number(i, j, l)] = is_solid(blocks, middle(i, j, l));
  }

  [[nodiscard]] std::size_t cells(int k) const { return lines_[k].size() - 1; }
  [[nodiscard]] bool solid(std::array<std::size_t, 3> c) const {
    for (int k = 0; k < 3; ++k)
      if (c[k] >= cells(k)) return false; // also the one before the first
    return solid_[number(c[0], c[1], c[2])];
  }
  [[nodiscard]] Vec3 corner(std::array<std::size_t, 3> c) const {
    return {lines_[0][c[0]], lines_[1][c[1]], lines_[2][c[2]]};
  }

 private:
  static double axis(const Vec3& p, int k) { return k == 0 ? p.x : k == 1 ? p.y : p.z; }
  [[nodiscard]] std::size_t number(std::size_t i, std::size_t j, std::size_t l) const {
    return (i * cells(1) + j) * cells(2) + l;
  }
  [[nodiscard]] Vec3 middle(std::size_t i, std::size_t j, std::size_t l) const {
    return 0.5 * (corner({i, j, l}) + corner({i + 1, j + 1, l + 1}));
  }
  static bool is_solid(std::span<const Block> blocks, const Vec3& p) {
    bool solid = false;
    for (const Block& b : blocks)
      if (b.low.x < p.x && p.x < b.high.x && b.low.y < p.y && p.y < b.high.y && b.low.z < p.z && p.z < b.high.z)
        solid = b.solid;
    return solid;
  }

  std::array<std::vector<double>, 3> lines_;
  std::vector<bool> solid_;
};

/// Collects the squares between solid and empty cells.
class BlockSurface {
 public:
  explicit BlockSurface(const Lattice& lattice) : lattice_(lattice) {
    for (int k = 0; k < 3; ++k)
      for (std::size_t i = 0; i <= lattice.cells(0); ++i)
        for (std::size_t j = 0; j <= lattice.cells(1); ++j)
          for (std::size_t l = 0; l <= lattice.cells(2); ++l) look({i, j, l}, k);
  }

  /// Lattice edges whose two squares do not lie in one plane.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> sharp_edges() const {
    std::vector<std::array<std::uint32_t, 2>> sharp;
    for (const auto& [edge, directions] : edges_)
      if (directions.front() != directions.back()) sharp.push_back(edge);
    return sharp;
  }

  TriangleMesh mesh;
  double area = 0;

 private:
  using Cell = std::array<std::size_t, 3>;

  /// The square across direction k between the cell c and the one before it.
  void look(const Cell& c, int k) {
    Cell before = c;
    --before[k]; // of 0: out of range, which is not solid
    const bool here = lattice_.solid(c), there = lattice_.solid(before);
    if (here == there) return;
    Cell b = c, d = c;
    ++b[(k + 1) % 3];
    ++d[(k + 2) % 3];
    Cell opposite = b;
    ++opposite[(k + 2) % 3];
    std::array<std::uint32_t, 4> square{vertex(c), vertex(b), vertex(opposite), vertex(d)}; // faces along +k
    if (here) std::swap(square[1], square[3]);
    mesh.triangles.push_back({square[0], square[1], square[2]});
    mesh.triangles.push_back({square[0], square[2], square[3]});
    area += distance(lattice_.corner(c), lattice_.corner(b)) * distance(lattice_.corner(c), lattice_.corner(d));
    for (int e = 0; e < 4; ++e) {
      const auto [low, high] = std::minmax(square[e], square[(e + 1) % 4]);
      edges_[{low, high}].push_back(k);
    }
  }

  std::uint32_t vertex(const Cell& c) {
    const auto [place, fresh] = numbers_.try_emplace(c, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.push_back(lattice_.corner(c));
    return place->second;
  }

  const Lattice& lattice_;
  std::map<Cell, std::uint32_t> numbers_;
  std::map<std::array<std::uint32_t, 2>, std::vector<int>> edges_;
};

/// Point of the plate's outline in the direction u from its middle.
Vec3 on_outline(const Vec3& size, double u) {
  const double c = std::cos(u), s = std::sin(u);
  const double t =
      std::min(0.5 * size.x / std::max(std::fabs(c), 1e-300), 0.5 * size.y / std::max(std::fabs(s), 1e-300));
  return {0.5 * size.x + t * c, 0.5 * size.y + t * s, 0};
}

Truth holed_plate_truth(const Vec3& size, double hole) {
  std::vector<double> turns;
  for (unsigned j = 0; j < fine; ++j) turns.push_back(2 * pi * j / fine - pi);
  const double corner = std::atan2(size.y, size.x);
  turns.insert(turns.end(), {corner, pi - corner, -corner, corner - pi});
  std::sort(turns.begin(), turns.end());
  turns.erase(std::unique(turns.begin(), turns.end()), turns.end());
  std::array<std::vector<Vec3>, 4> rings; // bottom of the hole, bottom outline, top outline, top of the hole
  for (const double u : turns) {
    const Vec3 inner{0.5 * size.x + hole * std::cos(u), 0.5 * size.y + hole * std::sin(u), 0};
    const Vec3 outer = on_outline(size, u), up{0, 0, size.z};
    rings[0].push_back(inner);
    rings[1].push_back(outer);
    rings[2].push_back(outer + up);
    rings[3].push_back(inner + up);
  }
  const double flat = size.x * size.y - pi * hole * hole;
  return formula_truth(loft({rings.begin(), rings.end()}, true), flat * size.z,
                       2 * flat + (2 * (size.x + size.y) + 2 * pi * hole) * size.z);
}

} // namespace

Part block_part(std::span<const Block> blocks, double spacing) {
  const Lattice lattice(blocks, spacing);
  BlockSurface surface(lattice);
  Part part;
  part.samples = surface.mesh.vertices;
  part.sharp_edges = surface.sharp_edges();
  part.truth = truth_of(std::move(surface.mesh));
  part.truth.area = surface.area;
  return part;
}

Part open_bin(const Vec3& size, double wall, double spacing) {
  const std::array<Block, 2> blocks{Block{{0, 0, 0}, size},
                                    Block{{wall, wall, wall}, {size.x - wall, size.y - wall, size.z}, false}};
  return block_part(blocks, spacing);
}

Part turned_part(std::span<const ProfilePoint> profile, double spacing) {
  const bool closed = profile.front().radius > 0;
  const std::size_t segments = profile.size() - (closed ? 0 : 1);
  Part part;
  double volume = 0, area = 0;
  bool turned = false;
  std::vector<std::vector<Vec3>> rings;
  for (const ProfilePoint& p : profile) rings.push_back(circle(p.radius, p.height));
  for (std::size_t i = 0; i < segments; ++i) {
    const ProfilePoint a = profile[i], b = profile[(i + 1) % profile.size()];
    const double length = std::hypot(b.radius - a.radius, b.height - a.height);
    volume += pi / 3 * (b.height - a.height) * (a.radius * a.radius + a.radius * b.radius + b.radius * b.radius);
    area += pi * (a.radius + b.radius) * length;
    const unsigned n = steps(length, spacing);
    const bool last = !closed && i + 1 == segments;
    for (unsigned j = 0; j < n + (last ? 1 : 0); ++j, turned = !turned) {
      const double t = static_cast<double>(j) / n, z = a.height + t * (b.height - a.height);
      add_ring(part, a.radius + t * (b.radius - a.radius), spacing, turned, j == 0 && is_corner(profile, i),
               [z](double x, double y) {
                 return Vec3{x, y, z};
               });
    }
  }
  part.truth = formula_truth(loft(rings, closed), volume, area);
  return part;
}

Part cup(double radius, double height, double wall, double spacing) {
  const std::array<ProfilePoint, 6> profile{
      {{0, 0}, {radius, 0}, {radius, height}, {radius - wall, height}, {radius - wall, wall}, {0, wall}}};
  return turned_part(profile, spacing);
}

Part pipe_bend(double bend, double outer, double inner, double spacing) {
  const double angle = pi / 2;
  const auto ring_at = [bend](double u) { // of the bend
    return [=](double x, double y) { return Vec3{(bend + x) * std::cos(u), (bend + x) * std::sin(u), y}; };
  };
  Part part;
  const unsigned along = steps(bend * angle, spacing), across = steps(outer - inner, spacing);
  for (unsigned i = 0; i <= along; ++i)
    for (const double radius : {outer, inner})
      add_ring(part, radius, spacing, i % 2 == 1, i == 0 || i == along, ring_at(angle * i / along));
  for (const double end : {0.0, angle})
    for (unsigned k = 1; k < across; ++k)
      add_ring(part, inner + (outer - inner) * k / across, spacing, k % 2 == 1, false, ring_at(end));
  std::vector<std::vector<Vec3>> rings;
  constexpr unsigned pieces = 90; // a degree each
  for (const bool out : {true, false})
    for (unsigned i = 0; i <= pieces; ++i) {
      std::vector<Vec3> ring;
      for (const Vec3& p : circle(out ? outer : inner, 0))
        ring.push_back(ring_at(angle * (out ? i : pieces - i) / pieces)(p.x, p.y));
      rings.push_back(std::move(ring));
    }
  // Pappus: what the centre of gravity travels times what is swept.
  const double section = pi * (outer * outer - inner * inner);
  part.truth =
      formula_truth(loft(rings, true), section * bend * angle, 2 * pi * (outer + inner) * bend * angle + 2 * section);
  return part;
}

Part holed_plate(const Vec3& size, double hole, double spacing, bool rims) {
  const unsigned nx = steps(size.x, spacing), ny = steps(size.y, spacing), nz = steps(size.z, spacing);
  const double clear = hole + (rims ? 0.6 * spacing : 0); // samples of the rim take the place of the nearest
  const Vec3 middle{0.5 * size.x, 0.5 * size.y, 0};
  Part part;
  const auto on = [&](unsigned i, unsigned j, unsigned k) {
    return Vec3{size.x * i / nx, size.y * j / ny, size.z * k / nz};
  };
  std::map<std::array<unsigned, 3>, std::uint32_t> row;
  for (unsigned k = 0; k <= nz; ++k)
    for (unsigned i = 0; i <= nx; ++i)
      for (unsigned j = 0; j <= ny; ++j) {
        const bool flat = k == 0 || k == nz, rim = i == 0 || j == 0 || i == nx || j == ny;
        const Vec3 p = on(i, j, k);
        if (!(flat || (rims && rim)) || norm(Vec3{p.x, p.y, 0} - middle) < clear) continue;
        row[{i, j, k}] = static_cast<std::uint32_t>(part.samples.size());
        part.samples.push_back(p);
      }
  if (rims) {
    for (const auto& [c, from] : row) // along the twelve edges
      for (int k = 0; k < 3; ++k) {
        std::array<unsigned, 3> next = c;
        ++next[k];
        const std::array<unsigned, 3> count{nx, ny, nz};
        const auto at_end = [&](int axis) { return c[axis] == 0 || c[axis] == count[axis]; };
        const auto to = row.find(next);
        if (to != row.end() && at_end((k + 1) % 3) && at_end((k + 2) % 3))
          part.sharp_edges.push_back({from, to->second});
      }
    for (unsigned k = 0; k <= nz; ++k)
      add_ring(part, hole, spacing, k % 2 == 1, k == 0 || k == nz, [&](double x, double y) {
        return middle + Vec3{x, y, size.z * k / nz};
      });
  }
  part.truth = holed_plate_truth(size, hole);
  return part;
}

Part closed_tube(const std::function<Vec3(double)>& curve, double radius, double spacing) {
  constexpr unsigned pieces = 1440;
  const double step = 2 * pi / pieces;
  struct Frame {
    Vec3 place, normal, binormal;
  };
  const auto frame_at = [&](double t) { // Frenet's
    const Vec3 before = curve(t - step), here = curve(t), after = curve(t + step);
    const Vec3 tangent = after - before, bend = after + before - 2 * here;
    const Vec3 b = cross(tangent, bend), n = cross(b, tangent);
    return Frame{here, (1 / norm(n)) * n, (1 / norm(b)) * b};
  };
  const auto ring_in = [](const Frame& f) {
    return [f](double x, double y) { return f.place + x * f.normal + y * f.binormal; };
  };
  std::vector<std::vector<Vec3>> rings;
  std::vector<double> travelled{0};
  for (unsigned i = 0; i < pieces; ++i) {
    travelled.push_back(travelled.back() + distance(curve(i * step), curve((i + 1) * step)));
    if (i % 4 != 0) continue; // the mesh needs fewer rings than the length
    std::vector<Vec3> ring;
    constexpr unsigned sides = 180;
    for (unsigned j = 0; j < sides; ++j) {
      const double u = 2 * pi * j / sides;
      ring.push_back(ring_in(frame_at(i * step))(radius * std::cos(u), radius * std::sin(u)));
    }
    rings.push_back(std::move(ring));
  }
  Part part;
  const double length = travelled.back();
  const unsigned count = 2 * steps(length, 2 * spacing); // even, so that turned rings alternate all around
  unsigned i = 0;
  for (unsigned k = 0; k < count; ++k) {
    const double wanted = length * k / count;
    while (travelled[i + 1] <= wanted) ++i;
    const double t = step * (i + (wanted - travelled[i]) / (travelled[i + 1] - travelled[i]));
    add_ring(part, radius, spacing, k % 2 == 1, false, ring_in(frame_at(t)));
  }
  part.truth = formula_truth(loft(rings, true), pi * radius * radius * length, 2 * pi * radius * length);
  return part;
}

Part mesh_part(TriangleMesh mesh) {
  Part part;
  part.samples = mesh.vertices;
  part.truth = truth_of(std::move(mesh));
  for (const auto& [a, b, c] : part.truth.mesh->triangles) {
    const Vec3& o = part.truth.mesh->vertices[a];
    part.truth.area += 0.5 * norm(cross(part.truth.mesh->vertices[b] - o, part.truth.mesh->vertices[c] - o));
  }
  return part;
}

Part darted(Part part, std::size_t count, std::uint64_t seed) {
  part.samples = even_samples(*part.truth.mesh, count, seed);
  part.sharp_edges.clear();
  return part;
}

namespace {

/// Every sample and every vertex of the truth goes to place(point).
template <class Place>
Part placed(Part part, Place&& place) {
  for (Vec3& p : part.samples) p = place(p);
  TriangleMesh mesh = *part.truth.mesh;
  for (Vec3& p : mesh.vertices) p = place(p);
  part.truth.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  part.truth.inside = nullptr;
  return part;
}

} // namespace

Part rotated(Part part, std::uint64_t seed) {
  // A random unit quaternion (Marsaglia): four normal deviates.
  const tools::CounterRandom random(seed, 0, 0);
  std::array<double, 4> q{};
  double length = 0;
  for (unsigned k = 0; k < 4; ++k) {
    q[k] = random.normal(2 * k);
    length += q[k] * q[k];
  }
  for (double& x : q) x /= std::sqrt(length);
  const Vec3 v{q[1], q[2], q[3]};
  return placed(std::move(part), [&](const Vec3& p) { return p + 2 * cross(v, cross(v, p) + q[0] * p); });
}

Part laid_down(Part part) {
  return placed(std::move(part), [](const Vec3& p) { return Vec3{p.z, p.x, p.y}; });
}

Part moved(Part part, const Vec3& shift) {
  return placed(std::move(part), [&](const Vec3& p) { return p + shift; });
}

Part beside(Part a, const Part& b) {
  const auto first = static_cast<std::uint32_t>(a.samples.size());
  a.samples.insert(a.samples.end(), b.samples.begin(), b.samples.end());
  for (const auto& [from, to] : b.sharp_edges) a.sharp_edges.push_back({from + first, to + first});
  const double area = a.truth.area + b.truth.area;
  a.truth = {std::make_shared<const TriangleMesh>(shapes::joined(*a.truth.mesh, *b.truth.mesh)),
             a.truth.volume + b.truth.volume,
             a.truth.components + b.truth.components,
             a.truth.genus + b.truth.genus,
             {},
             area};
  return a;
}

Part through_each_other(Part a, const Part& b, double in_common) {
  a = beside(std::move(a), b);
  Truth truth;
  truth.volume = a.truth.volume - in_common;
  a.truth = std::move(truth);
  return a;
}

} // namespace eigencrust::bench
