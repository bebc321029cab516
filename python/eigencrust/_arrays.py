# SPDX-License-Identifier: GPL-3.0-or-later
"""What people pass as points, indices and columns, checked and as numpy arrays. The library copies them once."""

from __future__ import annotations

import os
from typing import Any, Mapping, NamedTuple, Optional, Tuple

import numpy as np

from ._errors import InputError


class Sensor(NamedTuple):
    """Where a scanner stood; at infinity there is no place but the unit direction from the surface to it."""

    place: Tuple[float, float, float]
    at_infinity: bool


class ListColumn(NamedTuple):
    """A column of lists: row i holds values[offsets[i]:offsets[i + 1]]."""

    values: np.ndarray
    offsets: np.ndarray


def as_array(values: Any, what: str) -> np.ndarray:
    """values as a numpy array; no copy where it is one."""
    if isinstance(values, np.ma.MaskedArray):
        raise InputError(what, "it is a masked array", "fill it, .filled(numpy.nan), or leave out what is masked")
    try:
        return np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise InputError(what, f"it cannot be made an array: {error}", "give rows of equal length") from None


def _as_float(array: np.ndarray, what: str) -> np.ndarray:
    kind, size = array.dtype.kind, array.dtype.itemsize
    if kind == "f" and size in (4, 8) and array.dtype.isnative:
        return array
    if kind == "f" and size <= 8:
        return array.astype(np.float64)
    if kind in "iu":
        if size == 8 and array.size > 0 and max(abs(int(array.min())), abs(int(array.max()))) > 2**53:
            raise InputError(what, "whole numbers beyond 2^53 are no exact coordinates", "shift them, then use float64")
        return array.astype(np.float64)
    raise InputError(what, f"numbers are needed, not {array.dtype}", "use an array of float64 or float32")


def as_points(points: Any, what: str) -> np.ndarray:
    """(N,3), N > 0, float32 or float64 in the machine's byte order, any strides."""
    if isinstance(points, (str, os.PathLike)):
        raise InputError(what, "it is the name of a file", "read that first, eigencrust.read_point_cloud(...)")
    array = as_array(points, what)
    if array.size == 0:
        raise InputError(what, f"it is empty, of shape {array.shape}", "give an array of shape (N, 3)")
    if array.ndim != 2 or array.shape[1] != 3:
        remedy = "give an array of shape (N, 3)"
        if array.ndim == 2 and array.shape[0] == 3:
            remedy += ", perhaps its transpose .T"
        elif array.ndim == 2 and array.shape[1] > 3:
            remedy += ", perhaps its first columns [:, :3]"
        raise InputError(what, f"its shape is {array.shape}", remedy)
    return _as_float(array, what)


def as_places(places: Any, what: str) -> np.ndarray:
    """Points of which there may be none, or a single one without its row."""
    array = as_array(places, what)
    if array.shape == (3,):
        array = array.reshape(1, 3)
    if array.size == 0:
        raise InputError(what, "it is empty", "pass None for none")
    return as_points(array, what)


def _one_dimensional(values: Any, what: str) -> np.ndarray:
    array = as_array(values, what)
    if array.ndim != 1:
        raise InputError(what, f"its shape is {array.shape}", "give one entry per row, an array of shape (N,)")
    return array


def as_integers(values: Any, what: str) -> np.ndarray:
    """(N,) whole numbers as int64."""
    array = _one_dimensional(values, what)
    if array.dtype.kind not in "iub":
        raise InputError(what, f"whole numbers are needed, not {array.dtype}", "convert it, for example .astype(int)")
    if array.dtype == np.uint64 and array.size > 0 and int(array.max()) > 2**63 - 1:
        raise InputError(what, "a number exceeds 2^63", "number from 0")
    return np.ascontiguousarray(array, dtype=np.int64)


def as_numbers(values: Any, what: str) -> np.ndarray:
    """(N,) numbers as float64."""
    array = _one_dimensional(values, what)
    if array.dtype.kind == "b":
        array = array.astype(np.uint8)
    return np.ascontiguousarray(_as_float(array, what), dtype=np.float64)


def as_triangles(triangles: Any, vertices: int) -> np.ndarray:
    """(T,3) uint32, each below `vertices`."""
    array = as_array(triangles, "triangles")
    if array.size == 0:
        return np.empty((0, 3), np.uint32)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InputError("triangles", f"its shape is {array.shape}", "give an array of shape (T, 3)")
    if array.dtype.kind not in "iu":
        raise InputError("triangles", f"whole numbers are needed, not {array.dtype}", "give indices into the vertices")
    least, most = int(array.min()), int(array.max())
    if least < 0 or most >= vertices:
        raise InputError(
            "triangles",
            f"a triangle names vertex {least if least < 0 else most} of {vertices}",
            "number the vertices from 0",
        )
    return np.ascontiguousarray(array, dtype=np.uint32)


def _as_column(values: Any, what: str) -> np.ndarray:
    """A column of a type that files have: whole numbers of up to 32 bits, float32 or float64."""
    array = _one_dimensional(values, what)
    kind, size = array.dtype.kind, array.dtype.itemsize
    if kind == "b":
        return np.ascontiguousarray(array, dtype=np.uint8)
    if kind in "iu" and size == 8:
        least, most = (int(array.min()), int(array.max())) if array.size > 0 else (0, 0)
        for smaller in (np.int32, np.uint32):
            if np.iinfo(smaller).min <= least and most <= np.iinfo(smaller).max:
                return np.ascontiguousarray(array, dtype=smaller)
        return np.ascontiguousarray(_as_float(array, what))
    if kind in "iu":
        return np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("="))
    return np.ascontiguousarray(_as_float(array, what))


def as_columns(
    columns: Mapping[str, Any], rows: int, of: str
) -> "list[Tuple[str, np.ndarray, Optional[np.ndarray]]]":
    """(name, values, offsets or None) of each column; of lists there are offsets."""
    if not isinstance(columns, Mapping):
        raise InputError("attributes", f"it is a {type(columns).__name__}", "give a dict of names and columns")
    result = []
    for name, column in columns.items():
        what = f"attribute {name}"
        offsets = None
        if isinstance(column, ListColumn):
            offsets = as_integers(column.offsets, what).astype(np.uint64)
            column = column.values
            rises = len(offsets) > 0 and bool((np.diff(offsets.view(np.int64)) >= 0).all())
            if not rises or offsets[0] != 0 or offsets[-1] != len(column):
                raise InputError(what, "its offsets do not rise from 0 to the number of values", "see ListColumn")
        elif as_array(column, what).ndim == 2:
            raise InputError(
                what,
                f"its shape is {np.shape(column)}",
                "give each of its columns a name, for example red, green, blue",
            )
        values = _as_column(column, what)
        found = len(values) if offsets is None else len(offsets) - 1
        if found != rows:
            raise InputError(what, f"it has {found} rows for {rows} {of}", "give one entry for each")
        result.append((str(name), values, offsets))
    return result
