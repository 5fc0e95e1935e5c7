"""What files of points leave open or say in many ways: names, units, and which way is up."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..containers import UniqueNames, printable
from .axes import z_up_from_y_up

METERS = {
    "mm": 0.001, "millimeter": 0.001, "millimetre": 0.001, "cm": 0.01, "centimeter": 0.01,
    "centimetre": 0.01, "dm": 0.1, "m": 1.0, "meter": 1.0, "metre": 1.0, "in": 0.0254,
    "inch": 0.0254, "inches": 0.0254, "ft": 0.3048, "foot": 0.3048, "feet": 0.3048,
}  # fmt: skip
"""Metres in a unit, by its name without the s of the plural."""
BODY_EXTENT_M = 1.5
FLOOR_TOLERANCE_M = 0.15


def point_names(labels: Sequence[str]) -> tuple[str, ...]:
    """Return names without the actor's, if there is only one, and different from each other."""
    prefixes = {label.rpartition(":")[0] for label in labels if ":" in label}
    if len(prefixes) == 1:
        labels = [label.rpartition(":")[2] for label in labels]
    names = UniqueNames()
    return tuple(
        names.give(printable(label) or f"point_{place}")
        for place, label in enumerate(labels, start=1)
    )


def meters_from_unit_name(word: str) -> float | None:
    """Return the metres in a unit of this name; None if there is no such name."""
    word = word.strip().lower()
    return METERS.get(word, METERS.get(word.removesuffix("s")))


def guess_unit_of_points(points: NDArray[np.float64]) -> float:
    """Return the one of metres, centimetres and millimetres that gives a person's size."""
    extent = float(np.median(_extents(points).max(axis=1)))
    if extent == 0.0:
        return METERS["mm"]
    return min((0.001, 0.01, 1.0), key=lambda unit: abs(np.log(extent * unit / BODY_EXTENT_M)))


def points_z_up(points: NDArray[np.float64], up: str) -> NDArray[np.float64]:
    """Turn points, in metres, so that `up`, such as `+Y` or unknown, becomes Z."""
    if up[-1:] not in {"X", "Y", "Z"}:
        up = "+Y" if _looks_y_up(points) else "+Z"
    if up[-1] == "X":
        points = np.roll(points, -1, axis=-1)  # x y z -> y z x
    if up[-1] == "Y":
        points = z_up_from_y_up(points)
    return points * (1.0, -1.0, -1.0) if up[0] == "-" else points


def _looks_y_up(points: NDArray[np.float64]) -> bool:
    """Whether Y rather than Z is up, of points in metres.

    Nobody is far below the floor: if that rules out one of the two, the other is up. Else the
    greater extent in most frames decides; right for all files at hand that say their axes.
    """
    above = np.nanpercentile(points.reshape(-1, 3), 2, axis=0) > -FLOOR_TOLERANCE_M
    if above[1] != above[2]:
        return bool(above[1])
    _, y, z = np.median(_extents(points), axis=0)
    return bool(y > z)


def _extents(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the size of the bounding box, shape (n, 3), in frames where anything is seen."""
    seen = points[np.isfinite(points).any(axis=(1, 2))]
    return np.asarray(np.nanmax(seen, axis=1) - np.nanmin(seen, axis=1))
