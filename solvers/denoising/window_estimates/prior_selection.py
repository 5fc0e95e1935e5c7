"""Select the prior of a take: the examples' patterns, smoothness alone, or a mixture."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...progress import Progress
from ..outliers import OFFSET_DEVIATION
from ..window_priors import (
    FilterBases,
    SmoothPrior,
    WindowPrior,
    Windows,
    build_smooth_prior,
    mix_priors,
)
from .estimate_channels import estimate_channels
from .filters import compute_gains
from .mean_pose import estimate_mean_pose
from .rough_take import RoughTake
from .smoothness import build_smooth_kernels

SMOOTH_FRACTIONS = (0.003, 0.05, 0.3)
"""Weights of the smooth prior in its mixtures with the examples' prior. Chosen by hand;
`make sensitivity` varies it."""
N_TRIAL_ITERATIONS = 3
"""Iterations of a trial of each mixture. Half and twice are no better (`make sensitivity`)."""
IN_SAMPLE_PENALTY = 1.007
"""The smooth prior learns from the samples that it predicts, so its error is too small. Each
larger fraction of it multiplies the error by this factor. Chosen by hand; `make sensitivity`
varies it."""
MAX_NOISE_MULTIPLE = 4.0
"""Errors beyond this many standard deviations of the noise all count the same. Chosen by hand;
`make sensitivity` varies it."""
MIN_OBSERVED_FRACTION = 0.5
"""Fraction of a take in which a channel must be observed to score the examples. Chosen by hand;
`make sensitivity` varies it."""
OWN_WEIGHT, OWN_WEIGHT_IN_GAPS = 0.05, 0.2
"""Weight of the take's own covariance relative to the examples', and in windows with gaps.
Chosen by hand; `make sensitivity` varies them."""
WINDOWS_FOR_HALF_WEIGHT = 300
"""Windows of a take at which its own covariance would have half the weight. Half and twice are
no better (`make sensitivity`)."""
MAX_OWN_WEIGHT = 0.3
"""Largest weight of the take's own covariance. It guards long takes, of 130 windows and more,
from repeating their own errors."""
OWN_WEIGHT_WITHOUT_EXAMPLES = 0.5
"""Weight in gaps without examples: a missing limb is best predicted from the same body. Half
and twice are no better (`make sensitivity`)."""


def build_examples_prior(
    bases: FilterBases,
    keys: tuple[str, ...],
    columns: NDArray[np.intp],
    own: Array,
    n_observed: Array,
    n_frames: float,
    noise: Array,
    smooth: SmoothPrior,
) -> WindowPrior:
    """Return the examples' prior of some channels of a take, all of them in the examples.

    Parameters
    ----------
    bases : FilterBases
    keys : tuple of str
        Of the take's parts.
    columns : shape (n_channels,)
        Requested channels of the take; all are among those that move in the bases.
    own : shape (n_channels,)
        Their mean over the frames in which they are observed.
    n_observed : shape (n_channels,)
        Number of these frames, at the frame rate of the bases.
    n_frames : float
        Of the complete take, at that rate.
    noise : shape (n_channels,)
        Standard deviation of the noise of each observation.
    smooth : SmoothPrior
        The prior of the channels without examples: not yet part of the result.
    """
    index_of_key = {str(key): index for index, key in enumerate(bases.keys)}
    moving = {int(channel): index for index, channel in enumerate(bases.moving)}
    indices = [moving[3 * index_of_key[keys[column // 3]] + column % 3] for column in columns]
    window, channels = bases.window, np.arange(len(columns))
    slow, fast = bases.slow[:, indices][:, :, :, indices], bases.fast[:, indices]
    variance = np.einsum("kckc->c", slow) + fast.sum(axis=0)
    mean, mean_variance = estimate_mean_pose(
        bases.clip_means[:, indices], own, n_observed, n_frames, variance / window, noise**2
    )
    slow[0, channels, 0, channels] += window * mean_variance
    mean_adaptation = np.minimum(n_observed / n_frames, 1.0)
    return WindowPrior(
        mean,
        slow,
        fast,
        OWN_WEIGHT,
        OWN_WEIGHT_IN_GAPS,
        mean_adaptation,
        replace(smooth, fraction=0.0),
    )


def build_take_prior(
    rough: Array,
    noise: Array,
    ever_observed: NDArray[np.bool_],
    windows: Windows,
    bases_window: int,
    frame_rate: float,
) -> WindowPrior:
    """Return the prior of a take alone: it moves as much as the take does, and as smoothly.

    Channels that were never observed may be off by as much as outliers. The covariance between
    channels is learned from the take during the solve, with more weight for longer takes.

    Parameters
    ----------
    rough : shape (n_frames, n_channels), without NaN
    noise, ever_observed : shape (n_channels,)
    windows : Windows
    bases_window : int
        Frames of a window at `frame_rate`, hertz: that of the patterns.
    """
    kernels = build_smooth_kernels(bases_window, frame_rate)
    variance = np.maximum(rough.var(axis=0) - noise**2, 0.05 * noise**2 + 1e-6)
    variance = np.where(ever_observed, variance, OFFSET_DEVIATION**2)
    weights = np.repeat(variance[None] / len(kernels), len(kernels), axis=0)
    n_windows = windows.n_frames / windows.length
    own_weight = min(n_windows / (n_windows + WINDOWS_FOR_HALF_WEIGHT), MAX_OWN_WEIGHT)
    return build_smooth_prior(
        np.median(rough, axis=0),
        SmoothPrior(kernels, weights),
        own_weight,
        OWN_WEIGHT_WITHOUT_EXAMPLES,
    )


def select_prior(
    examples: WindowPrior,
    own: WindowPrior,
    take: RoughTake,
    joints: NDArray[np.intp],
    progress: Progress,
) -> tuple[WindowPrior, float]:
    """Return the mixture that predicts the take best, and its fraction of `own`.

    Each candidate adapts to the take in a few rounds. Then every sample is compared with its
    prediction from all others (leave one out). Samples that most candidates classify as
    outliers hardly count; otherwise candidates that follow bursts of errors would win. Examples
    of another movement lose against plain smoothness, and cannot do harm. Only channels that
    are mostly observed take part. Leaving out complete joints measures how well the others
    predict a missing joint.

    Parameters
    ----------
    examples, own : WindowPrior
    take : RoughTake
    joints : shape (n_channels,)
        Of each channel.
    progress : Progress
    """
    candidates = {
        fraction: mix_priors(examples, own, fraction) for fraction in SMOOTH_FRACTIONS
    }
    candidates[1.0] = own
    scored = np.flatnonzero(np.isfinite(take.noisy).mean(axis=0) > MIN_OBSERVED_FRACTION)
    if not len(scored):
        return candidates[SMOOTH_FRACTIONS[0]], SMOOTH_FRACTIONS[0]
    compared = take.select_channels(scored)
    trials = []
    for index, prior in enumerate(candidates.values()):
        progress(0.4 * index / len(candidates), "Comparing with the examples")
        trials.append(
            estimate_channels(
                compared._replace(windows=replace(take.windows, solve_gaps=False)),
                prior.select_channels(scored),
                max_iterations=N_TRIAL_ITERATIONS,
            )
        )
    inlier_probability = np.mean([trial.inliers for trial in trials], axis=0)
    scores = [
        IN_SAMPLE_PENALTY**index
        * score_leave_one_out(trial.leave_one_out_error, inlier_probability, compared.noise)
        for index, trial in enumerate(trials)
    ]
    best = list(candidates)[int(np.argmin(scores))]
    joint_error = score_leave_joint_out(
        candidates[best].select_channels(scored), compared.values, compared.noise,
        joints[scored], take.windows,
    )  # fmt: skip
    return replace(candidates[best], decoupling=float(np.clip(joint_error, 0.0, 1.0))), best


def score_leave_one_out(
    leave_one_out_error: Array, inlier_probability: Array, noise: Array
) -> float:
    """Return the mean squared error of predicting each sample from all others.

    For a linear filter the leave-one-out error is the error of the estimate divided by one
    minus the leverage. It is in units of MAX_NOISE_MULTIPLE times the noise, and never more
    than 1.

    Parameters
    ----------
    leave_one_out_error : shape (n_frames, n_channels)
        NaN where not observed.
    inlier_probability : same shape
        Probability that the sample is no outlier.
    noise : shape (n_channels,)
    """
    squared = np.nan_to_num(
        np.minimum((leave_one_out_error / (MAX_NOISE_MULTIPLE * noise)) ** 2, 1.0)
    )
    return float((inlier_probability * squared).sum() / max(inlier_probability.sum(), 1e-9))


def score_leave_joint_out(
    prior: WindowPrior, rough: Array, noise: Array, joints: NDArray[np.intp], windows: Windows
) -> float:
    """Return the relative squared error of predicting a complete joint from the others.

    It is the residual power over a window, relative to the joint's own: 1 if the joints are
    independent, more if they mislead. In closed form: with K the covariance of the observed
    coefficients y, the error of the coefficients J predicted by all others is (K^-1)_JJ^-1
    (K^-1 y)_J.
    """
    prior = prior.in_windows(windows)
    gains = compute_gains(prior.matrix, prior.fast, noise, windows.density)
    n_slow, n_channels = prior.n_slow, len(prior.mean)
    coefficients = windows.coefficients_from_frames(
        windows.extract(rough - prior.mean, windows.starts)
    )[:, :n_slow]
    coefficients = coefficients / gains.noise
    solved = coefficients.reshape(len(coefficients), -1) @ (
        np.eye(n_slow * n_channels) - gains.slow
    )
    residual_power, joint_power = 0.0, 1e-12
    for joint in np.unique(joints):
        columns = np.flatnonzero(joints == joint)
        indices = (np.arange(n_slow)[:, None] * n_channels + columns).ravel()
        block = -gains.slow[np.ix_(indices, indices)]
        block[np.diag_indices(len(indices))] += 1.0
        error = np.linalg.solve(block, solved[:, indices].T).T.reshape(
            len(coefficients), n_slow, -1
        )
        residual_power += float(((error * gains.noise[columns]) ** 2).sum())
        joint_power += float(((coefficients[:, :, columns] * gains.noise[columns]) ** 2).sum())
    return residual_power / joint_power
