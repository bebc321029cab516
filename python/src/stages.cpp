// SPDX-License-Identifier: GPL-3.0-or-later
// Every stage of eigencrust/stages.h. The library trusts what its stages hand each other; here it is checked that
// the pieces fit.
#include <pybind11/stl.h>

#include <eigencrust/error.h>
#include <eigencrust/option_table.h>

#include "stage_types.h"
#include "watch.h"

namespace eigencrust::python {
namespace {

using Tets = Tetrahedralization;
using Unlocked = py::call_guard<py::gil_scoped_release>;

/// \throws Error{input}
void require(bool fits, const char* what, const char* of) {
  if (!fits)
    throw Error(ErrorKind::input, what, std::string("it does not belong to this ") + of,
                "pass what the stage before returned for it");
}

void check(const VertexStars& stars, const Tets& t) {
  require(
      stars.begin.size() == t.positions.size() + 1 && stars.tetrahedra.size() == 4 * std::size_t{t.tetrahedra.size()},
      "stars", "tetrahedralization");
}

void check(const Poles& poles, const Tets& t) {
  bool fits = poles.of_sample.size() == t.sample_count && poles.sphere.size() == poles.tetrahedron.size();
  for (const TetrahedronIndex i : poles.tetrahedron) fits = fits && i.value < t.tetrahedra.size();
  require(fits, "poles", "tetrahedralization");
}

void check(const SightLines& lines, const Tets& t) {
  for (const SightLine& line : lines.lines) require(line.sample.value < t.sample_count, "lines", "tetrahedralization");
}

void check(const SightCrossings& crossings, const SightLines& lines, const Tets& t) {
  require(crossings.begin.size() == lines.lines.size() + 1, "crossings", "set of lines");
  for (const TetrahedronIndex i : crossings.tetrahedra)
    require(i.value < t.tetrahedra.size(), "crossings", "tetrahedralization");
}

void check(const PoleGraph& graph, const Poles& poles) {
  bool fits = graph.node.size() == poles.tetrahedron.size();
  const std::uint32_t nodes = graph.graph.node_count();
  for (const NodeIndex i : graph.node) fits = fits && (!i.valid() || i.value < nodes);
  require(fits, "graph", "set of poles");
}

Labels to_labels(const py::object& array, const char* what, const Tets& t) {
  const std::vector<std::uint8_t> bytes = to_bytes(array, what, t.tetrahedra.size(), 2);
  std::vector<Label> labels(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) labels[i] = static_cast<Label>(bytes[i]);
  return Labels(std::move(labels));
}

/// Calls progress(fraction) in the stage's inner loop; False and exceptions stop it.
class Inner {
 public:
  Inner(py::object progress, const py::object& cancel, const char* stage)
      : watch_(std::move(progress), cancel, py::none()), stage_(stage) {
    watch_.stage_begins(stage);
  }
  template <class Work>
  auto run(unsigned count, Work&& work) {
    return watch_.run([&] {
      throw_if_cancelled(watch_, stage_);
      const Threads threads(count, [this] { throw_if_cancelled(watch_, stage_); });
      return work(threads, [this](double fraction) {
        watch_.progress(fraction);
        throw_if_cancelled(watch_, stage_);
      });
    });
  }

 private:
  Watch watch_;
  const char* stage_;
};

void bind_beginning(py::module_& m) {
  m.def(
      "prepare_samples",
      [](const py::object& points, unsigned threads) {
        const std::shared_ptr<PointCloud> cloud = to_cloud(points);
        const py::gil_scoped_release unlocked;
        return std::make_shared<Samples>(prepare_samples(cloud->points, Threads(threads)));
      },
      py::arg("points"), py::arg("threads") = 0, "The distinct finite points, along a Hilbert curve.");
  m.def(
      "median_spacing",
      [](const Samples& samples, const py::object& points, unsigned threads) {
        const std::shared_ptr<PointCloud> cloud = to_cloud(points);
        require(samples.of_row.size() == cloud->points.size(), "samples", "cloud");
        const py::gil_scoped_release unlocked;
        return median_spacing(samples, cloud->points, cloud->scan_index, Threads(threads));
      },
      py::arg("samples"), py::arg("points"), py::arg("threads") = 0,
      "Median distance of a sample to its nearest sample, of the same scan if the cloud has a scan index.");
  m.def(
      "resolve_grid_spacing",
      [](const std::string& option, const Samples& samples, const py::object& points, unsigned threads) {
        const std::shared_ptr<PointCloud> cloud = to_cloud(points);
        require(samples.of_row.size() == cloud->points.size(), "samples", "cloud");
        const LengthChoice choice = parse_length_choice("grid spacing", option);
        const py::gil_scoped_release unlocked;
        return resolve_grid_spacing(choice, samples, cloud->points, cloud->scan_index, Threads(threads));
      },
      py::arg("option"), py::arg("samples"), py::arg("points"), py::arg("threads") = 0,
      "The grid spacing of §3.3 from the option auto, off, a length or N%; 0 means off.");
  m.def(
      "tetrahedralize",
      [](const Samples& samples, unsigned threads) {
        return std::make_shared<Tets>(tetrahedralize(samples, Threads(threads)));
      },
      Unlocked(), py::arg("samples"), py::arg("threads") = 0,
      "§3: Delaunay tetrahedra of the samples and the corners of a wide cube.");
  m.def(
      "vertex_stars", [](const Tets& t, unsigned threads) { return vertex_stars(t, Threads(threads)); }, Unlocked(),
      py::arg("tetrahedralization"), py::arg("threads") = 0, "The tetrahedra around each sample.");
  m.def(
      "find_poles",
      [](const Tets& t, const VertexStars& stars, const py::object& reach, const std::string& weights,
         unsigned threads) {
        check(stars, t);
        const SampleLengths lengths(to_floats(reach, "reach", t.sample_count));
        const Weights kind = parse_weights(weights);
        const py::gil_scoped_release unlocked;
        return find_poles(t, stars, lengths, kind, Threads(threads));
      },
      py::arg("tetrahedralization"), py::arg("stars"), py::arg("reach") = py::none(), py::arg("weights") = "evidence",
      py::arg("threads") = 0, "§3: the pole pair of every sample. reach: a length per sample, or None.");
}

void bind_knowledge(py::module_& m) {
  m.def(
      "known_labels",
      [](const Tets& t, const VertexStars& stars, const py::object& outside_points, const py::object& inside_points,
         const std::optional<std::string>& facade, unsigned threads) {
        check(stars, t);
        const std::vector<Vec3> outside = to_optional_points(outside_points, "outside_points"),
                                inside = to_optional_points(inside_points, "inside_points");
        Surroundings surroundings;
        if (facade) surroundings = {.kind = SceneKind::facade, .front = parse_axis(*facade)};
        Labels labels;
        {
          const py::gil_scoped_release unlocked;
          labels = known_labels(t, stars, outside, inside, surroundings, Threads(threads));
        }
        return own(std::move(labels.raw()));
      },
      py::arg("tetrahedralization"), py::arg("stars"), py::arg("outside_points") = py::none(),
      py::arg("inside_points") = py::none(), py::arg("facade") = py::none(), py::arg("threads") = 0,
      "§3.1: what is known beforehand, uint8 per tetrahedron: 0 nothing, 1 inside, 2 outside.");
}

void bind_lines_of_sight(py::module_& m) {
  m.def(
      "sight_lines",
      [](const py::object& points, const Samples& samples, const Tets& t, const py::object& depth,
         const py::object& left_out) {
        const std::shared_ptr<PointCloud> cloud = to_cloud(points);
        require(samples.of_row.size() == cloud->points.size(), "samples", "cloud");
        require(samples.positions.size() == t.sample_count, "samples", "tetrahedralization");
        const SampleLengths depths(to_floats(depth, "depth", t.sample_count)),
            without(to_floats(left_out, "left_out", t.sample_count));
        if (depths.empty()) throw Error(ErrorKind::input, "depth", "it is None", "give a length per sample");
        return SightLines{sight_lines(*cloud, samples.of_row, t, depths, without)};
      },
      py::arg("points"), py::arg("samples"), py::arg("tetrahedralization"), py::arg("depth"),
      py::arg("left_out") = py::none(), "One line for each place from which a sample was seen.");
  m.def(
      "sight_crossings",
      [](const Tets& t, const VertexStars& stars, const SightLines& lines, const py::object& known,
         const std::string& weights, unsigned threads) {
        check(stars, t);
        check(lines, t);
        const Labels labels = to_labels(known, "known", t);
        const Weights kind = parse_weights(weights);
        const py::gil_scoped_release unlocked;
        return sight_crossings(t, stars, lines.lines, kind, labels, Threads(threads));
      },
      py::arg("tetrahedralization"), py::arg("stars"), py::arg("lines"), py::arg("known"),
      py::arg("weights") = "evidence", py::arg("threads") = 0, "§3.1: the tetrahedra that each line crosses.");
  m.def(
      "line_of_sight",
      [](const Tets& t, const VertexStars& stars, const SightLines& lines, const SightCrossings& crossings,
         const py::object& known, const std::string& weights, const py::object& isolated, unsigned threads) {
        check(stars, t);
        check(lines, t);
        check(crossings, lines, t);
        const Labels labels = to_labels(known, "known", t);
        const SampleLengths lonely(to_floats(isolated, "isolated", t.sample_count));
        const SightRule rule{parse_weights(weights), lonely};
        const py::gil_scoped_release unlocked;
        return line_of_sight(t, stars, lines.lines, crossings, rule, labels, Threads(threads));
      },
      py::arg("tetrahedralization"), py::arg("stars"), py::arg("lines"), py::arg("crossings"), py::arg("known"),
      py::arg("weights") = "evidence", py::arg("isolated") = py::none(), py::arg("threads") = 0,
      "§3.1: labels of the tetrahedra that lines of sight decide, added to what is known.");
}

void bind_pole_graph(py::module_& m) {
  m.def(
      "questionable_tetrahedra",
      [](const Tets& t, const py::object& grid_spacing, unsigned threads) {
        const SampleLengths lengths(to_floats(grid_spacing, "grid_spacing", t.sample_count));
        std::vector<std::uint8_t> flags;
        {
          const py::gil_scoped_release unlocked;
          flags = questionable_tetrahedra(t, lengths, Threads(threads));
        }
        return own_flags(std::move(flags));
      },
      py::arg("tetrahedralization"), py::arg("grid_spacing"), py::arg("threads") = 0,
      "§3.3: bool per tetrahedron; grid_spacing: a length per sample, None: none is questionable.");
  m.def(
      "pole_graph",
      [](const Tets& t, const VertexStars& stars, const Poles& poles, const py::object& known,
         const py::object& left_out, const py::object& isolated, const py::object& noisy, bool contract,
         unsigned threads) {
        check(stars, t);
        check(poles, t);
        const Labels labels = to_labels(known, "known", t);
        const std::vector<std::uint8_t> without = to_bytes(left_out, "left_out", t.tetrahedra.size(), 1, true);
        const SampleLengths lonely(to_floats(isolated, "isolated", t.sample_count));
        const std::vector<std::uint8_t> in_noise = to_bytes(noisy, "noisy", t.sample_count, 1, true);
        const py::gil_scoped_release unlocked;
        return std::make_shared<PoleGraph>(
            pole_graph(t, stars, poles, labels, without, {lonely, in_noise}, contract, Threads(threads)));
      },
      py::arg("tetrahedralization"), py::arg("stars"), py::arg("poles"), py::arg("known"),
      py::arg("left_out") = py::none(), py::arg("isolated") = py::none(), py::arg("noisy") = py::none(),
      py::arg("contract") = true, py::arg("threads") = 0,
      "§3.1: the signed graph on the poles with its supernodes. isolated: a length per sample, 0 where it is not; "
      "noisy: bool per sample, whose poles join no chains.");
}

void bind_partition(py::module_& m) {
  m.def(
      "partition_poles",
      [](const PoleGraph& graph, const Options& options, bool reduce, unsigned threads, const py::object& progress,
         const py::object& cancel) {
        Inner inner(progress, cancel, "partition_poles");
        return inner.run(threads, [&](const Threads& team, const Checkpoint& checkpoint) {
          auto solved = std::make_shared<SolvedPartition>();
          static_cast<Partition&>(*solved) =
              partition_poles(graph, options.solver, reduce, team, &solved->component, checkpoint);
          return solved;
        });
      },
      py::arg("graph"), py::arg("options"), py::arg("reduce") = true, py::arg("threads") = 0,
      py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
      "§3.2: the eigenvector of the smallest eigenvalue of L x = λ D x.");
  m.def(
      "label_poles",
      [](const Tets& t, const Poles& poles, const PoleGraph& graph, const SolvedPartition& partition,
         const py::object& known, const std::string& global_sign, unsigned threads) {
        check(poles, t);
        check(graph, poles);
        require(partition.value.size() == graph.graph.node_count() &&
                    partition.component.size() == partition.value.size() &&
                    partition.supernode_value.size() == graph.graph.supernodes.size(),
                "partition", "graph");
        const Labels labels = to_labels(known, "known", t);
        Options options;
        set_option(options, "global-sign", global_sign);
        const py::gil_scoped_release unlocked;
        return label_poles(t, poles, graph, partition, partition.component, labels, options.global_sign,
                           Threads(threads));
      },
      py::arg("tetrahedralization"), py::arg("poles"), py::arg("graph"), py::arg("partition"), py::arg("known"),
      py::arg("global_sign") = "vote", py::arg("threads") = 0, "§3.2: labels from the signs of the partition.");
  m.def(
      "unlabel_questionable",
      [](const Tets& t, const py::object& questionable, const py::object& known, const py::object& labels) {
        const std::vector<std::uint8_t> flags = to_bytes(questionable, "questionable", t.tetrahedra.size(), 1);
        Labels changed = to_labels(labels, "labels", t);
        const std::uint64_t count = unlabel_questionable(flags, to_labels(known, "known", t), changed);
        return py::make_tuple(own(std::move(changed.raw())), count);
      },
      py::arg("tetrahedralization"), py::arg("questionable"), py::arg("known"), py::arg("labels"),
      "§3.3: the labels without those of questionable tetrahedra, and how many went.");
}

void bind_second_stage(py::module_& m) {
  m.def(
      "tetrahedron_graph",
      [](const Tets& t, const py::object& labels, unsigned threads) {
        const Labels given = to_labels(labels, "labels", t);
        const py::gil_scoped_release unlocked;
        return tetrahedron_graph(t, given, Threads(threads));
      },
      py::arg("tetrahedralization"), py::arg("labels"), py::arg("threads") = 0,
      "§3.4: one node per tetrahedron without a label.");
  m.def(
      "partition_tetrahedra",
      [](const TetrahedronGraph& graph, const std::string& method, const Options& options, unsigned threads,
         const py::object& progress, const py::object& cancel) {
        const SecondStage stage = parse_second_stage(method);
        if (stage == SecondStage::cut)
          throw Error(ErrorKind::usage, "method", "the cut has no partition of this graph",
                      "use harmonic or eigenvector");
        Inner inner(progress, cancel, "partition_tetrahedra");
        return inner.run(threads, [&](const Threads& team, const Checkpoint& checkpoint) {
          auto solved = std::make_shared<SolvedPartition>();
          static_cast<Partition&>(*solved) = partition_tetrahedra(graph.graph, stage, options.solver, team, checkpoint);
          return solved;
        });
      },
      py::arg("graph"), py::arg("method"), py::arg("options"), py::arg("threads") = 0, py::arg("progress") = py::none(),
      py::arg("cancel") = py::none(), "§3.4: eigenvector, as in the paper, or harmonic.");
  m.def(
      "label_tetrahedra",
      [](const Tets& t, const TetrahedronGraph& graph, const SolvedPartition& partition, const py::object& labels) {
        Labels given = to_labels(labels, "labels", t);
        bool fits = partition.value.size() == graph.tetrahedron.size() && partition.supernode_value.size() == 2;
        std::size_t open = 0;
        for (const Label label : given) open += label == Label::unlabelled ? 1 : 0;
        for (const TetrahedronIndex i : graph.tetrahedron) fits = fits && i.value < t.tetrahedra.size();
        require(fits && open == graph.tetrahedron.size(), "graph", "set of labels");
        return std::make_shared<TetrahedronLabels>(label_tetrahedra(graph, partition, std::move(given)));
      },
      py::arg("tetrahedralization"), py::arg("graph"), py::arg("partition"), py::arg("labels"),
      "Every tetrahedron labelled, with the value behind each label.");
  m.def(
      "supernodes_agree",
      [](const SolvedPartition& partition) {
        require(partition.supernode_value.size() >= 2, "partition", "stage");
        return supernodes_agree(partition);
      },
      py::arg("partition"), "Both supernodes on one side: the vector is useless.");
}

void bind_surface(py::module_& m) {
  m.def(
      "make_manifold",
      [](const Tets& t, const VertexStars& stars, const Poles& poles, const py::object& known,
         const TetrahedronLabels& labels, unsigned threads, const py::object& progress, const py::object& cancel) {
        check(stars, t);
        check(poles, t);
        require(labels.size() == t.tetrahedra.size(), "labels", "tetrahedralization");
        const Labels fixed = to_labels(known, "known", t);
        Inner inner(progress, cancel, "make_manifold");
        return inner.run(threads, [&](const Threads& team, const Checkpoint& checkpoint) {
          auto changed = std::make_shared<TetrahedronLabels>(labels);
          const ManifoldCounts counts = make_manifold(t, stars, poles, fixed, *changed, team, checkpoint);
          return std::pair(changed, counts);
        });
      },
      py::arg("tetrahedralization"), py::arg("stars"), py::arg("poles"), py::arg("known"), py::arg("labels"),
      py::arg("threads") = 0, py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
      "§3.5: labels whose surface is a manifold, and what was changed.");
  m.def(
      "extract_surface",
      [](const Tets& t, const py::object& labels, unsigned threads) {
        const Labels given = to_labels(labels, "labels", t);
        for (const Label label : given)
          if (label == Label::unlabelled)
            throw Error(ErrorKind::input, "labels", "a tetrahedron has no label", "settle all of them first");
        const py::gil_scoped_release unlocked;
        return std::make_shared<Surface>(extract_surface(t, given, Threads(threads)));
      },
      py::arg("tetrahedralization"), py::arg("labels"), py::arg("threads") = 0,
      "§3: the faces between inside and outside.");
  m.def(
      "smooth",
      [](const TriangleMesh& mesh, const std::string& method, std::uint32_t steps, unsigned threads) {
        const Smoothing kind = parse_smoothing(method);
        const py::gil_scoped_release unlocked;
        auto smoothed = std::make_shared<TriangleMesh>(mesh);
        smooth(*smoothed, kind, steps, Threads(threads));
        return smoothed;
      },
      py::arg("mesh"), py::arg("method") = "laplacian", py::arg("steps") = 1, py::arg("threads") = 0,
      "§3.6: a smoothed copy; boundary vertices stay.");
}

} // namespace

void bind_stages(py::module_& stages) {
  bind_beginning(stages);
  bind_knowledge(stages);
  bind_lines_of_sight(stages);
  bind_pole_graph(stages);
  bind_partition(stages);
  bind_second_stage(stages);
  bind_surface(stages);
}

} // namespace eigencrust::python
