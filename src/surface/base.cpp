// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/base.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <eigencrust/error.h>
#include <eigencrust/validate.h>

#include "geometry/mesh_topology.h"
#include "geometry/resolution.h"
#include "geometry/tetrahedron.h"
#include "numerics/quantile.h"
#include "surface/components.h"
#include "surface/trim.h"

namespace eigencrust {
namespace {

// So much, in spacings, the base is below the lowest vertex: what files keep apart, and little beside the body.
constexpr double gap = 1.0 / 500;

[[noreturn]] void refuse(const std::string& cause, const std::string& remedy) {
  throw Error(ErrorKind::usage, "base", cause, remedy);
}

/// The vertices of the one rim, each followed by the next along the triangle at the rim.
std::vector<std::uint32_t> only_rim(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> next = along_rims(mesh);
  const auto edges = next.size() - static_cast<std::size_t>(std::count(next.begin(), next.end(), no_index));
  if (edges == 0) refuse("the surface is closed: there is no rim to stand on a base", "leave out --base");
  const auto first = static_cast<std::uint32_t>(
      std::find_if(next.begin(), next.end(), [](std::uint32_t v) { return v != no_index; }) - next.begin());
  std::vector<std::uint32_t> rim;
  for (std::uint32_t v = first; rim.empty() || v != first; v = next[v]) {
    if (v == no_index || rim.size() == edges) break;
    rim.push_back(v);
  }
  if (rim.size() != edges)
    refuse("the surface has more than one rim", "--components largest keeps the largest piece; or leave out --base");
  return rim;
}

/// Where samples lie exactly above one another's edges, as those of a map's squares do, the hull hangs straight down
/// from its rim: there the walls of the base will stand.
void drop_upright_at_rim(const Vec3& along, Surface& surface) {
  // Sine of the slope to the axis.
  const double upright = std::sqrt(std::numeric_limits<double>::epsilon());
  std::vector<std::uint8_t> marked(surface.mesh.triangles.size());
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const Vec3 normal = area_vector(surface.mesh, i);
    marked[i] = std::fabs(dot(normal, along)) <= upright * norm(normal);
  }
  trim(marked_at_rim(surface.mesh, marked), surface);
}

/// Cavities behind the surface: nobody saw into them from the front, and the base need not reach around them.
void drop_cavities(Surface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  const std::vector<std::uint32_t> piece = triangle_components(mesh), next = along_rims(mesh);
  std::vector<std::uint8_t> has_rim(piece.size(), 0), gone(piece.size());
  std::vector<double> volume(piece.size(), 0);
  const Vec3 origin = mesh.vertices.empty() ? Vec3{} : mesh.vertices.front();
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    has_rim[piece[i]] |= next[a] != no_index || next[b] != no_index || next[c] != no_index;
    volume[piece[i]] += dot(mesh.vertices[a] - origin, cross(mesh.vertices[b] - origin, mesh.vertices[c] - origin));
  }
  for (std::size_t i = 0; i < piece.size(); ++i) gone[i] = !has_rim[piece[i]] && volume[piece[i]] < 0;
  drop_triangles(gone, surface);
}

/// Coordinates across and along the front: seen from there, u runs to the right and v upwards.
class Frame {
 public:
  explicit Frame(Axis front) : along_(direction_of(front)) {
    right_ = Vec3{along_.y, along_.z, along_.x};
    up_ = cross(along_, right_);
  }
  [[nodiscard]] Vec3 to(const Vec3& p) const { return {dot(p, right_), dot(p, up_), dot(p, along_)}; }
  [[nodiscard]] Vec3 from(const Vec3& q) const { return q.x * right_ + q.y * up_ + q.z * along_; }

 private:
  Vec3 along_, right_, up_;
};

double turn(const Vec3& a, const Vec3& b) { return a.x * b.y - a.y * b.x; }

/// Centroid of the area that the rim encloses, seen from the front.
Vec3 middle_of(const std::vector<Vec3>& rim) {
  const Vec3 start = rim.front();
  double area = 0;
  Vec3 sum;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3 a = rim[i] - start, b = rim[(i + 1) % rim.size()] - start;
    area += turn(a, b);
    sum = sum + turn(a, b) * centroid(std::array{Vec3{}, a, b});
  }
  return start + 1 / area * sum;
}

/// Does the rim run once, counter-clockwise, around that place?
bool runs_around(const std::vector<Vec3>& rim, const Vec3& middle) {
  double angle = 0;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3 a = rim[i] - middle, b = rim[(i + 1) % rim.size()] - middle;
    if (!(turn(a, b) > 0)) return false;
    angle += std::atan2(turn(a, b), a.x * b.x + a.y * b.y);
  }
  return std::lround(angle / (2 * std::numbers::pi)) == 1;
}

/// The plane z = a (x - middle.x) + b (y - middle.y) + c by least squares: {a, b, c}.
Vec3 plane_of(const std::vector<Vec3>& points, const Vec3& middle) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Vec3& p : points) {
    const Eigen::Vector3d row(p.x - middle.x, p.y - middle.y, 1);
    normal += row * row.transpose();
    right += p.z * row;
  }
  const Eigen::Vector3d plane = normal.ldlt().solve(right); // of full rank: the rim runs around a place
  return {plane[0], plane[1], plane[2]};
}

double height_over(const Vec3& plane, const Vec3& middle, const Vec3& p) {
  return p.z - plane.x * (p.x - middle.x) - plane.y * (p.y - middle.y) - plane.z;
}

/// The vertices that some steps along edges lead to from the rim; those of the rim come first.
std::vector<std::uint32_t> around_rim(const TriangleMesh& mesh, const std::vector<std::uint32_t>& rim) {
  constexpr int steps = 4;
  std::vector<std::uint8_t> met(mesh.vertices.size(), 0);
  std::vector<std::uint32_t> around = rim;
  for (const std::uint32_t v : rim) met[v] = 1;
  for (int step = 0; step < steps; ++step) {
    std::vector<std::uint32_t> next;
    for (const auto& t : mesh.triangles) {
      if (met[t[0]] != 1 && met[t[1]] != 1 && met[t[2]] != 1) continue;
      for (const std::uint32_t v : t)
        if (met[v] == 0) {
          met[v] = 2;
          next.push_back(v);
        }
    }
    for (const std::uint32_t v : next) met[v] = 1;
    around.insert(around.end(), next.begin(), next.end());
  }
  return around;
}

/// The plane through the rim; where the noise of its few vertices explains how the many around them lie to it, the
/// plane through those.
Vec3 plane_at_rim(const TriangleMesh& mesh, const std::vector<std::uint32_t>& rim, const Frame& frame,
                  const Vec3& middle) {
  std::vector<Vec3> points;
  for (const std::uint32_t v : around_rim(mesh, rim)) points.push_back(frame.to(mesh.vertices[v]));
  const std::vector<Vec3> outline(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(rim.size()));
  const Vec3 plane = plane_of(outline, middle);
  double squares = 0, sum = 0;
  for (const Vec3& p : outline) squares += std::pow(height_over(plane, middle, p), 2);
  for (const Vec3& p : points) sum += height_over(plane, middle, p);
  const auto few = static_cast<double>(outline.size()), many = static_cast<double>(points.size());
  return std::fabs(sum / many) <= static_cast<double>(noise_bound) * std::sqrt(squares) / few ? plane_of(points, middle)
                                                                                              : plane;
}

/// Volume between the surface and that plane, below it counting as negative.
double volume_above(const TriangleMesh& mesh, const Frame& frame, const Vec3& plane, const Vec3& middle) {
  double volume = 0;
  for (const auto& triangle : mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = frame.to(mesh.vertices[triangle[k]]);
    volume += turn(p[1] - p[0], p[2] - p[0]) / 2 * height_over(plane, middle, centroid(p));
  }
  return volume;
}

} // namespace

Base close_with_base(Axis front, const SampleModel& model, const Vec3& origin, Surface& surface) {
  if (!is_resolved(gap * model.typical_spacing, surface.mesh.vertices, origin))
    throw Error(ErrorKind::input, "base", "the coordinates are so large that a base would round into the surface",
                "move the cloud nearer to zero with --shift");
  drop_upright_at_rim(direction_of(front), surface);
  drop_cavities(surface);
  TriangleMesh& mesh = surface.mesh;
  const std::vector<std::uint32_t> rim = only_rim(mesh);
  const Frame frame(front);
  std::vector<Vec3> outline;
  for (const std::uint32_t v : rim) outline.push_back(frame.to(mesh.vertices[v]));
  Vec3 middle = middle_of(outline);
  if (!runs_around(outline, middle))
    refuse("seen along " + to_string(front) + ", the rim of the surface crosses itself",
           "name another side with --facade, or leave out --base");
  Base base;
  const Vec3 plane = plane_at_rim(mesh, rim, frame, middle);
  base.volume_above_rim = volume_above(mesh, frame, plane, middle);
  std::vector<double> heights;
  for (const Vec3& p : outline) heights.push_back(p.z);
  base.level = median(heights);
  for (const Vec3& p : mesh.vertices) base.level = std::min(base.level, frame.to(p).z - gap * model.typical_spacing);
  if (!(volume_above(mesh, frame, {0, 0, base.level}, middle) > 0))
    refuse("seen along " + to_string(front) + ", the surface is wider than its rim, and a body on a base inside out",
           "name another side with --facade, or leave out --base");

  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto count = static_cast<std::uint32_t>(rim.size());
  outline.push_back(middle);
  for (std::uint32_t i = 0; i <= count; ++i) {
    mesh.vertices.push_back(frame.from({outline[i].x, outline[i].y, base.level}));
    surface.sample_of.push_back(surface.sample_of[rim[i % count]]);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = (i + 1) % count, a = rim[i], b = rim[j], below_a = first + i, below_b = first + j;
    mesh.triangles.insert(mesh.triangles.end(),
                          {{b, a, below_a}, {b, below_a, below_b}, {first + count, below_b, below_a}});
  }
  base.vertices = count + 1;
  surface.support.resize(mesh.triangles.size(), 0);
  surface.inside.resize(mesh.triangles.size());
  if (!surface.unsupported.empty()) surface.unsupported.resize(mesh.triangles.size(), 1);
  return base;
}

} // namespace eigencrust
