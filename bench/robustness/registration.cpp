// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <eigencrust/metrics.h>

#include "parallel/threads.h"

namespace eigencrust::bench {
namespace {

constexpr double kept_pairs = 0.9; // of the pairs, nearest first

Eigen::Vector3d eigen(const Vec3& p) { return {p.x, p.y, p.z}; }

/// Points of a surface, and the surface to ask for nearest points.
struct Side {
  Side(const TriangleMesh& mesh, std::size_t count) : points(sample_surface(mesh, count, 8)), tree(mesh) {
    for (const Vec3& p : points) centre = centre + (1 / static_cast<double>(count)) * p;
    for (const Vec3& p : points) {
      const Eigen::Vector3d d = eigen(p - centre);
      moments += d * d.transpose() / static_cast<double>(count);
    }
  }
  [[nodiscard]] double size() const { return std::sqrt(moments.trace()); }

  std::vector<Vec3> points;
  TriangleTree tree;
  Vec3 centre;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
};

Similarity similarity_of(const Eigen::Matrix3d& rotation, const Side& moving, const Side& fixed) {
  Similarity s;
  s.scale = fixed.size() / moving.size();
  for (int i = 0; i < 3; ++i) s.rotation[i] = {rotation(i, 0), rotation(i, 1), rotation(i, 2)};
  const Vec3 turned = s.apply(moving.centre);
  s.translation = fixed.centre - turned;
  return s;
}

/// The 24 rotations that turn a cube into itself, then the four that lay principal axes onto each other.
std::vector<Eigen::Matrix3d> start_rotations(const Side& moving, const Side& fixed) {
  std::vector<Eigen::Matrix3d> proper; // permutations of the axes with signs and determinant +1
  std::array<int, 3> axis{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
      for (int i = 0; i < 3; ++i) m(i, axis[i]) = signs >> i & 1 ? -1 : 1;
      if (m.determinant() > 0) proper.push_back(m);
    }
  } while (std::next_permutation(axis.begin(), axis.end()));

  std::vector<Eigen::Matrix3d> starts = proper;
  const Eigen::Matrix3d from = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moving.moments).eigenvectors();
  const Eigen::Matrix3d to = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(fixed.moments).eigenvectors();
  for (unsigned signs = 0; signs < 8; ++signs) {
    Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 3; ++i) flip(i, i) = signs >> i & 1 ? -1 : 1;
    const Eigen::Matrix3d m = to * flip * from.transpose();
    if (m.determinant() > 0) starts.push_back(m);
  }
  return starts;
}

struct Step {
  Similarity similarity;
  double error = 0; ///< root mean square of the pairs used, before the step
};

/// One step: the first `count` points of each side, spread over it, are paired with the other surface.
Step closest_points_step(const Similarity& s, const Side& moving, const Side& fixed, std::size_t count,
                         const Threads& threads) {
  struct Pair {
    double distance = 0;
    Vec3 moving, fixed;
  };
  std::vector<Pair> pairs(2 * count);
  const Similarity back = s.inverse();
  const auto row = [count](const Side& side, std::size_t i) { return i * side.points.size() / count; };
  for_each_index(
      threads, count,
      [&](std::size_t i) {
        const Vec3& m = moving.points[row(moving, i)];
        const auto on_fixed = fixed.tree.nearest(s.apply(m));
        pairs[2 * i] = {on_fixed.distance, m, on_fixed.point};
        const Vec3& f = fixed.points[row(fixed, i)];
        const auto on_moving = moving.tree.nearest(back.apply(f));
        pairs[2 * i + 1] = {s.scale * on_moving.distance, on_moving.point, f};
      },
      128);
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  pairs.resize(static_cast<std::size_t>(kept_pairs * static_cast<double>(pairs.size())));
  std::vector<Vec3> from, to;
  double sum = 0;
  for (const Pair& p : pairs) {
    from.push_back(p.moving);
    to.push_back(p.fixed);
    sum += p.distance * p.distance;
  }
  return {fit_similarity(from, to), std::sqrt(sum / static_cast<double>(pairs.size()))};
}

} // namespace

Vec3 Similarity::apply(const Vec3& p) const {
  return scale * Vec3{dot(rotation[0], p), dot(rotation[1], p), dot(rotation[2], p)} + translation;
}

Similarity Similarity::inverse() const {
  Similarity s;
  s.scale = 1 / scale;
  for (int i = 0; i < 3; ++i) {
    const auto of = [i](const Vec3& v) { return i == 0 ? v.x : i == 1 ? v.y : v.z; };
    s.rotation[i] = {of(rotation[0]), of(rotation[1]), of(rotation[2])};
  }
  s.translation = -1.0 * s.apply(translation);
  return s;
}

Similarity fit_similarity(std::span<const Vec3> from, std::span<const Vec3> to) {
  Eigen::Matrix3Xd a(3, from.size()), b(3, to.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = eigen(from[i]);
    b.col(static_cast<Eigen::Index>(i)) = eigen(to[i]);
  }
  const Eigen::Matrix4d m = Eigen::umeyama(a, b, true);
  Similarity s;
  s.scale = std::cbrt(m.topLeftCorner<3, 3>().determinant());
  for (int i = 0; i < 3; ++i) s.rotation[i] = (1 / s.scale) * Vec3{m(i, 0), m(i, 1), m(i, 2)};
  s.translation = {m(0, 3), m(1, 3), m(2, 3)};
  return s;
}

Similarity lay_onto(const TriangleMesh& moving_mesh, const TriangleMesh& fixed_mesh, unsigned thread_count) {
  constexpr std::size_t all = 5'000, few = 300;
  constexpr int first_steps = 12, last_steps = 100;
  const Side moving(moving_mesh, all), fixed(fixed_mesh, all);
  const Threads threads(thread_count);
  Step best{{}, std::numeric_limits<double>::infinity()};
  for (const Eigen::Matrix3d& rotation : start_rotations(moving, fixed)) {
    Step step{similarity_of(rotation, moving, fixed), 0};
    for (int i = 0; i < first_steps; ++i) step = closest_points_step(step.similarity, moving, fixed, few, threads);
    if (step.error < best.error) best = step;
  }
  for (int i = 0; i < last_steps; ++i) {
    const Step next = closest_points_step(best.similarity, moving, fixed, all, threads);
    const bool settled = std::fabs(next.error - best.error) < 1e-4 * next.error;
    best = next;
    if (settled) break;
  }
  return best.similarity;
}

} // namespace eigencrust::bench
