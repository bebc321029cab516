# SPDX-License-Identifier: GPL-3.0-or-later
"""Every stage of the method from Python: together they make a surface, and pieces that do not fit are refused."""

import unittest

import eigencrust
import numpy as np
from eigencrust import stages
from support import sphere


class Whole(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.points = np.concatenate([sphere(1500, centre=(100, 0, 0)), sphere(20, centre=(100, 0, 0))])
        cls.samples = stages.prepare_samples(cls.points)
        cls.tets = stages.tetrahedralize(cls.samples)
        cls.stars = stages.vertex_stars(cls.tets)
        cls.known = stages.known_labels(cls.tets, cls.stars)
        cls.poles = stages.find_poles(cls.tets, cls.stars)
        cls.graph = stages.pole_graph(cls.tets, cls.stars, cls.poles, cls.known)
        cls.first = stages.partition_poles(cls.graph)
        cls.labelled = stages.label_poles(cls.tets, cls.poles, cls.graph, cls.first, cls.known)

    def settled(self, method):
        graph = stages.tetrahedron_graph(self.tets, self.labelled.labels)
        second = stages.partition_tetrahedra(graph, method)
        self.assertFalse(stages.supernodes_agree(second))
        self.assertEqual(len(graph.tetrahedron), graph.graph.node_count)
        return stages.label_tetrahedra(self.tets, graph, second, self.labelled.labels)

    def test_samples(self):
        self.assertEqual((len(self.samples), self.samples.duplicates, self.samples.nonfinite), (1520, 0, 0))
        positions = self.samples.positions + np.array(self.samples.origin)
        np.testing.assert_allclose(positions, self.points[self.samples.source], atol=1e-12)
        np.testing.assert_array_equal(self.samples.of_row[self.samples.source], np.arange(1520))
        spacing = stages.median_spacing(self.samples, self.points)
        self.assertTrue(0.01 < spacing < 0.2)
        self.assertEqual(stages.resolve_grid_spacing("off", self.samples, self.points), 0)
        self.assertEqual(stages.resolve_grid_spacing(0.5, self.samples, self.points), 0.5)

    def test_tetrahedra(self):
        tets, positions = self.tets.tetrahedra, self.tets.positions
        self.assertEqual(len(self.tets), len(tets))
        self.assertEqual(self.tets.sample_count + 8, len(positions))
        a, b, c, d = (positions[tets[:, k]] for k in range(4))
        self.assertTrue((np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) > 0).all())
        inner = self.tets.neighbours != stages.NONE
        self.assertEqual(inner.sum() % 2, 0)
        begin = self.stars.begin
        self.assertEqual((begin[0], begin[-1]), (0, 4 * len(tets)))
        first = self.stars.tetrahedra[begin[7] : begin[8]]
        self.assertTrue((tets[first] == 7).any(axis=1).all())

    def test_poles(self):
        self.assertEqual(self.poles.of_sample.shape, (1520, 2))
        self.assertEqual(self.poles.centre.shape, (len(self.poles), 3))
        corner = self.tets.positions[self.tets.tetrahedra[self.poles.tetrahedron, 0]]
        np.testing.assert_allclose(np.linalg.norm(self.poles.centre - corner, axis=1), self.poles.radius, rtol=1e-6)
        lengths = np.full(1520, 0.1)
        self.assertLessEqual(len(stages.find_poles(self.tets, self.stars, reach=lengths)), len(self.poles))
        self.assertGreater(len(stages.find_poles(self.tets, self.stars, weights="paper")), 0)

    def test_first_stage(self):
        graph = self.graph.graph
        self.assertEqual(len(graph.row_begin), graph.node_count + 1)
        self.assertEqual(len(graph.column), len(graph.weight))
        self.assertEqual(len(graph.supernodes), len(graph.supernode_weight))
        self.assertEqual(len(graph.supernodes[0]), graph.node_count)
        self.assertEqual(len(self.graph.node), len(self.poles))
        self.assertEqual(len(self.first.value), graph.node_count)
        self.assertEqual(len(self.first.component), graph.node_count)
        self.assertIn(self.first.status, ("converged", "signs_stable", "consistent"))
        exact = stages.partition_poles(self.graph, reduce=False, eigensolver="lanczos", tolerance=1e-9)
        sign = np.sign(exact.value) * np.sign(exact.supernode_value[0])
        ours = np.sign(self.first.value) * np.sign(self.first.supernode_value[0])
        self.assertGreater((sign == ours).mean(), 0.99)
        self.assertFalse(self.labelled.reversed)
        self.assertGreater(self.labelled.vote, 0)
        self.assertEqual(self.labelled.trust.shape, self.labelled.labels.shape)

    def test_questionable(self):
        none = stages.questionable_tetrahedra(self.tets, None)
        self.assertFalse(none.any())
        flags = stages.questionable_tetrahedra(self.tets, np.full(1520, 0.05))
        self.assertEqual(flags.dtype, np.bool_)
        self.assertTrue(0 < flags.sum() < len(flags))
        labels, count = stages.unlabel_questionable(self.tets, flags, self.known, self.labelled.labels)
        self.assertEqual(count, (labels != self.labelled.labels).sum())
        self.assertTrue((labels[flags & (self.known == 0)] == stages.UNLABELLED).all())

    def test_surface(self):
        for method in ("harmonic", "eigenvector"):
            settled = self.settled(method)
            self.assertEqual(len(settled), len(self.tets))
            np.testing.assert_array_equal(settled.labels == stages.OUTSIDE, settled.values >= 0)
            manifold, counts = stages.make_manifold(self.tets, self.stars, self.poles, self.known, settled)
            self.assertEqual(counts.relabelled >= (manifold.labels != settled.labels).sum(), True)
            surface = stages.extract_surface(self.tets, manifold.labels)
            summary = eigencrust.check(surface.mesh)
            self.assertTrue(summary.closed and summary.manifold and summary.oriented)
            self.assertAlmostEqual(summary.volume, 4 / 3 * np.pi, delta=0.05)
            self.assertEqual(len(surface.sample_of), len(surface.mesh.vertices))
            self.assertEqual(len(surface.inside), len(surface.mesh.triangles))
            smooth = stages.smooth(surface.mesh, "taubin", 2)
            self.assertEqual(len(smooth.vertices), len(surface.mesh.vertices))
            self.assertTrue((smooth.vertices != surface.mesh.vertices).any())

    def test_lines_of_sight(self):
        cloud = eigencrust.PointCloud(self.points, sensors=(100, 0, 9))
        lines = stages.sight_lines(cloud, self.samples, self.tets, np.full(1520, 0.02))
        self.assertEqual((len(lines), len(lines.sample), len(lines.depth), lines.target.shape), (1520, 1520, 1520, (1520, 3)))
        # They look from the sample to the scanner, and end there or where they leave the box of the samples.
        sample = self.tets.positions[lines.sample]
        way, ended = np.array([100, 0, 9]) - self.samples.origin - sample, lines.target - sample
        np.testing.assert_allclose(np.cross(way, ended), 0, atol=1e-9)
        share = (way * ended).sum(axis=1) / (way * way).sum(axis=1)
        self.assertTrue(((0 <= share) & (share <= 1)).all())
        crossings = stages.sight_crossings(self.tets, self.stars, lines, self.known)
        self.assertEqual(len(crossings.begin), 1521)
        self.assertEqual(crossings.begin[-1], len(crossings.tetrahedra))
        for further in ({}, dict(weights="paper"), dict(isolated=np.zeros(1520))):
            seen = stages.line_of_sight(self.tets, self.stars, lines, crossings, self.known, **further)
            self.assertEqual((seen.labels == stages.OUTSIDE).sum(), (self.known == stages.OUTSIDE).sum() + seen.outside)
            self.assertEqual(seen.front.shape, seen.behind.shape)
            self.assertGreaterEqual(seen.disbelieved + seen.inside, 0)

    def test_named_points(self):
        labels = stages.known_labels(self.tets, self.stars, inside_points=(100, 0, 0))
        self.assertEqual((labels == stages.INSIDE).sum(), 1)
        open_ones = stages.known_labels(self.tets, self.stars, facade="+z")
        self.assertGreater((open_ones == stages.INSIDE).sum(), 0)
        with self.assertRaises(eigencrust.UsageError):
            stages.known_labels(self.tets, self.stars, (100, 0, 0), (100, 0, 0))

    def test_noisy_samples_join_no_chains(self):
        points = np.random.default_rng(1).random((300, 3))
        tets = stages.tetrahedralize(stages.prepare_samples(points))
        stars = stages.vertex_stars(tets)
        known, poles = stages.known_labels(tets, stars), stages.find_poles(tets, stars)

        def nodes(noisy):
            return stages.pole_graph(tets, stars, poles, known, noisy=noisy).graph.node_count

        self.assertEqual(nodes(np.zeros(300, bool)), nodes(None))
        self.assertGreater(nodes(np.ones(300, bool)), nodes(None))

    def test_pieces_that_do_not_fit(self):
        other = stages.tetrahedralize(stages.prepare_samples(sphere(50)))
        other_stars = stages.vertex_stars(other)
        other_known = stages.known_labels(other, other_stars)
        other_poles = stages.find_poles(other, other_stars)
        other_graph = stages.pole_graph(other, other_stars, other_poles, other_known)
        other_first = stages.partition_poles(other_graph)
        settled = self.settled("harmonic")
        lines = stages.sight_lines(
            eigencrust.PointCloud(self.points, sensors=(0, 0, 0)), self.samples, self.tets, np.zeros(1520)
        )
        crossings = stages.sight_crossings(self.tets, self.stars, lines, self.known)
        for call in (
            lambda: stages.median_spacing(self.samples, sphere(9)),
            lambda: stages.find_poles(self.tets, other_stars),
            lambda: stages.find_poles(self.tets, self.stars, reach=[1.0, 2.0]),
            lambda: stages.known_labels(self.tets, other_stars),
            lambda: stages.sight_lines(self.points, self.samples, other, np.zeros(50)),
            lambda: stages.sight_lines(self.points, self.samples, self.tets, None),
            lambda: stages.sight_crossings(other, other_stars, lines, other_known),
            lambda: stages.line_of_sight(other, other_stars, lines, crossings, other_known),
            lambda: stages.questionable_tetrahedra(self.tets, np.zeros(3)),
            lambda: stages.pole_graph(self.tets, self.stars, other_poles, self.known),
            lambda: stages.pole_graph(self.tets, self.stars, self.poles, other_known),
            lambda: stages.pole_graph(self.tets, self.stars, self.poles, self.known + 9),
            lambda: stages.pole_graph(self.tets, self.stars, self.poles, self.known, noisy=[True, False]),
            lambda: stages.label_poles(self.tets, self.poles, other_graph, other_first, self.known),
            lambda: stages.label_poles(self.tets, self.poles, self.graph, other_first, self.known),
            lambda: stages.tetrahedron_graph(self.tets, other_known),
            lambda: stages.make_manifold(other, other_stars, other_poles, other_known, settled),
            lambda: stages.extract_surface(self.tets, np.zeros(len(self.tets), np.uint8)),
            lambda: stages.extract_surface(self.tets, np.ones(3, np.uint8)),
            lambda: stages.extract_surface(self.tets, np.full(len(self.tets), 2.0)),
        ):
            with self.assertRaises(eigencrust.InputError):
                call()
        with self.assertRaises(eigencrust.UsageError):
            stages.partition_tetrahedra(stages.tetrahedron_graph(self.tets, self.known), "cut")

    def test_stages_can_be_cancelled(self):
        with self.assertRaises(ZeroDivisionError):
            stages.partition_poles(self.graph, progress=lambda stage, fraction: 1 / 0)
        token = eigencrust.Cancellation()
        token.cancel()
        with self.assertRaises(eigencrust.Cancelled):
            stages.partition_poles(self.graph, cancel=token)


if __name__ == "__main__":
    unittest.main(verbosity=2)
