"""Solve of the button Record Live: a stream of joints becomes motion of a rig's controls."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from time import monotonic, sleep
from typing import Any, NamedTuple

import numpy as np

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.motion import HumanoidMap, Motion, find_humanoid_map, forward_kinematics
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings.live import Receiver, StreamReader
from ...solvers.retargeting import LiveRetargeting, RetargetSettings
from ...solvers.rotations import IDENTITY
from ...solvers.workflows import LiveMotion, LiveTake, LiveTakeSettings
from ..scene.controls import BoneKeys, Carried, TargetRig, keys_of
from ..track.pose_previews import Show, no_preview

POLL_INTERVAL_S = 0.002
"""Seconds between two looks at the socket. It bounds the delay, and the processor's load."""
MAX_SILENCE_S = 10.0
"""Seconds without data after which a recording of fixed duration ends. It guards scripts."""


@dataclass(frozen=True, eq=False)
class LiveProblem:
    """All that Record Live depends on."""

    port: int
    target: TargetRig
    settings: LiveTakeSettings
    duration_s: float
    """After calibration; 0: until Esc."""


class LiveFrameKeys(NamedTuple):
    """One frame of the rig: its preview, and a part of the recording."""

    frame_rate: float
    frame: int
    keys: Mapping[str, BoneKeys]
    confidence: Mapping[str, float]
    """Of each keyed bone."""


class RecordedTake(NamedTuple):
    """Channels of each bone for all frames."""

    frame_rate: float
    frames: Array
    """Numbers of the frames, shape (n_frames,), from 0."""
    keys: Mapping[str, BoneKeys]
    confidence: Mapping[str, Array]
    remark: str = ""


def record_live(
    problem: LiveProblem, *, progress: Progress = unwatched, show: Show = no_preview
) -> RecordedTake:
    """Receive, reconstruct and retarget frames until the duration is over.

    Raises
    ------
    InvalidMotionError
        No data came, or no body was found in it.
    """
    take, stream = LiveTake(problem.settings), StreamReader()
    shown: list[LiveFrameKeys] = []
    rig: _LiveRig | None = None
    last_data = monotonic()
    with Receiver(problem.port) as receiver:
        while True:
            frames = list(stream.read(*receiver.poll()))
            if not frames:
                _check_silence(problem, last_data)
                progress(*_state(problem, take, len(shown), stream.heard.frames))
                sleep(POLL_INTERVAL_S)
                continue
            last_data = monotonic()
            for motion in take.add(frames):
                if rig is None and take.calibration is not None:
                    rig = _LiveRig(problem.target, take.calibration, take.names)
                if rig is not None:
                    shown.append(rig.keys(motion))
                    show(shown[-1])
            if problem.duration_s and shown and _seconds(shown) >= problem.duration_s:
                return recorded_take(shown, take.n_skipped)


def recorded_take(previews: Iterable[Any], n_skipped: int = 0) -> RecordedTake:
    """Return the recording that these previews are the frames of.

    Raises
    ------
    InvalidMotionError
        There are none.
    """
    frames = list(previews)
    if not frames:
        raise InvalidMotionError(
            "Nothing was recorded: the actor was not measured yet. Start the tracker first."
        )
    first, numbers = frames[0], np.array([each.frame for each in frames], dtype=np.float64)
    remark = f"{n_skipped} frames were skipped, as the solver was busy." if n_skipped else ""
    return RecordedTake(
        first.frame_rate,
        numbers - numbers[0],
        {bone: _joined([each.keys[bone] for each in frames]) for bone in first.keys},
        {
            bone: np.array([each.confidence[bone] for each in frames])
            for bone in first.confidence
        },
        remark,
    )


class _LiveRig:
    """A target that follows an actor, who starts in its origin."""

    def __init__(self, target: TargetRig, calibration: Motion, names: tuple[str, ...]) -> None:
        self._target = target
        self._start = calibration.root_positions[-1] * (1.0, 1.0, 0.0)
        roles = find_humanoid_map(calibration.skeleton)
        self._retargeting = LiveRetargeting(
            _moved(calibration, -self._start),
            roles,
            target.skeleton,
            target.humanoid,
            RetargetSettings(to_ground=True),
        )
        self._sources = _sources(target, roles, names)
        self._still = Carried(IDENTITY[None], np.zeros(3), np.zeros((1, 3)))

    def keys(self, live: LiveMotion) -> LiveFrameKeys:
        posed = self._retargeting.update(_moved(live.motion, -self._start))
        keys = keys_of(self._target, forward_kinematics(posed), self._still)
        confidence = {
            bone: float(live.joints.confidence[joint]) for bone, joint in self._sources.items()
        }
        return LiveFrameKeys(posed.frame_rate, live.frame, keys, confidence)


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


def _moved(motion: Motion, offset: Array) -> Motion:
    return motion.with_poses(motion.rotations, motion.root_positions + offset)


def _joined(channels: list[BoneKeys]) -> BoneKeys:
    """Return the channels of a bone over several frames."""
    rotations = [each.rotations for each in channels if each.rotations is not None]
    locations = [each.locations for each in channels if each.locations is not None]
    return BoneKeys(
        np.concatenate(rotations) if rotations else None,
        np.concatenate(locations) if locations else None,
    )


def _seconds(shown: list[LiveFrameKeys]) -> float:
    return (shown[-1].frame - shown[0].frame + 1) / shown[0].frame_rate


def _check_silence(problem: LiveProblem, last_data: float) -> None:
    if problem.duration_s and monotonic() - last_data > MAX_SILENCE_S:
        raise InvalidMotionError(
            f"No data came on port {problem.port} for {MAX_SILENCE_S:.0f} seconds. Start the"
            " tracker, and check the port."
        )


def _state(
    problem: LiveProblem, take: LiveTake, n_shown: int, n_heard: int
) -> tuple[float, str]:
    """Return fraction and message of the progress."""
    if not n_heard:
        return 0.0, "Waiting for the tracker"
    if take.calibration is None:
        return take.calibrated_fraction, "Measuring the actor: move arms and legs"
    return 1.0, "Recording: Esc ends"
