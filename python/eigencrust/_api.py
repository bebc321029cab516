# SPDX-License-Identifier: GPL-3.0-or-later
"""What people call: points in, meshes, normals and masks out."""

from __future__ import annotations

import json
import logging
import numbers
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._convert import as_drawable, as_mesh
from ._errors import GuaranteeError, UsageError
from ._options import documents_options, make_options

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from ._option_types import MethodOptions

logger = logging.getLogger("eigencrust")

Path = Union[str, "os.PathLike[str]"]
#: Called with the stage's name and the fraction of it that is done; the run stops where it returns False.
Progress = Callable[[str, float], Optional[bool]]
#: Called with a stage's name and what it made.
Snapshots = Callable[[str, _core.Mesh], Any]


class Forecast:
    """How much memory and time a reconstruction will take."""

    def __init__(self, memory_bytes: int, seconds: float) -> None:
        self.memory_bytes = memory_bytes  #: largest resident memory of the process
        self.seconds = seconds  #: on one thread, a rough figure

    def __repr__(self) -> str:
        return f"<eigencrust.Forecast: {self.memory_bytes / 1e6:,.0f} MB, about {self.seconds:.2g} s>"


class Outliers:
    """Which points belong to the surface, one entry per input row."""

    def __init__(self, result: _core.Result) -> None:
        self.inlier: np.ndarray = result.inlier  #: (N,) bool
        self.confidence: np.ndarray = result.confidence  #: (N,) float32, at least 0.5 for inliers

    @property
    def outlier(self) -> np.ndarray:
        """(N,) bool, the opposite of `inlier`; rows that are not finite are outliers."""
        return ~self.inlier

    def __repr__(self) -> str:
        return f"<eigencrust.Outliers: {int(self.outlier.sum()):,} of {len(self.inlier):,} points>"


def _make_cloud(points: Any, **further: Any) -> _core.PointCloud:
    if not isinstance(points, _core.PointCloud):
        return _core.PointCloud(points, **further)
    given = [name for name, value in further.items() if value is not None and name != "nonfinite"]
    if given:
        raise UsageError(given[0], "a PointCloud has its own", "pass it where the PointCloud is made")
    return points


def _checked(result: _core.Result) -> _core.Result:
    """Logs the warnings. A result that is not what it was promised to be does not pass."""
    left_out = result.report["input"]["nonfinite"]
    if left_out == 1:
        logger.warning("1 row that is NaN or infinite was left out")
    elif left_out > 1:
        logger.warning("%d rows that are NaN or infinite were left out", left_out)
    for text in result.warnings:
        logger.warning("%s", text)
    if result.broken_guarantees:
        error = GuaranteeError(
            "validate",
            "the mesh is not " + ", ".join(result.broken_guarantees),
            "report this as a fault of the program; the exception has the result",
        )
        error.result = result
        raise error
    return result


def _run(cloud: _core.PointCloud, options: Dict[str, Any], **watched: Any) -> _core.Result:
    made = make_options(options)
    forecast_warning = _core.memory_warning(cloud)
    if forecast_warning:
        logger.warning("%s", forecast_warning)
    if options.get("smoothing") is not None and made.get("smooth") == "0":
        logger.warning("smoothing has no effect without smooth=N")
    return _checked(_core.reconstruct(cloud, made, **watched))


@documents_options
def reconstruct(
    points: Union["ArrayLike", _core.PointCloud],
    *,
    sensors: Optional["ArrayLike"] = None,
    attributes: Optional[Dict[str, "ArrayLike"]] = None,
    scan_index: Optional["ArrayLike"] = None,
    sensor_directions: Optional["ArrayLike"] = None,
    nonfinite: str = "raise",
    progress: Optional[Progress] = None,
    cancel: Optional[_core.Cancellation] = None,
    snapshots: Optional[Snapshots] = None,
    **options: "Unpack[MethodOptions]",
) -> _core.Result:
    """Reconstructs the closed, manifold, outward oriented surface that points were sampled from.

    Parameters
    ----------
    points: (N,3) array, a list of triples, or a PointCloud
        float64 or float32 in any memory order; they are copied once.
    sensors: (3,), (K,3) or (N,3) array
        Where the scanner stood: one place, one for each of K scans, or one for each point (NaN: not known).
    attributes: dict
        Columns by name, each of N entries; the mesh's vertices get those of their points.
    scan_index: (N,) whole numbers
        Which scan each point came from.
    sensor_directions: as sensors
        Directions from the surface to a scanner with parallel rays, in place of sensors.
    nonfinite: "raise" or "skip"
        What to do with rows that are NaN or infinite. Skipped rows keep their numbers: masks have N entries.
    progress: callable
        progress(stage, fraction), some 20 times a second at most; the run stops where it returns False or raises.
    cancel: Cancellation
        Its cancel(), called from any thread, stops the run.
    snapshots: callable
        snapshots(stage, mesh) with what the stages make.

    Options of the method, None for the default:

    OPTIONS

    Returns
    -------
    Result
        with mesh, report and warnings; with point_results=True also inlier, confidence and normals.

    Raises
    ------
    UsageError, InputError, MemoryLimitError, NoSurfaceError, GuaranteeError, Cancelled

    Warnings go to the logger "eigencrust". The interpreter lock is released meanwhile.
    """
    cloud = _make_cloud(
        points,
        sensors=sensors,
        attributes=attributes,
        scan_index=scan_index,
        sensor_directions=sensor_directions,
        nonfinite=nonfinite,
    )
    return _run(cloud, dict(options), progress=progress, cancel=cancel, snapshots=snapshots)


def _of_points(points: Any, further: Dict[str, Any], options: Dict[str, Any]) -> _core.Result:
    watched = {name: options.pop(name, None) for name in ("progress", "cancel")}
    options["point_results"] = True
    return _run(_make_cloud(points, **further), options, **watched)


def orient(
    points: Union["ArrayLike", _core.PointCloud],
    *,
    sensors: Optional["ArrayLike"] = None,
    scan_index: Optional["ArrayLike"] = None,
    sensor_directions: Optional["ArrayLike"] = None,
    nonfinite: str = "raise",
    **options: Any,
) -> np.ndarray:
    """Unit normals that look outward, (N,3) float64, in the order of the points; NaN for outliers.

    Arguments are those of reconstruct().
    """
    further = dict(sensors=sensors, scan_index=scan_index, sensor_directions=sensor_directions, nonfinite=nonfinite)
    return _of_points(points, further, options).normals


def outliers(
    points: Union["ArrayLike", _core.PointCloud],
    *,
    sensors: Optional["ArrayLike"] = None,
    scan_index: Optional["ArrayLike"] = None,
    sensor_directions: Optional["ArrayLike"] = None,
    nonfinite: str = "raise",
    **options: Any,
) -> Outliers:
    """Which points belong to the surface and which do not, and how sure that is, in the order of the points.

    Arguments are those of reconstruct().
    """
    further = dict(sensors=sensors, scan_index=scan_index, sensor_directions=sensor_directions, nonfinite=nonfinite)
    return Outliers(_of_points(points, further, options))


class Session:
    """One cloud, labelled again and again as points in space are named.

    Triangulates and solves once; label() then costs what comes after. Arguments are those of reconstruct().
    """

    def __init__(
        self,
        points: Union["ArrayLike", _core.PointCloud],
        *,
        sensors: Optional["ArrayLike"] = None,
        attributes: Optional[Dict[str, "ArrayLike"]] = None,
        scan_index: Optional["ArrayLike"] = None,
        sensor_directions: Optional["ArrayLike"] = None,
        nonfinite: str = "raise",
        progress: Optional[Progress] = None,
        cancel: Optional[_core.Cancellation] = None,
        **options: "Unpack[MethodOptions]",
    ) -> None:
        cloud = _make_cloud(
            points,
            sensors=sensors,
            attributes=attributes,
            scan_index=scan_index,
            sensor_directions=sensor_directions,
            nonfinite=nonfinite,
        )
        self._session = _core.Session(cloud, make_options(options), progress, cancel)

    def label(
        self,
        outside_points: Optional["ArrayLike"] = None,
        inside_points: Optional["ArrayLike"] = None,
        *,
        progress: Optional[Progress] = None,
        cancel: Optional[_core.Cancellation] = None,
    ) -> _core.Result:
        """The surface with these points known to be outside and inside, (3,) or (M,3).

        It depends on the points of this call alone, not on those of calls before.
        """
        return _checked(self._session.label(outside_points, inside_points, progress, cancel))

    @property
    def tetrahedralization(self) -> _core.stages.Tetrahedralization:
        """What Result.labels refer to."""
        return self._session.tetrahedralization

    @property
    def cloud(self) -> _core.PointCloud:
        return self._session.cloud


def check(
    mesh: Any, *, self_intersections: bool = True, merge_equal_vertices: bool = True, threads: int = 0
) -> _core.MeshSummary:
    """Is a mesh closed, manifold and oriented? Its genus, volume, area and self-intersections.

    mesh is a Mesh, a file, (vertices, triangles), or a mesh of trimesh or Open3D.
    """
    return _core.validate(as_mesh(mesh, "mesh"), self_intersections, merge_equal_vertices, threads)


def measure(
    mesh: Any,
    *,
    metres: Optional[float] = None,
    self_intersections: bool = True,
    walls: bool = True,
    threads: int = 0,
) -> _core.MeshMeasures:
    """Angles, edges and the thinnest wall of a mesh, and whether it can be printed.

    mesh is as for check(). metres: length of its unit, 0.001 for mm; None: what the file says, else unknown. walls:
    False leaves out the search for the thinnest wall.
    """
    if isinstance(mesh, (str, os.PathLike)):
        mesh, of_file = read_mesh_and_unit(mesh)
        metres = of_file if metres is None else metres
    return _core.measure(as_mesh(mesh, "mesh"), metres or 0.0, self_intersections, walls, threads)


def compare(
    mesh: Any, reference: Any, *, samples: int = 100_000, seed: int = 1, threshold: float = 0, threads: int = 0
) -> _core.Comparison:
    """How far a mesh is from a reference: distances between points spread over both surfaces.

    threshold is the distance of the F-score; 0: 1 % of the reference's diagonal.
    """
    return _core.compare(as_mesh(mesh, "mesh"), as_mesh(reference, "reference"), samples, seed, threshold, threads)


def info(points: Any, *, threads: int = 0) -> Dict[str, Any]:
    """What is in a cloud, an array or a file: counts, bounds, spacing, sensors, attributes; forecast of memory and
    time."""
    notes: List[str] = []
    warnings: List[str] = []
    if isinstance(points, (str, os.PathLike)):
        points, notes, warnings = _core.read_point_cloud(points, [], "auto", True, 1.0, (0.0, 0.0, 0.0))
    cloud = _make_cloud(points, nonfinite="skip")
    figures: Dict[str, Any] = json.loads(_core.info_json(cloud, threads))
    figures["notes"], figures["warnings"] = notes, warnings
    return figures


def forecast(points: Union[int, "ArrayLike", _core.PointCloud]) -> Forecast:
    """How much memory and time a reconstruction of that many points, or of these points, will take."""
    count = int(points) if isinstance(points, numbers.Integral) else len(points)  # type: ignore[arg-type]
    if count < 0:
        raise UsageError("points", f"there are no {count} points", "give 0 or more")
    return Forecast(*_core.forecast(count))


def read_point_cloud(
    path: Path,
    *,
    columns: Sequence[str] = (),
    pcd_viewpoint: str = "auto",
    sensors: bool = True,
    scale: float = 1.0,
    shift: Tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> _core.PointCloud:
    """Reads a cloud with all its attributes: ply e57 las ptx pcd pts npz npy xyz txt asc csv obj off stl glb 3mf.

    columns: names of a text file's columns in order, "-" skips one. pcd_viewpoint: auto, sensor, pose or none.
    sensors: False leaves out what the file says of sensors. Coordinates are multiplied with scale, then shift is added
    to them. What could be read in two ways is
    logged as information, what was left out or looks wrong as a warning.
    """
    cloud, notes, warnings = _core.read_point_cloud(path, list(columns), pcd_viewpoint, sensors, scale, tuple(shift))
    for note in notes:
        logger.info("%s: %s", path, note)
    _warned(path, warnings)
    return cloud


def read_mesh(path: Path) -> _core.Mesh:
    """Reads a mesh: ply obj off stl glb 3mf. What was left out is logged as information."""
    return read_mesh_and_unit(path)[0]


def read_mesh_and_unit(path: Path) -> Tuple[_core.Mesh, Optional[float]]:
    """Reads a mesh, and the length of its unit in metres: 1 for glb, what a 3mf file says, None for other formats."""
    mesh, metres, notes = _core.read_mesh(path)
    for note in notes:
        logger.info("%s: %s", path, note)
    return mesh, metres or None


def _warned(path: Path, warnings: Iterable[str]) -> None:
    for text in warnings:
        logger.warning("%s: %s", path, text)


def write_mesh(
    path: Path,
    mesh: Any,
    *,
    coordinates: str = "auto",
    spacing: Optional[float] = None,
    comments: Sequence[str] = (),
    format: str = "",
    metres: float = 0.0,
    shift: Tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> None:
    """Writes a mesh, whole or not at all: ply obj off stl glb 3mf.

    coordinates: auto, float32 or float64; auto takes float32 where that moves no vertex by more than a thousandth of
    `spacing` (of a Result it is known; else the median edge length). format: "ply", "obj" ..., else that of the name's
    extension. metres: length of the unit, for formats that tell it (glb, 3mf). shift: what was added to the coordinates
    when they were read; it is written as a comment, or into a file .offset.txt beside formats without any.
    """
    if spacing is None:
        spacing = mesh.report["input"]["spacing"] if isinstance(mesh, _core.Result) else 0.0
    made = as_mesh(mesh, "mesh")
    _warned(path, _core.write_mesh(path, made, coordinates, spacing, list(comments), format, tuple(shift), metres))


def write_point_cloud(
    path: Path,
    cloud: Any,
    *,
    coordinates: str = "auto",
    spacing: float = 0.0,
    comments: Sequence[str] = (),
    format: str = "",
    shift: Tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> None:
    """Writes a cloud with its attributes, whole or not at all: ply pcd las xyz txt asc csv obj.

    Arguments are those of write_mesh().
    """
    made = _make_cloud(cloud, nonfinite="skip")
    _warned(path, _core.write_point_cloud(path, made, coordinates, spacing, list(comments), format, tuple(shift)))


def join_scans(scans: Sequence[Union["ArrayLike", _core.PointCloud]]) -> _core.PointCloud:
    """Several aligned scans of one scene as one cloud that tells them apart."""
    if len(scans) == 0:
        raise UsageError("scans", "there are none", "give at least one")
    return _core.join_scans([_make_cloud(scan) for scan in scans])


def read_scan_index(path: Path, points: int) -> np.ndarray:
    """Scan numbers of so many points from a file: bytes (.u8) or one number per line."""
    return _core.read_scan_index(path, points)


def read_scan_sensors(path: Path, cloud: _core.PointCloud) -> _core.PointCloud:
    """The cloud with the sensors of its scans from a file of rows scan,x,y,z or, under a header, scan,dx,dy,dz."""
    return _core.read_scan_sensors(path, cloud)


_axes = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_axes.update({f"-{name}": tuple(-c for c in axis) for name, axis in list(_axes.items())})  # type: ignore[misc]


def render(objects: Any, *, up: Union[str, Tuple[float, float, float]] = "y", **options: Any) -> np.ndarray:
    """A picture of a mesh, a cloud or a result, or of several side by side: (height, width, 3) uint8.

    up: x, y, z, -x, -y, -z or a direction. Further: width, height (pixels), azimuth, elevation, roll (degrees), zoom,
    point_size (pixels), view ("front", "back", "left", "right", "top", "bottom", in place of azimuth and elevation),
    frame ("bulk" or "all": with strays), clip_normal, clip_point, wireframe, use_colors, front, back, background (0 to
    255 each). Back faces are red. Needs no display.
    """
    if isinstance(up, str):
        if up not in _axes:
            raise UsageError("up", f"{up!r} is no axis", "use x, y, z, -x, -y or -z")
        up = _axes[up]
    several = list(objects) if isinstance(objects, (list, tuple)) else [objects]
    if not several:
        raise UsageError("objects", "there is nothing to draw", "pass a mesh or a cloud")
    try:
        return _core.render([as_drawable(thing) for thing in several], up=up, **options)
    except TypeError as error:
        raise UsageError("render", str(error).split("\n")[0], "see help(eigencrust.render)") from None


def write_png(path: Path, picture: np.ndarray) -> None:
    """Writes a picture (height, width, 3) of uint8, whole or not at all."""
    _core.write_png(path, picture)


def distances_to_surface(points: "ArrayLike", mesh: Any, *, threads: int = 0) -> np.ndarray:
    """Distance of each point to a mesh, (N,); NaN for a point that is not finite."""
    return _core.distances_to_surface(points, as_mesh(mesh, "mesh"), threads)


def distances_to_points(points: "ArrayLike", targets: "ArrayLike", *, threads: int = 0) -> np.ndarray:
    """Distance of each point to the nearest of the targets, (N,); NaN for a point that is not finite."""
    return _core.distances_to_points(points, targets, threads)


def summarize(distances: "ArrayLike") -> _core.DistanceStatistics:
    """Mean, quantiles and maximum of distances; what is not finite is left out."""
    return _core.summarize(np.asarray(distances, dtype=float).ravel())


def sample_surface(mesh: Any, count: int, *, seed: int = 1) -> Tuple[np.ndarray, np.ndarray]:
    """Points spread evenly over a mesh (count,3), and the triangle of each (count,)."""
    return _core.sample_surface(as_mesh(mesh, "mesh"), count, seed)


def volume_iou(a: Any, b: Any, *, columns: int = 512, threads: int = 0) -> float:
    """Volume of the intersection over volume of the union of two closed meshes."""
    return _core.volume_iou(as_mesh(a, "a"), as_mesh(b, "b"), columns, threads)
