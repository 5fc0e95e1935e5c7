"""Planted feet in all kinds of movement: kicks, hops, punches, dances, lying down."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from time import perf_counter

import numpy as np
from scipy.ndimage import gaussian_filter1d

from solvers.arrays import Array, Flags
from solvers.feet.legs import LegJoints, find_legs
from solvers.feet.sole_contact import find_foot_contact
from solvers.feet.standing_feet import detect_standing_feet, standing_probabilities
from solvers.feet.support import held_steps
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
EDGE_S = 0.067
"""Seconds around the ends of a contact in which a jolt counts: two frames at 30 Hz."""
COLUMNS = (
    "slide, cm/s", "certain slide, cm/s", "worst certain drift, mm", "jolt at edges, m/s2",
    "worst jolt", "knee, times given", "95 %", "worst",
    "elbow", "largest change, deg", "worst change", "hips, times given", "worst hips",
    "hips moved, cm", "ms a frame",
)  # fmt: skip
SUMMARIES: tuple[Callable[[Array], float], ...] = (
    np.mean, np.mean, np.max, np.mean, np.max,
    np.mean, lambda values: np.percentile(values, 95.0), np.max,
    np.max, np.mean, np.max, np.mean, np.max,
    np.mean, np.mean,
)  # fmt: skip


def take_tables(
    title: str, motions: Iterable[Motion], planters: Mapping[str, Planter]
) -> list[str]:
    """Return a table for each kind of input.

    Slide: mean speed of the loaded sole over the floor in contact. Certain slide and drift: the
    same, and the farthest way of the sole, where a contact is certain. Jolt: largest
    acceleration of a point of a foot where a contact begins or ends, beyond that in the motion
    that is planted. Knee, elbow and hips: largest acceleration of the joint's angle and
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
    soles = _soles(given, planted, legs, contacts)
    roles = find_humanoid_map(given.skeleton).indices(given.skeleton)
    knees = [leg.knee for leg in legs]
    elbows = [roles[role] for role in ("leftLowerArm", "rightLowerArm") if role in roles]
    knee, elbow = (acceleration_ratio(given, planted, joints) for joints in (knees, elbows))
    change = float(np.degrees(angle_between(planted.rotations, given.rotations)).max())
    hips = _worst_hips(planted) / max(_worst_hips(given), 1e-9)
    moved = np.linalg.norm(planted.root_positions - given.root_positions, axis=1).max()
    return [
        *soles, soles[-1], knee, knee, knee, elbow, change, change, hips, hips,
        100.0 * float(moved),
    ]  # fmt: skip


def _soles(
    given: Motion, planted: Motion, legs: Sequence[LegJoints], contacts: Flags
) -> tuple[float, float, float, float]:
    """Return slide and certain slide in cm/s, certain drift in mm and jolt at edges in m/s2."""
    before, after = forward_kinematics(given), forward_kinematics(planted)
    probability = standing_probabilities(given, find_humanoid_map(given.skeleton), legs)
    speeds, certain_speeds, drifts, jolts = [np.zeros(0)], [np.zeros(0)], [0.0], [0.0]
    for leg in legs:
        column = SIDES.index(leg.side)
        contact = contacts[:, column]
        foot = find_foot_contact(given, before, leg, contact)
        was, now = (
            np.stack([point.position(poses) for point in foot.points], axis=1)
            for poses in (before, after)
        )
        steps = np.einsum("fp,fpi->fi", foot.step_load, np.diff(now, axis=0))[:, :2]
        both = contact[1:] & contact[:-1]
        certain = both & (held_steps(probability[:, column]) == 1.0)
        speed = np.linalg.norm(steps, axis=1) * given.frame_rate
        speeds.append(speed[both])
        certain_speeds.append(speed[certain])
        drifts += [
            float(np.linalg.norm(np.cumsum(steps[start:stop], axis=0), axis=1).max())
            for start, stop in find_runs(certain)
        ]
        jolts += _jolts(was, now, contact, given.frame_rate)
    found = [np.concatenate(each) for each in (speeds, certain_speeds)]
    slide, certain_slide = (100.0 * float(each.mean()) if len(each) else 0.0 for each in found)
    return slide, certain_slide, 1000.0 * max(drifts), max(jolts)


def _jolts(before: Array, after: Array, contact: Flags, frame_rate: float) -> list[float]:
    """Return how much more a foot accelerates where each contact begins or ends, m/s2.

    Positions before and after planting have the shape (n_frames, n_points, 3).
    """
    was, now = (
        np.linalg.norm(np.diff(path, 2, axis=0), axis=2).max(axis=1) * frame_rate**2
        for path in (before, after)
    )
    width = max(round(EDGE_S * frame_rate), 1)
    edges = np.flatnonzero(contact[1:] != contact[:-1])
    windows = [slice(max(edge - width, 0), edge + width) for edge in edges]
    return [float(now[one].max() - was[one].max()) for one in windows if now[one].size]


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
