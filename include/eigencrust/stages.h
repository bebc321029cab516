// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every stage of the method as a free function, in the paper's order: the table of contents.
/// § numbers are those of Kolluri, Shewchuk and O'Brien, Spectral Surface Reconstruction from Noisy
/// Point Clouds (SGP 2004). src/pipeline.cpp shows how they fit together.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <eigencrust/observer.h>
#include <eigencrust/options.h>
#include <eigencrust/types.h>

namespace eigencrust {

/// The distinct finite points, exactly relative to an origin, along a Hilbert curve.
struct Samples {
  Vec3 origin;
  IndexedArray<SampleIndex, Vec3> positions;
  IndexedArray<SampleIndex, std::uint32_t> source; ///< smallest row with these coordinates
  std::uint64_t duplicates = 0, nonfinite = 0;
  Box3 bounds; ///< input coordinates
};
/// \throws Error{input} for fewer than 5 distinct finite points or more than 2^32 - 16
Samples prepare_samples(std::span<const Vec3> points, const Threads& threads);

/// Median distance of a sample to its nearest sample; 0 with fewer than two.
/// With scan numbers (one per input row) only samples of the same scan count.
double median_spacing(const Samples& samples, std::span<const Vec3> points, std::span<const std::uint32_t> scan_index,
                      const Threads& threads);
/// ℓ of §3.3 from the option; 0 means off.
double resolve_grid_spacing(const GridSpacing& option, const Samples& samples, std::span<const Vec3> points,
                            std::span<const std::uint32_t> scan_index, const Threads& threads);

/// How close the samples stand, and which of them may be outliers (not in the paper; docs/decisions/0013).
struct Neighbourhoods {
  std::vector<float> spacing; ///< distance to the third nearest other sample
  double typical = 0;         ///< median of those
  double nearest = 0;         ///< median distance to the nearest other sample: the spacing of the report
  /// Distance to the 20th nearest sample where a sample is isolated: its spacing is 2.5 times the typical one
  /// and its neighbourhood is not flat. 0 for all others.
  std::vector<float> isolated;
};
Neighbourhoods sample_neighbourhoods(std::span<const Vec3> positions, const Threads& threads);

/// Standard deviation of the noise at each sample, 0 where there is none to be told from curvature; smooth
/// in space, length unit of the input (not in the paper). Isolated samples (see above; may be empty) set no scale.
IndexedArray<SampleIndex, float> noise_scale(const Samples& samples, std::span<const float> isolated,
                                             const Threads& threads);

/// §3: Delaunay tetrahedra of the samples and the corners of a cube whose half side is 10 diagonals of
/// their bounding box. Points are inserted one after the other, so one thread does it; `beside` (may be empty)
/// is called meanwhile on another, if there is one.
/// \throws Error{input} when all samples are coplanar or collinear
Tetrahedralization tetrahedralize(Samples samples, const Threads& threads, const std::function<void()>& beside = {});
VertexStars vertex_stars(const Tetrahedralization& tetrahedralization, const Threads& threads);

/// §3: the pole pair of every sample, the farthest circumcentres on either side. With `reach` (may be empty;
/// a length per sample) a sample takes its pair from the poles of all samples within reach: where noise
/// exceeds the spacing no single cell sees both sides (Alliez et al. 2007; not in the paper).
Poles find_poles(const Tetrahedralization& tetrahedralization, const VertexStars& stars, std::span<const float> reach,
                 const Threads& threads);

/// §3.1: what is known beforehand. Tetrahedra at the cube are outside (with a façade: those at its front;
/// those whose corners are all at the back are inside), as are those that hold the user's points.
/// \throws Error{usage} when one tetrahedron is named both, or an inside point lies at or beyond the cube
Labels known_labels(const Tetrahedralization& tetrahedralization, std::span<const Vec3> outside_points,
                    std::span<const Vec3> inside_points, std::optional<Axis> facade, const Threads& threads);

/// A pole's ball holds no sample, so what is deep within it (nearer to its centre than half the radius) is on the
/// pole's side of the surface: poles without a label take that of the user's points there, unless they disagree.
void name_poles(const Tetrahedralization& tetrahedralization, const Poles& poles, std::span<const Vec3> outside_points,
                std::span<const Vec3> inside_points, const Threads& threads, Labels& known);

/// What the scanner looked along when it saw a sample.
struct SightLine {
  SampleIndex sample;
  float depth = 0; ///< what begins nearer to the sample, or has a sample nearer to the line, is not crossed; length
  Vec3 target;     ///< the scanner, or a place beyond all samples in its direction; relative to the origin
};
/// One line for each place from which a sample was seen, ordered by sample, then place; duplicates count once.
/// \param depth a length per sample
/// \param left_out samples where it is > 0 have none (may be empty)
std::vector<SightLine> sight_lines(const PointCloud& cloud, const Tetrahedralization& tetrahedralization,
                                   std::span<const float> depth, std::span<const float> left_out);

/// What the lines say of the side they come from; none when they come from around, or there are none.
std::optional<OneSided> one_sided_scan(const Tetrahedralization& tetrahedralization, std::span<const SightLine> lines);

/// The tetrahedra that each line crosses, in their order along it (compressed rows).
struct SightCrossings {
  std::vector<std::uint64_t> begin; ///< number of lines + 1
  std::vector<TetrahedronIndex> tetrahedra;

  [[nodiscard]] std::span<const TetrahedronIndex> operator[](std::size_t line) const {
    return {tetrahedra.data() + begin[line], tetrahedra.data() + begin[line + 1]};
  }
};
/// §3.1: a line crosses a tetrahedron when it enters it farther than its depth from its sample, and the middle of
/// its way through is farther than that from the vertices (not in the paper; with Weights::paper vertices do not
/// matter). Those known to be outside are left out.
SightCrossings sight_crossings(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                               std::span<const SightLine> lines, Weights weights, const Labels& known,
                               const Threads& threads);

/// What makes a tetrahedron outside or inside, as in Options.
struct SightRule {
  std::uint32_t crossing_count = 2; ///< lines
  std::uint32_t behind_count = 0;   ///< samples; 0: none makes it inside
  Weights weights = Weights::evidence;
  std::span<const float> isolated = {}; ///< of each sample, see Neighbourhoods; tetrahedra at those are not made inside
};
/// §3.1: `known`, and outside for the tetrahedra without a label that enough lines cross, more than there are
/// samples right in front of them. Lines that cross what more samples lie in front of than lines cross are not
/// believed: they belong to outliers behind the surface or to scans that disagree. Inside are tetrahedra that no
/// line crosses with enough samples right in front (neither is in the paper; docs/decisions/0017). With
/// Weights::paper all lines count and nothing else.
struct SightLabels {
  Labels labels;
  std::uint64_t disbelieved = 0;         ///< lines
  std::uint64_t outside = 0, inside = 0; ///< tetrahedra that the lines made so
};
SightLabels line_of_sight(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                          std::span<const SightLine> lines, const SightCrossings& crossings, const SightRule& rule,
                          const Labels& known, const Threads& threads);
/// How many lines cross a tetrahedron that `labels` call inside.
std::uint64_t contradicting_lines(const SightCrossings& crossings, const Labels& labels, const Threads& threads);

/// §3.3: tetrahedra whose longest edge is < 4 × the mean grid spacing at their samples, none with a cube
/// corner. \param grid_spacing a length per sample; empty: none is questionable
std::vector<std::uint8_t> questionable_tetrahedra(const Tetrahedralization& tetrahedralization,
                                                  std::span<const float> grid_spacing, const Threads& threads);

/// §3.1: the signed graph on the poles with the outside supernode (0) and, when something is known to be
/// inside, the inside supernode (1). Poles of tetrahedra in `left_out` (may be empty) are no nodes. The pole
/// pairs of `isolated` samples (may be empty) count only as far as their cells are long.
PoleGraph pole_graph(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
                     const Labels& known, std::span<const std::uint8_t> left_out, std::span<const float> isolated,
                     const Threads& threads);

/// Called now and then with the fraction done; may throw to cancel.
using Checkpoint = std::function<void(double)>;

/// §3.2: the eigenvector of the smallest eigenvalue of L x = λ D x. Components of the graph that hold no
/// supernode are solved on their own; the sign of each of those is arbitrary.
/// \param graph     lends its edges to the solver and has them back in the end; not if an exception leaves
/// \param component receives the component of every node, 0 being the one of the supernodes; may be null
Partition partition_poles(PoleGraph& graph, const SolverOptions& options, const Threads& threads,
                          std::vector<std::uint32_t>* component = nullptr, const Checkpoint& checkpoint = {});

/// §3.2: labels from the signs of the partition, added to what is known. Nodes of components without a
/// supernode take the side that their labelled neighbours by face vote for by two thirds, else none.
/// A node gets no label when its neighbours' agreement Σ w x / Σ |w x| with its own sign is below
/// min_agreement (0: all get one; not in the paper, see docs/decisions).
struct PoleLabels {
  Labels labels;
  bool reversed = false;               ///< the vote overruled the outside supernode's own sign
  double vote = 0;                     ///< evidence for the sign chosen, in [-1, 1]; 1 = unanimous
  std::uint64_t left_to_stage_two = 0; ///< poles of components whose side is open
  std::uint64_t contradicted = 0;      ///< poles without a label because their neighbours disagree
};
PoleLabels label_poles(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
                       const PoleGraph& graph, const Partition& partition, std::span<const std::uint32_t> component,
                       const Labels& known, GlobalSign global_sign, double min_agreement, const Threads& threads);

/// §3.3: removes the labels of questionable tetrahedra but for those known beforehand.
/// \return how many
std::uint64_t unlabel_questionable(std::span<const std::uint8_t> questionable, const Labels& known, Labels& labels);

/// §3.4: one node per unlabelled tetrahedron, supernodes for all outside (0) and all inside (1) ones;
/// a face weighs longest/shortest of its edges. With pole_ties > 0 each node is also joined to the
/// supernodes by that factor times Σ e^(4 cos ∠(c s p)) over the poles p of its samples s whose two poles
/// have opposite labels, c being its circumcentre; samples with a reach (may be empty) > 0 are too noisy for
/// that (not in the paper).
TetrahedronGraph tetrahedron_graph(const Tetrahedralization& tetrahedralization, const Poles& poles,
                                   const Labels& labels, double pole_ties, std::span<const float> reach,
                                   const Threads& threads);

/// §3.4: `eigenvector` as in the paper; `harmonic`: outside fixed at +1, inside at -1.
Partition partition_tetrahedra(SignedGraph graph, SecondStage method, const SolverOptions& options,
                               const Threads& threads, const Checkpoint& checkpoint = {});

/// Every tetrahedron labelled, with the stage-two component behind each label (+1 and -1 times the
/// supernodes' magnitude for those labelled before).
struct FinalLabels {
  Labels labels;
  IndexedArray<TetrahedronIndex, float> value; ///< > 0 outside
  bool supernodes_agree = false;               ///< both supernodes on one side: the vector is useless
};
FinalLabels label_tetrahedra(const TetrahedronGraph& graph, const Partition& partition, Labels labels);

/// Where noise exceeds the spacing (`reach` > 0, see find_poles): moves the boundary between inside and outside to
/// the middle of the samples, half of them on either side, and smooths it at the scale of a few spacings. The harmonic
/// values leave it on the inner side, and nowhere in thin parts. Only tetrahedra that the first stage left open
/// (`first`) change (not in the paper).
struct CentringCounts {
  std::uint64_t relabelled = 0; ///< tetrahedra
};
CentringCounts centre_in_noise(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                               std::span<const float> reach, std::span<const float> isolated, const Labels& first,
                               const Threads& threads, FinalLabels& labels);

/// §3.5: relabels tetrahedra until the surface is a manifold. With the paper's rule labels only go from
/// inside to outside; with `cheapest` a tetrahedron may once go the other way, so both end. What is `known` gives way
/// only where nothing else does.
struct ManifoldCounts {
  std::uint64_t edges = 0, vertices = 0; ///< repairs of either kind
  std::uint64_t relabelled = 0;          ///< tetrahedra
  std::uint64_t overruled = 0;           ///< tetrahedra that are not what they are known to be
};
ManifoldCounts make_manifold(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
                             const Labels& known, ManifoldRule rule, FinalLabels& labels, const Threads& threads,
                             const Checkpoint& checkpoint = {});

/// Closes handles that no pole vouches for: along short loops of the surface the tetrahedra that the first stage
/// left open (`first`) change sides, if that takes a handle away and leaves a manifold; the cheaper of filling and
/// cutting, by Σ |value|. Expects a manifold (not in the paper).
struct HandleCounts {
  std::uint64_t closed = 0;
};
HandleCounts close_handles(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
                           const Labels& first, const Labels& known, std::span<const float> grid_spacing,
                           ManifoldRule rule, FinalLabels& labels, const Threads& threads,
                           const Checkpoint& checkpoint = {});

/// Takes samples into the surface that it passes by closely: the tetrahedron between such a sample and a
/// surface triangle changes sides, which neither opens nor joins anything. Only when such samples are at
/// most `max_share` of those on the surface; more are noise. Isolated samples (may be empty) stay out where they
/// are more (not in the paper).
struct RecoveryCounts {
  std::uint64_t samples = 0; ///< taken in
};
RecoveryCounts recover_samples(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                               const Labels& known, std::span<const float> isolated, double max_share, Labels& labels);

/// Cuts off spikes (and fills pits) that end in an isolated sample: where no triangle at it has a support of 0.1 (see
/// measure_support) and the first stage (`first`) settled no tetrahedron on one side of its star, that side changes,
/// if the surface stays a manifold with as many handles and pieces (not in the paper).
struct SpikeCounts {
  std::uint64_t cut = 0;
};
SpikeCounts cut_spikes(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
                       const Labels& first, const Labels& known, const Neighbourhoods& neighbourhoods,
                       std::span<const float> grid_spacing, ManifoldRule rule, FinalLabels& labels);

/// §3: the faces between inside and outside, counter-clockwise seen from outside; sample_of[v] is the
/// sample behind vertex v, coordinates are still relative to the origin.
struct Surface {
  TriangleMesh mesh;
  std::vector<SampleIndex> sample_of;
  std::vector<TetrahedronIndex> inside; ///< the tetrahedron behind each triangle
  std::vector<float> support;           ///< of each triangle, see measure_support
};
Surface extract_surface(const Tetrahedralization& tetrahedralization, const Labels& labels, const Threads& threads);

/// How well the samples bear out each triangle, in [0, 1]: min(1, 2.5 h / e) (1 + min(1, c)) / 2, where e is its
/// longest edge, h the mean over its vertices of the local spacing (of isolated ones: the typical one) or of the grid
/// spacing ℓ if that is larger, and c the contrast |x_out - x_in| of the second stage's values across it (not in the
/// paper).
void measure_support(const Tetrahedralization& tetrahedralization, const FinalLabels& labels,
                     const Neighbourhoods& neighbourhoods, std::span<const float> grid_spacing, Surface& surface,
                     const Threads& threads);

/// Removes pieces of the surface by `keep`; see docs/parameters.md for `supported`. Expects surface.support.
/// \param grid_spacing ℓ of each sample; may be empty
std::vector<DroppedComponent> filter_components(Surface& surface, const KeepComponents& keep,
                                                const Tetrahedralization& tetrahedralization,
                                                std::span<const float> grid_spacing, const Threads& threads);

/// The triangles that the samples do not bear out (1): their support is below 1/4, or their longest edge exceeds 10
/// times the smallest local spacing of their vertices (of isolated ones: the typical one), or no line of sight of
/// their vertices meets their front within 85° of the normal, in a one-sided scan: none of some vertex (not in the
/// paper; docs/decisions/0020). Expects surface.support. \param lines as sight_lines() gives them; may be empty
std::vector<std::uint8_t> unsupported_triangles(const Tetrahedralization& tetrahedralization,
                                                const Neighbourhoods& neighbourhoods, std::span<const SightLine> lines,
                                                bool one_sided, const Surface& surface, const Threads& threads);
/// The share of the surface's area that is marked.
double share_of_area(const Surface& surface, std::span<const std::uint8_t> marked);
/// What unsupported_triangles() marked, and its share.
struct UnsupportedTriangles {
  std::vector<std::uint8_t> marked;
  double share_of_area = 0;
};
/// Takes away the triangles marked, and then, at vertices with several fans, all but the largest fan: an oriented
/// manifold surface stays one, with boundary.
void trim(std::vector<std::uint8_t> unsupported, Surface& surface);

/// Which samples belong to the surface, from the labels (not in the paper; docs/decisions/0014).
struct Classification {
  IndexedArray<SampleIndex, std::uint8_t> inlier; ///< 1 exactly where the confidence is at least 0.5
  /// 1/(1 + (d/τ)²), d being how far the sample is from the surface that its neighbours make and τ the
  /// tolerance: 1.25 local spacings or 3 deviations of the noise.
  IndexedArray<SampleIndex, float> confidence;
  /// Vertices of the triangle of `surface` that is nearest; three times the same one where that is a vertex.
  /// Of samples with a plausible vertex of their own it is that.
  IndexedArray<SampleIndex, std::array<std::uint32_t, 3>> place;
};
/// \param surface as kept: pieces that were dropped make no inliers
/// \param grid_spacing a length per sample, 1.2 deviations of the noise; empty: no noise
Classification classify_samples(const Tetrahedralization& tetrahedralization, const Surface& surface,
                                std::span<const float> grid_spacing, const Threads& threads);

/// Unit normals of the inliers, outward by the labels: angle-weighted triangle normals, averaged over as
/// many neighbours as the noise asks for; between the vertices of its place for a sample beside the surface.
/// NaN for the others.
IndexedArray<SampleIndex, Vec3> orient_samples(const Tetrahedralization& tetrahedralization, const Surface& surface,
                                               const Classification& samples, std::span<const float> grid_spacing,
                                               const Threads& threads);

/// §3.6. \throws Error{usage} never; boundary vertices stay
void smooth(TriangleMesh& mesh, Smoothing method, std::uint32_t steps, const Threads& threads);

} // namespace eigencrust
