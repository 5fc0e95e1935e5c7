"""Choose the frames of keys by what joints lose in the world."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, forward_kinematics
from ..motion.skeletons import world_poses
from ..progress import Progress
from ..rotations import IDENTITY
from .judged_points import find_error_points
from .key_curves import KeyCurve, fit_curve
from .rotation_channels import RotationChannels

Array = NDArray[np.float64]
Frames = NDArray[np.intp]
Place = tuple[int, int]
"""A joint, and the frame of a new key."""

STILL = 1e-7
"""A joint that turns less, in radians, and a root that moves less, in metres, needs one key."""
LOOSE = 3.0
"""Part of the tolerance by which each joint alone may be off to begin with."""
SAME = 1e-12
SAMPLED = 100
"""Poses at which the reach of the joints is measured."""
ROOT = -1


class Thinning:
    """Curves of all joints with the keys that they have so far. -1 stands for the root's place.

    Attributes
    ----------
    curves : dict of joint to KeyCurve
    """

    def __init__(
        self,
        motion: Motion,
        tolerance: float,
        channels: Sequence[RotationChannels],
        *,
        together: bool,
    ) -> None:
        self.motion = motion
        self.channels = channels
        self.tolerance = tolerance
        self.together = together
        self.points = find_error_points(motion.skeleton)
        poses = forward_kinematics(motion)
        self.truth = self.points.positions(poses)
        self.joints = poses.positions
        self.samples = {ROOT: motion.root_positions} | {
            joint: each.from_rotations(motion.rotations[:, joint])
            for joint, each in enumerate(channels)
        }
        self.wanted = {ROOT: motion.root_positions} | {
            joint: each.to_rotations(self.samples[joint]) for joint, each in enumerate(channels)
        }
        self.reach = self._reach()
        self.curves: dict[int, KeyCurve] = {}
        self.errors: dict[int, Array] = {}
        self.fitted = {joint: np.zeros_like(each) for joint, each in self.wanted.items()}
        self.changed = np.ones(motion.n_frames, dtype=np.bool_)
        self.off = np.zeros(self.truth.shape[:2])
        for joint, samples in self.samples.items():
            rests = joint != ROOT and _rests(motion.rotations[:, joint])
            self._refit(joint, _first_keys(samples, rests))

    def begin(self, progress: Progress) -> None:
        """Give each joint so many keys that it alone is off by little."""
        for number, joint in enumerate(self.samples):
            while places := self._too_far(joint):
                self._add({(joint, frame) for frame in places})
            progress((number + 1) / len(self.samples), "Thinning out the keys of each joint")

    def finish(self, progress: Progress) -> float:
        """Add keys until no end is off by more than the tolerance; return what is left."""
        start, done = 0.0, 0.0
        while True:
            self._measure()
            worst = float(self.off.max())
            if worst <= self.tolerance or not self._add(self._wanted()):
                return worst
            start = max(start, worst)
            done = max(done, (start - worst) / (start - self.tolerance))
            progress(done, "Adding keys where limbs are off")

    def _reach(self) -> dict[int, float]:
        """Return how far from each joint the points are that it moves, at most."""
        step = max(len(self.truth) // SAMPLED, 1)
        reach = {ROOT: 1.0, **dict.fromkeys(range(self.motion.n_joints), 0.0)}
        for point, chain in enumerate(self.points.chains):
            ways = self.truth[::step, None, point] - self.joints[::step, chain]
            farthest = np.linalg.norm(ways, axis=-1).max(axis=0)
            for joint, far in zip(chain, farthest, strict=True):
                # A quaternion's error is half that of its angle.
                reach[int(joint)] = max(reach[int(joint)], 2.0 * float(far))
        return reach

    def _too_far(self, joint: int) -> list[int]:
        """Return the middles of the segments in which a joint alone is off by too much."""
        keys, away = self.curves[joint].frames, self.errors[joint] * self.reach[joint]
        if len(keys) < 2:
            return []
        far = np.maximum.reduceat(away, keys[:-1]) > LOOSE * self.tolerance
        far &= np.diff(keys) > 1
        return [int(middle) for middle in (keys[:-1] + keys[1:])[far] // 2]

    def _wanted(self) -> set[Place]:
        """Return where keys would help most: one place for each time that a point is off."""
        places = set()
        for point, chain in enumerate(self.points.chains):
            for frame in _peaks(self.off[:, point], self.tolerance):
                if (place := self._culprit(point, chain, frame)) is not None:
                    places.add(place)
        return places

    def _culprit(self, point: int, chain: Frames, frame: int) -> Place | None:
        """Return a new key for the joint that moves a point away most, or None."""
        arms = np.linalg.norm(self.truth[frame, point] - self.joints[frame, chain], axis=-1)
        shares = [
            (2.0 * arm * self.errors[int(joint)][frame], int(joint))
            for joint, arm in zip(chain, arms, strict=True)
        ]
        shares.append((self.errors[ROOT][frame], ROOT))
        for _, joint in sorted(shares, reverse=True):
            if (new := self._place_near(joint, frame)) is not None:
                return joint, new
        return None

    def _place_near(self, joint: int, frame: int) -> int | None:
        """Return the middle of the worst segment here or next to it; None if all are short."""
        keys = self.curves[joint].frames
        if len(keys) < 2:
            return None
        segment = min(int(np.searchsorted(keys, frame, side="right")), len(keys) - 1)
        for wider in (0, 1):
            start = int(keys[max(segment - 1 - wider, 0)])
            stop = int(keys[min(segment + wider, len(keys) - 1)])
            errors = self.errors[joint][start:stop].copy()
            errors[keys[(keys >= start) & (keys < stop)] - start] = 0.0
            if errors.any():
                worst = start + int(errors.argmax())
                after = int(np.searchsorted(keys, worst))
                return int(keys[after - 1] + keys[after]) // 2
        return None

    def _add(self, places: set[Place]) -> bool:
        """Add keys; tell whether there were any to add."""
        if self.together:
            moving = [joint for joint, curve in self.curves.items() if len(curve.frames) > 1]
            places = {(joint, frame) for joint in moving for _, frame in places}
        new: dict[int, list[int]] = {}
        for joint, frame in sorted(places):
            new.setdefault(joint, []).append(frame)
        for joint, frames in new.items():
            self._refit(joint, np.union1d(self.curves[joint].frames, frames).astype(np.intp))
        return bool(places)

    def _refit(self, joint: int, keys: Frames) -> None:
        curve = fit_curve(self.samples[joint], keys)
        fitted = self._evaluated(joint, curve)
        self.changed |= (np.abs(fitted - self.fitted[joint]) > SAME).any(axis=1)
        self.curves[joint], self.fitted[joint] = curve, fitted
        self.errors[joint] = np.linalg.norm(fitted - self.wanted[joint], axis=-1)

    def _evaluated(self, joint: int, curve: KeyCurve) -> Array:
        frames = np.arange(self.motion.n_frames)
        if joint == ROOT:
            return curve.at(frames)
        if not len(curve.frames):
            return np.tile(IDENTITY, (len(frames), 1))
        return self.channels[joint].to_rotations(curve.at(frames))

    def _measure(self) -> None:
        """Find out anew how far off the points are, in the frames that have changed."""
        here = self.changed
        rotations = [self.fitted[joint][here] for joint in range(self.motion.n_joints)]
        poses = world_poses(
            self.motion.skeleton, np.stack(rotations, axis=1), self.fitted[ROOT][here]
        )
        away = self.points.positions(poses) - self.truth[here]
        self.off[here] = np.linalg.norm(away, axis=-1)
        self.changed = np.zeros_like(here)


def _rests(rotations: Array) -> bool:
    """Tell whether all rotations are the identity, but for rounding."""
    return bool(np.linalg.norm(rotations[:, 1:], axis=1).max() < STILL / 2.0)


def _first_keys(samples: Array, rests: bool) -> Frames:
    """Return no key for a joint at rest, one for what keeps still, both ends for all else."""
    if rests:
        return np.array([], dtype=np.intp)
    if np.abs(samples - samples[0]).max() < STILL / 2.0:
        return np.array([0], dtype=np.intp)
    return np.unique([0, len(samples) - 1]).astype(np.intp)


def _peaks(off: Array, tolerance: float) -> list[int]:
    """Return the worst frame of each run of frames beyond the tolerance."""
    beyond = np.flatnonzero(off > tolerance)
    if not len(beyond):
        return []
    runs = np.split(beyond, np.flatnonzero(np.diff(beyond) > 1) + 1)
    return [int(run[off[run].argmax()]) for run in runs]
