"""Planted feet in all kinds of movement: kicks, hops, punches, dances, lying down."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from time import perf_counter

import numpy as np
from scipy.ndimage import gaussian_filter1d

from solvers.arrays import Array, Flags
from solvers.feet.legs import LegJoints, find_legs
from solvers.feet.sole_contact import find_foot_contact
from solvers.feet.standing_feet import detect_standing_feet
from solvers.motion import Motion, find_humanoid_map, forward_kinematics
from solvers.motion.humanoid import SIDES
from solvers.rotations import (
    angle_between,
    inverse,
    multiply,
    rotation_vector_from_quaternion,
)
from solvers.signals import find_runs

from ..shared.noise import seeded
from ..shared.tables import number, table

Planter = Callable[[Motion, Flags], Motion]

JITTER_M, JITTER_S = 0.01, 0.1
"""Meters of slow jitter of the root, and seconds over which it changes."""
COLUMNS = (
    "slide, cm/s", "worst drift, mm", "knee, times given", "95 %", "worst",
    "elbow", "largest change, deg", "worst change", "hips, times given", "worst hips",
    "hips moved, cm", "ms a frame",
)  # fmt: skip
SUMMARIES: tuple[Callable[[Array], float], ...] = (
    np.mean, np.max, np.mean, lambda values: np.percentile(values, 95.0), np.max,
    np.max, np.mean, np.max, np.mean, np.max,
    np.mean, np.mean,
)  # fmt: skip


def take_tables(
    title: str, motions: Iterable[Motion], planters: Mapping[str, Planter]
) -> list[str]:
    """Return a table for each kind of input.

    Slide: mean speed of the loaded sole over the floor in contact. Drift: farthest way of the
    sole within a contact. Knee, elbow and hips: largest acceleration of the joint's angle and
    of the root, as a ratio to the motion that is planted. Change: largest rotation of a joint.
    """
    motions = list(motions)
    return [
        _table(f"{title}, {what}", map(spoil, motions), planters)
        for what, spoil in INPUTS.items()
    ]


def _table(title: str, inputs: Iterable[Motion], planters: Mapping[str, Planter]) -> str:
    figures: dict[str, list[list[float]]] = defaultdict(list)
    for given in inputs:
        humanoid = find_humanoid_map(given.skeleton)
        legs = find_legs(given.skeleton, humanoid)
        contacts = detect_standing_feet(given, humanoid, legs)
        if not legs or not contacts.any():
            continue
        for name, plant in planters.items():
            started = perf_counter()
            planted = plant(given, contacts)
            duration = 1000.0 * (perf_counter() - started) / given.n_frames
            figures[name].append([*take_figures(given, planted, legs, contacts), duration])
    rows = {
        name: [
            number(float(summary(values)))
            for summary, values in zip(SUMMARIES, np.transpose(rows), strict=True)
        ]
        for name, rows in figures.items()
    }
    n_takes = len(next(iter(figures.values())))
    return f"**{title}, {n_takes} takes**\n\n{table(['method', *COLUMNS], rows)}\n"


def take_figures(
    given: Motion, planted: Motion, legs: Sequence[LegJoints], contacts: Flags
) -> list[float]:
    """Return all figures of `COLUMNS` but the last."""
    slide, drift = _slides(given, planted, legs, contacts)
    roles = find_humanoid_map(given.skeleton).indices(given.skeleton)
    knees = [leg.knee for leg in legs]
    elbows = [roles[role] for role in ("leftLowerArm", "rightLowerArm") if role in roles]
    knee, elbow = (acceleration_ratio(given, planted, joints) for joints in (knees, elbows))
    change = float(np.degrees(angle_between(planted.rotations, given.rotations)).max())
    hips = _worst_hips(planted) / max(_worst_hips(given), 1e-9)
    moved = np.linalg.norm(planted.root_positions - given.root_positions, axis=1).max()
    return [
        slide, drift, knee, knee, knee, elbow, change, change, hips, hips, 100.0 * float(moved)
    ]  # fmt: skip


def _slides(
    given: Motion, planted: Motion, legs: Sequence[LegJoints], contacts: Flags
) -> tuple[float, float]:
    """Return the mean speed in cm/s and the longest drift in mm of the loaded soles."""
    before, after = forward_kinematics(given), forward_kinematics(planted)
    speeds, drifts = [np.zeros(0)], [0.0]
    for leg in legs:
        contact = contacts[:, SIDES.index(leg.side)]
        foot = find_foot_contact(given, before, leg, contact)
        positions = np.stack([point.position(after) for point in foot.points], axis=1)
        load = 0.5 * (foot.load[1:] + foot.load[:-1])
        steps = np.einsum("fp,fpi->fi", load, np.diff(positions, axis=0))[:, :2]
        both = contact[1:] & contact[:-1]
        speeds.append(np.linalg.norm(steps[both], axis=1) * given.frame_rate)
        drifts += [
            float(np.linalg.norm(np.cumsum(steps[start:stop], axis=0), axis=1).max())
            for start, stop in find_runs(both)
        ]
    found = np.concatenate(speeds)
    return 100.0 * float(found.mean()) if len(found) else 0.0, 1000.0 * max(drifts)


def acceleration_ratio(given: Motion, planted: Motion, joints: Sequence[int]) -> float:
    """Return the largest angular acceleration of joints relative to that in the given motion.

    Angles alone would hide a recorded knee that jumps from 157 degrees to -157.
    """
    if not joints:
        return 1.0
    before, after = (
        np.linalg.norm(
            np.diff(_rotation_vectors(motion.rotations[:, joints]), axis=0), axis=-1
        ).max()
        for motion in (given, planted)
    )
    return float(after / max(before, 1e-9))


def _rotation_vectors(rotations: Array) -> Array:
    """Return the rotation vectors from each frame to the next, (n_frames - 1, n_joints, 3)."""
    steps = multiply(rotations[1:], inverse(rotations[:-1]))
    return rotation_vector_from_quaternion(steps)


def _worst_hips(motion: Motion) -> float:
    return float(np.linalg.norm(np.diff(motion.root_positions, 2, axis=0), axis=1).max())


def _as_it_is(motion: Motion) -> Motion:
    return motion


def _jittering(motion: Motion) -> Motion:
    noise: Array = seeded("contacts").normal(size=motion.root_positions.shape)
    slow = gaussian_filter1d(noise, JITTER_S * motion.frame_rate, axis=0)
    slow *= JITTER_M / slow.std()
    return motion.with_poses(root_positions=motion.root_positions + slow)


def _skating(motion: Motion) -> Motion:
    path = motion.root_positions.copy()
    path[:, :2] += 0.15 * (path[:, :2] - path[0, :2])
    return motion.with_poses(root_positions=path)


INPUTS: dict[str, Callable[[Motion], Motion]] = {
    "as they are": _as_it_is,
    "a root that jitters by 1 cm": _jittering,
    "travel 15 % too long": _skating,
}
