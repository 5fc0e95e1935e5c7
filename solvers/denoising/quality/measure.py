"""Measure the quality of a take: jitter, spikes, gaps, foot slide, bone-length drift."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ...arrays import Array, Flags
from ...motion import JointLimits, Motion, Tracks, forward_kinematics
from ...motion.humanoid import HumanoidMap
from ...motion.skeletons import (
    PathJump,
    find_path_jumps,
    find_shot_boundaries,
    move_root,
    path_offsets,
)
from ...progress import Progress, unwatched, within
from ...settings import Settings, setting
from ..held_samples import body_is_held, find_held_samples, hide_held_samples
from ..limits import limit_excess
from .bone_drift import BoneDrift, bones_are_searched, measure_bone_drifts
from .confirm_spikes import confirm_spikes
from .figures import quality_figures
from .foot_slide import FootSlide, foot_paths, measure_foot_slides, sole_paths
from .jitter import measure_jitter
from .joint_jumps import JointJump, find_joint_jumps
from .joint_signals import Signal, SpikeRule, extract_signals
from .report import quality_report


@dataclass(frozen=True, kw_only=True)
class QualitySettings(Settings):
    """Thresholds of a spike."""

    spike_threshold: float = setting(
        5.0,
        "Jump that counts as a spike, in multiples of the take's noise; higher finds fewer",
        minimum=2.0,
        maximum=50.0,
    )
    min_rotation_jump: float = setting(
        np.radians(8.0),
        "Ignore rotation jumps below this angle; higher finds fewer spikes",
        unit="rad",
        minimum=0.0,
        maximum=np.pi,
        label="Min Rotation Jump",
        former="smallest_turn",
    )
    min_position_jump: float = setting(
        0.02,
        "Ignore position jumps below this distance; higher finds fewer spikes",
        unit="m",
        minimum=0.0,
        maximum=10.0,
        label="Min Position Jump",
        former="smallest_move",
    )


@dataclass(frozen=True, eq=False)
class Quality:
    """Quality of a take, per joint and frame.

    Attributes
    ----------
    names : tuple of str
        The joints of the motion or the points of the tracks.
    parents : tuple of int
        Index of each joint's parent, -1 for the root; empty for tracks.
    n_frames, frame_rate : int, hertz
    jitter : shape (n_joints,), m/s^3
        Mean absolute third difference of the world position; NaN unless four consecutive
        frames are observed.
    signals : tuple of Signal
        Rotation of each joint (except end sites) and position of the root; or position of each
        point. Each signal has its noise, spikes and gaps.
    feet : tuple of FootSlide
        Empty if no feet are found.
    bones : tuple of BoneDrift
        Of tracks only; the bones of a motion cannot stretch.
    limit_excess : shape (n_frames, n_joints), radians, or None
        Angle of each joint beyond its limits, if limits were given.
    cuts : tuple of int
        First frame of each segment of a joined take, except the first segment. Cuts do not
        count as jitter, spikes or foot slide.
    body_held : bool, shape (n_frames,), or None
        True where most of the body repeats the frame before although it moves on; None:
        nowhere.
    path_jumps : tuple of PathJump
        Where the root is put elsewhere and stays.
    joint_jumps : tuple of JointJump
        Where a joint is turned elsewhere and stays.
    bones_searched : bool
        False where tracks have too many points without names of joints to search for bones.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    n_frames: int
    frame_rate: float
    jitter: Array
    signals: tuple[Signal, ...]
    feet: tuple[FootSlide, ...]
    bones: tuple[BoneDrift, ...]
    limit_excess: Array | None = None
    cuts: tuple[int, ...] = ()
    body_held: Flags | None = None
    path_jumps: tuple[PathJump, ...] = ()
    joint_jumps: tuple[JointJump, ...] = ()
    bones_searched: bool = True

    @cached_property
    def spikes(self) -> Flags:
        """True where a joint has a spike, shape (n_frames, n_joints)."""
        return self._by_joint([signal.spikes for signal in self.signals])

    @cached_property
    def gaps(self) -> Flags:
        """True where a joint was not observed or is held, shape (n_frames, n_joints)."""
        return self._by_joint([signal.gaps for signal in self.signals])

    @property
    def mean_jitter(self) -> float:
        """Mean of `jitter` over the joints that have one, m/s^3."""
        observed = self.jitter[np.isfinite(self.jitter)]
        return float(observed.mean()) if len(observed) else float("nan")

    @property
    def foot_slide(self) -> float:
        """Mean horizontal speed of the feet in contact, m/s; NaN where there is no contact."""
        speeds = [foot.speed[np.isfinite(foot.speed)] for foot in self.feet]
        observed = np.concatenate(speeds) if speeds else np.empty(0)
        return float(observed.mean()) if len(observed) else float("nan")

    @property
    def rotation_noise(self) -> float:
        """Mean noise of the joints' rotations, radians; NaN for points, which have none."""
        return _mean_noise(self.signals, is_rotation=True)

    @property
    def position_noise(self) -> float:
        """Mean noise of the points, or that of the root, meters."""
        return _mean_noise(self.signals, is_rotation=False)

    @property
    def longest_foot_slide(self) -> float:
        """Longest displacement of a foot in one contact, meters; NaN without contact."""
        return max((foot.longest for foot in self.feet if foot.contact.any()), default=np.nan)

    def report(self, frames: Sequence[float] | None = None) -> str:
        """Return a table for animators, in degrees and centimeters.

        Parameters
        ----------
        frames : sequence of float, length n_frames
            Numbers of the frames, such as those of a timeline; by default they count from 1.
        """
        return quality_report(self, range(1, self.n_frames + 1) if frames is None else frames)

    def figures(self) -> dict[str, Any]:
        """Return the figures as JSON-ready values; the units are in the names."""
        return quality_figures(self)

    def _by_joint(self, flags: list[Flags]) -> Flags:
        column_of = {name: index for index, name in enumerate(self.names)}
        flags_by_joint = np.zeros((self.n_frames, len(self.names)), dtype=np.bool_)
        for signal, flag in zip(self.signals, flags, strict=True):
            flags_by_joint[:, column_of[signal.joint]] |= flag
        return flags_by_joint


def _mean_noise(signals: tuple[Signal, ...], *, is_rotation: bool) -> float:
    noise = [signal.noise for signal in signals if signal.is_rotation is is_rotation]
    return float(np.mean(noise)) if noise else float("nan")


def measure_quality(
    recording: Motion | Tracks,
    *,
    settings: QualitySettings = QualitySettings(),
    contacts: Flags | None = None,
    humanoid_map: HumanoidMap | None = None,
    limits: JointLimits | None = None,
    progress: Progress = unwatched,
) -> Quality:
    """Measure the quality of a take without changing it.

    The take itself sets the scale of noise and spikes. A robust smooth trajectory is fitted to
    each joint's rotation (or point's position). The fast jitter about it is the noise. A spike
    is a short jump of several times that noise that is also visible to the eye and, in a
    motion, no movement for Clean (`confirm_spikes`). Where the body is put elsewhere in one
    frame, and stays, all else is measured without this jump (`find_path_jumps`).

    Parameters
    ----------
    recording : Motion or Tracks; NaN = not observed
    settings : QualitySettings
    contacts : bool, shape (n_frames, 2), left and right
        When each foot is in contact; detected if not given. Give the same contacts to compare
        the foot slide of a take before and after.
    humanoid_map : HumanoidMap
        Identifies the feet; found by name and structure if not given.
    limits : JointLimits
        Report the joints of a motion that exceed them.
    progress : Progress

    Returns
    -------
    Quality

    Raises
    ------
    InvalidMotionError
        The contacts do not fit the recording.
    SolveCancelled
        Raised by `progress`.
    """
    rule = SpikeRule(
        settings.spike_threshold, settings.min_rotation_jump, settings.min_position_jump
    )
    held = find_held_samples(recording)
    cuts = find_shot_boundaries(hide_held_samples(recording, held))
    path_jumps = find_path_jumps(hide_held_samples(recording, held), cuts)
    if isinstance(recording, Motion) and path_jumps:
        recording = move_root(recording, -path_offsets(path_jumps, recording.n_frames))
    seen = hide_held_samples(recording, held)
    if isinstance(recording, Motion):
        names, poses = recording.skeleton.names, forward_kinematics(recording)
        positions, feet = poses.positions, sole_paths(recording, poses, humanoid_map)
        bones: tuple[BoneDrift, ...] = ()
        parents = tuple(int(parent) for parent in recording.skeleton.parents)
    else:
        names, positions = recording.names, recording.positions
        feet = foot_paths(recording, humanoid_map)
        bones, parents = measure_bone_drifts(recording), ()
    signals = extract_signals(seen, held, rule, within(progress, 0.0, 0.8), cuts)
    joint_jumps: tuple[JointJump, ...] = ()
    if isinstance(seen, Motion):
        signals = confirm_spikes(seen, signals, cuts)
        joint_jumps = find_joint_jumps(seen, signals, cuts)
    quality = Quality(
        names=names,
        parents=parents,
        n_frames=recording.n_frames,
        frame_rate=recording.frame_rate,
        jitter=measure_jitter(positions, recording.frame_rate, cuts),
        signals=signals,
        feet=measure_foot_slides(recording, feet, contacts, humanoid_map, cuts),
        bones=bones,
        limit_excess=_excess(recording, limits, humanoid_map),
        cuts=cuts,
        body_held=body_is_held(recording, held) if held.any() else None,
        path_jumps=path_jumps,
        joint_jumps=joint_jumps,
        bones_searched=isinstance(recording, Motion) or bones_are_searched(recording),
    )
    progress(1.0, "Measured")
    return quality


def measure_at_contacts(
    quality: Quality, recording: Motion | Tracks, contacts: Flags
) -> Quality:
    """Return the quality of a recording with the slide of its feet in other contacts.

    Parameters
    ----------
    quality : Quality
        Result of `measure_quality` for this recording.
    recording : Motion or Tracks
    contacts : bool, shape (n_frames, 2), left and right

    Raises
    ------
    InvalidMotionError
        The contacts do not fit the recording.
    """
    if isinstance(recording, Motion):
        if quality.path_jumps:
            offsets = path_offsets(quality.path_jumps, recording.n_frames)
            recording = move_root(recording, -offsets)
        feet = sole_paths(recording, forward_kinematics(recording))
    else:
        feet = foot_paths(recording)
    slides = measure_foot_slides(recording, feet, contacts, None, quality.cuts)
    return replace(quality, feet=slides)


def _excess(
    recording: Motion | Tracks, limits: JointLimits | None, humanoid_map: HumanoidMap | None
) -> Array | None:
    if limits is None or isinstance(recording, Tracks):
        return None
    return limit_excess(recording, limits, humanoid_map)
