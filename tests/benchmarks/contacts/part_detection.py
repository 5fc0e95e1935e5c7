"""Detected contacts against known ones: precision, recall, onsets, and feet without weight."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping

import numpy as np

from solvers.arrays import Flags
from solvers.denoising import denoise
from solvers.motion import Motion, detect_contacts

from ..shared.tables import table
from .calibration import calibration_table
from .detection_scores import COLUMNS, DetectionScores
from .detectors import MOTION_DETECTORS, OURS, POINT_DETECTORS, MotionDetector
from .force_plates import weighed_walks
from .labeled_clips import at_rate, labeled_clips
from .made_drags import made_drags
from .made_takes import made_takes
from .part_takes import INPUTS
from .weightless_feet import weightless_takes

RATES = (30.0, 60.0, 120.0)
"""Hertz."""
MADE_RATE = 60.0
"""Hertz, of the table take by take."""
NOISE_DEG = (0.0, 1.0, 3.0)
CLEANED = f"{OURS}, after Clean"

Scores = Mapping[tuple[float, str], DetectionScores]
"""By frame rate and method."""


def detection_tables() -> list[str]:
    """Return the tables of known and of labeled contacts, and of feet without weight."""
    return [
        *_plate_table(),
        _table("Made takes, whose contacts are known", _made_scores()),
        _take_table(),
        _drag_table(),
        *(_noise_table(degrees) for degrees in NOISE_DEG),
        calibration_table(RATES),
        _weightless_table(),
    ]


def _plate_table() -> Iterable[str]:
    scores: dict[tuple[float, str], DetectionScores] = defaultdict(DetectionScores)
    walks = [walk for rate in RATES for walk in weighed_walks(rate)]
    for walk in walks:
        for name, detect in POINT_DETECTORS.items():
            found = detect(walk.feet, walk.frame_rate, 1.0)
            scores[walk.frame_rate, name].add(found, walk.contacts, walk.frame_rate, walk.known)
    if walks:
        n_steps = scores[RATES[0], OURS].n_onsets
        n_walks = len(walks) // len(RATES)
        yield _table(f"Force plates, {n_steps} steps of {n_walks} walkers, markers", scores)


def _made_scores() -> Scores:
    scores: dict[tuple[float, str], DetectionScores] = defaultdict(DetectionScores)
    for rate in RATES:
        for take in made_takes(rate).values():
            for name, detect in MOTION_DETECTORS.items():
                scores[rate, name].add(detect(take.motion), take.contacts, rate)
    return scores


def _take_table() -> str:
    rows = {}
    for name, take in made_takes(MADE_RATE).items():
        cells = []
        for detect in MOTION_DETECTORS.values():
            one = DetectionScores()
            one.add(detect(take.motion), take.contacts, MADE_RATE)
            cells.append(f"{one.precision():.2f} {one.recall():.2f}")
        rows[name] = cells
    title = f"**Precision and recall of each made take, {MADE_RATE:g} Hz**"
    return f"{title}\n\n{table(['take', *MOTION_DETECTORS], rows)}\n"


def _drag_table() -> str:
    """Return which frames of dragged feet, and of feet that stand, are planted, in percent."""
    detectors = {OURS: MOTION_DETECTORS[OURS], f"{OURS}, contacts alone": detect_contacts}
    rows = {}
    for spoiled, spoil in INPUTS.items():
        for name, take in made_drags(MADE_RATE).items():
            found = [detect(spoil(take.motion)) for detect in detectors.values()]
            rows[f"{name}, {spoiled}"] = [
                f"{100.0 * flags[chosen].mean():.0f}"
                for chosen in (~take.contacts, take.contacts)
                for flags in found
            ]
    heads = [f"{part}: {name}" for part in ("dragged", "standing") for name in detectors]
    title = f"**Dragged feet: frames of a foot that are planted, %, {MADE_RATE:g} Hz**"
    return f"{title}\n\n{table(['take', *heads], rows)}\n"


def _noise_table(degrees: float) -> str:
    scores: dict[tuple[float, str], DetectionScores] = defaultdict(DetectionScores)
    detectors: dict[str, MotionDetector] = dict(MOTION_DETECTORS)
    if degrees:
        detectors[CLEANED] = _after_clean(MOTION_DETECTORS[OURS])
    for rate in RATES:
        for motion, label in labeled_clips().values():
            noisy, truth = at_rate(motion, label, rate, degrees)
            for name, detect in detectors.items():
                scores[rate, name].add(detect(noisy), truth, rate)
    what = f"noise of {degrees:g} deg" if degrees else "as they are"
    return _table(
        f"Captures with labeled contacts, {what}, {len(labeled_clips())} takes", scores
    )


def _after_clean(detect: Callable[[Motion], Flags]) -> MotionDetector:
    def detect_in_cleaned(motion: Motion) -> Flags:
        return detect(denoise(motion).recording)

    return detect_in_cleaned


def _weightless_table() -> str:
    detectors = {OURS: MOTION_DETECTORS[OURS], f"{OURS}, contacts alone": detect_contacts}
    detectors |= {name: one for name, one in MOTION_DETECTORS.items() if name != OURS}
    rows, totals = {}, np.zeros(1 + len(detectors), np.intp)
    for name, take in weightless_takes():
        found = [detect(take.motion)[take.frames] for detect in detectors.values()]
        counts = np.array([found[0].size, *(int(flags.sum()) for flags in found)])
        totals += counts
        rows[name] = [str(count) for count in counts]
    rows["all"] = [str(count) for count in totals]
    title = "**Feet that bear no weight: frames of a foot that are planted, 30 Hz**"
    return f"{title}\n\n{table(['take', 'frames of a foot', *detectors], rows)}\n"


def _table(title: str, scores: Scores) -> str:
    rows = {f"{rate:g} Hz, {name}": one.row() for (rate, name), one in scores.items()}
    return f"**{title}**\n\n{table(['method', *COLUMNS], rows)}\n"
