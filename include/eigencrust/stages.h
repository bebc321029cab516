// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every step of the paper as a free function, in its order: the table of contents. What the paper does not have
/// is in src/, each chapter with a header of its own.
/// § numbers are those of Kolluri, Shewchuk and O'Brien, Spectral Surface Reconstruction from Noisy
/// Point Clouds (SGP 2004). src/pipeline.cpp shows how they fit together.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <eigencrust/options.h>
#include <eigencrust/threads.h>
#include <eigencrust/types.h>

namespace eigencrust {

/// The distinct finite points, exactly relative to an origin, along a Hilbert curve.
struct Samples {
  Vec3 origin;                                     ///< what was subtracted from the coordinates
  IndexedArray<SampleIndex, Vec3> positions;       ///< relative to the origin
  IndexedArray<SampleIndex, std::uint32_t> source; ///< smallest row with these coordinates
  std::vector<SampleIndex> of_row; ///< the sample of each row, duplicates included; invalid where it is not finite
  std::uint64_t duplicates = 0, nonfinite = 0; ///< rows that repeat a sample, and that are not finite
  Box3 bounds;                                 ///< input coordinates
};
/// \throws Error{input} for fewer than 5 distinct finite points or more than 2^32 - 9
Samples prepare_samples(std::span<const Vec3> points, const Threads& threads);

/// Median distance of a sample to its nearest sample; 0 with fewer than two.
/// With scan numbers (one per input row) only samples of the same scan count.
double median_spacing(const Samples& samples, std::span<const Vec3> points, std::span<const std::uint32_t> scan_index,
                      const Threads& threads);
/// ℓ of §3.3 from the option; 0 means off.
double resolve_grid_spacing(const LengthChoice& option, const Samples& samples, std::span<const Vec3> points,
                            std::span<const std::uint32_t> scan_index, const Threads& threads);

/// §3: Delaunay tetrahedra of the samples and the corners of a cube whose half side is 10 diagonals of
/// their bounding box. Each thread makes those of a part of the samples.
/// \throws Error{input} when all samples are coplanar or collinear
Tetrahedralization tetrahedralize(Samples samples, const Threads& threads);
/// A triangulation can be watched while it grows: most clouds have seven tetrahedra per sample, some have thousands.
/// Called every few samples, from all threads, with the fraction done and the number of tetrahedra so far. May throw to
/// end the work.
using WatchGrowth = std::function<void(double, std::uint64_t)>;
/// The same, watched.
Tetrahedralization tetrahedralize(Samples samples, const Threads& threads, const WatchGrowth& watch);
/// The tetrahedra around each vertex.
VertexStars vertex_stars(const Tetrahedralization& tetrahedralization, const Threads& threads);

/// §3: the pole pair of every sample, the farthest circumcentres on either side. With `reach` (may be empty;
/// a length per sample) a sample takes its pair from the poles of all samples within reach: where noise
/// exceeds the spacing no single cell sees both sides (Alliez et al. 2007; not in the paper).
/// With Weights::evidence "the other side" of a cell that leaves the cloud is that of the mean direction in which it
/// does (Amenta and Bern 1999): at a sharp corner it leaves in several.
Poles find_poles(const Tetrahedralization& tetrahedralization, const VertexStars& stars, SampleLengthsView reach,
                 Weights weights, const Threads& threads);

/// §3.1: what is known beforehand. Tetrahedra at the cube are outside (with a façade: those at its front;
/// those whose corners are all at the back are inside; around rooms all are inside), as are those that hold the
/// user's points.
/// \param solid tetrahedra at the cube that are inside all the same
/// \throws Error{usage} when one tetrahedron is named both, or an inside point lies at or beyond the cube
Labels known_labels(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                    std::span<const Vec3> outside_points, std::span<const Vec3> inside_points,
                    const Surroundings& surroundings, const Threads& threads,
                    std::span<const TetrahedronIndex> solid = {});

/// What the scanner looked along when it saw a sample.
struct SightLine {
  SampleIndex sample; ///< where it begins
  float depth = 0;    ///< what begins nearer to the sample, or has a sample nearer to the line, is not crossed; length
  Vec3 target;        ///< the scanner, or a place beyond all samples in its direction; relative to the origin
};
/// One line for each place from which a sample was seen, ordered by sample, then place; duplicates count once.
/// \param sample_of_row as Samples has it
/// \param depth a length per sample
/// \param left_out samples where it is > 0 have none (may be empty)
std::vector<SightLine> sight_lines(const PointCloud& cloud, std::span<const SampleIndex> sample_of_row,
                                   const Tetrahedralization& tetrahedralization, SampleLengthsView depth,
                                   SampleLengthsView left_out);

/// The tetrahedra that each line crosses, in their order along it (compressed rows).
struct SightCrossings {
  std::vector<std::uint64_t> begin;         ///< number of lines + 1
  std::vector<TetrahedronIndex> tetrahedra; ///< of all lines, one after another

  /// Those of one line.
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

/// With Weights::paper more than one line makes a tetrahedron outside and nothing makes it inside.
struct SightRule {
  Weights weights = Weights::evidence; ///< which rule counts the lines
  SampleLengthsView isolated =
      {}; ///< of each sample, see samples/sample_model.h; tetrahedra at those are not made inside
};
/// §3.1: `known`, and outside for the tetrahedra without a label that enough lines cross, more than there are
/// samples right in front of them. Lines that cross what more samples lie in front of than lines cross are not
/// believed: they belong to outliers behind the surface or to scans that disagree. Inside are tetrahedra that no
/// line crosses with enough samples right in front (neither is in the paper; docs/decisions/0017). With
/// Weights::paper all lines count and nothing else.
struct SightLabels {
  Labels labels; ///< the known ones and those that the lines decided
  /// How many lines that are believed cross each tetrahedron, and how many samples lie right in front of it; 255: or
  /// more.
  IndexedArray<TetrahedronIndex, std::uint8_t> front, behind;
  std::uint64_t disbelieved = 0;         ///< lines
  std::uint64_t outside = 0, inside = 0; ///< tetrahedra that the lines made so
};
/// What the lines decide (§3.1), added to what is known.
SightLabels line_of_sight(const Tetrahedralization& tetrahedralization, const VertexStars& stars,
                          std::span<const SightLine> lines, const SightCrossings& crossings, const SightRule& rule,
                          const Labels& known, const Threads& threads);
/// §3.3: tetrahedra whose longest edge is < 4 × the mean grid spacing at their samples, none with a cube
/// corner. \param grid_spacing a length per sample; empty: none is questionable
std::vector<std::uint8_t> questionable_tetrahedra(const Tetrahedralization& tetrahedralization,
                                                  SampleLengthsView grid_spacing, const Threads& threads);

/// What is known of the samples for the pole graph; either may be empty.
struct PoleGraphSamples {
  SampleLengthsView isolated = {};          ///< their pole pairs count only as far as their cells are long
  std::span<const std::uint8_t> noisy = {}; ///< their poles join along no chains; anything but 0: noisy
};
/// §3.1: the signed graph on the poles with the outside supernode (0) and, when something is known to be
/// inside, the inside supernode (1). Poles of tetrahedra in `left_out` (may be empty) are no nodes. With `contract`
/// each pole is one node with the largest pole of neighbouring samples whose ball nearly coincides with its own (cos φ
/// < -0.93) and that is not its opposite pole; a pole of noisy samples only where its ball nearly coincides (cos φ <
/// -0.8) with the largest of that node, too. The node's edges are the sums of theirs (not in the paper, where an edge
/// of weight e^8 joins them; docs/decisions/0025).
PoleGraph pole_graph(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
                     const Labels& known, std::span<const std::uint8_t> left_out, const PoleGraphSamples& samples,
                     bool contract, const Threads& threads);

/// Called now and then with the fraction done; may throw to cancel.
using Checkpoint = std::function<void(double)>;

/// §3.2: the eigenvector of the smallest eigenvalue of L x = λ D x. Components of the graph that hold no
/// supernode are solved on their own; the sign of each of those is arbitrary.
/// \param reduce    nodes that one edge decides are merged before (not in the paper; docs/decisions/0025)
/// \param component receives the component of every node, 0 being the one of the supernodes; may be null
Partition partition_poles(const PoleGraph& graph, const SolverOptions& options, bool reduce, const Threads& threads,
                          std::vector<std::uint32_t>* component = nullptr, const Checkpoint& checkpoint = {});

/// §3.2: labels from the signs of the partition, added to what is known. Nodes of components without a
/// supernode get none: nothing tells their sign.
/// `trust` is the agreement Σ w x / Σ |w x| of a node's neighbours with its own sign, not below 0 (not in the paper).
struct PoleLabels {
  Labels labels;                                      ///< of the tetrahedra; those of poles are set
  IndexedArray<TetrahedronIndex, std::uint8_t> trust; ///< agreement of labelled poles, 255: 1
  bool reversed = false;                              ///< the vote overruled the outside supernode's own sign
  double vote = 0;                                    ///< evidence for the sign chosen, in [-1, 1]; 1 = unanimous
  std::uint64_t left_to_stage_two = 0;                ///< poles of components whose side is open
  std::uint64_t contradicted = 0;                     ///< poles whose neighbours disagree
};
/// Labels from the signs of the partition (§3.2).
PoleLabels label_poles(const Tetrahedralization& tetrahedralization, const Poles& poles, const PoleGraph& graph,
                       const Partition& partition, std::span<const std::uint32_t> component, const Labels& known,
                       GlobalSign global_sign, const Threads& threads);

/// §3.3: removes the labels of questionable tetrahedra but for those known beforehand.
/// \return how many
std::uint64_t unlabel_questionable(std::span<const std::uint8_t> questionable, const Labels& known, Labels& labels);

/// §3.4: one node per unlabelled tetrahedron, supernodes for all outside (0) and all inside (1) ones;
/// a face weighs longest/shortest of its edges.
TetrahedronGraph tetrahedron_graph(const Tetrahedralization& tetrahedralization, const Labels& labels,
                                   const Threads& threads);

/// §3.4: `eigenvector` as in the paper; `harmonic`: outside fixed at +1, inside at -1.
Partition partition_tetrahedra(SignedGraph graph, SecondStage method, const SolverOptions& options,
                               const Threads& threads, const Checkpoint& checkpoint = {});

/// Every tetrahedron labelled, with the stage-two component behind each label (+1 and -1 times the
/// supernodes' magnitude for those labelled before).
TetrahedronLabels label_tetrahedra(const TetrahedronGraph& graph, const Partition& partition, Labels labels);
/// Both supernodes on one side: the vector is useless.
bool supernodes_agree(const Partition& partition);

/// §3.5: relabels tetrahedra from inside to outside until the surface is a manifold. What is `known` gives way only
/// where nothing else does.
struct ManifoldCounts {
  std::uint64_t edges = 0, vertices = 0; ///< repairs of either kind
  std::uint64_t relabelled = 0;          ///< tetrahedra
  std::uint64_t overruled = 0;           ///< tetrahedra that are not what they are known to be
};
/// Turns labels until the surface is a manifold (§3.5).
ManifoldCounts make_manifold(const Tetrahedralization& tetrahedralization, const VertexStars& stars, const Poles& poles,
                             const Labels& known, TetrahedronLabels& labels, const Threads& threads,
                             const Checkpoint& checkpoint = {});

/// §3: the faces between inside and outside, counter-clockwise seen from outside; sample_of[v] is the
/// sample behind vertex v, coordinates are still relative to the origin.
struct Surface {
  TriangleMesh mesh;                    ///< input coordinates
  std::vector<SampleIndex> sample_of;   ///< the sample that each vertex is
  std::vector<TetrahedronIndex> inside; ///< the tetrahedron behind each triangle
  std::vector<float> support;           ///< of each triangle, see measure_support
  /// Of each triangle: 1 where the samples do not bear it out, see unsupported_triangles; empty until that is known.
  std::vector<std::uint8_t> unsupported{};
};
/// The faces between inside and outside (§3).
Surface extract_surface(const Tetrahedralization& tetrahedralization, const Labels& labels, const Threads& threads);

/// §3.6. \throws Error{usage} never; boundary vertices stay
void smooth(TriangleMesh& mesh, Smoothing method, std::uint32_t steps, const Threads& threads);

} // namespace eigencrust
