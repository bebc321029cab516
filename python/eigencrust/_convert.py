# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes and clouds to and from the types of other packages, which are imported when they are asked for."""

from __future__ import annotations

import os
from typing import Any, Mapping, Optional, Union

import numpy as np

from . import _core
from ._errors import InputError


def colours_of(attributes: Mapping[str, np.ndarray]) -> Optional[np.ndarray]:
    """(N,3) float64 in 0..1 from red, green and blue, if there are any."""
    names = {name.lower(): name for name in attributes}
    if not all(channel in names for channel in ("red", "green", "blue")):
        return None
    columns = [attributes[names[channel]] for channel in ("red", "green", "blue")]
    if any(column.dtype.kind not in "iuf" for column in columns):
        return None
    return np.stack([c / np.iinfo(c.dtype).max if c.dtype.kind in "iu" else c for c in columns], axis=1).astype(float)


def normals_of(attributes: Mapping[str, np.ndarray]) -> Optional[np.ndarray]:
    """(N,3) float64 from nx, ny and nz, if there are any."""
    if not all(name in attributes for name in ("nx", "ny", "nz")):
        return None
    return np.stack([attributes[name] for name in ("nx", "ny", "nz")], axis=1).astype(float)


def mesh_to_trimesh(mesh: _core.Mesh) -> Any:
    """The mesh as trimesh.Trimesh; attributes are kept under their names. Needs trimesh."""
    import trimesh

    colours = colours_of(mesh.vertex_attributes)
    made = trimesh.Trimesh(
        vertices=mesh.vertices,
        faces=mesh.triangles.astype(np.int64),
        vertex_colors=None if colours is None else np.round(255 * colours).astype(np.uint8),
        process=False,
    )
    made.vertex_attributes.update({k: v for k, v in mesh.vertex_attributes.items() if isinstance(v, np.ndarray)})
    made.face_attributes.update({k: v for k, v in mesh.triangle_attributes.items() if isinstance(v, np.ndarray)})
    return made


def mesh_to_open3d(mesh: _core.Mesh) -> Any:
    """The mesh as open3d.geometry.TriangleMesh, with colours and normals where there are any. Needs Open3D."""
    import open3d

    made = open3d.geometry.TriangleMesh(
        # Open3D takes no array that cannot be written: hence a copy for it to copy.
        open3d.utility.Vector3dVector(np.array(mesh.vertices)),
        open3d.utility.Vector3iVector(mesh.triangles.astype(np.int32)),
    )
    colours, normals = colours_of(mesh.vertex_attributes), normals_of(mesh.vertex_attributes)
    if colours is not None:
        made.vertex_colors = open3d.utility.Vector3dVector(colours)
    if normals is not None:
        made.vertex_normals = open3d.utility.Vector3dVector(normals)
    return made


def mesh_to_pyvista(mesh: _core.Mesh) -> Any:
    """The mesh as pyvista.PolyData with its attributes as point and cell data. Needs PyVista."""
    import pyvista

    faces = np.empty((len(mesh.triangles), 4), np.int64)
    faces[:, 0] = 3
    faces[:, 1:] = mesh.triangles
    made = pyvista.PolyData(np.array(mesh.vertices), faces.ravel())
    for name, values in mesh.vertex_attributes.items():
        if isinstance(values, np.ndarray):
            made.point_data[name] = values
    for name, values in mesh.triangle_attributes.items():
        if isinstance(values, np.ndarray):
            made.cell_data[name] = values
    return made


def cloud_to_open3d(cloud: _core.PointCloud) -> Any:
    """The cloud as open3d.geometry.PointCloud, with colours and normals where there are any. Needs Open3D."""
    import open3d

    made = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(np.array(cloud.points)))
    colours, normals = colours_of(cloud.attributes), normals_of(cloud.attributes)
    if colours is not None:
        made.colors = open3d.utility.Vector3dVector(colours)
    if normals is not None:
        made.normals = open3d.utility.Vector3dVector(normals)
    return made


def cloud_to_pyvista(cloud: _core.PointCloud) -> Any:
    """The cloud as pyvista.PolyData with its attributes as point data. Needs PyVista."""
    import pyvista

    made = pyvista.PolyData(np.array(cloud.points))
    for name, values in cloud.attributes.items():
        if isinstance(values, np.ndarray):
            made.point_data[name] = values
    return made


def as_mesh(mesh: Any, what: str) -> _core.Mesh:
    """A Mesh; what has one; (vertices, triangles); a file; or a mesh of trimesh or Open3D."""
    if isinstance(mesh, _core.Mesh):
        return mesh
    if isinstance(mesh, (_core.Result, _core.stages.Surface)):
        return mesh.mesh
    if isinstance(mesh, (str, os.PathLike)):
        return _core.read_mesh(mesh)[0]
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return _core.Mesh(mesh[0], mesh[1])
    triangles = getattr(mesh, "triangles", getattr(mesh, "faces", None))
    vertices = getattr(mesh, "vertices", None)
    if vertices is None or triangles is None or callable(triangles):
        raise InputError(what, f"a {type(mesh).__name__} is no mesh", "pass a Mesh, a file, or (vertices, triangles)")
    return _core.Mesh(vertices, triangles)


Drawable = Union[_core.Mesh, _core.PointCloud, _core.Result]


def as_drawable(thing: Any) -> _core.Mesh:
    """What can be drawn as a mesh; a cloud as one without triangles."""
    if isinstance(thing, np.ndarray):
        thing = _core.PointCloud(thing)
    if isinstance(thing, _core.PointCloud):
        return thing._as_mesh()
    return as_mesh(thing, "object")
