// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/minimum_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "settle/minimum_cut.h"

namespace eigencrust {
namespace {

// Capacities are whole numbers, as fine as the heaviest face allows.
constexpr double units = CutProblem::largest_capacity / static_cast<double>(FaceWeights::largest);

std::int64_t in_units(float cost) { return std::llround(units * static_cast<double>(cost)); }

/// What its data, and its neighbours as far as they have a label, ask a tetrahedron to be; unlabelled if its other
/// faces could outweigh them.
Label decided_label(const Tetrahedralization& t, const Energy& energy, const auto& label_of, TetrahedronIndex i) {
  float asked = energy.data[i], open = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const TetrahedronIndex n = t.neighbours[i][k];
    if (!n.valid()) continue;
    const float weight = energy.faces(i, k);
    const Label label = label_of(n);
    if (label == Label::unlabelled)
      open += weight;
    else
      asked += label == Label::outside ? weight : -weight;
  }
  return std::fabs(asked) <= open ? Label::unlabelled : asked > 0 ? Label::outside : Label::inside;
}

/// What known and decided tetrahedra are; the others are unlabelled. One that is decided may decide its neighbours, as
/// far as that leads within a block.
Labels decided_labels(const Tetrahedralization& t, const Energy& energy, const Threads& threads) {
  Labels labels = energy.known;
  for_blocks(threads, labels.size(), default_block, [&](std::size_t begin, std::size_t end, std::size_t) {
    const auto is_here = [&](TetrahedronIndex i) { return i.value >= begin && i.value < end; };
    const auto label_of = [&](TetrahedronIndex i) { return is_here(i) ? labels[i] : energy.known[i]; };
    std::vector<TetrahedronIndex> waiting;
    for (TetrahedronIndex i{static_cast<std::uint32_t>(begin)}; i.value < end; ++i.value)
      for (waiting.assign(1, i); !waiting.empty();) {
        const TetrahedronIndex next = waiting.back();
        waiting.pop_back();
        if (labels[next] != Label::unlabelled) continue;
        labels[next] = decided_label(t, energy, label_of, next);
        if (labels[next] == Label::unlabelled) continue;
        for (const TetrahedronIndex n : t.neighbours[next]) // later ones have their turn
          if (n.valid() && is_here(n) && n < i) waiting.push_back(n);
      }
  });
  return labels;
}

/// The nodes are the undecided tetrahedra in their order.
CutProblem problem_of(const Tetrahedralization& t, const Energy& energy, const Labels& decided,
                      const Threads& threads) {
  std::vector<std::uint32_t> node_of(decided.size(), CutProblem::none);
  std::vector<TetrahedronIndex> nodes;
  nodes.reserve(static_cast<std::size_t>(std::count(decided.raw().begin(), decided.raw().end(), Label::unlabelled)));
  for (TetrahedronIndex i{0}; i.value < decided.size(); ++i.value) {
    if (decided[i] != Label::unlabelled) continue;
    node_of[i.value] = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back(i);
  }
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
        problem.capacity[node][k] = static_cast<std::uint16_t>(weight);
      else
        terminal += decided[n] == Label::outside ? weight : -weight;
    }
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    problem.terminal[node] = static_cast<std::int32_t>(std::clamp(terminal, -most, most));
  });
  return problem;
}

} // namespace

Energy make_energy(const Tetrahedralization& t, const DataTerms& data, const Labels& known, const Threads& threads) {
  Energy energy{FaceWeights(t, data.isolated(), threads), IndexedArray<TetrahedronIndex, float>(known.size()), known,
                0};
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
  const CutResult cut = minimum_cut(problem_of(t, energy, labels, threads), threads);
  result.undecided = cut.side.size();
  auto side = cut.side.begin();
  for (Label& label : labels.raw())
    if (label == Label::unlabelled) label = *side++ == CutSide::sink ? Label::inside : Label::outside;
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
