"""Read the segments of an OpenSim model over time, as OpenCap's viewer stores them in JSON."""

import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import Motion, Tracks
from ...progress import Progress, unwatched
from ...rotations import normalize, quaternion_from_euler, unroll
from ..containers import array_from_json, json_content
from ..conventions import ConstantRate, check_scale
from .segment_recordings import recording_from_segments

SEGMENTS = re.compile(rb'"bodies"\s*:\s*\{\s*"[^"]+"\s*:\s*\{\s*"attachedGeometries"')
CENTER = ("pelvis", "torso")
TREE = {
    "pelvis": "", "torso": "pelvis",
    "humerus": "torso", "ulna": "humerus", "radius": "ulna", "hand": "radius",
    "femur": "pelvis", "tibia": "femur", "talus": "tibia", "calcn": "talus", "toes": "calcn",
}  # fmt: skip
"""Segments of OpenCap's models [1]_ without their side, each with the one that carries it.

References
----------
.. [1] Rajagopal, Dembia, DeMers, Delp, Hicks, Delp (2016). Full-body musculoskeletal model for
   muscle-driven simulation of human gait. IEEE Trans. Biomedical Engineering 63(10).
"""
KNEECAP = "patella"
"""A segment that slides along the thigh, and carries nothing."""


def is_opensim_json(head: bytes) -> bool:
    """Return whether the first bytes are JSON with the segments of an OpenSim model."""
    return SEGMENTS.search(head) is not None


def read_opensim_json(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Motion | Tracks:
    """Read segments of an OpenSim model from OpenCap's JSON; in meters, Z up.

    The file has the position of each segment and its rotation in the room, as intrinsic
    angles about X, Y and Z in radians, with Y up. Bones are the mean of the origins seen from
    their parents. The kneecaps are left out.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: 1.
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing or damaged, or a segment has no positions and rotations.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    content = json_content(path).value
    times, segments = (content.get(key) for key in ("time", "bodies"))
    if not isinstance(segments, Mapping):
        raise InvalidFileError(f"{path} has no segments in bodies. Export it again.")
    seconds = array_from_json(times, (-1,), f"{path}, time")
    rate = ConstantRate(path, seconds)
    poses = {
        name: _poses(path, name, segment, len(seconds))
        for name, segment in segments.items()
        if not name.startswith(KNEECAP)
    }
    progress(0.5, "Reading")
    resampled = rate.positions(np.stack([*poses.values()], axis=1))
    return recording_from_segments(
        list(poses),
        resampled[..., :3] * (1.0 if scale is None else scale),
        normalize(resampled[..., 3:]),
        rate.frame_rate,
        progress,
        parents=dict(_parents(poses)),
        default_up="+Y",
    )


def _poses(path: Path | str, name: str, segment: Any, n_frames: int) -> Array:
    """Return the positions and rotations of a segment, shape (n_frames, 7)."""
    stated = segment if isinstance(segment, Mapping) else {}
    positions, angles = (
        array_from_json(stated.get(key), (n_frames, 3), f"{path}, {key} of {name}")
        for key in ("translation", "rotation")
    )
    return np.concatenate([positions, unroll(quaternion_from_euler(angles, "XYZ"))], axis=1)


def _parents(names: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield the segments of the tree, each with the nearest one above that the file has."""
    for name in names:
        part, _, side = name.partition("_")
        parent = TREE.get(part)
        while parent and _with_side(parent, side) not in names:
            parent = TREE[parent]
        if parent is not None:
            yield name, _with_side(parent, side) if parent else ""


def _with_side(part: str, side: str) -> str:
    return part if part in CENTER else f"{part}_{side}"
