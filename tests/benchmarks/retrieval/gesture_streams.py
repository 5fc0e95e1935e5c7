"""Streams of people who make gestures, and of people who exercise and mean none."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.io import loadmat

from solvers.arrays import Array
from solvers.gestures.events import Gesture, GestureEvent
from solvers.gestures.recognition import recognize_gestures
from solvers.gestures.settings import GestureSettings
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS
from solvers.recordings import read_joints
from solvers.recordings.streams import frames_from_recording
from solvers.workflows.live.live_session import pose_from_frame

from ..shared.clips import DATA

KINECT, UTD = DATA / "kinect", DATA / "depth" / "utd_mhad"
ARM, LEG = ("UpperArm", "LowerArm", "Hand", "HandEnd"), ("UpperLeg", "LowerLeg", "Foot", "Toes")
LIMBS = [(side, limb) for limb in (ARM, LEG) for side in ("left", "right")]
UTD_ORDER = ["head", "chest", "spine", "hips"]
UTD_ORDER += [side + part for side, limb in LIMBS for part in limb]
ALWAYS = GestureSettings(waves_need_hand_up=False)
ONE_GRIP = 1.0
"""Seconds without zoom or rotation, after which a new gesture starts."""
RIGHT_WRIST, LEFT_WRIST, HEAD = 10, 6, 3
TOUCH, WAVE_SPEED = 0.2, 1.5
"""Meters, and meters per second, of the simple thresholds."""
MOVES = {Gesture.ZOOM, Gesture.TURN}


@dataclass(frozen=True, eq=False)
class Stream:
    """Postures over time, as `recognize_gestures` takes them."""

    times: Array
    positions: Array
    confidence: Array

    @property
    def minutes(self) -> float:
        """How long it is."""
        return float(self.times[-1] - self.times[0]) / 60.0


def read_stream(paths: Sequence[Path]) -> Stream:
    """Read recordings, one after the other, as one stream."""
    start, parts = 0.0, []
    for path in paths:
        recording = read_joints(path)
        postures = [pose_from_frame(frame) for frame in frames_from_recording(recording)]
        positions, confidence = (np.stack(each) for each in zip(*postures, strict=True))
        times = start + np.arange(len(positions)) / recording.frame_rate
        start = float(times[-1]) + 1.0 / recording.frame_rate
        parts.append((times, positions, confidence))
    return Stream(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def read_utd(path: Path) -> Stream:
    """Read a skeleton of UTD-MHAD: mirrored, in camera space, y up, at 30 Hz."""
    x, y, z = np.moveaxis(loadmat(path)["d_skel"].transpose(2, 0, 1), -1, 0)
    given = np.stack([-x, z, y], axis=-1)
    positions = given[:, [UTD_ORDER.index(role) for role in POSTURE_JOINTS]]
    return Stream(np.arange(len(positions)) / 30.0, positions, np.ones(positions.shape[:2]))


def ours(stream: Stream, settings: GestureSettings) -> tuple[GestureEvent, ...]:
    """Return what our recognizer detects."""
    return recognize_gestures(stream.times, stream.positions, stream.confidence, settings)


def thresholds(stream: Stream, settings: GestureSettings) -> tuple[GestureEvent, ...]:
    """Return the gestures by simple thresholds on positions and speeds of wrists, in meters.

    A wrist above the head is a hand up, wrists that come nearer than 20 cm clap, a wrist that
    moves sideways at 1.5 m/s waves; each at its beginning. Zoom and rotation are left out.
    """
    del settings
    wrist, other = stream.positions[:, RIGHT_WRIST], stream.positions[:, LEFT_WRIST]
    speed = np.gradient(wrist[:, 0], stream.times) if len(wrist) > 1 else np.zeros(len(wrist))
    clap = np.linalg.norm(wrist - other, axis=-1) < TOUCH
    rules = {
        Gesture.HAND_UP: wrist[:, 2] > stream.positions[:, HEAD, 2],
        Gesture.CAPTURE_START: clap,
        Gesture.PAGE_NEXT: speed < -WAVE_SPEED,  # the actor faces the camera
        Gesture.PAGE_BACK: speed > WAVE_SPEED,
    }
    events = [
        GestureEvent(gesture, float(stream.times[frame]), float(stream.times[frame]))
        for gesture, holds in rules.items()
        for frame in np.flatnonzero(holds[1:] & ~holds[:-1]) + 1
    ]
    return tuple(sorted(events, key=lambda event: event.time))


def counted(events: Sequence[GestureEvent]) -> list[Gesture]:
    """Return gestures, where moves of the view that go on count once, as do both claps."""
    found: list[Gesture] = []
    last: dict[Gesture, float] = {}
    for event in events:
        gesture = event.gesture
        goes_on = event.time - last.get(gesture, -np.inf) < ONE_GRIP
        last[gesture] = event.time
        if not (gesture in MOVES and goes_on):
            claps = gesture is Gesture.CAPTURE_END
            found.append(Gesture.CAPTURE_START if claps else gesture)
    return found
