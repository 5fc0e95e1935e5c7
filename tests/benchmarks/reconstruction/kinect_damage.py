"""Takes of UI-PRMD with missing, hidden, shaken or swapped joints, and which these are."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from solvers.arrays import Array, Flags
from solvers.motion.humanoid.posture_heading import normalize_postures, rotate_about_vertical
from solvers.motion.humanoid.posture_joints import (
    N_JOINTS,
    PARENTS,
    POSTURE_JOINTS,
    posture_joint_indices,
)

from .kinect_folds import observed_postures
from .kinect_pairs import Pair

LIMBS = {"arm": (4, 5, 6), "leg": (12, 13, 14, 15), "both arms": (4, 5, 6, 8, 9, 10)}
"""Numbers of `POSTURE_JOINTS`; this sensor measures no ends of hands."""
COUNTS = (1, 2, 4, 8)
SECONDS = (0.5, 1.0, 2.0)
MIN_OBSERVED_FRAMES = 4
"""Frames before and after what is damaged."""
SHAKEN = (5, 6, 9, 10, 13, 14, 17, 18)
JUMPS = (0.05, 0.15)
SWAPS = (((5, 6), (9, 10)), ((13, 14, 15), (17, 18, 19)))
"""Left and right of forearms with hands, and of shanks with feet."""
DISTANCE, HEIGHT = 2.5, 1.0
"""Meters from the hips to the sensor, and from the ground."""
VIEWS = {"front": 0.0, "slantwise": np.radians(45.0), "side": np.radians(80.0)}
CAPSULES = (
    ((0, 2), 0.13), ((2, 3), 0.09),
    ((4, 5), 0.05), ((5, 6), 0.045), ((8, 9), 0.05), ((9, 10), 0.045),
    ((12, 13), 0.075), ((13, 14), 0.055), ((16, 17), 0.075), ((17, 18), 0.055),
)  # fmt: skip
"""Joints at both ends, and radius in meters."""


@dataclass(frozen=True, eq=False)
class Damaged:
    """A take, and which joints of postures are damaged in which frames."""

    what: str
    seconds: str
    pair: Pair
    where: Flags


def with_missing_joints(pair: Pair, random: np.random.Generator) -> Iterator[Damaged]:
    """Remove some joints at random, or complete limbs, once in the take."""
    observed = np.flatnonzero(np.isfinite(observed_postures(pair)).all(axis=(0, 2)))
    for seconds in SECONDS:
        n = round(seconds * pair.kinect.frame_rate)
        if n + 2 * MIN_OBSERVED_FRAMES >= pair.kinect.n_frames:
            continue
        choices = {str(n): random.choice(observed, n, replace=False) for n in COUNTS}
        for what, joints in {**choices, **LIMBS}.items():
            where = _stretch(pair, n, joints, random)
            yield Damaged(what, f"{seconds:g} s", without(pair, where), where)


def hidden(pair: Pair) -> Iterator[Damaged]:
    """Lose the joints that the sensor would have to see through the body."""
    for view, angle in VIEWS.items():
        where = occluded(observed_postures(pair), pair.kinect.frame_rate, angle)
        where &= (~where).sum(axis=0) >= MIN_OBSERVED_FRAMES
        if where.any():
            yield Damaged(view, "as long as hidden", without(pair, where), where)


def shaken(pair: Pair, random: np.random.Generator) -> Iterator[Damaged]:
    """Let two joints jump in each frame of a stretch."""
    for seconds in (0.3, 1.0):
        n = round(seconds * pair.kinect.frame_rate)
        if n + 2 * MIN_OBSERVED_FRAMES >= pair.kinect.n_frames:
            continue
        where = _stretch(pair, n, random.choice(SHAKEN, 2, replace=False), random)
        jumps = random.normal(size=(*where.shape, 3))
        jumps *= random.uniform(*JUMPS, where.shape)[..., None] / np.linalg.norm(
            jumps, axis=-1, keepdims=True
        )
        moved = observed_postures(pair) + np.where(where[..., None], jumps, 0.0)
        yield Damaged("vibration", f"{seconds:g} s", _with(pair, moved), where)


def swapped(pair: Pair, random: np.random.Generator) -> Iterator[Damaged]:
    """Exchange left and right limbs for half a second."""
    n = round(0.5 * pair.kinect.frame_rate)
    if n + 2 * MIN_OBSERVED_FRAMES >= pair.kinect.n_frames:
        return
    for what, (left, right) in zip(("arms", "legs"), SWAPS, strict=True):
        where = _stretch(pair, n, np.array(left + right), random)
        moved, original = observed_postures(pair), observed_postures(pair)
        rows = np.flatnonzero(where.any(axis=1))
        moved[np.ix_(rows, left)] = original[np.ix_(rows, right)]
        moved[np.ix_(rows, right)] = original[np.ix_(rows, left)]
        yield Damaged(f"swapped {what}", "0.5 s", _with(pair, moved), where)


def occluded(positions: Array, frame_rate: float, angle: float) -> Flags:
    """Tell which joints lie behind a part of the body that they do not belong to."""
    plain = normalize_postures(positions, frame_rate)
    ahead = rotate_about_vertical(np.array([[[0.0, -DISTANCE, 0.0]]]), np.array([angle]))[0, 0]
    middle = np.median(plain.hip_positions, axis=0)
    facing = np.angle(np.exp(1j * plain.headings).mean())
    sensor = middle + rotate_about_vertical(ahead[None, None], np.array([facing]))[0, 0]
    sensor[2] = np.nanmin(positions[..., 2]) + HEIGHT
    result = np.zeros(positions.shape[:2], bool)
    for (one, other), radius in CAPSULES:
        for joint in range(N_JOINTS):
            if not {joint, PARENTS[joint]} & {one, other} and joint not in _on(one, other):
                result[:, joint] |= _behind(
                    sensor, positions[:, joint], positions[:, one], positions[:, other], radius
                )
    return result


def _on(one: int, other: int) -> tuple[int, ...]:
    """Joints that lie in the trunk, which hides them always."""
    return (0, 1, 2, 4, 8, 12, 16) if (one, other) == (0, 2) else ()


def _behind(sensor: Array, joint: Array, one: Array, other: Array, radius: float) -> Flags:
    """Whether the line of sight comes nearer to the axis than the radius, before the joint."""
    sight, axis, between = joint - sensor, other - one, sensor - one
    a, b, c = ((x * y).sum(axis=-1) for x, y in ((sight, sight), (sight, axis), (axis, axis)))
    d, e = (sight * between).sum(axis=-1), (axis * between).sum(axis=-1)
    along = np.clip((a * e - b * d) / np.maximum(a * c - b * b, 1e-9), 0.0, 1.0)
    reach = (b * along - d) / np.maximum(a, 1e-9)
    gap = between + reach[:, None] * sight - along[:, None] * axis
    short = 1.0 - 1.5 * radius / np.sqrt(np.maximum(a, 1e-9))
    near = np.linalg.norm(gap, axis=-1) < radius
    return np.asarray(near & (reach > 0.0) & (reach < short))


def without(pair: Pair, where: Flags) -> Pair:
    """Take joints out of the recording."""
    return _with(pair, np.where(where[..., None], np.nan, observed_postures(pair)))


def _with(pair: Pair, moved: Array) -> Pair:
    positions = pair.kinect.tracks.positions.copy()
    for role, index in posture_joint_indices(pair.kinect.names).items():
        positions[:, index] = moved[:, POSTURE_JOINTS.index(role)]
    tracks = pair.kinect.tracks.with_positions(positions)
    return replace(pair, kinect=pair.kinect.with_tracks(tracks))


def _stretch(pair: Pair, n: int, joints: Array, random: np.random.Generator) -> Flags:
    n_frames = pair.kinect.n_frames
    start = random.integers(MIN_OBSERVED_FRAMES, n_frames - n - MIN_OBSERVED_FRAMES + 1)
    where = np.zeros((n_frames, N_JOINTS), bool)
    where[start : start + n, joints] = True
    return where
