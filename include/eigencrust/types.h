// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The plain values that flow between the stages, with their invariants.
#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace eigencrust {

/// A point or vector in space, in the unit of the input coordinates.
struct Vec3 {
  double x = 0, y = 0, z = 0; ///< along the three axes

  /// By x, then y, then z.
  friend constexpr auto operator<=>(const Vec3&, const Vec3&) = default;
};

/// \name Arithmetic of vectors
/// @{

/// Sum.
constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
/// Difference.
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
/// Multiple.
constexpr Vec3 operator*(double k, const Vec3& a) { return {k * a.x, k * a.y, k * a.z}; }
/// Inner product.
constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// Vector product.
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Square of the length.
constexpr double squared_norm(const Vec3& a) { return dot(a, a); }
/// Length.
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
/// Distance of two points.
inline double distance(const Vec3& a, const Vec3& b) { return norm(a - b); }
/// Is no coordinate NaN or infinite?
inline bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
/// @}

/// A direction along an axis.
enum class Axis : std::uint8_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };
/// The unit vector of an axis.
constexpr Vec3 direction_of(Axis axis) {
  const double sign = static_cast<int>(axis) % 2 == 0 ? 1 : -1;
  const int k = static_cast<int>(axis) / 2;
  return {k == 0 ? sign : 0, k == 1 ? sign : 0, k == 2 ? sign : 0};
}

/// Axis-aligned bounding box. Empty (min > max) until something is added.
struct Box3 {
  /// The corner with the smallest coordinates.
  Vec3 min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  /// The corner with the largest coordinates.
  Vec3 max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
           -std::numeric_limits<double>::infinity()};

  /// Makes it reach to a point.
  void add(const Vec3& p) {
    min = {std::fmin(min.x, p.x), std::fmin(min.y, p.y), std::fmin(min.z, p.z)};
    max = {std::fmax(max.x, p.x), std::fmax(max.y, p.y), std::fmax(max.z, p.z)};
  }
  /// Was nothing added?
  [[nodiscard]] bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  /// The middle.
  [[nodiscard]] Vec3 centre() const { return 0.5 * min + 0.5 * max; }
  /// Its length; 0 where it is empty.
  [[nodiscard]] double diagonal() const { return empty() ? 0.0 : distance(min, max); }
};

/// No number: of a sample, a place, a sensor.
inline constexpr std::uint32_t no_index = std::numeric_limits<std::uint32_t>::max();

/// Is all that Tag counts counted by Wider, too?
template <class Tag, class Wider>
concept IsAlso = std::same_as<typename Tag::is_also, Wider>;

/// A 32-bit index that only fits the thing it counts: a tetrahedron cannot be taken for a sample.
template <class Tag>
struct Index {
  static constexpr std::uint32_t none = no_index; ///< no thing
  std::uint32_t value = none;                     ///< counts from 0

  /// Is there a thing?
  [[nodiscard]] constexpr bool valid() const { return value != none; }
  /// By value.
  friend constexpr auto operator<=>(Index, Index) = default;
  /// A sample is a vertex, too.
  template <class Wider>
  requires IsAlso<Tag, Wider>
  constexpr operator Index<Wider>() const { // NOLINT: nothing is lost
    return {value};
  }
};
struct VertexTag {};
/// A sample is a vertex, too.
struct SampleTag {
  using is_also = VertexTag; ///< what it may be taken for
};
using VertexIndex = Index<VertexTag>; ///< a vertex of the tetrahedra: a distinct sample, or a cube corner
using SampleIndex = Index<SampleTag>; ///< a distinct sample; see Tetrahedralization::sample
using TetrahedronIndex = Index<struct TetrahedronTag>; ///< a Delaunay tetrahedron
using PoleIndex = Index<struct PoleTag>;               ///< a pole: a tetrahedron that some sample chose
using NodeIndex = Index<struct NodeTag>;               ///< a row of a SignedGraph

/// A std::vector that is read with one kind of index only. Without NDEBUG it looks whether the index is one of its own.
template <class I, class T>
class IndexedArray {
 public:
  IndexedArray() = default;
  /// `n` times the same value.
  explicit IndexedArray(std::size_t n, const T& value = T{}) : values_(n, value) {}
  /// With the values of a vector, which is taken over.
  explicit IndexedArray(std::vector<T> values) : values_(std::move(values)) {}

  /// The value of one thing.
  T& operator[](I i) {
    assert(i.value < values_.size());
    return values_[i.value];
  }
  /// The value of one thing.
  const T& operator[](I i) const {
    assert(i.value < values_.size());
    return values_[i.value];
  }
  /// How many values.
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(values_.size()); }
  /// Are there none?
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// The first value.
  auto begin() const { return values_.begin(); }
  /// Behind the last value.
  auto end() const { return values_.end(); }
  /// The vector itself.
  std::vector<T>& raw() { return values_; }
  /// The vector itself.
  const std::vector<T>& raw() const { return values_; }

 private:
  std::vector<T> values_;
};

/// An IndexedArray that belongs to somebody else, to read; it may be empty.
template <class I, class T>
class IndexedView {
 public:
  IndexedView() = default;
  /// Of an array, which must live longer.
  IndexedView(const IndexedArray<I, T>& array) : values_(array.raw()) {} // NOLINT: as a span is made of a vector

  /// The value of one thing.
  const T& operator[](I i) const {
    assert(i.value < values_.size());
    return values_[i.value];
  }
  /// How many values.
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(values_.size()); }
  /// Are there none?
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// The first value.
  auto begin() const { return values_.begin(); }
  /// Behind the last value.
  auto end() const { return values_.end(); }

 private:
  std::span<const T> values_;
};

/// A length at each sample, in the unit of the input coordinates. Corners of the cube have none.
using SampleLengths = IndexedArray<SampleIndex, float>;
/// Those of somebody else, to read.
using SampleLengthsView = IndexedView<SampleIndex, float>;

/// Type of an attribute's values as the file declared it.
enum class ScalarType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Size of one value in bytes.
constexpr std::size_t size_of(ScalarType type) {
  switch (type) {
    case ScalarType::int8:
    case ScalarType::uint8:
      return 1;
    case ScalarType::int16:
    case ScalarType::uint16:
      return 2;
    case ScalarType::int32:
    case ScalarType::uint32:
    case ScalarType::float32:
      return 4;
    case ScalarType::float64:
      return 8;
  }
  return 0;
}

/// One named column (red, intensity, nx ...) kept bit for bit under its own name and type.
struct Attribute {
  std::string name;                      ///< as in the file
  ScalarType type = ScalarType::float32; ///< of the values
  /// Values one after another in the machine's byte order: rows × size_of(type) bytes; for a list
  /// property all rows' entries, row i being entries [offsets[i], offsets[i+1]).
  std::vector<std::byte> values;
  bool is_list = false;                      ///< each row has a list of values
  ScalarType count_type = ScalarType::uint8; ///< type of the list's length in the file
  std::vector<std::uint64_t> offsets;        ///< rows + 1 entries when is_list, else empty
  bool derived = false; ///< made by the program, not read: formats without room for it need not say so

  /// For how many rows there are values.
  [[nodiscard]] std::size_t rows() const {
    return is_list ? (offsets.empty() ? 0 : offsets.size() - 1) : values.size() / size_of(type);
  }
};

/// Value of row i (not a list) as a double; 32-bit integers are exact.
double attribute_value(const Attribute& attribute, std::size_t row);
/// An attribute made of doubles, floats or integers; `type` decides how they are stored.
Attribute make_attribute(std::string name, ScalarType type, std::span<const double> values);
/// A column of uint32.
Attribute make_attribute(std::string name, std::span<const std::uint32_t> values);
/// A column of float32.
Attribute make_attribute(std::string name, std::span<const float> values);
/// The same, made by the program.
Attribute derived_attribute(Attribute attribute);
/// The rows `rows` of an attribute, in that order.
Attribute gather(const Attribute& attribute, std::span<const std::uint32_t> rows);
/// The attribute of that name, or null.
const Attribute* find_attribute(const std::vector<Attribute>& attributes, std::string_view name);

/// Where a scanner stood when it saw some of the points.
struct Sensor {
  Vec3 place;               ///< position in input coordinates; at infinity the unit direction surface -> scanner
  bool at_infinity = false; ///< parallel rays: there is a direction, but no position

  /// By place.
  friend constexpr auto operator<=>(const Sensor&, const Sensor&) = default;
};

/// The grid in which a scanner or depth camera saw its points; its cells are numbered row after row.
struct ScanGrid {
  std::uint32_t columns = 0, rows = 0; ///< 0 and 0: the scan has no grid; else columns * rows fits 32 bits

  /// By size.
  friend constexpr auto operator<=>(const ScanGrid&, const ScanGrid&) = default;
};

/// Points with whatever the files said of them.
/// Invariants: every attribute has points.size() rows; scan_index is empty or has points.size() entries;
/// so has sensor_of, and each entry is below sensors.size() or no_sensor; places are finite. So has cell, and each
/// entry is no_index or a cell of the grid of the point's scan, which then exists; grids has one entry per scan or
/// none.
struct PointCloud {
  static constexpr std::uint32_t no_sensor = no_index; ///< the point has no known sensor

  std::vector<Vec3> points;               ///< n rows in input order; may hold NaN, infinities and duplicates
  std::vector<Attribute> attributes;      ///< what the file says of each point
  std::vector<std::uint32_t> scan_index;  ///< which scan each point came from; empty: one scan, or unknown
  std::vector<Sensor> sensors{};          ///< in the order of the files; equal ones may occur
  std::vector<std::uint32_t> sensor_of{}; ///< which sensor saw each point; empty: none is known
  std::vector<ScanGrid> grids{};          ///< of each scan; empty: no scan is known to have one
  std::vector<std::uint32_t> cell{}; ///< row * columns + column in the grid of the point's scan; empty: none is known
};

/// Indexed triangles; counter-clockwise seen from outside. Indices are 0-based into vertices.
struct TriangleMesh {
  std::vector<Vec3> vertices;                          ///< in the unit of the input
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< of vertices, counter-clockwise seen from outside
  std::vector<Attribute> vertex_attributes;            ///< a row per vertex
  std::vector<Attribute> triangle_attributes;          ///< a row per triangle
};

/// Delaunay tetrahedra of the samples and the eight corners of a wide cube (§3 of the paper).
///
/// Coordinates are relative to `origin`, from which all of them are exact (near a cloud far from 0), so that clouds far
/// from zero lose nothing. Samples are distinct and numbered along a Hilbert curve (ties
/// lexicographic), the cube corners come last; tetrahedra are sorted by their smallest sample. Both
/// orders depend on the set of coordinates alone: neither on the order of the rows nor on threads.
struct Tetrahedralization {
  Vec3 origin;                                     ///< what was subtracted from the coordinates
  std::uint32_t sample_count = 0;                  ///< without the eight corners
  IndexedArray<VertexIndex, Vec3> positions;       ///< sample_count + 8
  IndexedArray<SampleIndex, std::uint32_t> source; ///< smallest input row of each sample; sample_count
  /// Vertices of each tetrahedron, smallest first, second smallest next, positively oriented: vertex 3
  /// sees (0,1,2) counter-clockwise, dot(cross(b-a, c-a), d-a) > 0.
  IndexedArray<TetrahedronIndex, std::array<VertexIndex, 4>> tetrahedra;
  /// Neighbour k shares the face opposite vertex k; invalid beyond the cube.
  IndexedArray<TetrahedronIndex, std::array<TetrahedronIndex, 4>> neighbours;

  /// Is it a corner of the cube, no sample?
  [[nodiscard]] bool is_corner(VertexIndex v) const { return v.value >= sample_count; }
  /// A vertex that is no corner: only samples have a spacing, noise, poles or an input row.
  [[nodiscard]] SampleIndex sample(VertexIndex v) const {
    assert(!is_corner(v));
    return {v.value};
  }
  /// Has it a corner of the cube?
  [[nodiscard]] bool touches_cube(TetrahedronIndex t) const {
    for (const VertexIndex v : tetrahedra[t])
      if (is_corner(v)) return true;
    return false;
  }
};

/// For each vertex the tetrahedra around it, in increasing order (compressed rows).
struct VertexStars {
  std::vector<std::uint64_t> begin;         ///< positions.size() + 1
  std::vector<TetrahedronIndex> tetrahedra; ///< 4 × number of tetrahedra

  /// Those around one vertex.
  [[nodiscard]] std::span<const TetrahedronIndex> operator[](VertexIndex v) const {
    assert(v.value + std::size_t{1} < begin.size());
    return {tetrahedra.data() + begin[v.value], tetrahedra.data() + begin[v.value + 1]};
  }
};

/// A ball.
struct Sphere {
  Vec3 centre;       ///< of the ball
  double radius = 0; ///< in the unit of the input
};

/// The two poles of each sample (§3). `first` is the farther; `second` is invalid only when no
/// circumcentre of the star makes an obtuse angle with it (never for an interior Voronoi cell).
struct PolePair {
  PoleIndex first, second; ///< the farther, and the one on the other side
};
/// All poles of a cloud.
struct Poles {
  IndexedArray<PoleIndex, TetrahedronIndex> tetrahedron; ///< in order of first appearance by sample
  IndexedArray<PoleIndex, Sphere> sphere;                ///< circumsphere of that tetrahedron
  IndexedArray<SampleIndex, PolePair> of_sample;         ///< sample_count entries, none for corners
};

/// Which side of the surface.
enum class Label : std::uint8_t { unlabelled = 0, inside = 1, outside = 2 };
/// Of each tetrahedron.
using Labels = IndexedArray<TetrahedronIndex, Label>;
/// Outside for inside, inside for outside.
inline Label other_side(Label label) { return label == Label::outside ? Label::inside : Label::outside; }

/// A side and a value for every tetrahedron; the value's sign is the side (> 0 outside), its size how sure that is.
class TetrahedronLabels {
 public:
  /// Tetrahedra that were turned, in order.
  using Journal = std::vector<TetrahedronIndex>;

  TetrahedronLabels() = default;
  /// \param labels inside or outside, none unlabelled
  /// \param value  its size counts; the sign is that of the label
  TetrahedronLabels(Labels labels, IndexedArray<TetrahedronIndex, float> value)
      : labels_(std::move(labels)), value_(std::move(value)) {
    for (std::uint32_t i = 0; i < labels_.size(); ++i) {
      float& v = value_.raw()[i];
      v = std::copysign(v, labels_.raw()[i] == Label::outside ? 1.0f : -1.0f);
    }
  }

  /// Its side.
  [[nodiscard]] Label operator[](TetrahedronIndex i) const { return labels_[i]; }
  /// > 0 outside, < 0 inside.
  [[nodiscard]] float value(TetrahedronIndex i) const { return value_[i]; }
  /// How many tetrahedra.
  [[nodiscard]] std::uint32_t size() const { return labels_.size(); }
  /// The sides.
  [[nodiscard]] const Labels& labels() const& { return labels_; }
  [[nodiscard]] Labels labels() && { return std::move(labels_); } ///< the sides, moved out
  /// The values behind the sides.
  [[nodiscard]] const IndexedArray<TetrahedronIndex, float>& values() const { return value_; }

  /// To the other side, as sure as before.
  void turn(TetrahedronIndex i) {
    labels_[i] = labels_[i] == Label::outside ? Label::inside : Label::outside;
    value_[i] = -value_[i];
  }
  /// The same, noted in a journal.
  void turn(TetrahedronIndex i, Journal& journal) {
    turn(i);
    journal.push_back(i);
  }
  /// Takes a journal back, the last one first.
  void undo(const Journal& journal) {
    for (std::size_t i = journal.size(); i-- > 0;) turn(journal[i]);
  }

 private:
  Labels labels_;
  IndexedArray<TetrahedronIndex, float> value_;
};

/// A symmetric weighted graph whose weights say "same side" (> 0) or "opposite sides" (< 0).
///
/// Ordinary nodes are stored as compressed rows without self-loops, columns increasing. Supernodes
/// (§3.1, §3.4) touch a large share of all nodes and are kept apart, as dense columns.
struct SignedGraph {
  /// A node with edges to a large share of all.
  struct Supernode {
    std::vector<float> weight; ///< to every ordinary node; 0 where there is no edge
  };
  std::vector<std::uint64_t> row_begin; ///< nodes + 1
  std::vector<std::uint32_t> column;    ///< the other node of each edge
  std::vector<float> weight;            ///< of each edge
  std::vector<Supernode> supernodes;    ///< kept apart as dense columns
  /// Weights between supernodes: entry [i][j] of a symmetric matrix with zero diagonal.
  std::vector<std::vector<double>> supernode_weight;

  /// How many ordinary nodes there are.
  [[nodiscard]] std::uint32_t node_count() const {
    return row_begin.empty() ? 0 : static_cast<std::uint32_t>(row_begin.size() - 1);
  }
};

/// The pole graph G (§3.1): which poles each node stands for. Supernode 0 is z (outside); supernode 1,
/// when there is one, is the inside supernode.
struct PoleGraph {
  SignedGraph graph;                       ///< on the poles
  IndexedArray<PoleIndex, NodeIndex> node; ///< of each pole; invalid where it is known, or left out
};

/// The second graph (§3.4): which unlabelled tetrahedron each node stands for. Supernode 0 holds all
/// outside, supernode 1 all inside tetrahedra.
struct TetrahedronGraph {
  SignedGraph graph;                                     ///< on the tetrahedra
  IndexedArray<NodeIndex, TetrahedronIndex> tetrahedron; ///< of each node
};

/// Why a solver ended.
enum class SolverStatus : std::uint8_t {
  converged,     ///< residual below the tolerance asked for
  signs_stable,  ///< stopped because signs no longer change; the residual is reported
  consistent,    ///< eigenvalue zero: no cycle of the graph contradicts itself, signs are exact
  not_converged, ///< step limit reached; the result is the best found
  trivial        ///< nothing to solve (no nodes)
};
/// Its name in the report, such as "converged".
const char* to_string(SolverStatus status);

/// Solution of one partition with the figures by which to judge it.
struct Partition {
  std::vector<float> value;                    ///< one component per node of the graph; its sign is the side
  std::vector<double> supernode_value;         ///< one per supernode
  std::uint64_t edges = 0;                     ///< of the graph, those to the supernodes included
  double eigenvalue = 0;                       ///< of D^-1 L; 0 for the harmonic problem
  double residual = 0;                         ///< |D^-1/2 (Lx - λDx)| / |D^1/2 x|; relative residual if harmonic
  std::uint32_t iterations = 0;                ///< steps on the finest level
  std::vector<std::uint32_t> sign_changes;     ///< per step on the finest level
  std::uint32_t components = 0;                ///< of the graph, counting those without a supernode
  std::uint32_t free_components = 0;           ///< components without a supernode
  std::uint32_t undecided = 0;                 ///< nodes left without a sign
  SolverStatus status = SolverStatus::trivial; ///< why it ended
};

/// What was scanned; what lies beyond all samples follows from it (not in the paper; docs/decisions/0032).
enum class SceneKind : std::uint8_t {
  body,     ///< something seen from outside: beyond the samples there is nothing
  interior, ///< rooms, seen from sensors among the samples: beyond the walls is the solid
  facade    ///< ground or a façade: solid behind, the surface is open at the rim
};
/// What was scanned, and from where.
struct Surroundings {
  SceneKind kind = SceneKind::body;    ///< what was scanned
  Axis front = Axis::plus_z;           ///< of a façade: the side it was seen from
  std::optional<Axis> likely_facade{}; ///< a body whose samples lie like a façade, or nearly so, seen from here
};

/// A scan from one side (not in the paper; docs/decisions/0020): all lines within 60° of their mean direction.
struct OneSided {
  Vec3 direction;          ///< unit vector, surface -> scanners
  double widest_angle = 0; ///< between it and a line, radians
};

/// The flat base that closes what was seen from one side.
struct Base {
  std::uint32_t vertices = 0;  ///< of the mesh, the last ones
  double level = 0;            ///< its coordinate on the façade's axis
  double volume_above_rim = 0; ///< between the surface and the plane through its rim; what is below counts negative
};

/// One piece of surface that was not kept, so that nothing is lost silently.
struct DroppedComponent {
  std::uint32_t vertices = 0, triangles = 0; ///< of the piece
  double support = 0;                        ///< mean over its area, see measure_support
  Vec3 centre;                               ///< mean of its vertices, input coordinates
};

} // namespace eigencrust
