"""Apply the default method to a complete take: select channels and prior, solve in groups."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...progress import Progress, within
from ...signals import estimate_noise, fill_channel_gaps, remove_outliers, shrink_noise
from ..averaging import MIN_NOISE
from ..channels import Channels, Estimate
from ..motion_model import MAX_CONSTANT_RANGE
from ..outliers import OFFSET_DEVIATION
from ..window_priors import (
    WHITE,
    FilterBases,
    FilterBasesSettings,
    NoiseSpectrum,
    WindowPrior,
    Windows,
)
from .estimate_channels import estimate_channels
from .prior_selection import build_examples_prior, build_take_prior, select_prior
from .rough_take import RoughTake

MAX_GROUP_CHANNELS = 96
"""Channels solved together; rigs with more are split between joints. It bounds the run time;
`make sensitivity` varies it."""
SPIKE_HALF_WIDTH = 4
"""Frames to either side among which a spike of the first guess is found. Chosen by hand;
`make sensitivity` varies it."""
FIRST_GUESS_EFFICIENCY = 0.2
"""Of the median of overlapping differences, relative to a standard deviation. Half and twice
gain less than 1 % (`make sensitivity`)."""
POOR_FIT_FRACTION = 0.2
"""Fraction of plain smoothness above which the examples are reported to fit badly. By
definition of the report: it only decides its sentence."""
PARTS = ("values", "inliers", "deviation", "leave_one_out_error")


def estimate_in_groups(
    channels: Channels,
    is_error: NDArray[np.bool_],
    frame_rate: float,
    bases: FilterBases | None,
    progress: Progress,
    noise_spectrum: NoiseSpectrum = WHITE,
    measured: NDArray[np.bool_] | None = None,
) -> tuple[Estimate, str]:
    """Estimate all channels; return them with a sentence on the prior.

    Samples known to be errors, shape (n_frames, n_channels), are outliers from the start. The
    noise has this spectrum; if it is not white, the take must be complete and at least as long
    as a window. Its size is measured by the samples that are `measured`, of the same shape, or
    else by all that are observed.
    """
    n_frames, n_channels = channels.flat.shape
    window, pattern_rate = _window_of(bases)
    length = window_length(bases, frame_rate)
    windows = Windows(
        max(n_frames, length), length, length / window, noise_spectrum=noise_spectrum
    )
    take = _estimate_roughly(channels.flat, is_error, windows, measured)
    is_unknown = np.isnan(take.noisy) & (take.n_observed == 0)
    parts = (
        take.values.copy(),
        np.isfinite(take.noisy).astype(float),
        np.where(is_unknown, OFFSET_DEVIATION, 0.0),
        np.full_like(take.noisy, np.nan),
    )
    in_examples = _find_example_channels(channels, bases)
    groups = group_channels(channels.flat, take.values, in_examples)
    iterations, converged, smooth_fractions = 0, True, []
    for index, columns in enumerate(groups):
        step = within(progress, index / len(groups), (index + 1) / len(groups))
        part = take.select_channels(columns)
        first_noise = shrink_noise(part.noise, part.n_observed, FIRST_GUESS_EFFICIENCY)
        part = part._replace(noise=first_noise)
        prior = build_take_prior(
            part.values, first_noise, part.n_observed > 0, part.windows, window, pattern_rate
        )
        if bases is not None and in_examples[columns[0]]:
            examples = _build_examples_prior(
                part, n_frames, bases, channels.keys, columns, prior
            )
            prior, smooth_fraction = select_prior(examples, prior, part, columns // 3, step)
            smooth_fractions += [smooth_fraction] * len(columns)
        group_estimate = estimate_channels(part, prior, within(step, 0.4, 1.0))
        for complete, name in zip(parts, PARTS, strict=True):
            complete[:, columns] = getattr(group_estimate, name)
        iterations = max(iterations, group_estimate.iterations)
        converged &= group_estimate.converged
    values, inliers, deviation, leave_one_out = (part[:n_frames] for part in parts)
    estimate = Estimate(values, inliers, deviation, leave_one_out, iterations, converged)
    return estimate, _describe_prior(bases, smooth_fractions, n_channels)


def window_length(bases: FilterBases | None, frame_rate: float) -> int:
    """Return the number of frames of a window of a take."""
    window, pattern_rate = _window_of(bases)
    return max(round(window * frame_rate / pattern_rate), 2)


def _window_of(bases: FilterBases | None) -> tuple[int, float]:
    """Return the number of frames of a window of patterns, and their frame rate."""
    if bases is None:
        return FilterBasesSettings().n_frames, FilterBasesSettings().frame_rate
    return bases.window, float(bases.frame_rate)


def _build_examples_prior(
    part: RoughTake,
    n_frames: int,
    bases: FilterBases,
    keys: tuple[str, ...],
    columns: NDArray[np.intp],
    prior: WindowPrior,
) -> WindowPrior:
    """Return the examples' prior of some channels of a rough take."""
    observed, density = np.isfinite(part.noisy[:n_frames]), part.windows.density
    observed_counts = observed.sum(axis=0)
    own = np.where(observed, part.values[:n_frames], 0.0).sum(axis=0) / np.maximum(
        observed_counts, 1
    )
    # Spikes that remain in the rough values show in their steps, though not in the noise.
    steps = np.diff(part.values[:n_frames], axis=0, prepend=part.values[:1])
    spiky_noise = np.maximum(part.noise, np.sqrt((steps**2).mean(axis=0) / 2.0))
    return build_examples_prior(
        bases, keys, columns, own, observed_counts / density, n_frames / density,
        spiky_noise / np.sqrt(density), prior.smooth,
    )  # fmt: skip


def _estimate_roughly(
    noisy: Array,
    is_error: NDArray[np.bool_],
    windows: Windows,
    measured: NDArray[np.bool_] | None,
) -> RoughTake:
    padded = np.full((windows.n_frames, noisy.shape[1]), np.nan)
    padded[: len(noisy)] = noisy
    padded_errors = np.zeros(padded.shape, dtype=np.bool_)
    padded_errors[: len(noisy)] = is_error
    despiked = np.where(padded_errors, np.nan, padded)
    despiked = remove_outliers(despiked, SPIKE_HALF_WIDTH)
    samples = despiked if measured is None else np.where(measured, despiked, np.nan)
    ratio = windows.noise_spectrum.deviation_ratio(windows.length)
    noise = np.maximum(ratio * estimate_noise(samples), MIN_NOISE)
    return RoughTake(
        padded,
        padded_errors,
        fill_channel_gaps(despiked),
        noise,
        np.isfinite(samples).sum(axis=0),
        windows,
    )


def _find_example_channels(channels: Channels, bases: FilterBases | None) -> NDArray[np.bool_]:
    """Return which channels the examples contain."""
    moving = set()
    if bases is not None:
        moving = {(str(bases.keys[channel // 3]), channel % 3) for channel in bases.moving}
    return np.array(
        [(key, axis) in moving for key in channels.keys for axis in range(3)], dtype=bool
    )


def group_channels(
    noisy: Array, rough: Array, in_examples: NDArray[np.bool_]
) -> list[NDArray[np.intp]]:
    """Return the columns of each group of moving channels: those of the examples first.

    The channels of a joint stay together, except those that the examples lack. `noisy` and
    `rough` have the shape (n_frames, n_channels).
    """
    missing = np.isnan(noisy)
    moves = (np.ptp(rough, axis=0) > MAX_CONSTANT_RANGE) | missing.all(axis=0)
    moves |= in_examples & missing.any(axis=0)
    groups = []
    for kind in (moves & in_examples, moves & ~in_examples):
        columns = np.flatnonzero(kind)
        if not len(columns):
            continue
        starts = np.append(np.unique(columns // 3, return_index=True)[1], len(columns))
        n_groups = -(-len(columns) // (MAX_GROUP_CHANNELS - 2))
        even = np.arange(1, n_groups) * len(columns) / n_groups
        nearest = np.abs(starts[:, None] - even).argmin(axis=0)
        groups += np.split(columns, starts[nearest])
    return groups


def _describe_prior(
    bases: FilterBases | None, smooth_fractions: list[float], n_channels: int
) -> str:
    if bases is None:
        return "The take's own patterns: no examples were given."
    n_clips = int(bases.n_clips)
    clips = "1 example clip" if n_clips == 1 else f"{n_clips} example clips"
    if not smooth_fractions:
        return f"The take's own patterns: the {clips} share no joint with it."
    mean_fraction = float(np.mean(smooth_fractions))
    if mean_fraction >= 1.0:
        return f"The take's own patterns: the movement of {clips} is too different to help."
    if mean_fraction > POOR_FIT_FRACTION:
        return f"Patterns of {clips}, at reduced weight: they fit the take only roughly."
    if len(smooth_fractions) < n_channels / 3:
        return f"Patterns of {clips} for the joints that they have; otherwise the take's own."
    return f"Patterns of {clips}, adapted to the take."
