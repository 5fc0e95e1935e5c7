"""Decide what to expect of a take: the examples' patterns, smoothness alone, or a mixture."""

import numpy as np
from numpy.typing import NDArray

from ..progress import Progress
from .denoise_posterior import estimate_channels
from .denoise_windows import Windows
from .filter_bases import FilterBases
from .offsets import take_offset
from .prior import WavePrior, mixed, smooth_prior

Array = NDArray[np.float64]

SHARES = (0.003, 0.05)
"""Shares of the prior that knows only smoothness, beside the examples'."""
TRIAL_ROUNDS = 3
OWN_HANDICAP = 1.04
"""What is learned from the take itself has seen the samples that it foretells, and so looks
better than it is: by so much on walks, whatever their noise."""
TRUST_IN_TAKE = 0.07
TRUST_WITHOUT_EXAMPLES = 0.05
TRUST_ALONE = 0.3


def examples_prior(
    bases: FilterBases,
    keys: tuple[str, ...],
    columns: NDArray[np.intp],
    own: Array,
    n_seen: Array,
    n_frames: float,
    noise: Array,
) -> WavePrior:
    """Return the examples' prior of some channels of a take; NaN where they tell nothing.

    Parameters
    ----------
    bases : FilterBases
    keys : tuple of str
        Of the take's parts.
    columns : shape (n_channels,)
        Channels of the take that are asked for.
    own : shape (n_channels,)
        Their mean over the frames in which they are observed.
    n_seen : shape (n_channels,)
        Number of these frames, at the frame rate of the bases.
    n_frames : float
        Of the whole take, at that rate.
    noise : shape (n_channels,)
        Standard deviation of what is added to each observation.
    """
    part = {str(key): place for place, key in enumerate(bases.keys)}
    moving = {int(channel): place for place, channel in enumerate(bases.moving)}
    source = [3 * part.get(keys[column // 3], -1) + column % 3 for column in columns]
    places = np.array([moving.get(channel, -1) for channel in source])
    known = np.flatnonzero(places >= 0)
    n_slow, window = len(bases.slow), bases.window
    mean = np.full(len(columns), np.nan)
    clip_means = bases.clip_means[:, places[known]]
    variance = np.einsum("kckc->c", bases.slow) + bases.fast.sum(axis=0)
    mean[known], unsure = take_offset(
        clip_means,
        own[known],
        n_seen[known],
        n_frames,
        variance[places[known]] / window,
        noise[known] ** 2,
    )
    slow = np.full((n_slow, len(columns), n_slow, len(columns)), np.nan)
    inside = bases.slow[:, places[known]][:, :, :, places[known]]
    inside[0, np.arange(len(known)), 0, np.arange(len(known))] += window * unsure
    slow[:, known[:, None], :, known] = inside.transpose(1, 3, 0, 2)
    fast = np.full((window - n_slow, len(columns)), np.nan)
    fast[:, known] = bases.fast[:, places[known]]
    trust = np.full(len(columns), TRUST_IN_TAKE)
    return WavePrior(mean, slow, fast, trust, np.zeros(len(columns)))


def take_prior(rough: Array, noise: Array, window: int, frame_rate: float) -> WavePrior:
    """Return what is expected of a take by itself: to move as much as it does, smoothly."""
    variance = np.maximum(rough.var(axis=0) - noise**2, 0.05 * noise**2 + 1e-6)
    return smooth_prior(
        np.median(rough, axis=0),
        variance,
        window,
        frame_rate,
        TRUST_WITHOUT_EXAMPLES,
        TRUST_ALONE,
    )


def choose_prior(
    examples: WavePrior,
    own: WavePrior,
    noisy: Array,
    rough: Array,
    noise: Array,
    windows: Windows,
    progress: Progress,
) -> tuple[WavePrior, float]:
    """Return the mixture that foretells the take best, and its share of `own`.

    Each candidate adapts to the take in a few rounds; then every sample is compared with what
    all others foretell of it (leave one out). Examples of another movement lose against plain
    smoothness, and cannot do harm.
    """
    known = np.isfinite(examples.mean)
    if not known.any():
        return own, 1.0
    candidates = {share: mixed(examples, own, share) for share in SHARES}
    candidates[1.0] = own
    foresights = {}
    for index, (share, prior) in enumerate(candidates.items()):
        progress(0.4 * index / len(candidates), "Comparing with the examples")
        trial = estimate_channels(noisy, rough, noise, prior, windows, at_most=TRIAL_ROUNDS)
        handicap = 1.0 if share < 1.0 else OWN_HANDICAP
        foresights[share] = handicap * trial.foresight
    best = min(foresights, key=lambda share: foresights[share])
    return candidates[best], best
