// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every option and its default, written once. The command line and the documentation follow this file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

/// Which defaults.
enum class Preset : std::uint8_t {
  robust, ///< the measured best
  paper   ///< Kolluri, Shewchuk and O'Brien (2004) to the letter
};
/// Which surface is made of the tetrahedra or poles. The others are what the paper is compared with (docs/crusts.md).
enum class Method : std::uint8_t {
  eigencrust,
  powercrust,          ///< Amenta, Choi, Kolluri 2001
  spectral_powercrust, ///< the same cells, labelled by the first partition (§3.4)
  tight_cocone,        ///< Dey, Goswami 2003
  robust_cocone,       ///< Dey, Goswami 2004
  spectral_cocone      ///< the samples that Robust Cocone keeps, then eigencrust
};
/// What the pole pairs of the pole graph weigh (§3.1).
enum class Weights : std::uint8_t {
  evidence, ///< those of isolated samples count only as far as their Voronoi cells are long
  paper     ///< all count in full
};
/// How the eigenvectors are found.
enum class Eigensolver : std::uint8_t {
  multigrid, ///< signed aggregation multigrid: about ten steps at any size
  lanczos    ///< the reference: thousands of matrix products on large clouds
};
/// How tetrahedra without a label get one (§3.4).
enum class SecondStage : std::uint8_t {
  cut,        ///< the exact minimum of an energy on all of them. docs/decisions/0026
  harmonic,   ///< both supernodes fixed at +1 and -1, the rest solved for
  eigenvector ///< §3.4: smallest eigenvector of the second graph
};
/// When tetrahedra below the noise scale lose their say (§3.3).
enum class Questionable : std::uint8_t {
  before, ///< their poles never enter the pole graph
  after,  ///< their labels are removed after the first partition, as in the paper
  never
};
/// How inside is told from outside (§3.2).
enum class GlobalSign : std::uint8_t {
  vote,     ///< long Voronoi cells beside the known outside decide; an outlier has none
  supernode ///< §3.2: the sign of the outside supernode's own component
};
/// Where the vertices of the mesh lie, and which triangles there are between them.
enum class SurfaceKind : std::uint8_t {
  automatic, ///< in the middle of the samples around where noise was measured, else samples
  samples,   ///< at input points; of an edge between two triangles and the other diagonal the better (decisions/0048)
  fitted,    ///< fitted wherever the fit itself finds noise. docs/decisions/0036
  delaunay   ///< at input points, and the triangles are faces of the Delaunay tetrahedralization: the paper's
};
/// How a mesh is smoothed (§3.6).
enum class Smoothing : std::uint8_t {
  laplacian, ///< §3.6: each vertex to the centroid of its neighbours; shrinks
  taubin     ///< alternating steps that keep the volume (Taubin 1995)
};
/// What is relabelled where the surface is no manifold (§3.5).
enum class ManifoldRule : std::uint8_t {
  cheapest, ///< the strand, component or path, inside or outside, with the least certain labels
  paper     ///< inside tetrahedra only: all strands but the strongest, all components but the pole's
};

/// A length that may be found out from the cloud.
struct LengthChoice {
  /// What `value` means.
  enum class Kind : std::uint8_t {
    automatic,
    off,    ///< 0
    length, ///< `value` in the unit of the input
    percent ///< `value` percent of the bounding box's diagonal
  };
  Kind kind = Kind::automatic; ///< what `value` means
  double value = 0;            ///< see Kind

  /// The length given; none: it is automatic.
  [[nodiscard]] std::optional<double> given(double diagonal) const;
};

/// A length of the result, in terms of the cloud.
struct SurfaceLength {
  /// What `value` means.
  enum class Kind : std::uint8_t {
    off,
    length,  ///< `value` in the unit of the input
    percent, ///< `value` percent of the bounding box's diagonal
    sigma    ///< `value` times the deviation of the noise, the median of the samples
  };
  Kind kind = Kind::off; ///< what `value` means
  double value = 0;      ///< see Kind

  /// 0: off, or there is no noise.
  [[nodiscard]] double resolve(double diagonal, double sigma) const;
};

/// Which pieces of the surface are kept.
struct KeepComponents {
  /// Which ones.
  enum class Kind : std::uint8_t {
    supported, ///< all but specks and pieces made of long edges; what goes is listed in the report
    all,
    largest,
    count ///< the `count` largest by number of vertices
  };
  Kind kind = Kind::supported; ///< which ones
  std::uint32_t count = 1;     ///< how many, with Kind::count
};

/// How the eigenvectors are found, and when that ends.
struct SolverOptions {
  Eigensolver eigensolver = Eigensolver::multigrid; ///< the solver
  /// Stop when signs no longer change; otherwise on the residual alone.
  bool stop_on_stable_signs = true;
  /// Share of all nodes that may still change sign in each of two steps running; in (0, 1].
  double stable_share = 2e-4;
  /// Residual of D^-1/2 L D^-1/2 at which a vector counts as converged; > 0.
  double tolerance = 1e-8;
  /// Steps on the finest level at most (Lanczos: restarts); >= 1.
  std::uint32_t max_steps = 60;
};

/// What one call of reconstruct() may be told. The defaults are those of the preset `robust`.
struct Options {
  Preset preset = Preset::robust;     ///< which the defaults are of
  Method method = Method::eigencrust; ///< which surface is made
  SolverOptions solver;               ///< of the eigenvectors
  /// docs/decisions/0013.
  Weights weights = Weights::evidence;
  /// How unlabelled tetrahedra are settled (§3.4).
  SecondStage second_stage = SecondStage::cut;
  /// ℓ of §3.3, the diagonal of the squares of the range grid, for the paper's weights; automatic: √2 × the median
  /// nearest-sample distance within a scan, off for a single scan. With the others a length given here stands for a
  /// noise of ℓ / 1.2.
  LengthChoice grid_spacing;
  /// Standard deviation of the noise across the surface; automatic: measured at the samples. docs/decisions/0024.
  LengthChoice noise;
  /// When tetrahedra below the noise lose their say (§3.3).
  Questionable questionable = Questionable::before;
  /// How inside is told from outside once the two sides are apart (§3.2).
  GlobalSign global_sign = GlobalSign::vote;
  /// Make the surface a manifold by relabelling (§3.5).
  bool manifold = true;
  ManifoldRule manifold_rule = ManifoldRule::cheapest; ///< how it is made one
  KeepComponents components;                           ///< which pieces of the surface are kept
  /// Whether vertices move to the middle of the noise (not in the paper).
  SurfaceKind surface = SurfaceKind::automatic;
  /// Smoothing steps (§3.6); 0: none. Vertices then leave the samples.
  std::uint32_t smooth = 0;
  Smoothing smoothing = Smoothing::laplacian; ///< how `smooth` moves the vertices
  /// Triangles are made fewer, down to so many; 0: all stay. docs/decisions/0041.
  std::uint32_t triangles = 0;
  /// Triangles are made fewer as long as no place, either way, is farther than this from the surface before. With
  /// `triangles` it ends at what comes first.
  SurfaceLength max_error;
  /// Triangles are made regular, with edges of about this length; creases and rims stay. Not with the two before.
  SurfaceLength edge;
  /// Points in space known to be outside or inside (§3.1); input coordinates.
  std::vector<Vec3> outside_points, inside_points;
  /// Where the cloud knows its sensors (§3.1): lines from samples to their sensors cross the tetrahedra that they enter
  /// farther than this from the sample; a length >= 0, none: the larger of half a spacing and 3 deviations of the noise
  /// at the sample. docs/decisions/0017.
  std::optional<double> crossing_depth;
  /// One-sided scan: outside is in front, along this direction (§3.1). The result is then open.
  std::optional<Axis> facade;
  /// Find out what was scanned. From the sensors: whether they stand among the samples, in rooms
  /// (Report::surroundings), and whether all lie on one side (Report::one_sided; that makes trimming stricter and
  /// changes no label, docs/decisions/0020). Without any: whether the samples lie like ground with what stands on it;
  /// that is a façade along +z. Not with the paper's weights. docs/decisions/0032.
  bool detect_facade = true;
  /// Close what was seen from one side with a flat base behind it; the surface's rim becomes its outline. Not with
  /// `trim`.
  bool base = false;
  /// Leave out triangles that the samples do not bear out, see unsupported_triangles(). The result is then open.
  bool trim = false;
  /// Also say of every input row whether it belongs to the surface, and its normal: Result::inlier,
  /// confidence and normals.
  bool point_results = false;
  /// Threads; 0: one per core. The result does not depend on it.
  unsigned threads = 0;
  /// Bytes; a cloud whose forecast (memory_forecast.h) exceeds them is refused before any work. 0: no limit.
  std::uint64_t max_memory = 0;

  /// The options of a preset.
  static Options of(Preset preset);
};

/// \name Names as the command line and the report write them.
/// @{

/// As the command line and the report write it.
std::string to_string(Preset value);
std::string to_string(Method value);
std::string to_string(Weights value);
std::string to_string(Eigensolver value);
std::string to_string(SecondStage value);
std::string to_string(Questionable value);
std::string to_string(GlobalSign value);
std::string to_string(ManifoldRule value);
std::string to_string(SurfaceKind value);
std::string to_string(Smoothing value);
std::string to_string(Axis value);
std::string to_string(SceneKind value);
std::string to_string(const LengthChoice& value);
std::string to_string(const SurfaceLength& value);
std::string to_string(const KeepComponents& value);
/// @}

/// \name The reverse
/// @{

/// What a word stands for. \throws Error{usage} naming the accepted values.
Preset parse_preset(const std::string& text);
Method parse_method(const std::string& text);
Weights parse_weights(const std::string& text);
Eigensolver parse_eigensolver(const std::string& text);
SecondStage parse_second_stage(const std::string& text);
Questionable parse_questionable(const std::string& text);
SurfaceKind parse_surface_kind(const std::string& text);
Smoothing parse_smoothing(const std::string& text);
Axis parse_axis(const std::string& text);
/// The same: auto, off, LENGTH or N%. \param what the option, for the message
LengthChoice parse_length_choice(const std::string& what, const std::string& text);
/// The same: off, LENGTH, N% or "N sigma". \param what the option, for the message
SurfaceLength parse_surface_length(const std::string& what, const std::string& text);
/// The same: supported, all, largest or N.
KeepComponents parse_components(const std::string& text);
/// The same: auto or LENGTH.
std::optional<double> parse_crossing_depth(const std::string& text);
/// The same: x,y,z.
Vec3 parse_point(const std::string& text);
/// @}

/// \throws Error{usage} naming the first option out of range.
void check_options(const Options& options);

} // namespace eigencrust
