"""The joint coordinates: the 34 of [WZC12] and two ankles, with axes and soft limits."""

from typing import NamedTuple

import numpy as np

from .tables import SEGMENTS


class CoordinateRow(NamedTuple):
    """One coordinate: a component of the rotation vectors of its segments."""

    name: str
    segments: dict[str, tuple[float, float, float]]
    """Rotation vector per unit, in the frame of the parent segment; x left, y down, z back."""
    lower: float
    upper: float
    """Soft limits, radians. Chosen by hand near the mean ranges of motion of the American
    Academy of Orthopaedic Surgeons (1965), such as 150 degrees of an elbow, 120 of a flexed
    hip and 60 of a shoulder that reaches back; most are wider. `LIMIT_WEIGHT` makes them
    soft."""


def _trunk() -> list[CoordinateRow]:
    return [
        *(CoordinateRow(f"lowerBack{name}", {"spine": axis, "chest": axis}, lower, upper)
          for name, axis, lower, upper in (("X", (0.5, 0.0, 0.0), -0.7, 1.6),
                                          ("Y", (0.0, 0.5, 0.0), -0.9, 0.9),
                                          ("Z", (0.0, 0.0, 0.5), -0.7, 0.7))),
        CoordinateRow("lowerNeckX", {"neck": (1.0, 0.0, 0.0)}, -0.6, 0.8),
        CoordinateRow("lowerNeckZ", {"neck": (0.0, 0.0, 1.0)}, -0.5, 0.5),
        CoordinateRow("headX", {"head": (1.0, 0.0, 0.0)}, -0.8, 0.8),
        CoordinateRow("headY", {"head": (0.0, 1.0, 0.0)}, -1.3, 1.3),
        CoordinateRow("headZ", {"head": (0.0, 0.0, 1.0)}, -0.6, 0.6),
    ]  # fmt: skip


def _limbs(side: str) -> list[CoordinateRow]:
    """Return the coordinates of one side; rotations about y and z are mirrored on the right."""
    out = 1.0 if side == "left" else -1.0

    def row(
        name: str, segment: str, axis: tuple[float, float, float], lower: float, upper: float
    ) -> CoordinateRow:
        return CoordinateRow(f"{side}{name}", {f"{side}{segment}": axis}, lower, upper)

    x, y, z = (-1.0, 0.0, 0.0), (0.0, out, 0.0), (0.0, 0.0, -out)
    return [
        row("ClavicleY", "Shoulder", y, -0.5, 0.5),
        row("ClavicleZ", "Shoulder", z, -0.3, 0.7),
        row("HumerusX", "UpperArm", x, -1.1, 3.1),
        row("HumerusY", "UpperArm", y, -2.0, 2.0),
        row("HumerusZ", "UpperArm", z, -0.9, 3.0),
        row("Radius", "LowerArm", x, -0.05, 2.6),
        row("FemurX", "UpperLeg", x, -0.7, 2.3),
        row("FemurY", "UpperLeg", y, -0.9, 0.9),
        row("FemurZ", "UpperLeg", z, -0.5, 1.2),
        row("Tibia", "LowerLeg", (1.0, 0.0, 0.0), -0.05, 2.6),
        row("Ankle", "Foot", (1.0, 0.0, 0.0), -0.6, 0.9),
    ]


ROOT = ("rootX", "rootY", "rootZ", "yaw", "roll", "pitch")
"""Position (meters) and rotation of the hips in the camera frame: first pitch about their x,
then roll about z, then yaw about the camera's y. Yaw and pitch are unbounded; only lying
exactly on the side is singular."""
N_ROOT = len(ROOT)
_ROWS = (*_trunk(), *_limbs("left"), *_limbs("right"))
COORDINATES = (*ROOT, *(row.name for row in _ROWS))
N_COORDINATES = len(COORDINATES)

ROTATION_AXES = np.zeros((len(SEGMENTS), 3, N_COORDINATES))
"""(n_segments, 3, 36): rotation vector of a segment in its parent's frame =
ROTATION_AXES @ coordinates."""
for _index, _row in enumerate(_ROWS):
    for _segment, _axis in _row.segments.items():
        ROTATION_AXES[SEGMENTS.index(_segment), :, N_ROOT + _index] = _axis

LOWER_LIMITS = np.array([*[-np.inf] * N_ROOT, *(row.lower for row in _ROWS)])
UPPER_LIMITS = np.array([*[np.inf] * N_ROOT, *(row.upper for row in _ROWS)])
