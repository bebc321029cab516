# SPDX-License-Identifier: GPL-3.0-or-later
"""Raw point clouds into watertight, manifold triangle meshes.

    import eigencrust
    result = eigencrust.reconstruct(points)          # (N,3) numpy array
    eigencrust.write_mesh("mesh.ply", result)
"""

from __future__ import annotations

import json as _json

from . import _convert, _core, _display, stages
from ._api import (
    Forecast,
    Outliers,
    Session,
    check,
    compare,
    distances_to_points,
    distances_to_surface,
    forecast,
    info,
    join_scans,
    measure,
    orient,
    outliers,
    read_mesh,
    read_mesh_and_unit,
    read_point_cloud,
    read_scan_index,
    read_scan_sensors,
    reconstruct,
    render,
    sample_surface,
    summarize,
    volume_iou,
    write_mesh,
    write_png,
    write_point_cloud,
)
from ._arrays import ListColumn, Sensor
from ._core import (
    Cancellation,
    Comparison,
    ComponentSummary,
    DistanceStatistics,
    Mesh,
    MeshMeasures,
    MeshSummary,
    PointCloud,
    Result,
    TriangleTree,
    can_write_mesh,
    can_write_point_cloud,
    encode_png,
    length_in_words,
    sha256_of_file,
)
from ._errors import Cancelled, Error, GuaranteeError, InputError, MemoryLimitError, NoSurfaceError, UsageError
from ._options import Option, option_table

__version__: str = _core.version


def _dress() -> None:
    """Gives the classes of the extension what is easier said in Python."""
    Mesh.to_trimesh = _convert.mesh_to_trimesh
    Mesh.to_open3d = _convert.mesh_to_open3d
    Mesh.to_pyvista = _convert.mesh_to_pyvista
    Mesh.__repr__ = _display.mesh_repr
    Mesh._repr_html_ = _display.mesh_html
    Mesh.__reduce__ = lambda mesh: (
        _remade_mesh,
        (mesh.vertices, mesh.triangles, mesh.vertex_attributes, mesh.triangle_attributes),
    )
    PointCloud.to_open3d = _convert.cloud_to_open3d
    PointCloud.to_pyvista = _convert.cloud_to_pyvista
    PointCloud.__repr__ = _display.cloud_repr
    PointCloud._repr_html_ = _display.cloud_html
    Result.report = property(
        lambda result: _json.loads(result._report_json), doc="What was done and found, as a dict: docs/report.md."
    )
    Result.vertices = property(lambda result: result.mesh.vertices, doc="(V,3) float64, of the mesh")
    Result.triangles = property(lambda result: result.mesh.triangles, doc="(T,3) uint32, of the mesh")
    Result.to_trimesh = lambda result: result.mesh.to_trimesh()
    Result.to_open3d = lambda result: result.mesh.to_open3d()
    Result.to_pyvista = lambda result: result.mesh.to_pyvista()
    Result.__repr__ = _display.result_repr
    Result._repr_html_ = _display.result_html
    MeshSummary.as_dict = lambda summary: _json.loads(summary._json)
    MeshSummary.__repr__ = _display.summary_repr
    MeshMeasures.as_dict = lambda measures: _json.loads(measures._json)
    MeshMeasures.__repr__ = lambda measures: f"<eigencrust.MeshMeasures: {measures.printability}>"


def _remade_mesh(vertices, triangles, vertex_attributes, triangle_attributes):  # type: ignore[no-untyped-def]
    return Mesh(vertices, triangles, vertex_attributes=vertex_attributes, triangle_attributes=triangle_attributes)


_dress()
# Written out, for type checkers read no others; a test compares.
__all__ = [
    "Cancellation",
    "Cancelled",
    "Comparison",
    "ComponentSummary",
    "DistanceStatistics",
    "Error",
    "Forecast",
    "GuaranteeError",
    "InputError",
    "ListColumn",
    "MemoryLimitError",
    "Mesh",
    "MeshMeasures",
    "MeshSummary",
    "NoSurfaceError",
    "Option",
    "Outliers",
    "PointCloud",
    "Result",
    "Sensor",
    "Session",
    "TriangleTree",
    "UsageError",
    "can_write_mesh",
    "can_write_point_cloud",
    "check",
    "compare",
    "distances_to_points",
    "distances_to_surface",
    "encode_png",
    "forecast",
    "info",
    "join_scans",
    "length_in_words",
    "measure",
    "option_table",
    "orient",
    "outliers",
    "read_mesh",
    "read_mesh_and_unit",
    "read_point_cloud",
    "read_scan_index",
    "read_scan_sensors",
    "reconstruct",
    "render",
    "sample_surface",
    "sha256_of_file",
    "stages",
    "summarize",
    "volume_iou",
    "write_mesh",
    "write_png",
    "write_point_cloud",
]
