"""Find positions that are not in the room: relative to parent bones, or to the hips."""

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import roles_by_name
from ...progress import Progress, Remark

NAMES_OF_ROOT = (
    "transworld", "roottranslation", "roottrans", "roottransform", "rootposition", "rootpos",
    "bodytransform", "bodyposition", "bodytranslation", "anchortransform", "hipsposition",
    "hipposition", "pelvisposition", "globaltranslation", "globaltrans", "transl", "trans",
    "translation", "smpltrans", "predtrans", "predcamtfull", "camtfull", "predcamt", "camt",
    "camtrans", "root", "transform", "position",
)  # fmt: skip
"""Names of the position of a body whose joints are relative to it, the clear ones first."""
MAX_SWAY_FRACTION = 0.01
"""Range of the hips relative to the size of the body, a ratio, up to which they are kept in
place. Measured: the hips of an actor who stands still
sway by 2 cm, which is above it."""
MAX_CENTER_FRACTION = 0.1
"""Distance of the hips from the origin, relative to the size of the body, up to which they are
the origin. Measured: the middle of the thighs is 8 cm from a pelvis, 0.07 of a small adult;
hips in a room are at 0.5 and more above its floor."""
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


def name_of_root(name: str) -> str:
    """Return a name as `NAMES_OF_ROOT` spells it."""
    return re.sub(r"[\W_]", "", name).lower()


def transforms_at(positions: Array) -> Array:
    """Return the transforms, shape (n_frames, 4, 4), of bodies at positions, (n_frames, 3)."""
    transforms = np.tile(np.eye(4), (len(positions), 1, 1))
    transforms[:, :3, 3] = positions
    return transforms


def key_of_root(names: Iterable[str]) -> str | None:
    """Return which of these names is that of the position of a body; None without one."""
    plain = {name_of_root(name): name for name in names}
    return next((plain[name] for name in NAMES_OF_ROOT if name in plain), None)


def in_room(names: Sequence[str], points: Array, roots: Array | None) -> Array:
    """Return joints where the body is, if they are relative to its position.

    They are if the hips stay at one place while the body moves or turns. A joint that is at the
    position of the body is in the room already.

    Parameters
    ----------
    names : names of joints with humanoid roles
    points : shape (n_frames, n_joints, 3), in the unit and axes of the file
    roots : shape (n_frames, 4, 4), or None
        The transform of the body in each frame, NaN where it is not stated.
    """
    roles = {role: list(names).index(name) for role, name in roles_by_name(names).items()}
    if roots is None or not {"leftUpperLeg", "rightUpperLeg"} <= roles.keys():
        return points
    hips, size, are_still = _hips(points, roles)
    path, turns = roots[:, :3, 3], roots[:, :3, :3]
    travel = max(_range(path), size * _range(turns.reshape(-1, 9)))
    distance = np.linalg.norm(hips - path, axis=1)
    known = distance[np.isfinite(distance)]
    if (
        not are_still
        or travel <= MIN_STEP_FRACTION * size
        or np.median(known) <= MAX_CENTER_FRACTION * size
    ):
        return points
    in_place = (points == path[:, None]).all(axis=(0, 2))
    return np.where(
        in_place[:, None], points, points @ turns.swapaxes(1, 2) + roots[:, None, :3, 3]
    )


def report_still_hips(points: Array, roles: Mapping[str, int], progress: Progress) -> None:
    """Say so if feet step while the hips stay, as in positions relative to the hips.

    Parameters
    ----------
    points : shape (n_frames, n_joints, 3), in any unit and axes; NaN where missing
    roles : joints by humanoid role, both upper legs and feet among them
    progress : Progress
    """
    _, size, are_still = _hips(points, roles)
    step = max(_range(points[:, roles[role]]) for role in ("leftFoot", "rightFoot"))
    if are_still and step > MIN_STEP_FRACTION * size > 0.0:
        progress(
            0.9,
            Remark(
                "The hips stay at one place in the file, so the actor does not travel. Save"
                " positions in the room, if your program has them"
            ),
        )


def _hips(points: Array, roles: Mapping[str, int]) -> tuple[Array, float, bool]:
    """Return the path of the hips, the size of the body, and whether the hips stay."""
    hips = points[:, [roles["leftUpperLeg"], roles["rightUpperLeg"]]].mean(axis=1)
    middles = [hips] if "hips" not in roles else [hips, points[:, roles["hips"]]]
    extents = np.fmax.reduce(points, axis=1) - np.fmin.reduce(points, axis=1)
    known = extents[np.isfinite(extents).all(axis=1)]
    size = float(np.median(known, axis=0).max()) if len(known) else 0.0
    sway = min(map(_range, middles))
    away = float(np.nan_to_num(np.linalg.norm(hips, axis=1)).max())
    are_still = sway <= MAX_SWAY_FRACTION * size or away <= MAX_CENTER_FRACTION * size
    return hips, size, are_still


def _range(path: Array) -> float:
    """Return the largest range of a path along an axis; 0 where it is never observed."""
    known = path[np.isfinite(path).all(axis=1)]
    return float(np.ptp(known, axis=0).max()) if len(known) else 0.0
