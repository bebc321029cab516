// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/minimum_energy.h"

#include <algorithm>
#include <cmath>

#include "settle/minimum_cut.h"

namespace eigencrust {
namespace {

// Capacities are whole numbers: a thousandth of a weight is small beside ε.
constexpr double units = 1000;

std::int64_t in_units(float cost) { return std::llround(units * static_cast<double>(cost)); }

/// What known and decided tetrahedra are; the others are unlabelled.
Labels decided_labels(const Tetrahedralization& t, const Energy& energy, const Threads& threads) {
  Labels labels = energy.known;
  for_each_index(threads, labels.size(), [&](std::size_t at) {
    const TetrahedronIndex i{static_cast<std::uint32_t>(at)};
    if (labels[i] != Label::unlabelled) return;
    float faces = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (t.neighbours[i][k].valid()) faces += energy.faces(i, k);
    if (std::fabs(energy.data[i]) > faces) labels[i] = energy.data[i] > 0 ? Label::outside : Label::inside;
  });
  return labels;
}

CutProblem problem_of(const Tetrahedralization& t, const Energy& energy, const Labels& decided,
                      std::span<const TetrahedronIndex> nodes, const Threads& threads) {
  std::vector<std::uint32_t> node_of(decided.size(), CutProblem::none);
  for (std::uint32_t node = 0; node < nodes.size(); ++node) node_of[nodes[node].value] = node;
  CutProblem problem;
  problem.neighbour.resize(nodes.size());
  problem.capacity.resize(nodes.size());
  problem.terminal.resize(nodes.size());
  for_each_index(threads, nodes.size(), [&](std::size_t node) {
    const TetrahedronIndex i = nodes[node];
    std::int64_t terminal = in_units(energy.data[i]);
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours[i][k];
      problem.neighbour[node][k] = n.valid() ? node_of[n.value] : CutProblem::none;
      problem.capacity[node][k] = 0;
      if (!n.valid()) continue;
      const std::int64_t weight = in_units(energy.faces(i, k));
      if (node_of[n.value] != CutProblem::none)
        problem.capacity[node][k] = static_cast<std::int32_t>(weight);
      else
        terminal += decided[n] == Label::outside ? weight : -weight;
    }
    problem.terminal[node] = terminal;
  });
  return problem;
}

} // namespace

Energy make_energy(const Tetrahedralization& t, const DataTerms& data, const Labels& known, const Threads& threads) {
  Energy energy{FaceWeights(t, threads), IndexedArray<TetrahedronIndex, float>(known.size()), known, 0};
  energy.constant = sum_blocks<double>(threads, known.size(), [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (TetrahedronIndex i{static_cast<std::uint32_t>(begin)}; i.value < end; ++i.value) {
      if (known[i] != Label::unlabelled) continue;
      const DataTerm term = data(i);
      energy.data[i] = term.outside - term.inside;
      sum += static_cast<double>(std::min(term.outside, term.inside));
    }
    return sum;
  });
  return energy;
}

MinimumLabels minimum_of(const Tetrahedralization& t, const Energy& energy, const Threads& threads) {
  MinimumLabels result;
  Labels labels = decided_labels(t, energy, threads);
  std::vector<TetrahedronIndex> nodes;
  for (TetrahedronIndex i{0}; i.value < labels.size(); ++i.value)
    if (labels[i] == Label::unlabelled) nodes.push_back(i);
  const CutResult cut = minimum_cut(problem_of(t, energy, labels, nodes, threads), threads);
  for (std::size_t node = 0; node < nodes.size(); ++node)
    labels[nodes[node]] = cut.side[node] == CutSide::sink ? Label::inside : Label::outside;
  result.undecided = nodes.size();
  result.clusters = cut.clusters;
  result.largest = cut.largest;
  IndexedArray<TetrahedronIndex, float> value(labels.size());
  for_each_index(threads, labels.size(), [&](std::size_t at) {
    const TetrahedronIndex i{static_cast<std::uint32_t>(at)};
    if (energy.known[i] != Label::unlabelled) {
      value[i] = 1;
      return;
    }
    const float balance = energy.balance(t, labels, i);
    // Of a tie either label is right.
    value[i] = (balance > 0) == (labels[i] == Label::outside) ? balance : 0;
  });
  result.energy = energy.of(t, labels, threads);
  result.labels = TetrahedronLabels(std::move(labels), std::move(value));
  return result;
}

} // namespace eigencrust
