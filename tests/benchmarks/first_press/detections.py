"""What Clean finds before it estimates anything: samples that repeat earlier ones.

All takes are for development: the rules by which repeats are found were chosen on them.
"""

from collections.abc import Iterable, Iterator

import numpy as np

from solvers.denoising.held_samples import body_is_held, find_held_samples
from solvers.motion import Motion
from solvers.recordings import read_acclaim, read_bvh

from ..shared import clips
from ..shared.tables import table
from .conditions import Case, Condition
from .takes import CORPUS, DEVELOPMENT

LIMBS = {"arm": "arms held 1 s", "leg": "legs held 1 s"}
SIGMA = 0.3
"""Noise of takes with repeats, degrees, as in the conditions of the first press."""
MIN_FRACTION = 0.5
"""Fraction of a limb's repeated samples from which on it counts as found."""


def detections() -> str:
    """Return the table of what is found, and of what is found in takes without anything."""
    rows = {title: _counted(_held_limbs(limb)) for limb, title in LIMBS.items()}
    rows["frames dropped"] = _counted(_dropped_frames())
    rows["clean takes in which nothing is held"] = _counted(
        not find_held_samples(each).any() for each in _clean_takes()
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
