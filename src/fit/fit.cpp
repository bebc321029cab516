// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "fit/place_fits.h"
#include "geometry/nearest.h"
#include "numerics/quantile.h"
#include "surface/fans.h"

namespace eigencrust {
namespace {

// Noise of less than 0.1 spacings cannot be told from curvature at one place: clean statues read as 0.09 in places. But
// noise is everywhere: a quarter of the vertices of clean shapes read as none, of noise of 0.1 spacings as 0.04 or
// more.
constexpr float much_noise_in_spacings = 0.1f, some_noise_in_spacings = 0.03f;
constexpr double share_with_much = 0.1, share_with_some = 0.75;
// Tips and edges read as free of noise, for they have no flat neighbourhood; they are about that many edges wide.
constexpr int edges_around = 10;

// Steps of smoothing before the first fit, and of the areas around that its normals are summed over.
constexpr int smoothing_steps = 5;
constexpr double tangling_noise_in_spacings = 0.5;
constexpr int normal_steps = 10;
// The vertex next to a sample is found from one in so many, along edges.
constexpr std::size_t in_tree = 2;
// The second fits start from the places and normals of the first, which may be coarse; a third takes off nothing any
// more.
constexpr std::array<FitEffort, 2> efforts{{{25, 3}, {50, 6}}};
// In units of widths, squared: what is less than that about a fit is no misfit.
constexpr double least_misfit = 1e-3;
// Of all planes: a direction that fewer lie across is left as it is. Slopes of smooth places are less than that.
constexpr double least_across = 0.05;
// Widths are in units of the noise, or of so many spacings where that is more: fewer samples make no fit.
constexpr double least_unit_in_spacings = 0.7;
// The noise of a place is no more than that of most of the places around, which are those of a cluster so many levels
// up.
constexpr std::size_t levels_of_usual_noise = 3;
constexpr double lowest_share = 0.05;
// Of noise alone, measured by narrow fits with six degrees of freedom, the quantile of that share is so much of the
// mean (chi-squared).
constexpr double lowest_of_noise = 0.27;
// What fits to clean samples leave of their shape, in spacings: where noise was measured, and where it was not.
constexpr double shape_left_beside_noise = 0.03, shape_left = 0.05;

/// Laplacian steps, in which vertices may come to lie on one another: nothing but a start. Rims stay.
/// \param share of each vertex: how far it goes towards the middle of its neighbours, in [0, 1]
std::vector<Vec3> smoothed(std::vector<Vec3> vertices, const SurfaceFans& fans, std::span<const double> share,
                           const Threads& threads) {
  std::vector<Vec3> next(vertices.size());
  const std::vector<std::uint8_t> at_rim = fans.rim_vertices(threads);
  for (int step = 0; step < smoothing_steps; ++step) {
    for_each_index(threads, vertices.size(), [&](std::size_t v) {
      next[v] = vertices[v];
      if (at_rim[v]) return;
      Vec3 sum;
      for (const auto& wing : fans[v]) sum = sum + (vertices[wing.next] - vertices[v]);
      next[v] = vertices[v] + (share[v] / static_cast<double>(fans[v].size())) * sum;
    });
    vertices.swap(next);
  }
  return vertices;
}

/// From the areas of the triangles around, which are summed over some edges: those of folds cancel.
std::vector<Vec3> averaged_normals(std::span<const Vec3> vertices, const SurfaceFans& fans, const Threads& threads) {
  std::vector<Vec3> area(vertices.size()), next(area.size());
  for_each_index(threads, area.size(), [&](std::size_t v) {
    for (const auto& wing : fans[v])
      area[v] = area[v] + cross(vertices[wing.next] - vertices[v], vertices[wing.last] - vertices[v]);
  });
  for (int step = 0; step < normal_steps; ++step) {
    for_each_index(threads, area.size(), [&](std::size_t v) {
      next[v] = area[v];
      for (const auto& wing : fans[v]) next[v] = next[v] + area[wing.next];
      next[v] = (1 / static_cast<double>(1 + fans[v].size())) * next[v];
    });
    area.swap(next);
  }
  for (Vec3& n : area)
    if (const double length = norm(n); length > 0) n = (1 / length) * n;
  return area;
}

Vec3 limited(const Vec3& from, const Vec3& to, double farthest) {
  const double length = distance(from, to);
  return length > farthest ? from + (farthest / length) * (to - from) : to;
}

/// Does the model read more noise at the vertex than that many spacings?
bool reads_more(const Surface& surface, const SampleModel& model, std::size_t v, float spacings) {
  const SampleIndex s = surface.sample_of[v];
  return model.input_noise[s] > spacings * model.spacing[s];
}

/// Which pieces are noisy, by the samples' readings at their vertices: much in a part of the piece, or some nearly
/// everywhere, for curvature is read as noise only in places.
class NoisyPieces {
 public:
  NoisyPieces(const Surface& surface, const SurfaceFans& fans, const SampleModel& model) : piece_(fans.pieces()) {
    struct Counts {
      std::uint32_t all = 0, some = 0, much = 0;
    };
    std::vector<Counts> counts(1 + *std::max_element(piece_.begin(), piece_.end()));
    for (std::size_t v = 0; v < piece_.size(); ++v) {
      Counts& here = counts[piece_[v]];
      ++here.all;
      here.some += reads_more(surface, model, v, some_noise_in_spacings);
      here.much += reads_more(surface, model, v, much_noise_in_spacings);
    }
    for (const Counts& c : counts)
      least_.push_back(c.some > share_with_some * c.all   ? some_noise_in_spacings
                       : c.much > share_with_much * c.all ? much_noise_in_spacings
                                                          : std::numeric_limits<float>::infinity());
  }

  /// In spacings; less is none.
  [[nodiscard]] float least_noise(std::size_t v) const { return least_[piece_[v]]; }

 private:
  std::vector<std::uint32_t> piece_; ///< of each vertex
  std::vector<float> least_;         ///< of each piece
};

std::vector<float> noise_at_vertices(const Surface& surface, const SurfaceFans& fans, const SampleModel& model,
                                     const Threads& threads) {
  const std::size_t n = surface.mesh.vertices.size();
  std::vector<float> noise(n, 0);
  std::size_t quiet = 0;
  while (quiet < n && !reads_more(surface, model, quiet, some_noise_in_spacings)) ++quiet;
  if (quiet == n) return noise;
  const NoisyPieces pieces(surface, fans, model);
  for_each_index(threads, n, [&](std::size_t v) {
    if (reads_more(surface, model, v, pieces.least_noise(v))) noise[v] = model.input_noise[surface.sample_of[v]];
  });
  if (std::none_of(noise.begin(), noise.end(), [](float s) { return s > 0; })) return noise;
  std::vector<float> next(n);
  for (int edge = 0; edge < edges_around; ++edge) {
    for_each_index(threads, n, [&](std::size_t v) {
      next[v] = noise[v];
      if (noise[v] > 0) return;
      for (const auto& wing : fans[v]) next[v] = std::max(next[v], noise[wing.next]);
    });
    noise.swap(next);
  }
  return noise;
}

/// A symmetric matrix, by its six entries.
struct Symmetric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  /// + w n nᵀ
  void add(double w, const Vec3& n) {
    const Vec3 m = w * n;
    xx += m.x * n.x;
    xy += m.x * n.y;
    xz += m.x * n.z;
    yy += m.y * n.y;
    yz += m.y * n.z;
    zz += m.z * n.z;
  }
  [[nodiscard]] Vec3 operator*(const Vec3& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};

/// The way to where some planes intersect, by least squares: to the edge between two, and along their normal where all
/// are about the same.
/// \param normals weighted sum of n nᵀ \param total of the weights, > 0 \param way weighted sum of the ways to each
Vec3 towards_all(const Vec3& way, const Symmetric& normals, double total) {
  const double share = 1 / total, ridge = least_across; // shares, for sums can be too small for a third power
  const Symmetric m{share * normals.xx + ridge, share * normals.xy, share * normals.xz,
                    share * normals.yy + ridge, share * normals.yz, share * normals.zz + ridge};
  const Symmetric adjugate{m.yy * m.zz - m.yz * m.yz, m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy,
                           m.xx * m.zz - m.xz * m.xz, m.xy * m.xz - m.xx * m.yz, m.xx * m.yy - m.xy * m.xy};
  const double determinant = m.xx * adjugate.xx + m.xy * adjugate.xy + m.xz * adjugate.xz; // > 0: the ridge is
  return (share / determinant) * (adjugate * way);
}

/// Which vertex is next to a sample: the tree has some of them, from there edges lead on.
class NearestVertex {
 public:
  NearestVertex(std::span<const Vec3> position, const SurfaceFans& fans) : position_(position), fans_(fans) {
    for (std::size_t v = 0; v < position.size(); v += in_tree) some_.push_back(position[v]);
    tree_.emplace(some_);
  }

  [[nodiscard]] std::uint32_t operator()(const Vec3& sample) const {
    std::array<std::uint32_t, starts> start{};
    std::array<double, starts> square{};
    const std::size_t found = tree_->nearest(sample, starts, start.data(), square.data());
    std::uint32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < found; ++k) {
      const std::uint32_t v = along_edges(static_cast<std::uint32_t>(start[k] * in_tree), sample);
      if (const double square_here = squared_norm(position_[v] - sample); square_here < least) {
        least = square_here;
        best = v;
      }
    }
    return best;
  }

 private:
  /// From vertex to vertex while a neighbour is nearer.
  [[nodiscard]] std::uint32_t along_edges(std::uint32_t v, const Vec3& sample) const {
    double least = squared_norm(position_[v] - sample);
    for (std::uint32_t from = ClusterPyramid::no_vertex; from != v;) {
      from = v;
      for (const auto& wing : fans_[from])
        if (const double square = squared_norm(position_[wing.next] - sample); square < least) {
          least = square;
          v = wing.next;
        }
    }
    return v;
  }

  static constexpr std::size_t starts = 2; // of other sides, where a wall is thin
  std::span<const Vec3> position_;
  const SurfaceFans& fans_;
  std::vector<Vec3> some_;
  std::optional<PointTree> tree_;
};

/// The middle of the noise, from fits at places spread over the surface.
class SurfaceFit {
 public:
  SurfaceFit(const Surface& surface, const SurfaceFans& fans, std::span<const Vec3> samples, const SampleModel& model,
             std::span<const float> noise, const Threads& threads)
      : surface_(surface),
        samples_(samples),
        model_(model),
        noise_(noise),
        threads_(threads),
        fans_(fans),
        position_(smoothed(surface.mesh.vertices, fans, shares_of_steps(), threads)),
        trust_(position_.size(), 0),
        sigma_(position_.size(), 0) {
    start_ = position_;
    for (std::size_t v = 0; v < position_.size(); ++v)
      if (noise_[v] < 0) position_[v] = own_sample(v); // it stays, but says which side its sample is on
    std::optional<NearestVertex> nearest;
    threads.run(2, [&](std::size_t k) { // one thread builds the tree
      if (k == 0)
        nearest.emplace(position_, fans);
      else
        normal_ = averaged_normals(start_, fans, threads);
    });
    vertex_of_ = vertices_of_samples(*nearest);
  }

  std::vector<Vec3> run() {
    ClusterPyramid clusters(fans_, position_, normal_, samples_, vertex_of_, threads_);
    for (const FitEffort& effort : efforts) {
      const bool is_first = chosen_.width.empty();
      if (!is_first) clusters.set_normals(normal_, threads_);
      const FitPlaces places = make_places(clusters);
      if (is_first) {
        chosen_ = chosen_widths(places, clusters, threads_);
        find_usual_noise(clusters);
      }
      move(clusters, fits_of_widths(places, clusters, chosen_.width, effort, threads_));
    }
    std::vector<Vec3> result(position_.size());
    for (std::size_t v = 0; v < result.size(); ++v) {
      result[v] = own_sample(v);
      if (noise_[v] >= 0)
        result[v] = limited(result[v], result[v] + trust_[v] * (position_[v] - slid(v) - result[v]), farthest(v));
    }
    return result;
  }

 private:
  /// Of the way to the middle of its neighbours that each vertex goes in a step of the start: all of it where noise
  /// tangles the triangles, little where samples already lie side by side, for there they would only slide.
  [[nodiscard]] std::vector<double> shares_of_steps() const {
    std::vector<double> share(surface_.mesh.vertices.size());
    for (std::size_t v = 0; v < share.size(); ++v)
      share[v] = std::min(1.0, noise_at(v) / (tangling_noise_in_spacings * spacing_at(v)));
    return share;
  }
  [[nodiscard]] const Vec3& own_sample(std::size_t v) const { return samples_[surface_.sample_of[v].value]; }
  [[nodiscard]] double spacing_at(std::size_t v) const {
    return static_cast<double>(model_.spacing[surface_.sample_of[v]]);
  }
  [[nodiscard]] double noise_at(std::size_t v) const { return std::max(0.0, static_cast<double>(noise_[v])); }
  /// What noise explains, and where the fits agree a spacing, which is that around or the typical one of the cloud,
  /// whichever is less: where samples are rare none of them is noise.
  [[nodiscard]] double farthest(std::size_t v) const {
    return static_cast<double>(noise_bound) * sigma_[v] + trust_[v] * std::min(spacing_at(v), model_.typical_spacing);
  }

  /// How far the start slid beside the surface, beyond what the noise that the fits find explains: none of it is for
  /// the better.
  [[nodiscard]] Vec3 slid(std::size_t v) const {
    const Vec3 way = start_[v] - own_sample(v), beside = way - dot(way, normal_[v]) * normal_[v];
    const double length = norm(beside), most = static_cast<double>(noise_bound) * sigma_[v];
    return length > most ? (1 - most / length) * beside : Vec3{};
  }

  /// Samples are on the side of the vertex next to them; those farther off than noise explains are on none.
  [[nodiscard]] std::vector<std::uint32_t> vertices_of_samples(const NearestVertex& nearest) const {
    std::vector<std::uint32_t> vertex_of(samples_.size(), ClusterPyramid::no_vertex);
    for (std::uint32_t v = 0; v < position_.size(); ++v) vertex_of[surface_.sample_of[v].value] = v;
    for_each_index(
        threads_, samples_.size(),
        [&](std::size_t s) {
          std::uint32_t v = vertex_of[s];
          if (v == ClusterPyramid::no_vertex) v = nearest(samples_[s]);
          const double beside = std::fabs(dot(samples_[s] - position_[v], normal_[v]));
          const double far = static_cast<double>(noise_bound) * noise_at(v) + spacing_at(v);
          vertex_of[s] = beside < far ? v : ClusterPyramid::no_vertex;
        },
        costly_block);
    return vertex_of;
  }

  [[nodiscard]] FitPlaces make_places(const ClusterPyramid& clusters) const {
    const ClusterLevel &fine = clusters[0], &level = clusters[FitPlaces::level];
    const std::size_t n = level.cluster.size();
    FitPlaces places{std::vector<Vec3>(n),   level.normal,           std::vector<double>(n),
                     std::vector<double>(n), std::vector<double>(n), std::vector<std::uint8_t>(n, 0)};
    std::vector<double> count(n, 0);
    for (std::size_t v = 0; v < position_.size(); ++v) {
      const std::uint32_t p = fine.parent[v];
      places.position[p] = places.position[p] + position_[v];
      places.noise[p] += noise_at(v);
      places.spacing[p] += spacing_at(v);
      places.wanted[p] |= noise_[v] >= 0;
      count[p] += 1;
    }
    for (std::size_t p = 0; p < n; ++p) {
      places.position[p] = (1 / count[p]) * places.position[p];
      places.noise[p] /= count[p];
      places.spacing[p] /= count[p];
      places.unit[p] = std::max(places.noise[p], least_unit_in_spacings * places.spacing[p]);
    }
    return places;
  }

  /// Deviation of the noise of each cluster of a coarse level, by the lowest of the narrowest fits of its places and of
  /// those beside it: fits across edges take shape for noise, and in a small body nearly all may be such.
  void find_usual_noise(const ClusterPyramid& clusters) {
    const std::vector<double>& variance = chosen_.noise_variance;
    const std::size_t level = coarse(clusters), n = clusters[level].cluster.size();
    const auto of_places = build_rows<double>(n, [&](auto&& visit) {
      for (std::uint32_t p = 0; p < variance.size(); ++p)
        if (variance[p] >= 0) visit(clusters.ancestor(FitPlaces::level, p, level), variance[p]);
    });
    constexpr double unknown = std::numeric_limits<double>::infinity();
    std::vector<double> lowest(n, unknown);
    for_each_index(threads_, n, [&](std::size_t c) {
      std::vector<double> around(of_places[c].begin(), of_places[c].end());
      for (const std::uint32_t beside : clusters[level].neighbours[c])
        around.insert(around.end(), of_places[beside].begin(), of_places[beside].end());
      if (!around.empty()) lowest[c] = std::sqrt(quantile(around, lowest_share) / lowest_of_noise);
    });
    usual_ = lowest; // between many edges the next cluster may know better
    for (std::size_t c = 0; c < n; ++c) {
      for (const std::uint32_t beside : clusters[level].neighbours[c]) usual_[c] = std::min(usual_[c], lowest[beside]);
      if (usual_[c] == unknown) usual_[c] = 0;
    }
  }
  [[nodiscard]] static std::size_t coarse(const ClusterPyramid& clusters) {
    return std::min(FitPlaces::level + levels_of_usual_noise, clusters.levels() - 1);
  }

  /// Each vertex to where the fits around it meet. Those of one place have the same fits around.
  void move(const ClusterPyramid& clusters, const PlaceFits& fits) {
    const ClusterLevel &places = clusters[FitPlaces::level], &wider = clusters[FitPlaces::level + 1];
    constexpr std::size_t block = 256;
    for_blocks(threads_, places.cluster.size(), block, [&](std::size_t begin, std::size_t end, std::size_t) {
      std::vector<const LocalQuadric*> around;
      const auto take = [&](std::uint32_t p) {
        if (fits.fit[p].variance > 0) around.push_back(&fits.fit[p]);
      };
      for (std::size_t p = begin; p < end; ++p) {
        around.clear();
        if (const std::uint32_t above = places.parent[p]; fits.wide[above]) {
          take(wider.seed[above]);
          for (const std::uint32_t c : wider.neighbours[above]) take(wider.seed[c]);
        } else {
          take(static_cast<std::uint32_t>(p));
          for (const std::uint32_t q : places.neighbours[p]) take(q);
        }
        if (around.empty()) continue;
        const double usual =
            usual_[clusters.ancestor(FitPlaces::level, static_cast<std::uint32_t>(p), coarse(clusters))];
        for (const std::uint32_t v : places.children[p]) move(v, around, chosen_.width[p], usual);
      }
    });
  }

  /// \param width of the place, in its units \param usual deviation of the noise around
  void move(std::uint32_t v, std::span<const LocalQuadric* const> around, double width, double usual) {
    if (noise_[v] < 0 || !(squared_norm(normal_[v]) > 0)) return;
    double total = 0, squares = 0, noise = 0, error = 0;
    Vec3 way, normal;
    Symmetric normals;
    const double spacing = spacing_at(v), unit = std::max(noise_at(v), least_unit_in_spacings * spacing);
    const double radius = width * unit, flat = 1 / (radius * radius), per_square = 1 / (unit * unit);
    const Vec3 strayed = position_[v] - own_sample(v);
    const double moved = norm(strayed);
    for (const LocalQuadric* const one : around) {
      const LocalQuadric& fit = *one;
      const double nearness = 1 - squared_norm(fit.origin - position_[v]) * flat;
      if (!(nearness > 0) || !(dot(fit.normal, normal_[v]) > 0)) continue;
      // Along the normal of the fit: along another one what lies beside an edge would slide beyond it.
      const auto [ahead, across] = fit.foot(position_[v]);
      // A surface farther off than that is another side, whose edge with this one is not here.
      const double far = moved + spacing + 2 * std::sqrt(fit.noise_variance);
      const double agreement = 1 - ahead * ahead / (far * far);
      if (!(agreement > 0)) continue;
      // Fits across an edge fit badly: they leave the word to those beside it.
      const double misfit = fit.noise_variance * per_square + least_misfit, square = misfit * misfit;
      const double word = nearness * agreement, w = word * word / (square * square * fit.variance);
      if (!(w > 0)) continue;
      way = way + w * ahead * across;
      normals.add(w, across);
      squares += w * ahead * ahead;
      noise += w * fit.noise_variance;
      error += w * fit.noise_variance * fit.variance;
      // Which side of an edge its sample is from says that sample.
      const double beside = ahead + dot(across, strayed), own = misfit / (misfit + beside * beside * per_square);
      normal = normal + (w * own * own) * across;
      total += w;
    }
    if (!(total > 0)) return;
    if (const double length = norm(normal); length > 0) normal_[v] = (1 / length) * normal;
    const Vec3 step = towards_all(way, normals, total);
    position_[v] = position_[v] + step;
    // How far the fits miss one another there shows how far off they are where the shape is finer or sharper than them.
    const double apart = (squares - dot(step, way)) / total,
                 shape = (noise_[v] > 0 ? shape_left_beside_noise : shape_left) * spacing;
    const double variance = std::min(noise / total, usual * usual) - shape * shape;
    sigma_[v] = std::sqrt(std::max(0.0, variance));
    trust_[v] = variance > 0 ? variance / (variance + std::max(0.0, apart - error / total)) : 0;
  }

  const Surface& surface_;
  std::span<const Vec3> samples_;
  const SampleModel& model_;
  std::span<const float> noise_;
  const Threads& threads_;
  const SurfaceFans& fans_;
  std::vector<Vec3> position_, normal_;  ///< of each vertex
  std::vector<Vec3> start_;              ///< of each vertex
  std::vector<std::uint32_t> vertex_of_; ///< of each sample
  std::vector<double> trust_; ///< in the fit, the rest is the sample's; 1: its error is nothing beside the noise
  std::vector<double> sigma_; ///< of the noise that the fits find
  ChosenWidths chosen_;
  std::vector<double> usual_; ///< deviation of the noise of each coarse cluster
};

} // namespace

std::vector<float> noise_to_fit(const Surface& surface, const SurfaceFans& fans, const SampleModel& model,
                                SurfaceKind kind, const Threads& threads) {
  if (kind == SurfaceKind::samples || kind == SurfaceKind::delaunay) return {};
  std::vector<float> noise = noise_at_vertices(surface, fans, model, threads);
  if (kind == SurfaceKind::fitted) return noise;
  if (std::none_of(noise.begin(), noise.end(), [](float sigma) { return sigma > 0; })) return {};
  for (float& sigma : noise)
    if (sigma == 0) sigma = -1;
  return noise;
}

std::vector<Vec3> fitted_vertices(const Surface& surface, const SurfaceFans& fans, std::span<const Vec3> samples,
                                  const SampleModel& model, std::span<const float> noise, const Threads& threads) {
  return SurfaceFit(surface, fans, samples, model, noise, threads).run();
}

} // namespace eigencrust
