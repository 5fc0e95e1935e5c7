"""Examples to vary: real clips of one behavior of one actor each."""

import itertools
from collections.abc import Iterator

import numpy as np
from scipy.signal import find_peaks

from solvers.motion import Motion, forward_kinematics
from solvers.recordings import read_acclaim
from solvers.variation.align_examples import positions_in_body_frame

from ..shared import clips

CLASSES = {
    "hop": "hopBothLegs1hops",
    "squat": "squat1Reps",
    "jog": "jogLeftCircle4StepsRstart",
    "kick": "kickLFront1Reps",
}
MAX_CLIPS = 12
CYCLE = 0.8
"""Seconds that a cycle of walking lasts at least."""


def development_sets() -> dict[str, list[Motion]]:
    """Sets on which settings are chosen: squats and hops of the held-out actor."""
    return {f"{name} bd": hdm05(name, "bd") for name in ("squat", "hop")}


def scored_sets() -> dict[str, list[Motion]]:
    """Sets whose figures are published."""
    found = {
        f"{name} {actor}": hdm05(name, actor) for name in CLASSES for actor in ("bk", "dg")
    }
    found["walk 35"] = walking_cycles("35")
    for side, spans in HOPS.items():
        found[f"hop on the {side} leg 49"] = single_hops(spans)
    found["jumping jack 13"] = jumping_jacks()
    return found


def hdm05(name: str, actor: str) -> list[Motion]:
    """Return clips of an actor, 120 Hz."""
    paths = sorted(clips.HDM05.glob(f"HDM_{actor}_{CLASSES[name]}_*_120.amc"))
    return [read_acclaim(path) for path in paths[:MAX_CLIPS]]


def walking_cycles(subject: str) -> list[Motion]:
    """Return one cycle of each walk, from the left foot in front to that again."""
    found = []
    for path in sorted(clips.WALKS.glob(f"{subject}_*.bvh")):
        motion = clips.read_cmu(path, 1)
        body, names = positions_in_body_frame(motion), motion.skeleton.names
        separation = body[:, names.index("RightFoot"), 1] - body[:, names.index("LeftFoot"), 1]
        peaks, _ = find_peaks(separation, distance=round(CYCLE * motion.frame_rate), height=0.2)
        if len(peaks) > 2:
            found.append(motion.slice(int(peaks[0]), int(peaks[1]) + 1))
    return found[:MAX_CLIPS]


HOPS = {
    "left": (("49_02", 8.0, 12.0), ("49_03", 4.0, 5.5)),
    "right": (("49_02", 12.5, 15.5), ("49_03", 6.0, 7.5)),
}


def single_hops(spans: tuple[tuple[str, float, float], ...]) -> list[Motion]:
    """Return hops of subject 49, each from one low point of the hips to the next."""
    found: list[Motion] = []
    for name, start, stop in spans:
        motion = clips.read_cmu(clips.HOPS / f"{name}.bvh", 1)
        found += _between_lows(motion.slice(round(start * 120), round(stop * 120)))
    return found


def jumping_jacks() -> list[Motion]:
    """Return jumping jacks of subject 13, each from arms down to arms down."""
    asf, found = clips.HDM05.parent / "05.asf", []
    for name, stop in (("13_29", 3.9), ("13_30", 1.8)):
        path = clips.HDM05.parent / "cmu_jumping_jack" / f"{name}.amc"
        motion = read_acclaim(path, asf).slice(0, round(stop * 120))
        hand = motion.skeleton.names.index("lhand")
        found += list(_cut(motion, -forward_kinematics(motion).positions[:, hand, 2], 0.6))
    return found


def _between_lows(motion: Motion) -> list[Motion]:
    return list(_cut(motion, -motion.root_positions[:, 2], 0.3))


def _cut(motion: Motion, highs: np.ndarray, least: float) -> Iterator[Motion]:
    width = round(least * motion.frame_rate)
    peaks, _ = find_peaks(highs, distance=width, prominence=0.25 * np.ptp(highs))
    for start, stop in itertools.pairwise(peaks):
        yield motion.slice(int(start), int(stop) + 1)
