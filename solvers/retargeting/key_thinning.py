"""Choose key frames by the error of the joints in world space."""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, Integers
from ..motion import Motion, forward_kinematics
from ..motion.skeletons import world_poses
from ..progress import Progress
from ..rotations import IDENTITY
from ..signals import find_runs
from .error_points import find_error_points
from .key_curves import KeyCurve, fit_curve
from .rotation_channels import RotationChannels

NewKey = tuple[int, int]
"""A joint, and the frame of a new key."""

MIN_CHANGE = 1e-7
"""Change, in radians or meters, below which a joint or the root needs only one key. It absorbs
rounding (`test_constant_joints_need_one_key_and_resting_ones_none`)."""
INITIAL_TOLERANCE_FACTOR = 3.0
"""Initial error of each joint alone, as a multiple of the tolerance. Half and twice gain less
than 1 % (`make sensitivity`)."""
ROUNDING = 1e-12
"""Radians or meters: a smaller change of a fitted curve is none. It absorbs rounding."""
N_SAMPLED_POSES = 100
"""Number of poses in which the distance of joints to their points is measured. It bounds the
run time."""
ROOT = -1


class Thinning:
    """Curves of all joints with their current keys; joint -1 is the root position.

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
        self.targets = {ROOT: motion.root_positions} | {
            joint: each.to_rotations(self.samples[joint]) for joint, each in enumerate(channels)
        }
        self.reach = self._reach()
        self.curves: dict[int, KeyCurve] = {}
        self.errors: dict[int, Array] = {}
        self.fitted = {joint: np.zeros_like(each) for joint, each in self.targets.items()}
        self.changed = np.ones(motion.n_frames, dtype=np.bool_)
        self.off = np.zeros(self.truth.shape[:2])
        for joint, samples in self.samples.items():
            is_identity = joint != ROOT and _is_identity(motion.rotations[:, joint])
            self._refit(joint, _first_keys(samples, is_identity))

    def begin(self, progress: Progress) -> None:
        """Add keys until the error of each joint alone is small."""
        for number, joint in enumerate(self.samples):
            while new_keys := self._too_far(joint):
                self._add({(joint, frame) for frame in new_keys})
            progress((number + 1) / len(self.samples), "Reducing keys")

    def finish(self, progress: Progress) -> float:
        """Add keys until all errors are within the tolerance; return the largest error."""
        start, done = 0.0, 0.0
        while True:
            self._measure()
            worst = float(self.off.max())
            if worst <= self.tolerance or not self._add(self._needed_keys()):
                return worst
            start = max(start, worst)
            done = max(done, (start - worst) / (start - self.tolerance))
            progress(done, "Adding keys where errors are large")

    def _reach(self) -> dict[int, float]:
        """Return the maximum distance of each joint to the points that it moves."""
        step = max(len(self.truth) // N_SAMPLED_POSES, 1)
        reach = {ROOT: 1.0, **dict.fromkeys(range(self.motion.n_joints), 0.0)}
        for point, chain in enumerate(self.points.chains):
            vectors = self.truth[::step, None, point] - self.joints[::step, chain]
            distances = np.linalg.norm(vectors, axis=-1).max(axis=0)
            for joint, too_far in zip(chain, distances, strict=True):
                # A quaternion's error is half that of its angle.
                reach[int(joint)] = max(reach[int(joint)], 2.0 * float(too_far))
        return reach

    def _too_far(self, joint: int) -> list[int]:
        """Return the middles of the segments where the error of a joint alone is too large."""
        keys, errors = self.curves[joint].frames, self.errors[joint] * self.reach[joint]
        if len(keys) < 2:
            return []
        too_far = (
            np.maximum.reduceat(errors, keys[:-1]) > INITIAL_TOLERANCE_FACTOR * self.tolerance
        )
        too_far &= np.diff(keys) > 1
        return [int(middle) for middle in (keys[:-1] + keys[1:])[too_far] // 2]

    def _needed_keys(self) -> set[NewKey]:
        """Return one new key for each interval in which a point exceeds the tolerance."""
        new_keys = set()
        for point, chain in enumerate(self.points.chains):
            for frame in _peaks(self.off[:, point], self.tolerance):
                if (new_key := self._key_for_point(point, chain, frame)) is not None:
                    new_keys.add(new_key)
        return new_keys

    def _key_for_point(self, point: int, chain: Integers, frame: int) -> NewKey | None:
        """Return a new key for the joint with the largest contribution to an error, or None."""
        arms = np.linalg.norm(self.truth[frame, point] - self.joints[frame, chain], axis=-1)
        contributions = [
            (2.0 * arm * self.errors[int(joint)][frame], int(joint))
            for joint, arm in zip(chain, arms, strict=True)
        ]
        contributions.append((self.errors[ROOT][frame], ROOT))
        for _, joint in sorted(contributions, reverse=True):
            if (new := self._key_near(joint, frame)) is not None:
                return joint, new
        return None

    def _key_near(self, joint: int, frame: int) -> int | None:
        """Return the middle of the worst segment near a frame; None if all are too short."""
        keys = self.curves[joint].frames
        if len(keys) < 2:
            return None
        segment = min(int(np.searchsorted(keys, frame, side="right")), len(keys) - 1)
        for extent in (0, 1):
            start = int(keys[max(segment - 1 - extent, 0)])
            stop = int(keys[min(segment + extent, len(keys) - 1)])
            errors = self.errors[joint][start:stop].copy()
            errors[keys[(keys >= start) & (keys < stop)] - start] = 0.0
            if errors.any():
                worst = start + int(errors.argmax())
                after = int(np.searchsorted(keys, worst))
                return int(keys[after - 1] + keys[after]) // 2
        return None

    def _add(self, new_keys: set[NewKey]) -> bool:
        """Add keys and return whether there were any."""
        if self.together:
            moving = [joint for joint, curve in self.curves.items() if len(curve.frames) > 1]
            new_keys = {(joint, frame) for joint in moving for _, frame in new_keys}
        new: dict[int, list[int]] = {}
        for joint, frame in sorted(new_keys):
            new.setdefault(joint, []).append(frame)
        for joint, frames in new.items():
            self._refit(joint, np.union1d(self.curves[joint].frames, frames).astype(np.intp))
        return bool(new_keys)

    def _refit(self, joint: int, keys: Integers) -> None:
        curve = fit_curve(self.samples[joint], keys)
        fitted = self._evaluate_curve(joint, curve)
        self.changed |= (np.abs(fitted - self.fitted[joint]) > ROUNDING).any(axis=1)
        self.curves[joint], self.fitted[joint] = curve, fitted
        self.errors[joint] = np.linalg.norm(fitted - self.targets[joint], axis=-1)

    def _evaluate_curve(self, joint: int, curve: KeyCurve) -> Array:
        frames = np.arange(self.motion.n_frames)
        if joint == ROOT:
            return curve.at(frames)
        if not len(curve.frames):
            return np.tile(IDENTITY, (len(frames), 1))
        return self.channels[joint].to_rotations(curve.at(frames))

    def _measure(self) -> None:
        """Update the errors of the points in the changed frames."""
        changed = self.changed
        rotations = [self.fitted[joint][changed] for joint in range(self.motion.n_joints)]
        poses = world_poses(
            self.motion.skeleton, np.stack(rotations, axis=1), self.fitted[ROOT][changed]
        )
        errors = self.points.positions(poses) - self.truth[changed]
        self.off[changed] = np.linalg.norm(errors, axis=-1)
        self.changed = np.zeros_like(changed)


def _is_identity(rotations: Array) -> bool:
    """Return whether all rotations are the identity, up to rounding."""
    return bool(np.linalg.norm(rotations[:, 1:], axis=1).max() < MIN_CHANGE / 2.0)


def _first_keys(samples: Array, is_identity: bool) -> Integers:
    """Return no key for a joint in its rest pose, one for a constant, else both ends."""
    if is_identity:
        return np.array([], dtype=np.intp)
    if np.abs(samples - samples[0]).max() < MIN_CHANGE / 2.0:
        return np.array([0], dtype=np.intp)
    return np.unique([0, len(samples) - 1]).astype(np.intp)


def _peaks(off: Array, tolerance: float) -> list[int]:
    """Return the worst frame of each interval above the tolerance."""
    return [start + int(off[start:stop].argmax()) for start, stop in find_runs(off > tolerance)]
