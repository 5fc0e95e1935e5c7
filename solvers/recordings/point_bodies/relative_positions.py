"""Find positions that are not in the room: relative to parent bones, or to the hips."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...progress import Progress, Remark

MAX_SWAY_FRACTION = 0.01
"""Range of the hips relative to the size of the body, a ratio, up to which they are kept in
place. Chosen by hand: hips of who stands still sway by 2 cm, which is above it."""
MAX_CENTER_FRACTION = 0.1
"""Distance of the hips from the origin, relative to the size of the body, up to which they are
the origin. Chosen by hand: the middle of the thighs is 8 cm from a pelvis, 0.07 of a small
adult; hips in a room are at 0.5 and more above its floor."""
MIN_STEP_FRACTION = 0.05
"""Range of the feet relative to the size of the body, a ratio, from which hips would have moved
in a room. Chosen by hand: half a foot's length of an adult."""
MAX_STILL_FRACTION = 0.05
"""Range of a joint relative to that of the hips, a ratio, up to which it does not move. It
guards bones whose lengths are rounded; joints of a body move with its hips."""
MIN_STILL_JOINTS = 0.8
"""Joints that do not move, a fraction of those with a role. Chosen by hand: some programs also
move collarbones or hands relative to their parents."""


def refuse_parent_positions(path: Path | str, points: Array, roles: Mapping[str, int]) -> None:
    """Raise InvalidFileError if only the hips move, as in positions relative to the parents.

    Parameters
    ----------
    path : Path or str
    points : shape (n_frames, n_joints, 3), in any unit and axes; NaN where missing
    roles : joints by humanoid role
    """
    is_seen = np.isfinite(points).all(axis=2).any(axis=0)
    ranges = {role: _range(points[:, joint]) for role, joint in roles.items() if is_seen[joint]}
    hips = ranges.pop("hips", 0.0)
    still = [each for each in ranges.values() if each <= MAX_STILL_FRACTION * hips]
    if hips > 0.0 and ranges and len(still) >= MIN_STILL_JOINTS * len(ranges):
        raise InvalidFileError(
            f"{path} holds positions relative to the parent bones, from which no pose follows."
            " Save positions in the room (world or global), or export BVH, FBX or GLB."
        )


def report_still_hips(points: Array, roles: Mapping[str, int], progress: Progress) -> None:
    """Say so if feet step while the hips stay, as in positions relative to the hips.

    Parameters
    ----------
    points : shape (n_frames, n_joints, 3), in any unit and axes; NaN where missing
    roles : joints by humanoid role, both upper legs and feet among them
    progress : Progress
    """
    hips = points[:, [roles["leftUpperLeg"], roles["rightUpperLeg"]]].mean(axis=1)
    middles = [hips] if "hips" not in roles else [hips, points[:, roles["hips"]]]
    extents = np.fmax.reduce(points, axis=1) - np.fmin.reduce(points, axis=1)
    known = extents[np.isfinite(extents).all(axis=1)]
    size = float(np.median(known, axis=0).max()) if len(known) else 0.0
    sway = min(map(_range, middles))
    step = max(_range(points[:, roles[role]]) for role in ("leftFoot", "rightFoot"))
    away = float(np.nan_to_num(np.linalg.norm(hips, axis=1)).max())
    are_still = sway <= MAX_SWAY_FRACTION * size or away <= MAX_CENTER_FRACTION * size
    if are_still and step > MIN_STEP_FRACTION * size > 0.0:
        progress(
            0.9,
            Remark(
                "The hips stay at one place in the file, so the actor does not travel. Save"
                " positions in the room, if your program has them"
            ),
        )


def _range(path: Array) -> float:
    """Return the largest range of a path along an axis; 0 where it is never observed."""
    known = path[np.isfinite(path).all(axis=1)]
    return float(np.ptp(known, axis=0).max()) if len(known) else 0.0
