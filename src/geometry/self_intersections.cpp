// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/self_intersections.h"

#include <CGAL/intersections.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/exact_points.h"

namespace eigencrust {
namespace {

using Point = ExactPredicates::Point_3;
using ExactCorners = std::array<Point, 3>;

Vec3 difference(const Point& p, const Point& q) { return {p.x() - q.x(), p.y() - q.y(), p.z() - q.z()}; }

/// On which side of the plane through a lie points, where floating point can tell?
class FilteredPlane {
 public:
  explicit FilteredPlane(const ExactCorners& c)
      : a_(c[0]), u_(difference(c[1], c[0])), v_(difference(c[2], c[0])), normal_(cross(u_, v_)) {
    const auto larger = [](double p, double q) { return std::max(std::fabs(p), std::fabs(q)); };
    size_ = {larger(u_.x, v_.x), larger(u_.y, v_.y), larger(u_.z, v_.z)};
  }

  /// 1 or -1; 0: not sure. Each of the six products of three differences has at most eight roundings of 2^-53.
  [[nodiscard]] int side(const Point& p) const {
    constexpr double roundings = 6e-15, tiny = 1e-280; // below it products might vanish
    const Vec3 w = difference(p, a_);
    const double most =
        std::max(size_.x, std::fabs(w.x)) * std::max(size_.y, std::fabs(w.y)) * std::max(size_.z, std::fabs(w.z));
    const double volume = dot(normal_, w);
    if (!(most > tiny) || !(std::fabs(volume) > roundings * most)) return 0;
    return volume > 0 ? 1 : -1;
  }

 private:
  Point a_;
  Vec3 u_, v_, normal_, size_;
};

/// Are all points strictly on one and the same side of the plane of `plane`? One normal does for all of them.
template <class... Points>
bool strictly_beside(const ExactCorners& plane, const Points&... points) {
  const FilteredPlane filter(plane);
  const int sure[] = {filter.side(points)...};
  if (std::none_of(std::begin(sure), std::end(sure), [](int s) { return s == 0; }))
    return std::all_of(std::begin(sure), std::end(sure), [&](int s) { return s == sure[0]; });
  const CGAL::Orientation sides[] = {CGAL::orientation(plane[0], plane[1], plane[2], points)...};
  return sides[0] != CGAL::COPLANAR &&
         std::all_of(std::begin(sides), std::end(sides), [&](CGAL::Orientation s) { return s == sides[0]; });
}

bool meet_anywhere(const ExactCorners& f, const ExactCorners& g) {
  if (strictly_beside(f, g[0], g[1], g[2]) || strictly_beside(g, f[0], f[1], f[2])) return false;
  return CGAL::do_intersect(ExactPredicates::Triangle_3(f[0], f[1], f[2]),
                            ExactPredicates::Triangle_3(g[0], g[1], g[2]));
}

/// f[0] = g[0] is shared. A second common point p would lie on a ray from there that stays in both
/// triangles until it leaves one of them, and that is through the side opposite the shared vertex.
bool meet_beyond_vertex(const ExactCorners& f, const ExactCorners& g) {
  if (strictly_beside(f, g[1], g[2]) || strictly_beside(g, f[1], f[2])) return false;
  return CGAL::do_intersect(ExactPredicates::Triangle_3(f[0], f[1], f[2]), ExactPredicates::Segment_3(g[1], g[2])) ||
         CGAL::do_intersect(ExactPredicates::Triangle_3(g[0], g[1], g[2]), ExactPredicates::Segment_3(f[1], f[2]));
}

/// f[0] = g[0] and f[1] = g[1] are shared: only a fold by half a turn makes them overlap.
bool meet_beyond_edge(const ExactCorners& f, const ExactCorners& g) {
  return CGAL::orientation(f[0], f[1], f[2], g[2]) == CGAL::COPLANAR &&
         CGAL::coplanar_orientation(f[0], f[1], f[2], g[2]) == CGAL::POSITIVE;
}

/// The same triangles with their shared vertices first and in the same order; how many there are.
int shared_first(Triangle& f, Triangle& g) {
  int shared = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = shared; j < 3; ++j)
      if (f[i] == g[j]) {
        std::swap(f[i], f[shared]);
        std::swap(g[j], g[shared]);
        ++shared;
        break;
      }
  return shared;
}

bool intersect(std::span<const Vec3> vertices, Triangle f, Triangle g) {
  const auto corners = [&](const Triangle& t) {
    return ExactCorners{to_cgal(vertices[t[0]]), to_cgal(vertices[t[1]]), to_cgal(vertices[t[2]])};
  };
  switch (shared_first(f, g)) {
    case 0:
      return meet_anywhere(corners(f), corners(g));
    case 1:
      return meet_beyond_vertex(corners(f), corners(g));
    case 2:
      return meet_beyond_edge(corners(f), corners(g));
    default:
      return true; // one triangle twice
  }
}

void add_to(Box3& box, const Box3& other) {
  box.min = {std::min(box.min.x, other.min.x), std::min(box.min.y, other.min.y), std::min(box.min.z, other.min.z)};
  box.max = {std::max(box.max.x, other.max.x), std::max(box.max.y, other.max.y), std::max(box.max.z, other.max.z)};
}

std::vector<Box3> boxes_of(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  std::vector<Box3> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    boxes[t] = box_around(vertices[a], vertices[b], vertices[c]);
  }
  return boxes;
}

/// Of each triangle with those of greater number. At first each looks at a few; then those that have more go on, in
/// rounds of a fixed size, until the limit of all is reached: which they are does not depend on threads.
class CrossingCounter {
 public:
  /// \param triangles none degenerate, at least one; outlive this
  CrossingCounter(std::span<const Vec3> vertices, std::span<const Triangle> triangles, const CrossingLimits& limits,
                  const Threads& threads)
      : vertices_(vertices),
        triangles_(triangles),
        limits_(limits),
        boxes_(boxes_of(vertices, triangles)),
        tree_(boxes_, threads) {}

  Crossings count(const Threads& threads) const {
    constexpr std::size_t block = 2048;
    std::vector<Few> few((triangles_.size() + block - 1) / block);
    for_blocks(threads, triangles_.size(), block,
               [&](std::size_t begin, std::size_t end, std::size_t b) { few[b] = look_at_few(begin, end); });
    Crossings sum;
    std::vector<Wide> wide;
    for (const Few& one : few) {
      add(one.done, sum);
      wide.insert(wide.end(), one.wide.begin(), one.wide.end());
    }
    std::uint64_t more = 0;
    for (std::size_t begin = 0, end = 0; begin < wide.size(); begin = end) {
      end = std::min(wide.size(), begin + round);
      const bool go_on = more < limits_.in_all;
      if (go_on)
        threads.run(end - begin, [&](std::size_t k) {
          Wide& one = wide[begin + k];
          one.so_far = look(one.triangle, limits_.in_all);
        });
      for (std::size_t k = begin; k < end; ++k) {
        if (go_on) more += wide[k].so_far.looked;
        add(wide[k].so_far, sum);
      }
    }
    return sum;
  }

 private:
  // So many triangles go on before it is asked again whether it was enough: at most so many times all triangles more.
  static constexpr std::size_t round = 64;

  struct Wide { ///< a triangle with more pairs than are always looked at
    std::uint32_t triangle;
    Crossings so_far;
  };
  struct Few {
    Crossings done;
    std::vector<Wide> wide;
  };

  static void add(const Crossings& one, Crossings& sum) {
    sum.pairs += one.pairs;
    sum.looked += one.looked;
    sum.all = sum.all && one.all;
  }

  /// In the order of the leaves, so that one query after the other walks through the same nodes.
  Few look_at_few(std::size_t begin, std::size_t end) const {
    Few few;
    for (std::size_t place = begin; place < end; ++place) {
      const std::uint32_t t = tree_.order()[place];
      const Crossings one = look(t, limits_.always);
      if (one.all)
        add(one, few.done);
      else
        few.wide.push_back({t, one});
    }
    return few;
  }

  Crossings look(std::uint32_t t, std::uint64_t most) const {
    Crossings found;
    found.all = tree_.overlapping_leaves(boxes_[t], [&](std::uint32_t place) {
      const std::uint32_t other = tree_.order()[place];
      if (found.looked == most) return false;
      ++found.looked;
      found.pairs += other > t && BoxTree::overlap(boxes_[other], boxes_[t]) &&
                     intersect(vertices_, triangles_[t], triangles_[other]);
      return true;
    });
    return found;
  }

  std::span<const Vec3> vertices_;
  std::span<const Triangle> triangles_;
  CrossingLimits limits_;
  std::vector<Box3> boxes_;
  BoxTree tree_;
};

} // namespace

bool is_degenerate(std::span<const Vec3> vertices, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  return CGAL::collinear(to_cgal(vertices[a]), to_cgal(vertices[b]), to_cgal(vertices[c]));
}

std::vector<std::uint8_t> find_degenerate_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                                    std::span<const std::uint8_t> clear, const Threads& threads) {
  std::vector<std::uint8_t> degenerate(triangles.size());
  for_each_index(threads, triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = triangles[t];
    if (!clear.empty() && (clear[a] | clear[b] | clear[c]) != 0) return;
    degenerate[t] = is_degenerate(vertices, triangles[t]) ? 1 : 0;
  });
  return degenerate;
}

Crossings count_self_intersections(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                   std::span<const std::uint8_t> degenerate, const Threads& threads,
                                   const CrossingLimits& limits) {
  std::vector<Triangle> sound;
  sound.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (degenerate[t] == 0) sound.push_back(triangles[t]);
  return sound.empty() ? Crossings{} : CrossingCounter(vertices, sound, limits, threads).count(threads);
}

/// Sorts triangles to vertices, so that each is in one star.
class CrossingSearch::Stars {
 public:
  Stars(std::span<const Triangle> triangles, std::span<const std::uint8_t> degenerate, std::size_t vertices)
      : hub_(vertices, 0) {
    // A vertex is a hub where a triangle has none yet; then each triangle goes to that of its hubs that has the fewest.
    const auto is_hub = [&](std::uint32_t v) { return hub_[v] != 0; };
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (degenerate[t] == 0 && std::none_of(triangles[t].begin(), triangles[t].end(), is_hub))
        hub_[triangles[t][0]] = 1;
    std::vector<std::uint32_t> star_of(vertices, no_index); // the last one of each hub
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      if (degenerate[t] != 0) continue;
      std::uint32_t best = no_index;
      for (const std::uint32_t v : triangles[t])
        if (is_hub(v) && (best == no_index || count_at(star_of[v]) < count_at(star_of[best]))) best = v;
      if (star_of[best] == no_index || count_at(star_of[best]) == most_of_star) {
        star_of[best] = static_cast<std::uint32_t>(members_.size());
        members_.push_back({best, 0, {}});
      }
      Members& star = members_[star_of[best]];
      star.triangle[star.count++] = t;
    }
  }

  struct Members {
    std::uint32_t hub, count;
    std::array<std::uint32_t, most_of_star> triangle;
  };
  [[nodiscard]] const std::vector<Members>& members() const { return members_; }

 private:
  [[nodiscard]] std::uint32_t count_at(std::uint32_t star) const { return star == no_index ? 0 : members_[star].count; }
  std::vector<std::uint8_t> hub_; ///< of each vertex
  std::vector<Members> members_;  ///< of each star
};

CrossingSearch::CrossingSearch(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                               std::span<const std::uint8_t> degenerate, const Threads& threads)
    : vertices_(vertices), triangles_(triangles), degenerate_(degenerate) {
  const Stars stars(triangles, degenerate, vertices.size());
  const auto& members = stars.members();
  if (members.empty()) return;
  std::vector<Box3> boxes(members.size());
  for_each_index(threads, boxes.size(), [&](std::size_t s) {
    for (std::uint32_t k = 0; k < members[s].count; ++k) add_to(boxes[s], box_of(members[s].triangle[k]));
  });
  tree_ = BoxTree(boxes, threads);
  stars_.resize(members.size());
  std::uint32_t begin = 0;
  for (std::size_t place = 0; place < stars_.size(); ++place) {
    const std::uint32_t s = tree_.order()[place];
    stars_[place] = {boxes[s], members[s].hub, begin, begin + members[s].count};
    begin += members[s].count;
  }
  items_.resize(begin);
  for_each_index(threads, stars_.size(), [&](std::size_t place) {
    const Stars::Members& star = members[tree_.order()[place]];
    for (std::uint32_t k = 0; k < star.count; ++k)
      items_[stars_[place].begin + k] = {box_of(star.triangle[k]), triangles[star.triangle[k]], star.triangle[k]};
  });
  parts_ = tree_.parts_of_join();
}

/// Have they a vertex in common whose triangles are known not to cross?
inline bool CrossingSearch::shares_clear(const Triangle& f, const Triangle& g) const {
  if (clear_.empty()) return false;
  const auto is_shared = [&](std::uint32_t v) { return ((v == g[0]) | (v == g[1]) | (v == g[2])) != 0; };
  return std::any_of(f.begin(), f.end(), [&](std::uint32_t v) { return is_shared(v) && clear_[v] != 0; });
}

/// Those whose boxes overlap the other. Whether one does is anybody's guess: each is written down.
CrossingSearch::Near CrossingSearch::items_near(const Star& star, const Box3& box) const {
  Near near;
  for (std::uint32_t k = star.begin; k < star.end; ++k) {
    near.item[near.count] = &items_[k];
    near.count += BoxTree::overlap(items_[k].box, box) ? 1 : 0;
  }
  return near;
}

/// look(a, b) for two triangles of these leaves of the tree, each pair once, whose boxes may overlap.
template <class Look>
void CrossingSearch::look_at_pairs(const BoxTree::Node& p, const BoxTree::Node& q, Look&& look) const {
  for (std::uint32_t i = p.first; i < p.first + p.count; ++i) {
    const Star& one = stars_[i];
    if (&p == &q && (clear_.empty() || clear_[one.hub] == 0))
      for (std::uint32_t a = one.begin; a < one.end; ++a)
        for (std::uint32_t b = a + 1; b < one.end; ++b) look(items_[a], items_[b]);
    for (std::uint32_t j = &p == &q ? i + 1 : q.first; j < q.first + q.count; ++j) {
      const Star& other = stars_[j];
      if (!BoxTree::overlap(one.box, other.box)) continue;
      const Near near_other = items_near(one, other.box), near_one = items_near(other, one.box);
      for (std::uint32_t a = 0; a < near_other.count; ++a)
        for (std::uint32_t b = 0; b < near_one.count; ++b) look(*near_other.item[a], *near_one.item[b]);
    }
  }
}

/// visit(part, f, g), f < g, for each pair once, on the thread of the part.
template <class Visit>
void CrossingSearch::for_all(const Threads& threads, Visit&& visit) const {
  threads.run(parts_.size(), [&](std::size_t part) {
    const auto look = [&](const Item& one, const Item& other) {
      if (!BoxTree::overlap(one.box, other.box) || shares_clear(one.corners, other.corners)) return;
      const std::uint32_t f = std::min(one.number, other.number), g = std::max(one.number, other.number);
      if (intersect(vertices_, triangles_[f], triangles_[g])) visit(part, f, g);
    };
    tree_.join(parts_[part], [&](const BoxTree::Node& p, const BoxTree::Node& q) { look_at_pairs(p, q, look); });
  });
}

std::uint64_t CrossingSearch::count(const Threads& threads) const {
  std::vector<std::uint64_t> pairs(parts_.size(), 0);
  for_all(threads, [&](std::size_t part, std::uint32_t, std::uint32_t) { ++pairs[part]; });
  return std::accumulate(pairs.begin(), pairs.end(), std::uint64_t{0});
}

std::vector<CrossingSearch::Pair> CrossingSearch::all(const Threads& threads) const {
  std::vector<std::vector<Pair>> pairs(parts_.size());
  for_all(threads, [&](std::size_t part, std::uint32_t f, std::uint32_t g) { pairs[part].push_back({f, g}); });
  std::vector<Pair> joined;
  for (const auto& part : pairs) joined.insert(joined.end(), part.begin(), part.end());
  return joined;
}

std::vector<CrossingSearch::Pair> CrossingSearch::of_changed(std::span<const std::uint32_t> changed,
                                                             const Threads& threads) {
  state_.resize(triangles_.size(), State::same);
  for (const std::uint32_t t : changed_) state_[t] = State::changed;
  for (const std::uint32_t t : changed) {
    if (state_[t] == State::same) changed_.push_back(t);
    state_[t] = State::asked;
  }
  // What moved is in a tree of its own; it counts no more where it was.
  std::vector<std::uint32_t> number;
  std::vector<Box3> boxes;
  for (const std::uint32_t t : changed_) {
    if (degenerate_[t]) continue;
    number.push_back(t);
    boxes.push_back(box_of(t));
  }
  const BoxTree moved = boxes.empty() ? BoxTree() : BoxTree(boxes, threads);
  constexpr std::size_t block = 256;
  std::vector<std::vector<Pair>> pairs((changed.size() + block - 1) / block);
  for_blocks(threads, changed.size(), block, [&](std::size_t begin, std::size_t end, std::size_t b) {
    for (const std::uint32_t f : changed.subspan(begin, end - begin)) {
      if (degenerate_[f]) continue;
      const Box3 box = box_of(f);
      const auto look = [&](std::uint32_t g, const Box3& other) {
        if (BoxTree::overlap(box, other) && intersect(vertices_, triangles_[f], triangles_[g]))
          pairs[b].push_back({f, g});
      };
      tree_.overlapping_leaves(box, [&](std::uint32_t place) {
        const Star& star = stars_[place];
        if (!BoxTree::overlap(box, star.box)) return true;
        for (std::uint32_t k = star.begin; k < star.end; ++k)
          if (state_[items_[k].number] == State::same) look(items_[k].number, items_[k].box);
        return true;
      });
      moved.overlapping_leaves(box, [&](std::uint32_t place) {
        const std::uint32_t item = moved.order()[place], g = number[item];
        if (state_[g] == State::changed || f < g) look(g, boxes[item]);
        return true;
      });
    }
  });
  std::vector<Pair> joined;
  for (const auto& part : pairs) joined.insert(joined.end(), part.begin(), part.end());
  return joined;
}

Box3 CrossingSearch::box_of(std::uint32_t t) const {
  const auto& [a, b, c] = triangles_[t];
  return box_around(vertices_[a], vertices_[b], vertices_[c]);
}

} // namespace eigencrust
