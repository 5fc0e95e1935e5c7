"""Clean sections of a take separately where its noise changes."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..arrays import Array
from ..motion import Motion
from ..progress import Progress, within
from ..rotations import inverse, mean_rotation, multiply, rotation_vector_from_quaternion, slerp
from ..signals import local_median, smoothstep
from .denoised import Denoised, join_segments
from .motion_model import load_motion_mixture, noise_levels
from .observed_samples import observed_mask

MIN_NOISE_DEG = 1.0
"""Noise of a noisy section, degrees. Chosen by hand: below it, noise of another section costs
little, and fast movement is rarely taken for noise."""
MIN_RATIO = 4.0
"""Noise of a noisy section as a ratio to that of a quiet one. Chosen by hand: one step of
`LEVELS_DEG` may be chance."""
MIN_SECTION_S = 0.5
"""Shortest section, seconds. By definition, the length of the windows that noise is estimated
in."""
BLEND_S = 0.2
"""Seconds on each side of a change over which sections blend. Chosen by hand: less than half
of the shortest section."""
N_SMOOTHED = 3
"""Number of windows whose median counts. Chosen by hand: they span one second."""


def find_noise_changes(motion: Motion) -> tuple[int, ...]:
    """Return the frames at which sections begin whose noise differs much, without the first."""
    mean = mean_rotation(motion.rotations)
    vectors = rotation_vector_from_quaternion(multiply(inverse(mean), motion.rotations))
    found = noise_levels(np.degrees(vectors), motion.frame_rate, load_motion_mixture())
    if found is None:
        return ()
    middles, levels = found
    is_known = np.isfinite(levels)
    if not is_known.any():
        return ()
    levels = np.interp(middles, middles[is_known], levels[is_known])
    smooth = local_median(np.log(levels), N_SMOOTHED // 2)
    low, high = smooth.min(), smooth.max()
    if np.exp(high) < MIN_NOISE_DEG or high - low < np.log(MIN_RATIO):
        return ()
    is_noisy = smooth > (low + high) / 2.0
    shortest = round(MIN_SECTION_S * motion.frame_rate)
    changes: list[int] = []
    for window in np.flatnonzero(is_noisy[1:] != is_noisy[:-1]):
        frame = int(middles[window] + middles[window + 1]) // 2
        previous = changes[-1] if changes else 0
        if frame - previous >= shortest and motion.n_frames - frame >= shortest:
            changes.append(frame)
    return tuple(frame for frame in changes if _is_observed(motion, frame))


def clean_sections(
    motion: Motion, clean: Callable[[Motion, Progress], Denoised], progress: Progress
) -> Denoised:
    """Clean a motion, in sections that are blended where its noise changes.

    Noise is estimated once for a section. That of a quiet half would leave all of the noise of
    the other half, and that of a noisy half would take movement out of a quiet one.

    Parameters
    ----------
    motion : Motion
    clean : function
        Of a motion and a progress.
    progress : Progress
    """
    changes = find_noise_changes(motion)
    if not changes:
        return clean(motion, progress)
    n_frames, margin = motion.n_frames, max(round(BLEND_S * motion.frame_rate), 1)
    rotations, positions = motion.rotations.copy(), motion.root_positions.copy()
    results = []
    for start, stop in pairwise((0, *changes, n_frames)):
        first, last = max(start - margin, 0), min(stop + margin, n_frames)
        step = within(progress, start / n_frames, stop / n_frames)
        result = clean(motion.slice(first, last), step)
        cleaned = result.recording
        assert isinstance(cleaned, Motion)
        shared = slice(first, start + margin if start else first)
        weight = smoothstep(np.arange(shared.start, shared.stop) + 0.5, first, shared.stop)
        own = slice(0, shared.stop - first)
        rotations[shared] = _blend(rotations[shared], cleaned.rotations[own], weight)
        gap = cleaned.root_positions[own] - positions[shared]
        positions[shared] += weight[:, None] * gap
        rotations[shared.stop : last] = cleaned.rotations[own.stop :]
        positions[shared.stop : last] = cleaned.root_positions[own.stop :]
        results.append(_crop(result, start - first, stop - first))
    joined = join_segments(motion, results, ())
    sentence = f"The noise changes: {len(results)} sections were cleaned separately."
    complete = motion.with_poses(rotations, positions)
    message = f"{joined.prior_used} {sentence}".strip()
    return replace(joined, recording=complete, prior_used=message)


def _is_observed(motion: Motion, frame: int) -> bool:
    """Return whether all that is ever observed is, where sections blend."""
    margin = round(BLEND_S * motion.frame_rate)
    observed = observed_mask(motion)
    near = observed[max(frame - margin, 0) : frame + margin]
    return bool(near[:, observed.any(axis=0)].all())


def _blend(before: Array, after: Array, weight: Array) -> Array:
    """Return the blend of rotations; equal ones stay as they are, to the last bit."""
    blended = slerp(before, after, weight[:, None])
    return np.where((before == after).all(axis=-1, keepdims=True), before, blended)


def _crop(result: Denoised, start: int, stop: int) -> Denoised:
    return replace(
        result,
        recording=result.recording.slice(start, stop),
        outliers=result.outliers[start:stop],
        held=result.held[start:stop],
        confidence=result.confidence[start:stop],
    )
