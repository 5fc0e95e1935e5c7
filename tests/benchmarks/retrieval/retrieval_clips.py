"""Clips of known classes for the benchmark of retrieval, and what is done to queries.

Settings are chosen with queries of TRAINING classes and EXERCISES only, in a library of those
alone. Figures are published of queries of the other classes, in a library of all.
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from solvers.motion import JointRecording, Motion, Tracks
from solvers.motion.humanoid.posture_joints import (
    POSTURE_JOINTS,
    posture_positions,
    postures_from_motion,
)
from solvers.recordings import read_acclaim, read_recording

from ..shared import clips

RATE_HZ = 120.0
WALK = 2.5
"""Seconds used of each CMU walk, from its middle: about as long as other clips."""
TRAINING = frozenset({
    "depositFloorR", "hopBothLegs1hops", "lieDownFloor", "squat1Reps", "walk", "run",
})  # fmt: skip
"""Every third class of HDM05 by the alphabet, and CMU's walks and runs."""
RUNS = frozenset(f"35_{number}" for number in range(17, 27))
"""Among CMU's walks: they go at 3.1 to 3.5 m/s, the others at 0.4 to 1.9."""
MISFILED = frozenset({"kickLFront1Reps bk 007", "kickLFront1Reps bk 008"})
"""Kicks to the side (the foot is 0.8 m to the left and 0.3 m ahead) that HDM05 has among those
to the front."""
KINECT_FOLDER = clips.DATA / "kinect"
EXERCISES = tuple(f"m{number:02}" for number in range(2, 11))
"""Of UI-PRMD, classes to choose settings on besides: with five classes alone the best
dictionaries are too small for more. Two takes of each person; the first exercise, a squat, is
kept for queries."""
HOPS = {
    "hopLeftLeg": {"49_02": (8.0, 12.0), "49_03": (4.0, 5.5)},
    "hopRightLeg": {"49_02": (12.5, 15.5), "49_03": (6.0, 7.5)},
}
HOP = 1.3
"""Seconds of one clip of hops."""
JACKS = {"13_29": 3.9, "13_30": 1.8}
JACK = 1.3


@dataclass(frozen=True, eq=False)
class LabeledClip:
    """One clip of the library: the twenty joints of postures in the world at 120 Hz."""

    name: str
    label: str
    actor: str
    tracks: Tracks


@cache
def library() -> tuple[LabeledClip, ...]:
    """All clips: HDM05, and CMU's walks, hops and jumping jacks."""
    return (*_hdm05(), *_walks(), *_hops(), *_jacks())


@cache
def training_library() -> tuple[LabeledClip, ...]:
    """The clips that settings may be chosen on."""
    return (*(clip for clip in library() if clip.label in TRAINING), *_exercises())


def _exercises() -> list[LabeledClip]:
    found = []
    for exercise in EXERCISES:
        for path in sorted((KINECT_FOLDER / "ui_prmd").glob(f"{exercise}_s*_e0[37].npz")):
            actor = path.stem.split("_")[1]
            found.append(LabeledClip(path.stem, exercise, actor, sensor_tracks(path)))
    return found


def _hdm05() -> list[LabeledClip]:
    found = []
    for path in sorted(clips.HDM05.glob("HDM_*_120.amc")):
        _, actor, label, number, _ = path.stem.split("_")
        found.append(_clip(f"{label} {actor} {number}", label, actor, read_acclaim(path)))
    return found


def _walks() -> list[LabeledClip]:
    found = []
    for path in sorted(clips.WALKS.glob("*.bvh")):
        motion = clips.read_cmu(path, step=1)
        length = min(motion.n_frames, round(WALK * RATE_HZ))
        start = (motion.n_frames - length) // 2
        cut = motion.slice(start, start + length)
        label = "run" if path.stem in RUNS else "walk"
        found.append(_clip(f"{label} {path.stem}", label, path.stem[:2], cut))
    return found


def _hops() -> list[LabeledClip]:
    takes = {
        name: clips.read_cmu(clips.HOPS / f"{name}.bvh", step=1) for name in ("49_02", "49_03")
    }
    return [
        _clip(f"{label} {name} {start:.1f}", label, "49", _cut(takes[name], start, HOP))
        for label, intervals in HOPS.items()
        for name, (first, last) in intervals.items()
        for start in np.arange(first, last - HOP + 1e-6, HOP)
    ]


def _jacks() -> list[LabeledClip]:
    found = []
    for name, last in JACKS.items():
        path = clips.DATA / "mocap" / "cmu_jumping_jack" / f"{name}.amc"
        motion = read_acclaim(path, clips.DATA / "mocap" / "05.asf")
        for start in np.arange(0.0, last - JACK + 1e-6, JACK):
            cut = _cut(motion, start, JACK)
            found.append(_clip(f"jumpingJack {name} {start:.1f}", "jumpingJack", "13", cut))
    return found


def _cut(motion: Motion, start: float, seconds: float) -> Motion:
    first = round(start * RATE_HZ)
    return motion.slice(first, first + round(seconds * RATE_HZ))


def _clip(name: str, label: str, actor: str, motion: Motion) -> LabeledClip:
    tracks = Tracks(POSTURE_JOINTS, postures_from_motion(motion), motion.frame_rate)
    return LabeledClip(name, label, actor, tracks)


def sensor_tracks(path: Path) -> Tracks:
    """Return the joints of postures in what a Kinect saw."""
    recording = read_recording(path)
    assert isinstance(recording, JointRecording)
    postures = posture_positions(recording)
    return Tracks(POSTURE_JOINTS, postures, recording.tracks.frame_rate)
