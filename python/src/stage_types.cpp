// SPDX-License-Identifier: GPL-3.0-or-later
// What flows between the stages, as read-only arrays.
#include <pybind11/stl.h>

#include "stage_types.h"

namespace eigencrust::python {
namespace {

/// `get(const Owner&)` returns a reference to a vector that the owner holds.
template <class Owner, class Get>
auto array_of(Get get) {
  return [get](const py::object& self) { return view(get(self.cast<const Owner&>()), self); };
}

void bind_samples(py::module_& m) {
  using S = Samples;
  py::class_<S, std::shared_ptr<S>>(m, "Samples", "Distinct finite points, exactly relative to an origin.")
      .def_property_readonly("origin", [](const S& s) { return py::make_tuple(s.origin.x, s.origin.y, s.origin.z); })
      .def_property_readonly("positions", array_of<S>([](const S& s) -> auto& { return s.positions.raw(); }),
                             "(S,3) relative to the origin, along a Hilbert curve")
      .def_property_readonly("source", array_of<S>([](const S& s) -> auto& { return s.source.raw(); }),
                             "(S,) smallest row of each sample")
      .def_property_readonly("of_row", array_of<S>([](const S& s) -> auto& { return s.of_row; }),
                             "(N,) sample of each row; 2^32-1 where it is not finite")
      .def_readonly("duplicates", &S::duplicates)
      .def_readonly("nonfinite", &S::nonfinite)
      .def("__len__", [](const S& s) { return s.positions.size(); });
}

void bind_tetrahedra(py::module_& m) {
  using T = Tetrahedralization;
  py::class_<T, std::shared_ptr<T>>(m, "Tetrahedralization",
                                    "Delaunay tetrahedra of the samples and the eight corners of a wide cube.")
      .def_property_readonly("origin", [](const T& t) { return py::make_tuple(t.origin.x, t.origin.y, t.origin.z); })
      .def_readonly("sample_count", &T::sample_count, "Without the eight corners, which come last.")
      .def_property_readonly("positions", array_of<T>([](const T& t) -> auto& { return t.positions.raw(); }),
                             "(S+8,3) relative to the origin")
      .def_property_readonly("source", array_of<T>([](const T& t) -> auto& { return t.source.raw(); }),
                             "(S,) smallest row of each sample")
      .def_property_readonly("tetrahedra", array_of<T>([](const T& t) -> auto& { return t.tetrahedra.raw(); }),
                             "(T,4) samples, positively oriented")
      .def_property_readonly("neighbours", array_of<T>([](const T& t) -> auto& { return t.neighbours.raw(); }),
                             "(T,4) tetrahedron beyond the face opposite each vertex; 2^32-1 beyond the cube")
      .def("__len__", [](const T& t) { return t.tetrahedra.size(); });
  py::class_<VertexStars>(m, "VertexStars", "The tetrahedra around each sample, as compressed rows.")
      .def_property_readonly("begin", array_of<VertexStars>([](const VertexStars& s) -> auto& { return s.begin; }),
                             "(S+9,) uint64")
      .def_property_readonly("tetrahedra",
                             array_of<VertexStars>([](const VertexStars& s) -> auto& { return s.tetrahedra; }),
                             "(4T,) uint32");
}

void bind_poles(py::module_& m) {
  py::class_<Poles>(m, "Poles", "The two poles of each sample.")
      .def_property_readonly("tetrahedron",
                             array_of<Poles>([](const Poles& p) -> auto& { return p.tetrahedron.raw(); }),
                             "(P,) the tetrahedron of each pole")
      .def_property_readonly(
          "centre",
          [](const py::object& self) {
            return view_member(self.cast<const Poles&>().sphere.raw(), &Sphere::centre, self);
          },
          "(P,3) of its circumsphere, relative to the origin")
      .def_property_readonly(
          "radius",
          [](const py::object& self) {
            return view_member(self.cast<const Poles&>().sphere.raw(), &Sphere::radius, self);
          },
          "(P,)")
      .def_property_readonly(
          "of_sample",
          [](const py::object& self) {
            const auto& pairs = self.cast<const Poles&>().of_sample.raw();
            return view_memory(py::dtype::of<std::uint32_t>(), {static_cast<py::ssize_t>(pairs.size()), 2},
                               {sizeof(PolePair), sizeof(PoleIndex)}, pairs.data(), self);
          },
          "(S,2) the farther pole and the one on the other side; 2^32-1 for none")
      .def("__len__", [](const Poles& p) { return p.tetrahedron.size(); });
}

void bind_graphs(py::module_& m) {
  using G = SignedGraph;
  py::class_<G>(m, "SignedGraph", "Weights > 0 say: same side, < 0: opposite sides. Symmetric, as compressed rows.")
      .def_property_readonly("row_begin", array_of<G>([](const G& g) -> auto& { return g.row_begin; }))
      .def_property_readonly("column", array_of<G>([](const G& g) -> auto& { return g.column; }))
      .def_property_readonly("weight", array_of<G>([](const G& g) -> auto& { return g.weight; }))
      .def_property_readonly(
          "supernodes",
          [](const py::object& self) {
            py::list columns;
            for (const G::Supernode& s : self.cast<const G&>().supernodes) columns.append(view(s.weight, self));
            return columns;
          },
          "Of each supernode its weight to every node, 0 where there is no edge.")
      .def_readonly("supernode_weight", &G::supernode_weight)
      .def_property_readonly("node_count", &G::node_count);
  py::class_<PoleGraph, std::shared_ptr<PoleGraph>>(m, "PoleGraph",
                                                    "Supernode 0 is the outside, 1 the inside where some is known.")
      .def_property_readonly(
          "graph", [](PoleGraph& g) { return &g.graph; }, py::return_value_policy::reference_internal)
      .def_property_readonly("node", array_of<PoleGraph>([](const PoleGraph& g) -> auto& { return g.node.raw(); }),
                             "(P,) node of each pole; 2^32-1 where it is known or left out");
  py::class_<TetrahedronGraph>(m, "TetrahedronGraph", "One node per tetrahedron without a label.")
      .def_property_readonly(
          "graph", [](TetrahedronGraph& g) { return &g.graph; }, py::return_value_policy::reference_internal)
      .def_property_readonly("tetrahedron", array_of<TetrahedronGraph>([](const TetrahedronGraph& g) -> auto& {
                               return g.tetrahedron.raw();
                             }));
  py::class_<SolvedPartition, std::shared_ptr<SolvedPartition>>(m, "Partition",
                                                                "A solution with the figures to judge it by.")
      .def_property_readonly("value",
                             array_of<SolvedPartition>([](const SolvedPartition& p) -> auto& { return p.value; }),
                             "(nodes,) its sign is the side")
      .def_readonly("supernode_value", &Partition::supernode_value)
      .def_property_readonly(
          "component", array_of<SolvedPartition>([](const SolvedPartition& p) -> auto& { return p.component; }),
          "(nodes,) piece of the graph that each node belongs to, 0 with the supernodes; empty for the second stage")
      .def_readonly("edges", &Partition::edges)
      .def_readonly("eigenvalue", &Partition::eigenvalue)
      .def_readonly("residual", &Partition::residual)
      .def_readonly("iterations", &Partition::iterations)
      .def_readonly("sign_changes", &Partition::sign_changes)
      .def_readonly("components", &Partition::components)
      .def_readonly("free_components", &Partition::free_components)
      .def_readonly("undecided", &Partition::undecided)
      .def_property_readonly("status", [](const SolvedPartition& p) { return to_string(p.status); });
}

void bind_sight(py::module_& m) {
  using L = SightLines;
  py::class_<L>(m, "SightLines", "From samples to what saw them.")
      .def_property_readonly(
          "sample",
          [](const py::object& self) { return view_member(self.cast<const L&>().lines, &SightLine::sample, self); })
      .def_property_readonly(
          "depth",
          [](const py::object& self) { return view_member(self.cast<const L&>().lines, &SightLine::depth, self); })
      .def_property_readonly(
          "target",
          [](const py::object& self) { return view_member(self.cast<const L&>().lines, &SightLine::target, self); },
          "(L,3) relative to the origin")
      .def("__len__", [](const L& lines) { return lines.lines.size(); });
  using C = SightCrossings;
  py::class_<C>(m, "SightCrossings", "The tetrahedra that each line crosses, as compressed rows.")
      .def_property_readonly("begin", array_of<C>([](const C& c) -> auto& { return c.begin; }))
      .def_property_readonly("tetrahedra", array_of<C>([](const C& c) -> auto& { return c.tetrahedra; }));
  using S = SightLabels;
  py::class_<S>(m, "SightLabels", "Labels with what the lines of sight say.")
      .def_property_readonly("labels", array_of<S>([](const S& s) -> auto& { return s.labels.raw(); }))
      .def_property_readonly("front", array_of<S>([](const S& s) -> auto& { return s.front.raw(); }),
                             "(T,) lines that cross each tetrahedron, at most 255")
      .def_property_readonly("behind", array_of<S>([](const S& s) -> auto& { return s.behind.raw(); }),
                             "(T,) samples right in front of it, at most 255")
      .def_readonly("disbelieved", &S::disbelieved)
      .def_readonly("outside", &S::outside)
      .def_readonly("inside", &S::inside);
}

void bind_labels(py::module_& m) {
  using P = PoleLabels;
  py::class_<P>(m, "PoleLabels", "Labels from the signs of the partition, added to what is known.")
      .def_property_readonly("labels", array_of<P>([](const P& p) -> auto& { return p.labels.raw(); }))
      .def_property_readonly("trust", array_of<P>([](const P& p) -> auto& { return p.trust.raw(); }),
                             "(T,) agreement of labelled poles with their neighbours, 255: all")
      .def_readonly("reversed", &P::reversed)
      .def_readonly("vote", &P::vote)
      .def_readonly("left_to_stage_two", &P::left_to_stage_two)
      .def_readonly("contradicted", &P::contradicted);
  using T = TetrahedronLabels;
  py::class_<T, std::shared_ptr<T>>(m, "TetrahedronLabels", "A side for every tetrahedron, and how sure that is.")
      .def_property_readonly("labels", array_of<T>([](const T& t) -> auto& { return t.labels().raw(); }),
                             "(T,) uint8: 1 inside, 2 outside")
      .def_property_readonly("values", array_of<T>([](const T& t) -> auto& { return t.values().raw(); }),
                             "(T,) float32, > 0 outside")
      .def("__len__", [](const T& t) { return t.size(); });
  using S = Surface;
  py::class_<S, std::shared_ptr<S>>(m, "Surface", "The faces between inside and outside.")
      .def_property_readonly(
          "mesh", [](const std::shared_ptr<S>& s) { return std::shared_ptr<TriangleMesh>(s, &s->mesh); },
          "Its coordinates are relative to the origin.")
      .def_property_readonly("sample_of", array_of<S>([](const S& s) -> auto& { return s.sample_of; }),
                             "(V,) sample behind each vertex")
      .def_property_readonly("inside", array_of<S>([](const S& s) -> auto& { return s.inside; }),
                             "(T,) tetrahedron behind each triangle");
  py::class_<ManifoldCounts>(m, "ManifoldCounts")
      .def_readonly("edges", &ManifoldCounts::edges)
      .def_readonly("vertices", &ManifoldCounts::vertices)
      .def_readonly("relabelled", &ManifoldCounts::relabelled)
      .def_readonly("overruled", &ManifoldCounts::overruled);
}

} // namespace

void bind_stage_types(py::module_& stages) {
  bind_samples(stages);
  bind_tetrahedra(stages);
  bind_poles(stages);
  bind_graphs(stages);
  bind_sight(stages);
  bind_labels(stages);
}

} // namespace eigencrust::python
