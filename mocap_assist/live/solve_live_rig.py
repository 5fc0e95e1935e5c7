"""A rig that follows a live stream: limits, planted feet, and the channels of its controls."""

from typing import NamedTuple

import numpy as np

from ...solvers.arrays import Array, Single
from ...solvers.denoising import clamp_to_limits
from ...solvers.feet import LivePlanting
from ...solvers.motion import (
    HumanoidMap,
    JointLimits,
    Motion,
    find_humanoid_map,
    forward_kinematics,
)
from ...solvers.retargeting import LiveRetargeting, RetargetSettings
from ...solvers.rotations import IDENTITY
from ...solvers.workflows import LiveMotion
from ..scene.controls import BoneKeys, Carried, TargetRig, keys_of


class LiveRigChoices(NamedTuple):
    """Corrections of the target's poses."""

    hold_feet: bool = True
    limits: JointLimits | None = None


class LiveBones(NamedTuple):
    """First preview: the bones that the frames hold."""

    frame_rate: float
    first_frame: float
    rotating: tuple[str, ...]
    moving: tuple[str, ...]
    rated: tuple[str, ...]
    """Bones with a confidence."""
    has_contacts: bool = False
    """Whether feet are held, and their contacts recorded."""


class LiveFrameKeys(NamedTuple):
    """One frame of the rig: a preview, and a part of the recording."""

    frame: int
    n_skipped: int
    rotations: Single
    """Shape (n_rotating, 4)."""
    locations: Single
    """Shape (n_moving, 3)."""
    confidence: Single
    """Shape (n_rated,)."""
    contacts: tuple[bool, bool] = (False, False)
    """Left and right foot."""

    def keys(self, bones: LiveBones) -> dict[str, BoneKeys]:
        """Return the channels of each bone, of one frame."""
        rotations, locations = self.rotations[None], self.locations[None]
        return channels_of(bones, rotations.astype(np.float64), locations.astype(np.float64))


def channels_of(bones: LiveBones, rotations: Array, locations: Array) -> dict[str, BoneKeys]:
    """Return the channels of each bone from those of all, (n_frames, n_bones, 4 or 3)."""
    rotated = dict(zip(bones.rotating, rotations.swapaxes(0, 1), strict=True))
    moved = dict(zip(bones.moving, locations.swapaxes(0, 1), strict=True))
    names = dict.fromkeys((*bones.rotating, *bones.moving))
    return {name: BoneKeys(rotated.get(name), moved.get(name)) for name in names}


class LiveRig:
    """A target that follows an actor, who starts in its origin.

    Parameters
    ----------
    target : TargetRig
    choices : LiveRigChoices
    calibration : Motion
        In which the actor was measured.
    names : tuple of str
        The tracked joints, in the order of their confidence.
    first_frame : float
        Frame of the scene at which the recording starts.
    """

    def __init__(
        self,
        target: TargetRig,
        choices: LiveRigChoices,
        calibration: Motion,
        names: tuple[str, ...],
        first_frame: float,
    ) -> None:
        self._target, self.frame_rate = target, calibration.frame_rate
        self._limits = choices.limits
        self._start = calibration.root_positions[-1] * (1.0, 1.0, 0.0)
        roles = find_humanoid_map(calibration.skeleton)
        measured = _shift_root(calibration, -self._start)
        self._retargeting = LiveRetargeting(
            measured,
            roles,
            target.skeleton,
            target.humanoid,
            RetargetSettings(to_ground=True),
        )
        self._planting: LivePlanting | None = None
        if choices.hold_feet:
            self._planting = LivePlanting(self._retargeting.update(measured), target.humanoid)
        self._last_frame = 0
        self._body: int | None = None
        self._sources = _sources(target, roles, names)
        self._still = Carried(IDENTITY[None], np.zeros(3), np.zeros((1, 3)))
        self.bones = LiveBones(
            self.frame_rate,
            first_frame,
            tuple(control.bone for control in target.controls if control.rotates),
            tuple(control.bone for control in target.controls if control.moves),
            tuple(self._sources),
            self._planting is not None and self._planting.has_legs,
        )

    def keys(self, live: LiveMotion, n_skipped: int) -> LiveFrameKeys:
        """Return the channels of the controls for the actor's next pose."""
        posed, contacts = self._pose_target(live)
        keys = keys_of(self._target, forward_kinematics(posed), self._still)
        rotations = [keys[bone].rotations for bone in self.bones.rotating]
        locations = [keys[bone].locations for bone in self.bones.moving]
        return LiveFrameKeys(
            live.frame,
            n_skipped,
            np.array(rotations, dtype=np.float32).reshape(-1, 4),
            np.array(locations, dtype=np.float32).reshape(-1, 3),
            self._confidence(live),
            contacts,
        )

    def _pose_target(self, live: LiveMotion) -> tuple[Motion, tuple[bool, bool]]:
        """Return the pose of the target with its feet held, as far as its limits allow."""
        posed = self._retargeting.update(_shift_root(live.motion, -self._start))
        elapsed_s = (live.frame - self._last_frame) / self.frame_rate
        self._last_frame = live.frame
        posed = self._within_limits(posed)
        if self._planting is None:
            return posed, (False, False)
        if self._body not in (None, live.body):
            self._planting.restart()
        self._body = live.body
        posed, (left, right) = self._planting.update(posed, elapsed_s)
        return self._within_limits(posed), (bool(left), bool(right))

    def _within_limits(self, posed: Motion) -> Motion:
        if self._limits is None:
            return posed
        return clamp_to_limits(posed, self._limits, humanoid_map=self._target.humanoid)

    def _confidence(self, live: LiveMotion) -> Single:
        if live.joints is None:
            return np.zeros(0, dtype=np.float32)
        return live.joints.confidence[list(self._sources.values())].astype(np.float32)


def _sources(target: TargetRig, roles: HumanoidMap, names: tuple[str, ...]) -> dict[str, int]:
    """Return for each keyed bone the tracked joint of its role."""
    role_of = {joint: role for role, joint in target.humanoid.joints.items()}
    found = {}
    for control in target.controls:
        role = role_of.get(target.skeleton.names[control.joint]) if control.joint >= 0 else None
        source = roles.joints.get(role) if role else None
        if source in names:
            found[control.bone] = names.index(source)
    return found


def _shift_root(motion: Motion, offset: Array) -> Motion:
    return motion.with_poses(motion.rotations, motion.root_positions + offset)
