// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse.h"

#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/mesh_topology.h"
#include "geometry/nearest_on_triangle.h"
#include "simplify/edge_queue.h"
#include "surface/fans.h"

namespace eigencrust {
namespace {

// Open edges count as a wall of so many times the square on them: a rim moves less readily than the surface bends.
constexpr double rim_weight = 10;
// Where planes leave a direction open, on flat parts and along creases, vertices go to the middle of the edge and short
// edges go first: by so small a share of the weight that it decides nothing else.
constexpr double pull_to_middle = 1e-5;
constexpr double cost_of_length = 1e-6;
// Cosine: no triangle may turn farther in one step.
constexpr double least_turn = 0.2;
// Twice the area over the square of the longest edge: no thinner triangle is made.
constexpr double least_shape = 1e-3;

using Mesh = CGAL::Surface_mesh<Vec3>;
using VertexId = Mesh::Vertex_index;
using HalfedgeId = Mesh::Halfedge_index;
using EdgeId = Mesh::Edge_index;

class Collapsing {
 public:
  Collapsing(const TriangleMesh& mesh, std::span<const Quadric> quadrics, std::span<const float> limits,
             const StandFor& before, double max_error)
      : given_(mesh),
        before_(before),
        max_error_(max_error),
        quadric_(quadrics.begin(), quadrics.end()),
        limit_(limits.begin(), limits.end()),
        into_(mesh.vertices.size()) {
    std::iota(into_.begin(), into_.end(), 0u);
    if (limits_error()) chain_points(before.triangle);
    const auto vertices = static_cast<Mesh::size_type>(mesh.vertices.size());
    const auto triangles = static_cast<Mesh::size_type>(mesh.triangles.size());
    mesh_.reserve(vertices, 3 * triangles / 2 + vertices / 2, triangles);
    for (const Vec3& p : mesh.vertices) mesh_.add_vertex(p);
    for (const auto& [a, b, c] : mesh.triangles)
      if (mesh_.add_face(VertexId(a), VertexId(b), VertexId(c)) == Mesh::null_face()) {
        is_manifold_ = false;
        return;
      }
    state_.assign(mesh_.num_edges(), State::left_out);
    at_rim_.assign(mesh_.num_vertices(), 0);
    for (const EdgeId e : mesh_.edges())
      if (mesh_.is_border(e)) at_rim_[mesh_.vertex(e, 0)] = at_rim_[mesh_.vertex(e, 1)] = 1;
  }

  Collapsed run(const CollapseGoal& goal) {
    if (!is_manifold_)
      return {{given_.vertices, given_.triangles, {}, {}}, std::move(quadric_), std::move(into_), false};
    // What could not be collapsed may be possible when all around it has changed.
    for (std::size_t before = mesh_.number_of_faces() + 1;
         before > mesh_.number_of_faces() && mesh_.number_of_faces() > goal.triangles;) {
      before = mesh_.number_of_faces();
      fill_queue(goal);
      empty_queue(goal);
    }
    return result();
  }

 private:
  [[nodiscard]] bool limits_error() const { return max_error_ < std::numeric_limits<double>::infinity(); }

  void chain_points(std::span<const std::uint32_t> triangle) {
    first_point_.assign(given_.triangles.size(), no_index);
    next_point_.resize(triangle.size());
    for (std::uint32_t i = 0; i < triangle.size(); ++i) chain_point(i, triangle[i]);
  }
  void chain_point(std::uint32_t point, std::uint32_t triangle) {
    next_point_[point] = std::exchange(first_point_[triangle], point);
  }

  struct StarTriangle {
    Corners corners;
    std::uint32_t number;
  };
  /// Of edges: not in the queue, there with its cost, there with that of before.
  enum class State : std::uint8_t { left_out, waits, changed };
  struct Collapse {
    Vec3 place;
    double cost, distance; ///< root of the mean square to the planes
  };

  [[nodiscard]] const Vec3& place(VertexId v) const { return mesh_.point(v); }

  void fill_queue(const CollapseGoal& goal) {
    queue_.clear();
    for (const EdgeId e : mesh_.edges())
      if (const double cost = cost_of(e, goal); cost >= 0) queue_.append(cost, static_cast<std::uint32_t>(e));
    queue_.make();
  }

  /// Also writes down whether the edge is to wait. \return negative: it is to be left out
  double cost_of(EdgeId e, const CollapseGoal& goal) {
    state_[e] = State::left_out;
    const double limit = static_cast<double>(std::min(limit_[mesh_.vertex(e, 0)], limit_[mesh_.vertex(e, 1)]));
    if (limit < 0) return -1;
    const Collapse collapse = evaluate(e);
    if (!(collapse.distance <= std::min(goal.max_error, limit))) return -1;
    state_[e] = State::waits;
    return collapse.cost;
  }

  [[nodiscard]] Collapse evaluate(EdgeId e) const {
    const VertexId u = mesh_.vertex(e, 0), v = mesh_.vertex(e, 1);
    const Vec3 &p = place(u), &q = place(v);
    const Quadric sum = quadric_[u] + quadric_[v];
    // What is not at the rim does not pull it in.
    const Vec3 to = at_rim_[u] == at_rim_[v] ? sum.least(0.5 * (p + q), pull_to_middle) : at_rim_[u] ? p : q;
    const double error = sum.at(to);
    return {to, error + cost_of_length * sum.weight() * squared_norm(p - q),
            sum.weight() > 0 ? std::sqrt(error / sum.weight()) : 0};
  }

  void empty_queue(const CollapseGoal& goal) {
    while (!queue_.empty() && mesh_.number_of_faces() > goal.triangles) {
      const EdgeId e(queue_.top());
      if (!mesh_.is_removed(e) && state_[e] == State::changed) {
        if (const double cost = cost_of(e, goal); cost >= 0)
          queue_.change_top(cost);
        else
          queue_.pop();
        continue;
      }
      queue_.pop();
      if (mesh_.is_removed(e)) continue;
      state_[e] = State::left_out;
      const std::size_t fewer = mesh_.is_border(e) ? 1 : 2;
      if (mesh_.number_of_faces() < goal.triangles + fewer) continue; // one at a rim may do for the last
      const Vec3 to = evaluate(e).place;
      if (!CGAL::Euler::does_satisfy_link_condition(e, mesh_) || !keeps_sides(e, to)) continue;
      if (limits_error() && !keeps_near(e, to)) continue;
      collapse(e, to, goal);
    }
  }

  void collapse(EdgeId e, const Vec3& to, const CollapseGoal& goal) {
    const VertexId u = mesh_.vertex(e, 0), v = mesh_.vertex(e, 1);
    const Quadric sum = quadric_[u] + quadric_[v];
    const VertexId kept = CGAL::Euler::collapse_edge(e, mesh_);
    const VertexId gone = kept == u ? v : u;
    into_[gone] = static_cast<std::uint32_t>(kept);
    if (limits_error()) move_points();
    mesh_.point(kept) = to;
    quadric_[kept] = sum;
    limit_[kept] = std::min(limit_[u], limit_[v]);
    at_rim_[kept] = at_rim_[u] | at_rim_[v];
    // Quadrics add up, so that edges around hardly ever become cheaper: it is soon enough to ask again at their turn.
    for (const HalfedgeId h : CGAL::halfedges_around_target(mesh_.halfedge(kept), mesh_))
      if (const EdgeId around = mesh_.edge(h); state_[around] != State::left_out)
        state_[around] = State::changed;
      else if (const double cost = cost_of(around, goal); cost >= 0)
        queue_.push(cost, static_cast<std::uint32_t>(around));
  }

  /// Does no triangle that is left turn over or become too thin?
  [[nodiscard]] bool keeps_sides(EdgeId e, const Vec3& to) const {
    const VertexId u = mesh_.vertex(e, 0), v = mesh_.vertex(e, 1);
    return keeps_sides(u, v, to) && keeps_sides(v, u, to);
  }
  [[nodiscard]] bool keeps_sides(VertexId moving, VertexId other, const Vec3& to) const {
    const Vec3& from = place(moving);
    for (const HalfedgeId h : CGAL::halfedges_around_target(mesh_.halfedge(moving), mesh_)) {
      if (mesh_.is_border(h)) continue;
      const VertexId a = mesh_.target(mesh_.next(h)), b = mesh_.source(h);
      if (a == other || b == other) continue;
      const Vec3 &p = place(a), &q = place(b);
      const Vec3 before = cross(p - from, q - from), after = cross(p - to, q - to);
      const double squared = squared_norm(after);
      const double longest = std::max({squared_norm(p - to), squared_norm(q - to), squared_norm(p - q)});
      if (!(squared > least_shape * least_shape * longest * longest)) return false;
      const double along = dot(before, after);
      if (!(along > 0) || !(along * along > least_turn * least_turn * squared * squared_norm(before))) return false;
    }
    return true;
  }

  /// Is each point of the triangles around near enough to one that there will be? Keeps which.
  [[nodiscard]] bool keeps_near(EdgeId e, const Vec3& to) {
    const VertexId u = mesh_.vertex(e, 0), v = mesh_.vertex(e, 1);
    star_.clear();
    around_.clear();
    for (const auto& [moving, other] : {std::pair{u, v}, std::pair{v, u}})
      for (const HalfedgeId h : CGAL::halfedges_around_target(mesh_.halfedge(moving), mesh_)) {
        if (mesh_.is_border(h)) continue;
        const VertexId a = mesh_.target(mesh_.next(h)), b = mesh_.source(h);
        const auto f = static_cast<std::uint32_t>(mesh_.face(h));
        around_.push_back(f); // those at the edge twice
        if (a != other && b != other) star_.push_back({{to, place(a), place(b)}, f});
      }
    goes_to_.clear();
    for (const std::uint32_t f : around_)
      for (std::uint32_t i = first_point_[f]; i != no_index; i = next_point_[i]) {
        double least = max_error_ * max_error_;
        std::uint32_t nearest = no_index;
        for (const StarTriangle& t : star_)
          if (const double d = squared_norm(nearest_on_triangle(t.corners, before_.points[i]) - before_.points[i]);
              d <= least) {
            least = d;
            nearest = t.number;
          }
        if (nearest == no_index) return false;
        goes_to_.emplace_back(i, nearest);
      }
    return stays_near(to);
  }
  /// The other way: are the triangles that there will be near the surface before?
  [[nodiscard]] bool stays_near(const Vec3& to) const {
    const auto is_near = [&](const Vec3& p) {
      return before_.surface->nearest(p + before_.origin).distance <= max_error_;
    };
    return is_near(to) && std::all_of(star_.begin(), star_.end(), [&](const StarTriangle& t) {
             const auto& [a, b, c] = t.corners;
             return is_near((1.0 / 3) * (a + b + c));
           });
  }
  /// After keeps_near() the points of what has changed go to their new triangles.
  void move_points() {
    for (const std::uint32_t f : around_) first_point_[f] = no_index;
    std::sort(goes_to_.begin(), goes_to_.end());
    goes_to_.erase(std::unique(goes_to_.begin(), goes_to_.end()), goes_to_.end());
    for (const auto& [point, triangle] : goes_to_) chain_point(point, triangle);
  }

  Collapsed result() {
    Collapsed left;
    std::vector<std::uint32_t> number(into_.size(), no_index);
    for (const VertexId v : mesh_.vertices()) {
      number[v] = static_cast<std::uint32_t>(left.mesh.vertices.size());
      left.mesh.vertices.push_back(place(v));
      left.quadrics.push_back(quadric_[v]);
    }
    for (const auto f : mesh_.faces()) {
      const HalfedgeId h = mesh_.halfedge(f);
      left.mesh.triangles.push_back(
          {number[mesh_.target(h)], number[mesh_.target(mesh_.next(h))], number[mesh_.source(h)]});
    }
    left.into.resize(into_.size());
    for (std::uint32_t v = 0; v < into_.size(); ++v) {
      std::uint32_t root = v;
      while (into_[root] != root) root = into_[root] = into_[into_[root]];
      left.into[v] = number[root];
    }
    return left;
  }

  const TriangleMesh& given_;
  StandFor before_;
  double max_error_;
  Mesh mesh_;
  bool is_manifold_ = true;
  std::vector<Quadric> quadric_;                        ///< of each vertex
  std::vector<float> limit_;                            ///< of each vertex
  std::vector<std::uint32_t> into_;                     ///< of each vertex
  std::vector<std::uint8_t> at_rim_;                    ///< of each vertex
  std::vector<State> state_;                            ///< of each edge
  std::vector<std::uint32_t> first_point_, next_point_; ///< of each triangle; after each point of the same triangle
  // Of the collapse that is looked at:
  std::vector<StarTriangle> star_;                               ///< triangles that there will be
  std::vector<std::uint32_t> around_;                            ///< those that there are
  std::vector<std::pair<std::uint32_t, std::uint32_t>> goes_to_; ///< points and their new triangles
  EdgeQueue queue_;
};

} // namespace

std::vector<Quadric> vertex_quadrics(const TriangleMesh& mesh, const Threads& threads) {
  const SurfaceFans fans(mesh);
  std::vector<Quadric> quadrics(mesh.vertices.size());
  for_each_index(threads, quadrics.size(), [&](std::size_t i) {
    const auto v = static_cast<std::uint32_t>(i);
    const Vec3& p = mesh.vertices[v];
    const auto add = [&](const Vec3& normal, double weight) {
      if (const double length = norm(normal); length > 0) quadrics[v] += Quadric((1 / length) * normal, p, weight);
    };
    const auto area_of = [&](const SurfaceFans::Wing& wing) {
      return cross(mesh.vertices[wing.next] - p, mesh.vertices[wing.last] - p);
    };
    for (const auto& wing : fans[v]) add(area_of(wing), norm(area_of(wing)) / 2);
    if (!fans.at_rim(v)) return;
    for (const auto& wing : fans[v])
      for (const std::uint32_t other : {wing.next, wing.last})
        if (const Vec3 side = mesh.vertices[other] - p; fans.is_open(v, other))
          add(cross(side, area_of(wing)), rim_weight * squared_norm(side));
  });
  return quadrics;
}

Collapsed collapse_edges(const TriangleMesh& mesh, std::span<const Quadric> quadrics, std::span<const float> limits,
                         const StandFor& before, const CollapseGoal& goal) {
  return Collapsing(mesh, quadrics, limits, before, goal.max_error).run(goal);
}

} // namespace eigencrust
