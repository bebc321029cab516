// SPDX-License-Identifier: GPL-3.0-or-later
#include "bezier_patches.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <string>
#include <string_view>

#include <eigencrust/error.h>
#include <eigencrust/metrics.h>

#include "parallel/threads.h"
#include "sensors.h"

namespace eigencrust::tools {
namespace {

/// Lines of numbers with their place for messages.
class NumberLines {
 public:
  explicit NumberLines(const std::filesystem::path& path) : path_(path.string()), stream_(path, std::ios::binary) {
    if (!stream_) throw Error(ErrorKind::input, path_, "cannot open the patches file", "check the name");
  }

  /// The next line that holds anything, without its comment; false at the end of the file.
  bool next() {
    while (std::getline(stream_, line_)) {
      ++number_;
      line_.resize(std::min(line_.find('#'), line_.size()));
      for (char& c : line_)
        if (c == ',' || c == '\t' || c == '\r') c = ' ';
      if (line_.find_first_not_of(' ') != std::string::npos) return true;
    }
    if (stream_.bad()) throw Error(ErrorKind::input, path_, "cannot read the patches file", "check the file");
    return false;
  }

  /// Exactly n numbers of the current line.
  template <class T, std::size_t n>
  std::array<T, n> numbers(const char* what) const {
    std::array<T, n> result{};
    const char* at = line_.data();
    const char* const end = at + line_.size();
    for (T& value : result) {
      while (at != end && *at == ' ') ++at;
      const auto [after, error] = std::from_chars(at, end, value);
      if (error != std::errc() || (after != end && *after != ' ')) fail(expected(n, what));
      at = after;
    }
    while (at != end && *at == ' ') ++at;
    if (at != end) fail(expected(n, what));
    return result;
  }

  template <class T, std::size_t n>
  std::array<T, n> next_numbers(const char* what) {
    if (!next()) fail("the file ends where " + std::to_string(n) + " " + what + " should stand");
    return numbers<T, n>(what);
  }

  [[noreturn]] void fail(const std::string& cause) const { fail(cause, std::max<std::size_t>(number_, 1)); }
  [[noreturn]] void fail(const std::string& cause, std::size_t line) const {
    throw Error(ErrorKind::input, path_ + ":" + std::to_string(line), cause,
                "give the number of patches, 16 indices per patch, the number of points and x y z per point");
  }
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  static std::string expected(std::size_t n, const char* what) {
    return "expected " + std::to_string(n) + " " + what + " on this line";
  }

  std::string path_;
  std::ifstream stream_;
  std::string line_;
  std::size_t number_ = 0;
};

/// Cubic Bernstein weights at k/n. Taken at n - k they are the same numbers in reverse.
std::array<double, 4> bernstein(std::uint32_t k, std::uint32_t n) {
  const double t = static_cast<double>(k) / n;
  const double s = static_cast<double>(n - k) / n;
  return {s * s * s, 3 * (s * s) * t, 3 * (t * t) * s, t * t * t};
}

/// Weighted sum whose value does not change when both sequences are reversed. Four equal points, the
/// pole of a patch, stay that point: the weights add up to 1 only up to rounding.
Vec3 blend(const std::array<double, 4>& w, const std::array<Vec3, 4>& p) {
  if (p[0] == p[1] && p[1] == p[2] && p[2] == p[3]) return p[0];
  return (w[0] * p[0] + w[3] * p[3]) + (w[1] * p[1] + w[2] * p[2]);
}

Vec3 triangle_normal(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
}

} // namespace

BezierPatches read_bezier_patches(const std::filesystem::path& path) {
  NumberLines lines(path);
  BezierPatches result;
  std::vector<std::size_t> line_of_patch;
  const auto [patch_count] = lines.next_numbers<std::uint32_t, 1>("number of patches");
  if (patch_count == 0) lines.fail("there are no patches");
  for (std::uint32_t i = 0; i < patch_count; ++i) {
    result.patches.push_back(lines.next_numbers<std::uint32_t, 16>("indices of control points"));
    line_of_patch.push_back(lines.number());
  }
  const auto [point_count] = lines.next_numbers<std::uint32_t, 1>("number of control points");
  for (std::uint32_t i = 0; i < point_count; ++i) {
    const auto [x, y, z] = lines.next_numbers<double, 3>("coordinates");
    if (!is_finite(Vec3{x, y, z})) lines.fail("a coordinate is not finite");
    result.control_points.push_back({x, y, z});
  }
  if (lines.next()) lines.fail("more lines than the counts announce");
  for (std::uint32_t i = 0; i < patch_count; ++i)
    for (std::uint32_t& index : result.patches[i]) {
      if (index < 1 || index > point_count)
        lines.fail("index " + std::to_string(index) + " is not within 1 to " + std::to_string(point_count),
                   line_of_patch[i]);
      --index;
    }
  return result;
}

Vec3 bezier_position(const BezierPatches& patches, std::size_t patch, std::uint32_t i, std::uint32_t j,
                     std::uint32_t n) {
  const auto& index = patches.patches[patch];
  const auto v = bernstein(j, n);
  std::array<Vec3, 4> curve;
  for (std::size_t row = 0; row < 4; ++row) {
    std::array<Vec3, 4> points;
    for (std::size_t k = 0; k < 4; ++k) points[k] = patches.control_points[index[4 * row + k]];
    curve[row] = blend(v, points);
  }
  return blend(bernstein(i, n), curve);
}

TriangleMesh tessellate(const BezierPatches& patches, std::uint32_t subdivisions) {
  if (subdivisions < 1 || subdivisions > 1024)
    throw Error(ErrorKind::usage, "--subdivisions", std::to_string(subdivisions) + " subdivisions per patch",
                "give 1 to 1024");
  TriangleMesh mesh;
  const std::uint32_t n = subdivisions;
  const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    if (p != q && q != r && r != p) mesh.triangles.push_back({a, b, c});
  };
  for (std::size_t patch = 0; patch < patches.patches.size(); ++patch) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t i = 0; i <= n; ++i)
      for (std::uint32_t j = 0; j <= n; ++j) mesh.vertices.push_back(bezier_position(patches, patch, i, j, n));
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < n; ++j) {
        const std::uint32_t a = first + i * (n + 1) + j, b = a + n + 1;
        add(a, a + 1, b);
        add(b, a + 1, b + 1);
      }
  }
  return mesh;
}

TriangleMesh outer_part(const TriangleMesh& mesh, std::uint32_t directions, double fraction, unsigned thread_count) {
  const TriangleTree tree(mesh);
  const std::vector<Vec3> sphere = fibonacci_directions(2 * directions);
  Box3 box;
  for (const Vec3& p : mesh.vertices) box.add(p);
  const double offset = 1e-6 * box.diagonal(); // starts the ray clear of its own triangle
  std::vector<std::uint8_t> keep(mesh.triangles.size());
  const Threads threads(thread_count);
  for_each_index(
      threads, keep.size(),
      [&](std::size_t t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3 normal = triangle_normal(mesh, t);
        if (norm(normal) == 0) return;
        const Vec3 centre = (1.0 / 3) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]);
        const Vec3 origin = centre + (offset / norm(normal)) * normal;
        std::uint32_t out = 0;
        for (const Vec3& d : sphere)
          if (dot(d, normal) > 0 && !tree.first_hit(origin, d).valid()) ++out;
        keep[t] = out > fraction * directions;
      },
      256);
  TriangleMesh result;
  result.vertices = mesh.vertices;
  for (std::size_t t = 0; t < keep.size(); ++t)
    if (keep[t]) result.triangles.push_back(mesh.triangles[t]);
  return result;
}

} // namespace eigencrust::tools
