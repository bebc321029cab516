// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that the surface passes by, taken in one tetrahedron at a time (not in the paper;
// docs/decisions/0007).
#include <algorithm>
#include <limits>

#include <eigencrust/stages.h>

#include "repair/recover.h"

namespace eigencrust {
namespace {

// Area of the three new triangles over that of the old one, minus one: 30 is a height of about 8 edges.
constexpr double max_growth = 30;
// An outlier is lonely: its nearest sample is farther away than the surface's samples are from each other.
constexpr double max_loneliness = 1.5;
// Isolated samples passed by are tips, and no outliers, when they are at most so many of those on the surface.
constexpr double share_of_tips = 0.005;
// Beside outliers so much of the share.
constexpr double share_beside_outliers = 0.4;

class Recovery {
 public:
  Recovery(const Tetrahedralization& t, const VertexStars& stars, const Labels& known, TetrahedronLabels& labels)
      : t_(t), stars_(stars), known_(known), labels_(labels) {}

  bool is_passed_by(SampleIndex s) const {
    for (const TetrahedronIndex tetrahedron : stars_[s])
      if (labels_[tetrahedron] != labels_[stars_[s].front()]) return false;
    return true;
  }

  /// The tetrahedron of the star with a surface triangle opposite s that grows least when it changes
  /// sides; invalid if there is none below the limit.
  TetrahedronIndex best_tetrahedron(SampleIndex s) const {
    const Label side = labels_[stars_[s].front()];
    const double alone = nearest_neighbour(s);
    double least = max_growth;
    TetrahedronIndex best;
    for (const TetrahedronIndex tetrahedron : stars_[s]) {
      if (known_[tetrahedron] != Label::unlabelled) continue;
      const auto& v = t_.tetrahedra[tetrahedron];
      std::size_t k = 0;
      while (v[k] != s) ++k;
      const TetrahedronIndex across = t_.neighbours[tetrahedron][k];
      if (!across.valid() || labels_[across] == side) continue;
      const double growth = growth_of(v, k);
      if (growth < least && alone <= max_loneliness * spacing_at_face(v, k)) {
        least = growth;
        best = tetrahedron;
      }
    }
    return best;
  }

  void take_in(TetrahedronIndex tetrahedron) { labels_.turn(tetrahedron); }

 private:
  double nearest_neighbour(SampleIndex s) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const TetrahedronIndex tetrahedron : stars_[s])
      for (const SampleIndex v : t_.tetrahedra[tetrahedron])
        if (v != s) nearest = std::min(nearest, distance(t_.positions[s], t_.positions[v]));
    return nearest;
  }

  /// The largest distance from a vertex of the face opposite `apex` to the sample nearest to it.
  double spacing_at_face(const std::array<SampleIndex, 4>& v, std::size_t apex) const {
    double spacing = 0;
    for (std::size_t k = 1; k < 4; ++k) spacing = std::max(spacing, nearest_neighbour(v[(apex + k) % 4]));
    return spacing;
  }

  double growth_of(const std::array<SampleIndex, 4>& v, std::size_t apex) const {
    const Vec3 &a = t_.positions[v[(apex + 1) % 4]], &b = t_.positions[v[(apex + 2) % 4]],
               &c = t_.positions[v[(apex + 3) % 4]], &s = t_.positions[v[apex]];
    const auto twice_area = [](const Vec3& p, const Vec3& q, const Vec3& r) { return norm(cross(q - p, r - p)); };
    return (twice_area(a, b, s) + twice_area(b, c, s) + twice_area(c, a, s)) / twice_area(a, b, c) - 1;
  }

  const Tetrahedralization& t_;
  const VertexStars& stars_;
  const Labels& known_;
  TetrahedronLabels& labels_;
};

} // namespace

RecoveryCounts recover_samples(const Tetrahedralization& t, const VertexStars& stars, const Labels& known,
                               std::span<const float> isolated, double max_share, TetrahedronLabels& labels) {
  if (!(max_share > 0)) return {};
  Recovery recovery(t, stars, known, labels);
  std::vector<SampleIndex> passed;
  for (std::uint32_t i = 0; i < t.sample_count; ++i) {
    if (!recovery.is_passed_by(SampleIndex{i})) continue;
    passed.push_back(SampleIndex{i});
  }
  // Isolated samples are tips of thin parts where they are few, outliers otherwise; of the others many passed by are
  // noise on either side.
  const double on_surface = static_cast<double>(t.sample_count - passed.size());
  const bool many = static_cast<double>(passed.size()) > max_share * on_surface;
  const auto is_isolated = [&](SampleIndex s) { return !isolated.empty() && isolated[s.value] > 0; };
  const auto lonely = std::count_if(passed.begin(), passed.end(), is_isolated);
  if (static_cast<double>(lonely) > share_of_tips * on_surface) std::erase_if(passed, is_isolated);
  if (many && static_cast<double>(passed.size()) > share_beside_outliers * max_share * on_surface) return {};
  RecoveryCounts counts;
  for (std::size_t before = passed.size() + 1; passed.size() < before;) {
    before = passed.size();
    std::vector<SampleIndex> left;
    for (const SampleIndex s : passed) {
      const TetrahedronIndex best = recovery.best_tetrahedron(s);
      if (best.valid())
        recovery.take_in(best);
      else
        left.push_back(s);
    }
    counts.samples += passed.size() - left.size();
    passed = std::move(left);
  }
  return counts;
}

} // namespace eigencrust
