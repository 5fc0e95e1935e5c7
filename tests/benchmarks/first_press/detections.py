"""What Clean finds before it estimates anything: samples that are repeats, and takes baked.

All takes are for development: repeats and rates are found by rules that were chosen on them.
"""

from collections.abc import Iterable, Iterator

import numpy as np

from solvers.arrays import Array
from solvers.denoising.baked_takes import Baking, find_baking
from solvers.denoising.held_samples import body_is_held, find_held_samples
from solvers.motion import Motion
from solvers.recordings import read_acclaim, read_bvh
from solvers.rotations import slerp

from ..shared import clips
from ..shared.tables import table
from .conditions import Case, Condition
from .takes import CORPUS, DEVELOPMENT

LIMBS = {"arm": "arms held 1 s", "leg": "legs held 1 s"}
SIGMA = 0.3
"""Noise of takes with repeats, degrees, as in the conditions of the first press."""
MIN_FRACTION = 0.5
"""Fraction of a limb's repeated samples from which on it counts as found."""
BAKED = {"24 to 30 Hz": (5, 4), "25 to 30 Hz": (6, 5), "30 to 60 Hz": (2, 1)}
"""Frames, and the samples that they were interpolated from."""


def detections() -> str:
    """Return the table of what is found, and of what is found in takes without anything."""
    rows = {title: _counted(_held_limbs(limb)) for limb, title in LIMBS.items()}
    rows["frames dropped"] = _counted(_dropped_frames())
    for title, ratio in BAKED.items():
        rows[f"takes interpolated from {title}"] = _counted(_baked(*ratio))
    clean = list(_clean_takes())
    rows["clean takes in which nothing is held"] = _counted(
        not find_held_samples(each).any() for each in clean
    )
    rows["clean takes that do not count as interpolated"] = _counted(
        find_baking(each) is None for each in clean
    )
    title = "**Found before the estimate, development takes**"
    return f"{title}\n\n{table(['', 'found', 'of'], rows)}\n"


def _counted(found: Iterable[bool]) -> list[str]:
    flags = list(found)
    return [str(sum(flags)), str(len(flags))]


def _held_limbs(limb: str) -> Iterator[bool]:
    condition = Condition(f"{limb} held 1 s", sigma=SIGMA, limb=limb, is_held=True)
    for take in DEVELOPMENT:
        case = Case(take, condition)
        held = find_held_samples(case.recording)[case.missing_frames, case.missing_joints]
        yield bool(held.mean() > MIN_FRACTION)


def _dropped_frames() -> Iterator[bool]:
    condition = Condition("frames dropped", sigma=SIGMA, dropped=0.15)
    for take in DEVELOPMENT:
        recording = Case(take, condition).recording
        repeats = np.all(np.diff(recording.rotations, axis=0) == 0.0, axis=(1, 2))
        yield from body_is_held(recording, find_held_samples(recording))[1:][repeats]


def _baked(n_frames: int, n_samples: int) -> Iterator[bool]:
    for take in DEVELOPMENT:
        motion = Case(take, Condition("baked", sigma=SIGMA)).recording
        rate = motion.frame_rate * n_frames / n_samples
        n_baked = (motion.n_frames - 1) * n_frames // n_samples + 1
        times = Baking(n_frames, n_samples, 0).times(n_baked)
        yield find_baking(_linear(motion, times, rate)) == Baking(n_frames, n_samples, 0)


def _clean_takes() -> Iterator[Motion]:
    """Yield all recordings of development people and of the corpus, also at 30 Hz."""
    paths = [
        *(
            path
            for actor in clips.DEV_ACTORS
            for path in clips.HDM05.glob(f"HDM_{actor}_*.amc")
        ),
        *(path for name in clips.DEV_SUBJECTS for path in clips.WALKS.glob(f"{name}_*.bvh")),
        *CORPUS.glob("*/*.bvh"),
    ]
    for path in sorted(paths):
        motion = read_acclaim(path) if path.suffix == ".amc" else read_bvh(path)
        yield motion
        if (step := round(motion.frame_rate / clips.FRAME_RATE)) > 1:
            yield clips.every(motion, step)


def _linear(motion: Motion, times: Array, rate: float) -> Motion:
    """Interpolate linearly at these times, in frames of the motion."""
    low, high = np.floor(times).astype(int), np.ceil(times).astype(int)
    weight = times - low
    rotations = slerp(motion.rotations[low], motion.rotations[high], weight[:, None])
    roots = motion.root_positions
    positions = roots[low] + weight[:, None] * (roots[high] - roots[low])
    return Motion(motion.skeleton, rotations, positions, rate)
