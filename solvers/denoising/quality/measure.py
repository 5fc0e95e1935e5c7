"""Measure what is wrong with a take: jitter, spikes, gaps, sliding feet, stretching bones."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import JointLimits, Motion, Tracks, forward_kinematics
from ...motion.humanoid import HumanoidMap, contacts_of_points, detect_contacts
from ...motion.skeletons import find_cuts
from ...progress import Progress, unwatched, within
from ...settings import Settings, setting
from ..feet import SIDES, foot_joints
from ..limits import limit_excess
from .bone_drift import BoneDrift, bone_drifts
from .figures import quality_figures
from .foot_slide import FootSlide, foot_slide
from .joint_signals import Signal, SpikeRule, signals_of
from .report import quality_report

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class QualitySettings(Settings):
    """What counts as a spike."""

    spike_threshold: float = setting(
        5.0,
        "Jump that counts as a spike, in multiples of the take's noise; higher finds fewer",
        minimum=2.0,
        maximum=50.0,
    )
    smallest_turn: float = setting(
        np.radians(8.0),
        "Ignore rotation jumps below this angle; higher finds fewer spikes",
        unit="rad",
        minimum=0.0,
        maximum=np.pi,
        label="Min Rotation Jump",
    )
    smallest_move: float = setting(
        0.02,
        "Ignore position jumps below this distance; higher finds fewer spikes",
        unit="m",
        minimum=0.0,
        maximum=10.0,
        label="Min Position Jump",
    )


@dataclass(frozen=True, eq=False)
class Quality:
    """What is wrong with a take, per joint and frame.

    Attributes
    ----------
    names : tuple of str
        The joints of the motion or the points of the tracks.
    n_frames, frame_rate : int, hertz
    jitter : shape (n_joints,), m/s^3
        Mean absolute third difference of the position in the world; NaN where no four frames
        in a row are observed.
    signals : tuple of Signal
        Rotation of each joint (end sites have none) and position of the root; or position of
        each point. Noise, spikes and gaps are theirs.
    feet : tuple of FootSlide
        Empty where no feet are known.
    bones : tuple of BoneDrift
        Of tracks; the bones of a motion cannot stretch.
    limit_excess : shape (n_frames, n_joints), radians, or None
        How far each joint is beyond its limits, where limits were given.
    cuts : tuple of int
        First frames of the pieces of which the take was joined, but the first. What happens
        there is no jitter, no spike and no slide of the body.
    """

    names: tuple[str, ...]
    n_frames: int
    frame_rate: float
    jitter: Array
    signals: tuple[Signal, ...]
    feet: tuple[FootSlide, ...]
    bones: tuple[BoneDrift, ...]
    limit_excess: Array | None = None
    cuts: tuple[int, ...] = ()

    @cached_property
    def spikes(self) -> Flags:
        """Where a joint jumps away and back, shape (n_frames, n_joints)."""
        return self._by_joint([signal.spikes for signal in self.signals])

    @cached_property
    def gaps(self) -> Flags:
        """Where a joint was not observed, shape (n_frames, n_joints)."""
        return self._by_joint([signal.gaps for signal in self.signals])

    @property
    def mean_jitter(self) -> float:
        """Mean of `jitter` over the joints that have one, m/s^3."""
        known = self.jitter[np.isfinite(self.jitter)]
        return float(known.mean()) if len(known) else float("nan")

    @property
    def foot_slide(self) -> float:
        """Mean horizontal speed of the feet in contact, m/s; NaN where there is no contact."""
        speeds = [foot.speed[np.isfinite(foot.speed)] for foot in self.feet]
        known = np.concatenate(speeds) if speeds else np.empty(0)
        return float(known.mean()) if len(known) else float("nan")

    def report(self) -> str:
        """Return a table for the animator's eyes, in degrees and centimetres."""
        return quality_report(self)

    def figures(self) -> dict[str, Any]:
        """Return the figures as JSON-ready values; the units are in the names."""
        return quality_figures(self)

    def _by_joint(self, flags: list[Flags]) -> Flags:
        place = {name: index for index, name in enumerate(self.names)}
        found = np.zeros((self.n_frames, len(self.names)), dtype=np.bool_)
        for signal, flag in zip(self.signals, flags, strict=True):
            found[:, place[signal.joint]] |= flag
        return found


def measure_quality(
    recording: Motion | Tracks,
    *,
    settings: QualitySettings = QualitySettings(),
    contacts: Flags | None = None,
    humanoid_map: HumanoidMap | None = None,
    limits: JointLimits | None = None,
    progress: Progress = unwatched,
) -> Quality:
    """Measure what is wrong with a take. Nothing is changed.

    Spikes and noise are judged against the take itself: a robust smooth course is fitted to
    each joint's rotation (or point's position), the fast jitter about it is the noise, and a
    spike is a jump out and back of several times that noise that is also large for an eye.

    Parameters
    ----------
    recording : Motion or Tracks; NaN = not observed
    settings : QualitySettings
    contacts : bool, shape (n_frames, 2), left and right
        When each foot stands; detected where it is not given. Give the same contacts to
        compare the foot slide of a take before and after.
    humanoid_map : HumanoidMap
        Says which joints are feet; found by name and structure where it is not given.
    limits : JointLimits
        Joints of a motion that are beyond them are reported.
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
    rule = SpikeRule(settings.spike_threshold, settings.smallest_turn, settings.smallest_move)
    if isinstance(recording, Motion):
        names, positions = recording.skeleton.names, forward_kinematics(recording).positions
        bones: tuple[BoneDrift, ...] = ()
    else:
        names, positions = recording.names, recording.positions
        bones = bone_drifts(recording)
    cuts = find_cuts(recording)
    quality = Quality(
        names=names,
        n_frames=recording.n_frames,
        frame_rate=recording.frame_rate,
        jitter=mean_jitter(positions, recording.frame_rate, cuts),
        signals=signals_of(recording, rule, within(progress, 0.0, 0.8), cuts),
        feet=_foot_slides(recording, names, positions, contacts, humanoid_map, cuts),
        bones=bones,
        limit_excess=_excess(recording, limits, humanoid_map),
        cuts=cuts,
    )
    progress(1.0, "Measured")
    return quality


def mean_jitter(positions: Array, frame_rate: float, cuts: tuple[int, ...] = ()) -> Array:
    """Return the mean absolute third difference over time, shape (n_joints,), m/s^3.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), metres; NaN is left out
    frame_rate : float, hertz
    cuts : tuple of int
        Frames that have nothing to do with those before; no difference is taken across.
    """
    if len(positions) < 4:
        return np.full(positions.shape[1], np.nan)
    jerk = np.linalg.norm(np.diff(positions, n=3, axis=0), axis=-1) * frame_rate**3
    for cut in cuts:
        jerk[max(cut - 3, 0) : cut] = np.nan
    known = np.isfinite(jerk)
    total = np.where(known, jerk, 0.0).sum(axis=0)
    count = known.sum(axis=0)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _foot_slides(
    recording: Motion | Tracks,
    names: tuple[str, ...],
    positions: Array,
    contacts: Flags | None,
    humanoid_map: HumanoidMap | None,
    cuts: tuple[int, ...],
) -> tuple[FootSlide, ...]:
    if contacts is not None and np.shape(contacts) != (recording.n_frames, len(SIDES)):
        raise InvalidMotionError(
            f"Contacts need shape ({recording.n_frames}, 2), not {np.shape(contacts)}."
        )
    joints = foot_joints(recording, humanoid_map)
    if joints is None:
        return ()
    points = positions[:, joints]
    if contacts is None:
        contacts = (
            detect_contacts(recording, humanoid_map)
            if isinstance(recording, Motion)
            else contacts_of_points(points, recording.frame_rate)
        )
    return tuple(
        foot_slide(
            side,
            names[joints[place, 0]],
            points[:, place],
            contacts[:, place],
            recording.frame_rate,
            cuts,
        )
        for place, side in enumerate(SIDES)
    )


def _excess(
    recording: Motion | Tracks, limits: JointLimits | None, humanoid_map: HumanoidMap | None
) -> Array | None:
    if limits is None or isinstance(recording, Tracks):
        return None
    return limit_excess(recording, limits, humanoid_map)
