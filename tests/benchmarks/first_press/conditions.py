"""What is wrong with a take: noise, outliers, bursts, drift, a missing or misplaced limb."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.motion import Motion, find_humanoid_map
from solvers.rotations import IDENTITY, unwrap_rotation_vectors

from ..shared.noise import (
    METERS_PER_DEGREE,
    Channels,
    corrupt,
    corrupt_in_bursts,
    learn_channels,
    low_passed,
    one_over_f,
    seeded,
)
from .root_bone import below_bone, spin, without_bone
from .takes import Take, read

LIMBS = {"arm": ("left", "UpperArm"), "leg": ("right", "UpperLeg")}
MISSING_S = 1.0


@dataclass(frozen=True)
class Condition:
    """How a take is corrupted."""

    title: str
    sigma: float = 0.0
    """Standard deviation of the noise of each channel, degrees or half centimeters."""
    outliers: float = 0.0
    """Fraction of single samples that lie 20 to 60 degrees off."""
    bursts: float = 0.0
    """Fraction of frames in which a joint is off by 20 to 60 degrees, for 2 to 8 frames."""
    quiet: float = 1.0
    """Factor of the noise of the second half."""
    drift: float = 0.0
    """Standard deviation of 1/f noise, degrees."""
    filtered: float = 0.0
    """Standard deviation of noise, degrees, after a filter of 8 Hz."""
    limb: str = ""
    """Which limb is missing for a second."""
    is_held: bool = False
    """Whether the limb repeats its last pose instead of missing."""
    dropped: float = 0.0
    """Fraction of frames that were lost, 1 to 8 at a time: the body repeats its last pose."""
    t_pose_frames: int = 0
    """For so many frames at the start the left arm is in the rest pose; they are not scored."""
    spin: float = 0.0
    """Degrees by which the body turns within a second. Clean gets it below a still bone."""

    @property
    def is_clean(self) -> bool:
        """Whether the take is given as it is."""
        noise = self.sigma, self.outliers, self.bursts, self.drift, self.filtered
        return not any(noise) and not (self.limb or self.dropped or self.t_pose_frames)

    def __str__(self) -> str:
        return self.title


CONDITIONS = (
    Condition("clean"),
    Condition("sigma 1", sigma=1.0),
    Condition("sigma 3", sigma=3.0),
    Condition("3, 10 % outliers", sigma=3.0, outliers=0.10),
    Condition("sigma 3, then 0.3", sigma=3.0, quiet=0.1),
    Condition("bursts", sigma=0.3, bursts=0.02),
    Condition("1/f drift", drift=3.0),
    Condition("2, filtered at 8 Hz", filtered=2.0),
    Condition("arm lost 1 s", limb="arm"),
    Condition("leg lost 1 s", limb="leg"),
    Condition("arm held 1 s", sigma=0.3, limb="arm", is_held=True),
    Condition("frames dropped", sigma=0.3, dropped=0.15),
    Condition("sigma 1, arm in T-pose", sigma=1.0, t_pose_frames=3),
    Condition("two turns, root bone", spin=720.0),
)


@dataclass(frozen=True, eq=False)
class Case:
    """A take in one condition, as curves: degrees, and half centimeters of the root."""

    take: Take
    condition: Condition

    @cached_property
    def truth(self) -> Motion:
        motion = read(self.take)
        return spin(motion, self.condition.spin) if self.condition.spin else motion

    @cached_property
    def channels(self) -> Channels:
        return learn_channels([self.truth])

    @cached_property
    def clean(self) -> Array:
        """The true curves, shape (n_frames, n_channels), without jumps of full turns."""
        kept = self.channels.kept
        curves = replace(self.channels, kept=np.ones_like(kept)).values(self.truth)
        vectors = np.radians(curves[:, 1:]).reshape(len(curves), -1, 3)
        curves[:, 1:] = np.degrees(unwrap_rotation_vectors(vectors)).reshape(len(curves), -1)
        return np.hstack([curves[:, kept], self.truth.root_positions / METERS_PER_DEGREE])

    @cached_property
    def corrupted(self) -> Array:
        """The curves that every method is given; NaN where missing."""
        condition, rng = self.condition, seeded(str(self.take), str(self.condition))
        if condition.bursts:
            return corrupt_in_bursts(
                self.clean, condition.sigma, condition.bursts, self._groups, rng
            )
        result = corrupt(self.clean, condition.sigma, condition.outliers, rng)
        half = len(result) // 2
        result[half:] = self.clean[half:] + condition.quiet * (result - self.clean)[half:]
        if condition.drift:
            result += condition.drift * one_over_f(result.shape, rng)
        if condition.filtered:
            result += condition.filtered * low_passed(result.shape, self.truth.frame_rate, rng)
        for joints, frames in self._repeats:
            columns = self.channels.of_joints(joints)
            if 0 in joints:
                columns = np.append(columns, np.arange(-3, 0) + result.shape[1])
            result[:, columns] = result[np.ix_(frames, columns)]
        if condition.limb and not condition.is_held:
            rows = np.arange(len(result))[self.missing_frames]
            result[np.ix_(rows, self.channels.of_joints(self.missing_joints))] = np.nan
        if condition.t_pose_frames:
            arm, rotations = self._joints_of("arm"), self.truth.rotations.copy()
            rotations[:, arm] = IDENTITY
            posed = self.channels.values(self.truth.with_poses(rotations))
            block = np.ix_(range(condition.t_pose_frames), self.channels.of_joints(arm))
            result[block] = posed[block]
        return result

    @cached_property
    def is_good(self) -> NDArray[np.bool_]:
        """Where a joint is observed and no outlier, shape (n_frames, n_joints)."""
        error = np.abs(self.corrupted - self.clean)
        lasting = self.condition.drift + self.condition.filtered
        limit = 5.0 * self.condition.sigma + 3.0 * lasting + 1e-6
        good = np.ones(self.truth.rotations.shape[:2], dtype=np.bool_)
        for joint in range(self.truth.n_joints):
            columns = self.channels.of_joints([joint])
            if joint == 0:
                columns = np.append(columns, np.arange(-3, 0) + error.shape[1])
            good[:, joint] = (error[:, columns] < limit).all(axis=1)
        return good

    @cached_property
    def recording(self) -> Motion:
        """The corrupted take."""
        motion = self.motion(self.corrupted)
        for joints, frames in self._repeats:  # to the last bit, also where it hardly moves
            rotations = motion.rotations.copy()
            rotations[:, joints] = rotations[np.ix_(frames, joints)]
            motion = motion.with_poses(rotations)
        return motion

    @property
    def given(self) -> Motion:
        """The corrupted take as Clean gets it."""
        return below_bone(self.recording) if self.condition.spin else self.recording

    def body_of(self, cleaned: Motion) -> Motion:
        """Return the body of what was given."""
        return without_bone(cleaned, self.truth) if self.condition.spin else cleaned

    @cached_property
    def _repeats(self) -> list[tuple[list[int], NDArray[np.intp]]]:
        """Joints that repeat a pose, and the frame that each frame shows."""
        frames, condition = np.arange(self.truth.n_frames), self.condition
        if condition.is_held:
            frames[self.missing_frames] = self.missing_frames.start - 1
            return [(self.missing_joints, frames)]
        if not condition.dropped:
            return []
        rng = seeded(str(self.take), f"{condition} frames")
        lost = np.zeros(len(frames), dtype=np.bool_)
        while lost.mean() < condition.dropped:
            start = rng.integers(2, len(frames) - 10)
            lost[start : start + rng.integers(1, 9)] = True
        frames[lost] = 0
        return [(list(range(self.truth.n_joints)), np.maximum.accumulate(frames))]

    @cached_property
    def missing_joints(self) -> list[int]:
        """Joints of the missing limb."""
        return self._joints_of(self.condition.limb)

    def _joints_of(self, limb: str) -> list[int]:
        side, top = LIMBS[limb]
        skeleton = self.truth.skeleton
        first = skeleton.index(find_humanoid_map(skeleton).joints[side + top])
        moving = self.channels.joints
        return [joint for joint in skeleton.subtree(first) if moving[joint]]

    @cached_property
    def missing_frames(self) -> slice:
        """The second in the middle of the take, or half of a shorter take."""
        n_frames = self.truth.n_frames
        length = min(round(MISSING_S * self.truth.frame_rate), n_frames // 2)
        start = (n_frames - length) // 2
        return slice(start, start + length)

    def motion(self, curves: Array) -> Motion:
        """Return the take with these curves; joints with a NaN are missing."""
        moved = self.channels.motion(curves[:, :-3], self.truth)
        return moved.with_poses(root_positions=curves[:, -3:] * METERS_PER_DEGREE)

    @property
    def _groups(self) -> Sequence[NDArray[np.intp]]:
        moving = np.flatnonzero(self.channels.joints)
        root = np.arange(-3, 0) + self.clean.shape[1]
        return [*(self.channels.of_joints([int(joint)]) for joint in moving), root]
