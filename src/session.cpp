// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/memory_forecast.h>
#include <eigencrust/session.h>

#include <chrono>
#include <cmath>
#include <deque>

#include "parallel/threads.h"
#include "pipeline.h"
#include "report/output.h"

namespace eigencrust {
namespace {

// A node whose value changes by less than this share of itself tells its neighbours nothing new.
constexpr double noticeable = 0.01;
constexpr double negligible = 1e-4; // of the largest value, 1
// Each node is looked at so often on average, at most.
constexpr std::uint64_t most_visits = 20;

/// Nodes take the mean of their neighbours, signed and weighted, as the eigenvector does (x = Σ w y / Σ |w| / (1 - λ))
/// and the harmonic solution (λ = 0): around those that are held, from those that are woken on, and as far as that
/// changes anything.
class Spreading {
 public:
  Spreading(const SignedGraph& graph, Partition& partition)
      : graph_(graph), partition_(partition), waiting_(graph.node_count(), 0), held_(graph.node_count(), 0) {}

  void hold(std::uint32_t node, float value) {
    partition_.value[node] = value;
    held_[node] = 1;
    wake_neighbours(node);
  }
  void wake(std::uint32_t node) {
    if (waiting_[node] || held_[node]) return;
    waiting_[node] = 1;
    queue_.push_back(node);
  }
  void run() {
    std::uint64_t visits = most_visits * graph_.node_count();
    while (!queue_.empty() && visits-- > 0) {
      const std::uint32_t node = queue_.front();
      queue_.pop_front();
      waiting_[node] = 0;
      const double before = static_cast<double>(partition_.value[node]), after = mean_at(node);
      partition_.value[node] = static_cast<float>(after);
      if (std::fabs(after - before) > noticeable * std::max(std::fabs(before), negligible)) wake_neighbours(node);
    }
  }

 private:
  void wake_neighbours(std::uint32_t node) {
    for (std::uint64_t e = graph_.row_begin[node]; e < graph_.row_begin[node + 1]; ++e) wake(graph_.column[e]);
  }
  [[nodiscard]] double mean_at(std::uint32_t node) const {
    double sum = 0, size = 0;
    const auto add = [&](double w, double x) {
      sum += w * x;
      size += std::fabs(w);
    };
    for (std::uint64_t e = graph_.row_begin[node]; e < graph_.row_begin[node + 1]; ++e)
      add(static_cast<double>(graph_.weight[e]), static_cast<double>(partition_.value[graph_.column[e]]));
    for (std::size_t s = 0; s < graph_.supernodes.size(); ++s)
      add(static_cast<double>(graph_.supernodes[s].weight[node]), partition_.supernode_value[s]);
    return size > 0 ? sum / (size * (1 - partition_.eigenvalue)) : 0;
  }

  const SignedGraph& graph_;
  Partition& partition_;
  std::deque<std::uint32_t> queue_;
  std::vector<std::uint8_t> waiting_, held_;
};

/// The second solution by tetrahedron, with the weights to the supernodes that it came from; those are 0 where the
/// tetrahedron was no node.
struct SecondSolution {
  std::vector<float> value, outside, inside;

  SecondSolution() = default;
  SecondSolution(const TetrahedronGraph& graph, const Partition& partition, std::size_t tetrahedra)
      : value(tetrahedra, 0), outside(tetrahedra, 0), inside(tetrahedra, 0) {
    for (std::uint32_t node = 0; node < graph.tetrahedron.size(); ++node) {
      const std::uint32_t i = graph.tetrahedron.raw()[node].value;
      value[i] = partition.value[node];
      outside[i] = graph.graph.supernodes[0].weight[node];
      inside[i] = graph.graph.supernodes[1].weight[node];
    }
  }
  /// Of another graph of the same tetrahedra, changed here and there.
  [[nodiscard]] Partition adapted_to(const TetrahedronGraph& graph) const {
    Partition partition;
    partition.components = 1;
    partition.status = SolverStatus::signs_stable;
    partition.supernode_value = {1, -1};
    partition.value.resize(graph.tetrahedron.size());
    Spreading spreading(graph.graph, partition);
    for (std::uint32_t node = 0; node < graph.tetrahedron.size(); ++node) {
      const std::uint32_t i = graph.tetrahedron.raw()[node].value;
      partition.value[node] = value[i];
      if (outside[i] != graph.graph.supernodes[0].weight[node] || inside[i] != graph.graph.supernodes[1].weight[node])
        spreading.wake(node);
    }
    spreading.run();
    for (const float v : partition.value) partition.undecided += v == 0;
    return partition;
  }
};

} // namespace

struct Session::Kept {
  Kept(PointCloud points, const Options& all, Observer& observer)
      : cloud(std::move(points)), options(all), threads(all.threads) {
    check_options(options);
    check_cloud(cloud);
    check_memory(cloud, options.max_memory);
    report.options = options;
    Options unnamed = options;
    unnamed.outside_points.clear();
    unnamed.inside_points.clear();
    Run run(report, observer);
    half = first_half(cloud, unnamed, run, report, threads);
    PoleLabels labels = label_poles(half.t, half.stars, half.poles, half.graph, half.first, half.component,
                                    half.known.labels, options.global_sign, options.min_agreement, threads);
    if (options.questionable == Questionable::after)
      unlabel_questionable(half.questionable, half.known.labels, labels.labels);
    if (options.second_stage == SecondStage::harmonic) {
      const TetrahedronGraph graph = run.stage("tetrahedron_graph", [&] {
        return tetrahedron_graph(half.t, half.poles, labels.labels, options.pole_ties, half.measures.reach, threads);
      });
      const Partition solution = run.stage("partition_tetrahedra", [&] { return solve(graph, run); });
      second = {graph, solution, half.t.tetrahedra.size()};
    }
    const auto& supers = half.first.supernode_value;
    outside_value = supers.empty() ? 0 : static_cast<float>(labels.reversed ? -supers[0] : supers[0]);
    inside_value = supers.size() > 1 ? static_cast<float>(supers[1]) : -outside_value;
    node_of = IndexedArray<TetrahedronIndex, std::uint32_t>(half.t.tetrahedra.size(), NodeIndex::none);
    for (std::uint32_t node = 0; node < half.graph.pole.size(); ++node)
      node_of[half.poles.tetrahedron[half.graph.pole.raw()[node]]] = node;
    report.stages.clear();
  }

  /// What is known with the points, and the first partition as it follows.
  Partition apply(const Options& named, Known& known) const {
    known.named = known_labels(half.t, named.outside_points, named.inside_points, named.facade, threads);
    name_poles(half.t, half.poles, named.outside_points, named.inside_points, threads, known.named);
    known.labels = half.known.labels;
    Partition first = half.first;
    Spreading spreading(half.graph.graph, first);
    for (std::uint32_t i = 0; i < known.named.size(); ++i) {
      const Label label = known.named.raw()[i];
      if (label == half.known.named.raw()[i]) continue;
      known.labels.raw()[i] = label;
      const std::uint32_t node = node_of.raw()[i];
      if (node == NodeIndex::none || outside_value == 0 || half.component[node] != 0) continue;
      spreading.hold(node, label == Label::outside ? outside_value : inside_value);
    }
    spreading.run();
    return first;
  }

  Partition solve(const TetrahedronGraph& graph, Run& run) const {
    if (!second.value.empty()) return second.adapted_to(graph);
    return partition_tetrahedra(graph.graph, options.second_stage, options.solver, threads, run.checkpoint());
  }

  PointCloud cloud;
  Options options;
  Threads threads;
  Report report;
  FirstHalf half;
  SecondSolution second;
  float outside_value = 0, inside_value = 0;
  IndexedArray<TetrahedronIndex, std::uint32_t> node_of;
};

Session::Session(PointCloud cloud, const Options& options, Observer& observer)
    : kept_(std::make_unique<Kept>(std::move(cloud), options, observer)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

const Tetrahedralization& Session::tetrahedralization() const { return kept_->half.t; }
const PointCloud& Session::cloud() const { return kept_->cloud; }

Result Session::label(std::span<const Vec3> outside_points, std::span<const Vec3> inside_points, Observer& observer) {
  const auto start = std::chrono::steady_clock::now();
  Result result;
  result.report = kept_->report;
  Options& options = result.report.options;
  options.outside_points.insert(options.outside_points.end(), outside_points.begin(), outside_points.end());
  options.inside_points.insert(options.inside_points.end(), inside_points.begin(), inside_points.end());
  check_options(options);
  Run run(result.report, observer);
  Known known;
  const Partition first = run.stage("evidence", [&] { return kept_->apply(options, known); });
  const ValidateOptions checks{.self_intersections = options.smooth > 0, .threads = options.threads};
  second_half(
      kept_->cloud, kept_->half, nullptr, known, first,
      [&](const TetrahedronGraph& graph) { return kept_->solve(graph, run); }, checks, run, result, kept_->threads);
  result.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.report.peak_memory_bytes = peak_memory_bytes();
  return result;
}

} // namespace eigencrust
