// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/nearest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <tuple>

namespace eigencrust {
namespace {

struct Points {
  std::span<const Vec3> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return axis == 0 ? points[i].x : axis == 1 ? points[i].y : points[i].z;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, std::uint32_t>;

} // namespace

namespace {

/// The k nearest so far in a heap: nanoflann's own result set shifts on average half of them at each find,
/// which is quick for a handful only.
class NearestHeap {
 public:
  NearestHeap(std::size_t k, std::vector<std::pair<double, std::uint32_t>>& heap) : k_(k), heap_(heap) {
    heap_.clear();
  }
  [[nodiscard]] std::size_t size() const { return heap_.size(); }
  [[nodiscard]] bool full() const { return heap_.size() == k_; }
  [[nodiscard]] double worstDist() const { return full() ? heap_.front().first : std::numeric_limits<double>::max(); }
  bool addPoint(double square, std::uint32_t index) {
    if (full()) {
      if (!(std::pair(square, index) < heap_.front())) return true;
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.pop_back();
    }
    heap_.emplace_back(square, index);
    std::push_heap(heap_.begin(), heap_.end());
    return true;
  }

 private:
  std::size_t k_;
  std::vector<std::pair<double, std::uint32_t>>& heap_;
};

constexpr std::size_t a_handful = 32;

} // namespace

struct PointTree::Impl {
  Points points;
  Tree tree;

  explicit Impl(std::span<const Vec3> p) : points{p}, tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {
    tree.buildIndex();
  }
};

PointTree::PointTree(std::span<const Vec3> points) : impl_(std::make_unique<Impl>(points)) {}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;

std::size_t PointTree::nearest(const Vec3& query, std::size_t k, std::uint32_t* index, double* squared_distance) const {
  const std::array<double, 3> q{query.x, query.y, query.z};
  if (k <= a_handful) return impl_->tree.knnSearch(q.data(), k, index, squared_distance);
  std::vector<std::pair<double, std::uint32_t>> heap;
  heap.reserve(k);
  NearestHeap found(k, heap);
  impl_->tree.findNeighbors(found, q.data(), nanoflann::SearchParams());
  std::sort_heap(heap.begin(), heap.end());
  for (std::size_t i = 0; i < heap.size(); ++i) std::tie(squared_distance[i], index[i]) = heap[i];
  return heap.size();
}

std::vector<std::uint32_t> PointTree::within(const Vec3& query, double radius) const {
  const std::array<double, 3> q{query.x, query.y, query.z};
  std::vector<std::pair<std::uint32_t, double>> found;
  const nanoflann::SearchParams unsorted(32, 0.0f, false);
  impl_->tree.radiusSearch(q.data(), radius * radius, found, unsorted);
  std::vector<std::uint32_t> index;
  index.reserve(found.size());
  for (const auto& [i, square] : found) index.push_back(i);
  return index;
}

std::vector<double> nearest_other(std::span<const Vec3> points, const Threads& threads) {
  if (points.size() < 2) return {};
  const PointTree tree(points);
  std::vector<double> result(points.size());
  for_each_index(
      threads, points.size(),
      [&](std::size_t i) {
        std::array<std::uint32_t, 2> index{};
        std::array<double, 2> square{};
        tree.nearest(points[i], 2, index.data(), square.data());
        result[i] = std::sqrt(square[1]);
      },
      costly_block);
  return result;
}

} // namespace eigencrust
