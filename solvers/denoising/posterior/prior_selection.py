"""Decide what to expect of a take: the examples' patterns, smoothness alone, or a mixture."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...progress import Progress
from ..prior import FilterBases, Smoothness, WavePrior, mixed, smooth_prior
from .filters import gains_of
from .mean_pose import take_offset
from .posterior import estimate_channels
from .smoothness import smooth_kernels
from .windows import Windows

Array = NDArray[np.float64]

SHARES = (0.003, 0.05, 0.3)
"""Shares of the prior that knows only smoothness, beside the examples'."""
TRIAL_ROUNDS = 3
HANDICAP = 1.007
"""What is learned from the take itself has seen the samples that it foretells, and so looks
better than it is: with each larger share of it by so much."""
FAR = 4.0
"""Errors beyond so many standard deviations of the noise all count the same."""
UNKNOWN = 30.0
"""Standard deviation, degrees or centimetres, of what nothing is known of."""
MOSTLY = 0.5
"""Share of a take in which a channel must be observed to judge of examples."""
BLUR = 0.1
"""Standard deviation, relative to a channel's own, of what no pattern can say of it."""
TRUST_IN_TAKE, TRUST_BESIDE_GAPS = 0.05, 0.2
"""Share of the take's own covariance beside that of examples, and where limbs are missing."""
MANY = 300
"""Windows that it takes to learn from a take by itself what goes together in it."""
MOST_TRUST = 0.3
TRUST_IN_GAPS = 0.5
"""The same without examples: a missing limb is best told by the others of this body."""


def examples_prior(
    bases: FilterBases,
    keys: tuple[str, ...],
    columns: NDArray[np.intp],
    own: Array,
    n_seen: Array,
    n_frames: float,
    noise: Array,
    smooth: Smoothness,
) -> WavePrior:
    """Return the examples' prior of some channels of a take, of which all must tell.

    Parameters
    ----------
    bases : FilterBases
    keys : tuple of str
        Of the take's parts.
    columns : shape (n_channels,)
        Channels of the take that are asked for; all are among those that move in the bases.
    own : shape (n_channels,)
        Their mean over the frames in which they are observed.
    n_seen : shape (n_channels,)
        Number of these frames, at the frame rate of the bases.
    n_frames : float
        Of the whole take, at that rate.
    noise : shape (n_channels,)
        Standard deviation of what is added to each observation.
    smooth : Smoothness
        What is known of the channels without examples: no part of the result yet.
    """
    part = {str(key): place for place, key in enumerate(bases.keys)}
    moving = {int(channel): place for place, channel in enumerate(bases.moving)}
    places = [moving[3 * part[keys[column // 3]] + column % 3] for column in columns]
    window, channels = bases.window, np.arange(len(columns))
    slow, fast = bases.slow[:, places][:, :, :, places], bases.fast[:, places]
    variance = np.einsum("kckc->c", slow) + fast.sum(axis=0)
    mean, unsure = take_offset(
        bases.clip_means[:, places], own, n_seen, n_frames, variance / window, noise**2
    )
    slow[0, channels, 0, channels] += window * unsure
    trust, in_gaps = (
        np.full(len(columns), each) for each in (TRUST_IN_TAKE, TRUST_BESIDE_GAPS)
    )
    follows = np.minimum(n_seen / n_frames, 1.0)
    return WavePrior(mean, slow, fast, trust, in_gaps, follows, replace(smooth, share=0.0))


def take_prior(
    rough: Array,
    noise: Array,
    seen: NDArray[np.bool_],
    windows: Windows,
    bases_window: int,
    frame_rate: float,
) -> WavePrior:
    """Return what is expected of a take by itself: to move as much as it does, as smoothly.

    Channels that were never `seen` may be anywhere. What goes together in the take is learned
    from it in the course of the solve, the more so the longer it is.
    """
    kernels = smooth_kernels(bases_window, frame_rate)
    variance = np.maximum(rough.var(axis=0) - noise**2, 0.05 * noise**2 + 1e-6)
    variance = np.where(seen, variance, UNKNOWN**2)
    weights = np.repeat(variance[None] / len(kernels), len(kernels), axis=0)
    n_windows = windows.n_frames / windows.length
    trust = min(n_windows / (n_windows + MANY), MOST_TRUST)
    return smooth_prior(
        np.median(rough, axis=0), Smoothness(kernels, weights), trust, TRUST_IN_GAPS
    )


def choose_prior(
    examples: WavePrior,
    own: WavePrior,
    noisy: Array,
    rough: Array,
    noise: Array,
    joints: NDArray[np.intp],
    windows: Windows,
    progress: Progress,
) -> tuple[WavePrior, float]:
    """Return the mixture that foretells the take best, and its share of `own`.

    Each candidate adapts to the take in a few rounds; then every sample is compared with what
    all others foretell of it (leave one out). What most of them take for an outlier hardly
    counts, else those that follow bursts of errors would foretell them best. Examples of
    another movement lose against plain smoothness, and cannot do harm. Only channels that are
    mostly observed take part. How far the others can be believed about a lost joint is judged
    by whole `joints`.
    """
    candidates = {share: mixed(examples, own, share) for share in SHARES}
    candidates[1.0] = own
    judges = np.flatnonzero(np.isfinite(noisy).mean(axis=0) > MOSTLY)
    if not len(judges):
        return candidates[SHARES[0]], SHARES[0]
    part = (noisy[:, judges], rough[:, judges], noise[judges])
    without_gaps = replace(windows, solve_gaps=False)
    trials = []
    for index, prior in enumerate(candidates.values()):
        progress(0.4 * index / len(candidates), "Comparing with the examples")
        trials.append(
            estimate_channels(
                *part, prior.of_channels(judges), without_gaps, at_most=TRIAL_ROUNDS
            )
        )
    inside = np.mean([trial.inliers for trial in trials], axis=0)
    foresights = [
        HANDICAP**index * foresight(trial.surprise, inside, part[2])
        for index, trial in enumerate(trials)
    ]
    best = list(candidates)[int(np.argmin(foresights))]
    unforetold = joint_foresight(
        candidates[best].of_channels(judges), *part[1:], joints[judges], windows
    )
    return replace(candidates[best], caution=float(np.clip(unforetold, 0.0, 1.0))), best


def foresight(surprise: Array, inside: Array, noise: Array) -> float:
    """Return how badly samples are foretold by all others: their mean square.

    For a linear filter the error of what all others foretell is that of the estimate divided by
    one less the leverage. In units of FAR times the noise, and never more than 1.

    Parameters
    ----------
    surprise : shape (n_frames, n_channels)
        Error of what all others foretell; NaN where not observed.
    inside : same shape
        Probability that the sample is no outlier.
    noise : shape (n_channels,)
    """
    square = np.nan_to_num(np.minimum((surprise / (FAR * noise)) ** 2, 1.0))
    return float((inside * square).sum() / max(inside.sum(), 1e-9))


def joint_foresight(
    prior: WavePrior, rough: Array, noise: Array, joints: NDArray[np.intp], windows: Windows
) -> float:
    """Return how badly the other joints foretell a whole joint over a window.

    The mean square of what they leave over, relative to the joint's own; 1 where they know
    nothing of each other, more where they mislead. In closed form: with K the covariance of the
    observed waves y, the error of the waves J told by all others is (K^-1)_JJ^-1 (K^-1 y)_J.
    """
    prior = prior.at_most(windows.length)
    power = np.einsum("kckc->c", prior.slow) * windows.density / windows.length
    blurred = np.sqrt(noise**2 + BLUR**2 * power)
    gains = gains_of(prior.matrix, prior.fast, blurred, windows.density)
    n_slow, n_channels = prior.n_slow, len(prior.mean)
    waves = windows.waves_of(windows.cut(rough - prior.mean, windows.starts))[:, :n_slow]
    waves = waves / gains.noise
    solved = waves.reshape(len(waves), -1) @ (np.eye(n_slow * n_channels) - gains.slow)
    missed, whole = 0.0, 1e-12
    for joint in np.unique(joints):
        (part,) = np.nonzero(joints == joint)
        places = (np.arange(n_slow)[:, None] * n_channels + part).ravel()
        inside = -gains.slow[np.ix_(places, places)]
        inside[np.diag_indices(len(places))] += 1.0
        error = np.linalg.solve(inside, solved[:, places].T).T.reshape(len(waves), n_slow, -1)
        missed += float(((error * gains.noise[part]) ** 2).sum())
        whole += float(((waves[:, :, part] * gains.noise[part]) ** 2).sum())
    return missed / whole
