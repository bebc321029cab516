# SPDX-License-Identifier: GPL-3.0-or-later
"""Every step of the method as a function, in the order of Kolluri, Shewchuk and O'Brien (SGP 2004).

What one step returns is what the next takes; arrays are read-only views. Indices are uint32, and 2^32-1 (`NONE`)
stands for none. Labels are uint8: 0 unlabelled, 1 inside, 2 outside. Coordinates are relative to `origin`.
"""

from __future__ import annotations

from typing import Any, Optional

from ._core import stages as _stages
from ._core.stages import (
    ManifoldCounts,
    Partition,
    PoleGraph,
    PoleLabels,
    Poles,
    Samples,
    SightCrossings,
    SightLabels,
    SightLines,
    SignedGraph,
    Surface,
    Tetrahedralization,
    TetrahedronGraph,
    TetrahedronLabels,
    VertexStars,
    extract_surface,
    find_poles,
    known_labels,
    label_poles,
    label_tetrahedra,
    line_of_sight,
    make_manifold,
    median_spacing,
    pole_graph,
    prepare_samples,
    questionable_tetrahedra,
    sight_crossings,
    sight_lines,
    smooth,
    supernodes_agree,
    tetrahedralize,
    tetrahedron_graph,
    unlabel_questionable,
    vertex_stars,
)
from ._options import make_options

NONE = 2**32 - 1
UNLABELLED, INSIDE, OUTSIDE = 0, 1, 2


def resolve_grid_spacing(option: Any, samples: Samples, points: Any, threads: int = 0) -> float:
    """The grid spacing of §3.3 from the option "auto", "off", a length or "N%"; 0 means off."""
    return _stages.resolve_grid_spacing(str(option), samples, points, threads)


def partition_poles(
    graph: PoleGraph,
    *,
    reduce: bool = True,
    threads: int = 0,
    progress: Optional[Any] = None,
    cancel: Optional[Any] = None,
    **solver: Any,
) -> Partition:
    """§3.2: the eigenvector of the smallest eigenvalue of L x = λ D x.

    reduce: nodes that one edge decides are merged before. solver: preset, eigensolver, tolerance, max_steps,
    stable_share as in reconstruct().
    """
    return _stages.partition_poles(graph, make_options(solver), reduce, threads, progress, cancel)


def partition_tetrahedra(
    graph: TetrahedronGraph,
    method: str = "harmonic",
    *,
    threads: int = 0,
    progress: Optional[Any] = None,
    cancel: Optional[Any] = None,
    **solver: Any,
) -> Partition:
    """§3.4: "eigenvector", as in the paper, or "harmonic": outside fixed at +1, inside at -1."""
    return _stages.partition_tetrahedra(graph, method, make_options(solver), threads, progress, cancel)


_not_ours = ("annotations", "Any", "Optional", "make_options")
__all__ = sorted(name for name in globals() if not name.startswith("_") and name not in _not_ours)
