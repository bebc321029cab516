# SPDX-License-Identifier: GPL-3.0-or-later
"""How meshes, clouds and results show themselves, in a terminal and in a notebook."""

from __future__ import annotations

import base64
import html
from typing import Any, List

from . import _core
from ._convert import as_drawable
from ._errors import Error


def _picture(thing: Any) -> str:
    try:
        pixels = _core.render([as_drawable(thing)], width=480, height=360, up=(0, 0, 1), azimuth=-60)
    except Error as error:  # nothing to draw: say so in place of the picture
        return f"<i>no picture: {html.escape(error.cause)}</i>"
    data = base64.b64encode(_core.encode_png(pixels)).decode("ascii")
    return f'<img alt="picture, z upward" width="480" height="360" src="data:image/png;base64,{data}">'


def _figure(thing: Any, lines: List[str]) -> str:
    text = "<br>".join(html.escape(line) for line in lines)
    return f"<figure>{_picture(thing)}<figcaption>{text}</figcaption></figure>"


def _names(attributes: Any) -> str:
    return ", ".join(attributes) or "none"


def mesh_repr(mesh: _core.Mesh) -> str:
    return f"<eigencrust.Mesh: {len(mesh.vertices):,} vertices, {len(mesh.triangles):,} triangles>"


def cloud_repr(cloud: _core.PointCloud) -> str:
    return f"<eigencrust.PointCloud: {len(cloud):,} points, attributes {_names(cloud.attributes)}>"


def result_repr(result: _core.Result) -> str:
    mesh = result.report["mesh"]
    pieces = "1 component" if mesh["components"] == 1 else f"{mesh['components']:,} components"
    return (
        f"<eigencrust.Result: {mesh['vertices']:,} vertices, {mesh['triangles']:,} triangles, {pieces}, "
        f"genus {mesh['genus']}>"
    )


def mesh_html(mesh: _core.Mesh) -> str:
    return _figure(mesh, [mesh_repr(mesh).strip("<>"), f"vertex attributes: {_names(mesh.vertex_attributes)}"])


def cloud_html(cloud: _core.PointCloud) -> str:
    return _figure(cloud, [cloud_repr(cloud).strip("<>")])


def result_html(result: _core.Result) -> str:
    report = result.report
    warnings = [f"warning: {text}" for text in result.warnings]
    cost = f"{report['input']['points']:,} points in {report['seconds']:.2f} s"
    return _figure(result.mesh, [result_repr(result).strip("<>"), cost, *warnings])


def summary_repr(summary: _core.MeshSummary) -> str:
    said = [f"{summary.triangles:,} triangles"]
    said += [word if getattr(summary, word) else f"not {word}" for word in ("closed", "manifold", "oriented")]
    return f"<eigencrust.MeshSummary: {', '.join(said)}, genus {summary.genus}>"
