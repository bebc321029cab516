// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The engine of all repairs: tetrahedra turn where that makes the surface better.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include <eigencrust/stages.h>

#include "repair/priced_labels.h"
#include "repair/star_repair.h"
#include "samples/sample_model.h"
#include "settle/energy.h"

namespace eigencrust {

/// What moves look at.
struct MoveScene {
  const Tetrahedralization& t;
  const VertexStars& stars;
  const Energy& energy; ///< what it knows only the mandatory moves may overrule, and only where nothing else helps
  const SampleModel& model;
  const Threads& threads;
};
struct NearSample {
  double distance = std::numeric_limits<double>::infinity();
  SampleIndex sample; ///< invalid: there are not so many
};
/// Of those that share a tetrahedron with a sample, the three nearest, nearest first.
std::array<NearSample, 3> nearest_samples(const MoveScene& scene, SampleIndex s);

/// One rule says which moves are made (docs/decisions/0027): those that leave a manifold and decrease
///   J = E + u · samples passed by + lengths of long triangles + g · (pieces + handles).
/// The first three are the cost of the labels (PricedLabels); g is that of the place, 0 where there is no noise.
class Moves {
 public:
  Moves(const MoveScene& scene, TetrahedronLabels& labels);

  const MoveScene scene;
  const bool among_strays; ///< are lonely samples passed by so often that some may be strays?

  struct Prices {
    std::vector<float> price; ///< of each sample
    bool strays;
  };
  [[nodiscard]] const PricedLabels& labels() const { return priced_; }

  /// Mandatory moves: every star becomes a disc. The others expect that.
  ManifoldCounts make_manifold(const Checkpoint& checkpoint = {});

  /// What a move changes, and the tetrahedra that it turns with all that follows from it.
  struct Outcome {
    double change = 0; ///< of J; >= 0: not to be made
    std::vector<TetrahedronIndex> turned;
    std::int64_t pieces = 0, handles = 0; ///< more of them
  };
  /// What a move is hoped to make fewer: whether it did is looked at only where it may have.
  enum class Gain : std::uint8_t { handles, pieces };
  /// Turns these, mends the stars around, turns back what need not be, and then takes it all back.
  /// \param handle g: what one handle or piece less is worth here
  Outcome weigh(std::span<const TetrahedronIndex> turned, double handle, Gain gain = Gain::handles);
  void make(const Outcome& outcome);
  /// Turns one of which three vertices are a triangle of the surface and the fourth is passed by: that changes
  /// neither handles nor pieces.
  void turn(TetrahedronIndex i) { priced_.turn(i); }

  /// May this tetrahedron turn if nothing forces it?
  [[nodiscard]] bool is_open(TetrahedronIndex i) const {
    return scene.energy.known[i] == Label::unlabelled && !scene.t.touches_cube(i);
  }
  /// All that hangs together with `start` on its side; none where that is more than `most` tetrahedra, or may not turn,
  /// or was seen. Adds what it has looked at to `seen`, which is to be forgotten before anything turns but specks.
  /// \return valid until the next call
  std::span<const TetrahedronIndex> speck_at(TetrahedronIndex start, std::uint64_t most,
                                             std::vector<TetrahedronIndex>& seen);
  void forget(std::span<const TetrahedronIndex> seen);
  /// Distinct samples of these tetrahedra, increasing.
  [[nodiscard]] std::vector<std::uint32_t> samples_of(std::span<const TetrahedronIndex> tetrahedra) const;
  /// Makes the values at all that was turned what the energy says of them now.
  void settle_values();

 private:
  Moves(const MoveScene& scene, TetrahedronLabels& labels, Prices prices);
  void swallow_specks(const std::vector<TetrahedronIndex>& turned);
  void relax(const std::vector<TetrahedronIndex>& turned);
  bool turn_back(TetrahedronIndex i);
  std::int64_t pieces_at(const std::vector<std::uint32_t>& samples);

  TetrahedronLabels& all_;
  PricedLabels priced_;
  StarRepair repair_;
  std::vector<TetrahedronIndex> speck_;
  std::vector<std::uint8_t> seen_;   ///< tetrahedra, while specks are looked for
  std::vector<std::uint32_t> owner_; ///< while pieces are counted: which front reached the sample
};

} // namespace eigencrust
