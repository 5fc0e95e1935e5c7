"""Find out whether a take was recorded at a lower rate and interpolated linearly."""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...arrays import Array, Integers
from ...motion import Motion, Tracks
from ..held_samples import part_trajectories

RATIOS = (
    (5, 1), (4, 1), (3, 1), (5, 2), (12, 5), (2, 1), (5, 3), (3, 2), (4, 3), (5, 4), (6, 5),
)  # fmt: skip
"""Frames of the take, and samples that were recorded in the same time; the lowest rates first.
By definition: the ratios of 24, 25, 30, 50, 60, 90 and 120 Hz up to five."""
BLOCK_FRAMES = 30
"""Smallest number of frames that are explained at a time. It bounds the run time."""
MAX_SCANNED_BLOCKS = 24
"""Blocks of a take in which each ratio is tried. It bounds the run time."""
MIN_CHANGE_RAD = 2e-4
"""Change of the step from frame to frame, radians, below which a part says nothing. It guards
still joints, whose changes are the rounding of a file
(`test_rounding_of_still_joints_is_no_baking`)."""
MAX_RESIDUAL = 0.15
"""What the straight lines leave, as a ratio to the change of the step. Chosen by hand: the
development takes of the first press, baked from 24, 25 and 30 Hz by slerp or by Euler angles,
have up to 0.08."""
MAX_RATIO, MAX_PART_RATIO = 0.35, 0.7
"""The same, as a ratio to lines whose corners are at other times: of the body, and of each part
and time. They guard smooth movement, which lines of any phase explain
(`test_smooth_movement_is_not_baked`), and parts with a higher rate
(`test_fingers_of_a_faster_glove_are_kept`). Chosen by hand: the same takes have up to 0.35 and
0.7, and 1 as recorded."""


class Baking(NamedTuple):
    """Frame i shows the movement at sample (i n_samples + phase) / n_frames."""

    n_frames: int
    n_samples: int
    phase: int

    def times(self, n_frames: int) -> Array:
        """Return the times of the frames of a take, in samples."""
        times: Array = (np.arange(n_frames) * self.n_samples + self.phase) / self.n_frames
        return times

    def neighbors(self, n_frames: int) -> tuple[Integers, Integers, Array]:
        """Return the samples before and after each frame, and the weight of the second."""
        times = self.times(n_frames)
        low = np.floor(times).astype(np.intp)
        return low, np.ceil(times).astype(np.intp), times - low

    def weights(self, n_frames: int) -> Array:
        """Return the weight of each sample in each frame, shape (n_frames, n_samples)."""
        times = self.times(n_frames)
        samples = np.arange(int(np.ceil(times[-1])) + 1)
        return np.asarray(np.maximum(1.0 - np.abs(times[:, None] - samples), 0.0))


def find_baking(recording: Motion | Tracks) -> Baking | None:
    """Return how the recording was interpolated, or None if each frame was recorded.

    Between two recorded samples all frames lie on a straight line. Lines with corners at these
    samples then leave much less of the take than lines with corners at other times, in each
    part of the body and throughout the take.
    """
    curves = part_trajectories(recording)
    for n_frames, n_samples in RATIOS:
        candidates = [Baking(n_frames, n_samples, phase) for phase in range(n_frames)]
        residuals = [
            _median(_residuals(curves, each, MAX_SCANNED_BLOCKS)) for each in candidates
        ]
        least, second = sorted(residuals)[:2]
        if least < min(MAX_RESIDUAL, MAX_RATIO * second):
            best = candidates.pop(residuals.index(least))
            if _explains(curves, best, candidates):
                return best
    return None


def _explains(curves: Array, baking: Baking, others: Sequence[Baking]) -> bool:
    """Return whether these lines leave little of each part, and of the body at all times.

    Or much less than other lines do: a part that turns far between two recorded samples is not
    on a straight line where its Euler angles were interpolated.
    """
    left = _residuals(curves, baking)
    least = np.min([_residuals(curves, each) for each in others], axis=0)
    return all(
        _median(own) < max(MAX_RESIDUAL, MAX_PART_RATIO * _median(other))
        for own, other in (*zip(left, least, strict=True), *zip(left.T, least.T, strict=True))
        if np.isfinite(own).any()
    )


def _median(residuals: Array) -> float:
    """Return the median of all parts that move; infinity if none does."""
    known = np.isfinite(residuals)
    return float(np.median(residuals[known])) if known.any() else np.inf


def _residuals(curves: Array, baking: Baking, max_blocks: int | None = None) -> Array:
    """Return what the lines leave of each block and part, a ratio to the change of the step.

    NaN where a part is missing, or hardly moves. Shape (n_blocks, n_parts).
    """
    step = -(-BLOCK_FRAMES // baking.n_frames) * baking.n_frames
    length = step + 1
    last = (len(curves) - length) // baking.n_frames * baking.n_frames
    starts = np.append(np.arange(0, last, step), last) if last >= 0 else np.array([], int)
    if max_blocks is not None and len(starts) > max_blocks:
        starts = starts[np.linspace(0, len(starts) - 1, max_blocks).astype(int)]
    fit, freedom = _projection(baking, length)
    residuals = np.full((len(starts), curves.shape[1]), np.nan)
    for index, start in enumerate(starts):
        block = curves[start : start + length]
        changes = np.square(np.diff(block, n=2, axis=0)).sum(axis=2).mean(axis=0)
        with np.errstate(invalid="ignore"):
            informs = changes > MIN_CHANGE_RAD**2
        block = block[:, informs]
        if block.size:
            fitted = np.tensordot(fit, block, 1)
            left = np.square(block - fitted).sum(axis=(0, 2)) / freedom
            residuals[index, informs] = np.sqrt(left / changes[informs])
    return residuals


@lru_cache(maxsize=128)
def _projection(baking: Baking, length: int) -> tuple[Array, int]:
    """Return the matrix of the least-squares fit of lines, and its degrees of freedom left."""
    weights = baking.weights(length)
    basis, sizes, _ = np.linalg.svd(weights, full_matrices=False)
    basis = basis[:, sizes > 1e-9 * sizes[0]]
    return basis @ basis.T, length - basis.shape[1]
