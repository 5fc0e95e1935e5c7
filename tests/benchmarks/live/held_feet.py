"""How well feet are held while an actor moves: slide, jumps at release, and time."""

from collections.abc import Sequence
from time import thread_time
from typing import NamedTuple

import numpy as np

from solvers.arrays import Array, Flags
from solvers.denoising.quality.foot_slide import measure_foot_slide, sole_paths
from solvers.feet import LivePlanting, find_legs
from solvers.motion import Motion, detect_contacts, find_humanoid_map, forward_kinematics

RELEASE_S = 0.3
"""Seconds after a foot leaves the ground in which jumps are looked for."""
DRIFT_M = 0.03
"""Meters that the made path drifts in a second, as a random walk."""
HEADER = [
    "take", "contacts as offline, %", "slide, cm", "slide held, cm",
    "jump at release, cm", "eased, cm", "ms", "95th percentile",
]  # fmt: skip


class HeldFeet(NamedTuple):
    """A motion of a rig before and after feet were held, frame after frame."""

    raw: Motion
    held: Motion
    contacts: Flags
    later: Flags
    """Contacts that `detect_contacts` finds in the complete motion."""
    times_ms: list[float]

    @property
    def slide_m(self) -> float:
        """Return how far both soles slide in contact, meters."""
        return _slide(self.held, self.later)

    def cells(self) -> list[str]:
        """Return the row of the table."""
        jump, eased = self.jumps_m
        figures = [
            100.0 * float((self.contacts == self.later).mean()),
            100.0 * _slide(self.raw, self.later),
            100.0 * self.slide_m,
            100.0 * jump,
            100.0 * eased,
            *map(float, np.percentile(self.times_ms, [50, 95])),
        ]
        return [f"{figures[0]:.0f}", *(f"{each:.1f}" for each in figures[1:])]

    @property
    def jumps_m(self) -> tuple[float, float]:
        """Return the largest jump if feet were let go at once, and the largest step now."""
        shift = _ankles(self.held) - _ankles(self.raw)
        steps = np.linalg.norm(np.diff(shift, axis=0), axis=-1)
        at_once, eased, window = [0.0], [0.0], round(RELEASE_S * self.raw.frame_rate)
        for foot in range(2):
            ends = np.flatnonzero(self.contacts[:-1, foot] & ~self.contacts[1:, foot])
            for end in ends:
                at_once.append(float(np.linalg.norm(shift[end, foot])))
                eased.append(float(steps[end : end + window, foot].max()))
        return max(at_once), max(eased)


def drifting(walk: Motion) -> Motion:
    """Return a walk whose path drifts, as that of a camera or of a suit does."""
    noise = np.random.default_rng(5).normal(size=(walk.n_frames, 3))
    drift = np.cumsum(DRIFT_M / np.sqrt(walk.frame_rate) * noise, axis=0)
    return walk.with_poses(walk.rotations, walk.root_positions + drift * (1.0, 1.0, 0.2))


def hold_feet(calibration: Motion, poses: Sequence[Motion]) -> HeldFeet:
    """Hold the feet of a rig frame by frame; `calibration` comes before the poses."""
    roles = find_humanoid_map(calibration.skeleton)
    live, held, contacts, times = LivePlanting(calibration, roles), [], [], []
    for pose in poses:
        began = thread_time()
        found = live.update(pose, calibration.dt)
        times.append(1e3 * (thread_time() - began))
        held.append(found.motion)
        contacts.append(found.contacts)
    raw = _joined(poses)
    return HeldFeet(raw, _joined(held), np.array(contacts), detect_contacts(raw, roles), times)


def _joined(poses: Sequence[Motion]) -> Motion:
    return Motion(
        poses[0].skeleton,
        np.concatenate([pose.rotations for pose in poses]),
        np.concatenate([pose.root_positions for pose in poses]),
        poses[0].frame_rate,
    )


def _slide(motion: Motion, contacts: Flags) -> float:
    """Return how far both soles slide in contact, meters."""
    paths = sole_paths(motion, forward_kinematics(motion))
    return sum(
        measure_foot_slide(foot, contacts[:, side], motion.frame_rate).distance
        for side, foot in enumerate(paths)
    )


def _ankles(motion: Motion) -> Array:
    joints = [leg.ankle for leg in find_legs(motion.skeleton)]
    return np.asarray(forward_kinematics(motion).positions[:, joints])
