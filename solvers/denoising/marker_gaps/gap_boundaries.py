"""What happens where a gap begins and ends: learned densely, met without a step."""

import numpy as np
from numpy.typing import NDArray

from ...signals import DIFFERENCE_GAIN, DIFFERENCE_ORDER, runs
from .predict_marker import Foretold

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

MOST_ROWS, FEWEST_ROWS = 400, 100
"""Frames learned from, besides those at the borders of gaps."""
MANY_GAPS = 50
"""From so many on, each is learned from fewer frames, so that it does not take for ever."""
LEARN_RATE = 60.0
"""Hertz: bodies move too slowly for more frames a second to tell more."""
BORDER = (1, 2, 3, 5, 8)
"""Frames from a gap that are always learned from."""
BRIDGE = 0.2
"""Seconds over which what was missed at a border is made up for."""
SMALLEST_NOISE = 1e-5
"""Metres."""
MEDIAN_SIZE = 1.538
"""Of vectors whose three coordinates are Gaussian with variance one."""
N_DEPTHS = 5
"""Depths into a gap at which the expected error is told apart."""


def frames_to_learn(
    learned: NDArray[np.intp], seen: Flags, gap: Flags, frame_rate: float, n_gaps: int
) -> NDArray[np.intp]:
    """Thin out the frames to learn from, but not near the gaps."""
    share = min(MANY_GAPS / n_gaps, 1.0) ** 0.5
    n_rows = max(round(MOST_ROWS * share), FEWEST_ROWS)
    step = max(round(frame_rate / LEARN_RATE), -(-len(learned) // n_rows), 1)
    kept = np.zeros(len(seen), dtype=bool)
    kept[learned[::step]] = True
    for start, stop in runs(gap):
        near = np.array(
            [start - away for away in BORDER] + [stop - 1 + away for away in BORDER]
        )
        kept[near[(near >= 0) & (near < len(seen))]] = True
    return np.flatnonzero(kept & seen)


def usual_jitter(course: Array) -> float:
    """Return the standard deviation of a coordinate's noise, the same from whatever side.

    Parameters
    ----------
    course : shape (n_frames, 3), metres
        NaN where not seen.
    """
    sizes = np.linalg.norm(np.diff(course, DIFFERENCE_ORDER, axis=0), axis=1)
    sizes = sizes[np.isfinite(sizes)]
    return float(np.median(sizes)) / (MEDIAN_SIZE * DIFFERENCE_GAIN) if len(sizes) else 0.0


def bridge(
    missed: Array,
    learned: NDArray[np.intp],
    foretold: NDArray[np.intp],
    noise: float,
    frame_rate: float,
) -> Array:
    """Carry on into the gap what was missed around it, shape (n_foretold, 3), metres.

    The misses are taken for a random walk that is drawn back to zero (Ornstein, Uhlenbeck),
    seen with the noise: a smooth process would carry on their slope, which is mere chance.
    """
    near = np.abs(learned[:, None] - foretold[None]).min(axis=1) <= max(BORDER)
    if not near.any():
        return np.zeros((len(foretold), 3))
    at, misses = learned[near], missed[near]
    power = float((misses**2).mean()) + SMALLEST_NOISE**2
    lasts = -1.0 / (frame_rate * BRIDGE)
    among = power * np.exp(np.abs(at[:, None] - at) * lasts)
    among += (noise + SMALLEST_NOISE) ** 2 * np.eye(len(at))
    across = power * np.exp(np.abs(foretold[:, None] - at) * lasts)
    return np.asarray(across @ np.linalg.solve(among, misses))


def expected_error(result: Foretold, gap: Flags) -> Array:
    """Return the usual error of a coordinate in all frames of the gaps, metres."""
    n_frames = len(gap)
    frames = np.arange(n_frames)
    before = np.maximum.accumulate(np.where(gap, -n_frames, frames))
    after = np.minimum.accumulate(np.where(gap, 2 * n_frames, frames)[::-1])[::-1]
    depth = np.minimum(frames - before, after - frames)[gap]
    square = (result.trial**2).mean(axis=1)
    order = np.argsort(result.depth, kind="stable")
    parts = np.array_split(order, min(N_DEPTHS, len(order)))
    errors = [float(np.sqrt(square[part].mean())) for part in parts]
    return np.interp(depth, [float(result.depth[part].mean()) for part in parts], errors)
