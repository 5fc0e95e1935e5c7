"""Standardize names, units and the up axis of point files."""

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from ...motion import AxisName, FileConventions, Tracks
from ...motion.humanoid import ADULT_STATURE_M
from ...progress import Progress, Remark
from ..containers import UniqueNames, printable
from .axes import MIN_BODY_JOINTS, z_up_from_y_up
from .file_axes import FORWARD
from .marker_axes import estimate_up_of_markers
from .marker_bodies import axis_of_named_markers, position_of_feet, stature_of_markers
from .unit_estimate import UNITS_OF_MARKERS, describe_guessed_unit, estimate_unit

METERS = {
    "mm": 0.001, "millimeter": 0.001, "millimetre": 0.001, "cm": 0.01, "centimeter": 0.01,
    "centimetre": 0.01, "dm": 0.1, "m": 1.0, "meter": 1.0, "metre": 1.0, "in": 0.0254,
    "inch": 0.0254, "inches": 0.0254, "ft": 0.3048, "foot": 0.3048, "feet": 0.3048,
}  # fmt: skip
"""Meters per unit, by its name without the plural s."""
ROLLED_FORWARD: dict[AxisName, AxisName] = {"X": "-Z", "-X": "Z"}
"""Axis that becomes -Y where points are rotated cyclically."""
BODY_EXTENT_M = 1.5
"""Typical extent of the markers of a body, meters, to which the unit brings them nearest.
Chosen by hand: x2 fails `test_the_unit_is_the_header_s_or_gives_a_person_s_size`."""
FLOOR_TOLERANCE_M = 0.15
"""Depth below height 0, meters, of markers that are above a floor. Chosen by hand: x0.5 fails
`test_the_screen_is_obeyed_where_it_may_be_right`, x2
`test_real_files_are_what_a_naive_reader_sees`."""
MIN_STANDING_M, MIN_STANDING_RATIO = 1.2, 1.5
"""Extent of markers on a body that stands, and relative to their extent along the stated axis:
a body is about three times as tall as wide, and arms may be spread. Chosen by hand: x2 fails
`test_a_body_that_stands_along_another_axis_is_believed`."""


def point_names(labels: Sequence[str]) -> tuple[str, ...]:
    """Return unique names, without the prefix of the actor if there is only one."""
    prefixes = {label.rpartition(":")[0] for label in labels if ":" in label}
    if len(prefixes) == 1:
        labels = [label.rpartition(":")[2] for label in labels]
    names = UniqueNames()
    return tuple(
        names.give(printable(label) or f"point_{number}")
        for number, label in enumerate(labels, start=1)
    )


def meters_from_unit_name(word: str) -> float | None:
    """Return the meters per unit of this name; None if the name is unknown."""
    word = word.strip().lower()
    is_plural = len(word) > len("ms")  # milliseconds
    return METERS.get(word, METERS.get(word.removesuffix("s")) if is_plural else None)


@np.errstate(over="ignore", invalid="ignore")  # numbers that are refused later
def guess_unit_of_points(
    points: NDArray[np.float64], labels: Sequence[str], progress: Progress
) -> float:
    """Return the probable unit of points, in meters; report an unusual one.

    Labels of head and feet show the stature of the actor (`estimate_unit`). Without them, as
    with points of a limb, it is that of meters, centimeters and millimeters whose extent is
    nearest to a person's. Points have the shape (n_frames, n_points, 3), in that unit.
    """
    height = stature_of_markers(labels, points)
    if height is not None and 0.0 < height < np.inf:
        estimated = estimate_unit(height / ADULT_STATURE_M, UNITS_OF_MARKERS, is_body=False)
        if estimated.has_low_confidence:
            progress(0.8, Remark(describe_guessed_unit(estimated.unit, estimated.rival)))
        return estimated.unit
    extent = float(np.median(_extents(points).max(axis=1)))
    if not 0.0 < extent < np.inf:
        return METERS["mm"]
    return min((0.001, 0.01, 1.0), key=lambda unit: abs(np.log(extent * unit / BODY_EXTENT_M)))


def estimate_axes_of_points(
    points: NDArray[np.float64],
    up: str,
    unit: float,
    default_up: str = "",
    labels: Sequence[str] = (),
) -> FileConventions:
    """Return the axes by which `points_z_up` rotates points, (F, n, 3) m, that state `up`.

    If it is unknown, it is estimated, also from the labels of head and feet; with too few
    points for a body it is `default_up`, if that is given.
    """
    if up[-1:] not in {"X", "Y", "Z"} and points.shape[1] < MIN_BODY_JOINTS:
        up = default_up
    if up[-1:] in {"X", "Y", "Z"}:
        return axes_of_points(up, unit)
    guessed, confidence = estimate_up_of_markers(points, labels)
    axes = axes_of_points(other_standing_axis(points, guessed, labels) or guessed, unit)
    return replace(axes, confidence=confidence)


def stand_markers(
    labels: Sequence[str],
    points: NDArray[np.float64],
    frame_rate: float,
    unit: float,
    default_up: str,
) -> Tracks:
    """Return markers of a file that does not state its axes, with what was estimated.

    Parameters
    ----------
    labels : names in the file (`point_names`)
    points : shape (n_frames, n_points, 3), meters
    frame_rate : hertz
    unit : meters per unit of the file
    default_up : axis of the program, where there are too few points for a body
    """
    axes = estimate_axes_of_points(points, "", unit, default_up, labels)
    return Tracks(
        point_names(labels), points_z_up(points, axes.up), frame_rate, conventions=axes
    )


def axes_of_points(up: str, unit: float = 1.0) -> FileConventions:
    """Return the axes by which `points_z_up` rotates points with a known axis, such as `+y`."""
    axis = cast(AxisName, ("-" if up[0] == "-" else "") + up[-1].upper())
    return FileConventions(axis, ROLLED_FORWARD.get(axis, FORWARD[axis]), unit)


def points_z_up(points: NDArray[np.float64], up: str) -> NDArray[np.float64]:
    """Rotate points, shape (..., 3), so that `up`, such as `+Y`, becomes Z."""
    if up[-1] == "X":
        points = np.roll(points, -1, axis=-1)  # x y z -> y z x
    if up[-1] == "Y":
        points = z_up_from_y_up(points)
    return points * (1.0, -1.0, -1.0) if up[0] == "-" else points


def is_upside_down(points: NDArray[np.float64], up: str) -> bool:
    """Return whether a stated axis, such as `-Z`, would hang (F, n, 3) points below zero."""
    if up[:1] != "-" or up[-1:] not in {"X", "Y", "Z"} or points.shape[1] < MIN_BODY_JOINTS:
        return False
    along = points[..., "XYZ".index(up[-1])]
    return bool(
        np.nanpercentile(along, 2) > -FLOOR_TOLERANCE_M
        and np.nanpercentile(along, 98) > FLOOR_TOLERANCE_M
    )


def other_standing_axis(
    points: NDArray[np.float64], up: str, labels: Sequence[str] = ()
) -> str:
    """Return the axis along which points, (F, n, 3) m, stand if the stated one must be wrong.

    So it is where they are half below the floor along the stated axis, and along another one
    are all above it and much farther apart. Labels may show that the actor stands along a
    negative axis, as of cameras with Y down, unless only along the stated one the points rest
    on a floor at height 0; or along another positive one, if only along that one the feet are
    at height 0. Empty if the stated axis may be right.
    """
    if up[-1:] not in {"X", "Y", "Z"} or points.shape[1] < MIN_BODY_JOINTS:
        return ""
    lowest = np.nanpercentile(points.reshape(-1, 3), 2, axis=0)
    extents = np.median(_extents(points), axis=0)
    stated = "XYZ".index(up[-1])
    named = axis_of_named_markers(labels, points) if up[:1] != "-" else ""
    if named[:1] == "-":
        highest = np.nanpercentile(points[..., "XYZ".index(named[-1])], 98)
        if min(abs(highest), FLOOR_TOLERANCE_M) < abs(lowest[stated]):
            return named
    elif named and named[-1] != up[-1]:
        height = np.abs(position_of_feet(labels, points))
        if height["XYZ".index(named[-1])] < FLOOR_TOLERANCE_M < height[stated]:
            return named
    best = int(np.argmax(np.where(lowest > -FLOOR_TOLERANCE_M, extents, 0.0)))
    is_sunk = lowest[stated] <= -FLOOR_TOLERANCE_M
    is_tall = extents[best] > max(MIN_STANDING_M, MIN_STANDING_RATIO * extents[stated])
    return f"+{'XYZ'[best]}" if is_sunk and is_tall and best != stated else ""


def _extents(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the size of the bounding box, shape (n, 3), in frames with any observed point."""
    observed = points[np.isfinite(points).any(axis=(1, 2))]
    return np.asarray(np.nanmax(observed, axis=1) - np.nanmin(observed, axis=1))
