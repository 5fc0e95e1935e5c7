"""Takes for the metrics, none of which a benchmark scores.

Walks of the CMU subjects for development, HDM05 actor bd, and takes of `cmu_variety.tar.xz`,
which no benchmark reads.
"""

import re
import tarfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np

from solvers.arrays import Array, Flags
from solvers.motion import Motion, Skeleton, Tracks, forward_kinematics
from solvers.recordings import read_acclaim, read_bvh
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
)

from ..shared import clips

BUILD = Path(__file__).resolve().parents[3] / "build" / "sensitivity"
WALKS = frozenset(clips.QUICK_DEV)
ROUGH = (
    "hips|root|hipjoint|leg|femur|tibia|back|spine|thorax|arm|humerus|radius|shoulder|clavicle"
)
ARCHIVE = clips.DATA / "mocap" / "cmu_variety.tar.xz"


def walk(name: str, step: int = clips.STEP) -> Motion:
    """Return a development walk at 120 Hz over `step`."""
    if name.split("_")[0] not in clips.DEV_SUBJECTS:
        raise ValueError(f"{name} is not for development.")
    return clips.read_cmu(clips.WALKS / f"{name}.bvh", step)


def hdm05(motion_class: str, number: int = 1, step: int = clips.STEP) -> Motion:
    """Return a clip of HDM05 actor bd at 120 Hz over `step`."""
    path = sorted(clips.HDM05.glob(f"HDM_bd_{motion_class}_*_120.amc"))[number - 1]
    return clips.every(read_acclaim(path), step)


@cache
def variety(name: str) -> Motion:
    """Return a take of the archive, such as "02_05" (punches, 120 Hz) or "salsa_01" (60 Hz)."""
    dance = "_" in name and not name[0].isdigit()
    names = [f"bvh/{name}.bvh"] if dance else [f"asfamc/{name}.amc", f"asfamc/{name[:2]}.asf"]
    paths = [BUILD / "takes" / Path(each).name for each in names]
    if not all(path.exists() for path in paths):
        paths[0].parent.mkdir(parents=True, exist_ok=True)
        with tarfile.open(ARCHIVE) as archive:
            for each, path in zip(names, paths, strict=True):
                member = archive.extractfile(f"cmu_variety/{each}")
                assert member is not None
                path.write_bytes(member.read())
    if dance:
        motion = read_bvh(paths[0])
        return motion.slice(1, motion.n_frames)
    return read_acclaim(paths[0])


def pruned(motion: Motion) -> Motion:
    """Leave out head, hands and toes: half as many joints, an eighth of the time."""
    skeleton = motion.skeleton
    kept = [
        joint for joint, name in enumerate(skeleton.names) if re.search(ROUGH, name.lower())
    ]
    new = {joint: index for index, joint in enumerate(kept)}
    parents = tuple(new.get(skeleton.parents[joint], -1) for joint in kept)
    names = tuple(skeleton.names[joint] for joint in kept)
    rough = Skeleton(names, parents, skeleton.offsets[kept])
    return Motion(rough, motion.rotations[:, kept], motion.root_positions, motion.frame_rate)


def thrown_off(motion: Motion, joints: Sequence[str], rng: np.random.Generator) -> Motion:
    """Turn joints away for 2 to 8 frames at a time, as swapped markers do."""
    rotations = motion.rotations.copy()
    for joint in joints:
        column = motion.skeleton.names.index(joint)
        for start in rng.integers(0, motion.n_frames, size=3):
            frames = slice(start, start + int(rng.integers(2, 9)))
            axis = rng.normal(size=3)
            rotation = np.radians(rng.uniform(20, 60)) * axis / np.linalg.norm(axis)
            rotations[frames, column] = multiply(
                rotations[frames, column], quaternion_from_rotation_vector(rotation)
            )
    return motion.with_poses(rotations)


def joint_tracks(motion: Motion) -> Tracks:
    """Return the joints of a motion as points."""
    return Tracks(
        motion.skeleton.names, forward_kinematics(motion).positions, motion.frame_rate
    )


def angle_error(estimate: Motion, truth: Motion, where: Flags | None = None) -> float:
    """Mean angle between the local rotations of the joints that move, degrees."""
    moving = np.ptp(truth.rotations, axis=0).max(axis=1) > 1e-3
    angles = np.degrees(angle_between(estimate.rotations, truth.rotations))
    where = np.broadcast_to(moving, angles.shape) if where is None else where & moving
    return float(angles[where].mean())


def root_error(estimate: Motion, truth: Motion) -> float:
    """Mean distance of the root, centimeters."""
    distance = np.linalg.norm(estimate.root_positions - truth.root_positions, axis=1)
    return float(100.0 * distance.mean())


def point_error(estimate: Array, truth: Array, where: Flags | None = None) -> float:
    """Mean distance of points, millimeters; NaN in the estimate counts as one meter."""
    distance = np.nan_to_num(np.linalg.norm(estimate - truth, axis=-1), nan=1.0)
    return float(1000.0 * (distance if where is None else distance[where]).mean())


def missed_or_false(flagged: Flags, truth: Flags) -> float:
    """Return one minus the F1 score, percent, of flags."""
    hits = (flagged & truth).sum()
    return float(100.0 * (1.0 - 2.0 * hits / max(flagged.sum() + truth.sum(), 1)))
