"""The default method on whole takes: choose what moves, what to expect, and solve in groups."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...progress import Progress, within
from ...signals import alike, hampel, interpolated, rough_noise
from ..channels import Channels
from ..prior import FilterBases, FilterBasesSettings, WavePrior
from .estimate import Estimate
from .joint_outliers import WholeJoints
from .posterior import estimate_channels
from .prior_selection import UNKNOWN, choose_prior, examples_prior, take_prior
from .windows import Windows

Array = NDArray[np.float64]

LARGEST_GROUP = 96
"""Channels that are solved for together; rigs with more are cut between joints."""
CONSTANT = 1e-7
SPIKE_HALF_WIDTH = 4
SPIKE_TOLERANCE = 3.5
FIRST_GUESS_EFFICIENCY = 0.2
"""Of the median of overlapping differences, relative to a standard deviation."""
SMALLEST_NOISE = 0.01
FOREIGN = 0.2
"""Share of plain smoothness from which on the examples are said to fit badly."""


class Rough(NamedTuple):
    """A take before anything is known of it, long enough for one window."""

    noisy: Array
    """NaN where not observed, and beyond the end of a take shorter than a window."""
    values: Array
    """Without spikes, bridged by straight lines: no NaN."""
    noise: Array
    n_seen: NDArray[np.intp]
    windows: Windows


def estimate_in_groups(
    channels: Channels, frame_rate: float, bases: FilterBases | None, progress: Progress
) -> tuple[Estimate, str]:
    """Estimate all channels; return them with a sentence on the prior."""
    n_frames, n_channels = channels.flat.shape
    pattern_rate = float(bases.frame_rate) if bases else FilterBasesSettings().frame_rate
    window = bases.window if bases else FilterBasesSettings().n_frames
    take = _roughly(channels.flat, frame_rate, pattern_rate, window)
    values, inliers = take.values.copy(), np.isfinite(take.noisy).astype(float)
    deviation = np.where(np.isfinite(take.noisy) | (take.n_seen > 0), 0.0, UNKNOWN)
    told = _told(channels, bases)
    groups = groups_of(channels.flat, take.values, told)
    outside = np.zeros((len(values), n_channels // 3))
    iterations, converged, shares = 0, True, []
    for index, columns in enumerate(groups):
        step = within(progress, index / len(groups), (index + 1) / len(groups))
        guess = alike(take.noise[columns], take.n_seen[columns], FIRST_GUESS_EFFICIENCY)
        part = take._replace(
            noisy=take.noisy[:, columns], values=take.values[:, columns], noise=guess
        )
        prior = take_prior(
            part.values, guess, take.n_seen[columns] > 0, take.windows, window, pattern_rate
        )
        joints = columns // 3
        if bases is not None and told[columns[0]]:
            examples = _examples(part, n_frames, bases, channels.keys, columns, prior)
            prior, share = choose_prior(
                examples, prior, *part[:3], joints, take.windows, step
            )  # fmt: skip
            shares += [share] * len(columns)
        found = estimate_channels(
            *part[:3], prior, take.windows, within(step, 0.4, 1.0),
            joints=WholeJoints(joints, outside[:, joints]),
        )  # fmt: skip
        lost = np.isfinite(part.noisy) * (1.0 - found.inliers)
        np.maximum.at(outside.T, joints, lost.T)
        values[:, columns], inliers[:, columns] = found.values, found.inliers
        deviation[:, columns] = found.deviation
        iterations = max(iterations, found.iterations)
        converged &= found.converged
    whole = (values[:n_frames], inliers[:n_frames], deviation[:n_frames])
    unknown = np.full_like(channels.flat, np.nan)
    estimate = Estimate(*whole, unknown, iterations, converged)
    return estimate, _sentence(bases, shares, n_channels)


def _examples(
    part: Rough,
    n_frames: int,
    bases: FilterBases,
    keys: tuple[str, ...],
    columns: NDArray[np.intp],
    prior: WavePrior,
) -> WavePrior:
    """Return what the examples tell of some channels, whose rough values are given."""
    known, density = np.isfinite(part.noisy[:n_frames]), part.windows.density
    seen = known.sum(axis=0)
    own = np.where(known, part.values[:n_frames], 0.0).sum(axis=0) / np.maximum(seen, 1)
    # What spikes the rough values still hold is in their steps, though not in the noise.
    steps = np.diff(part.values[:n_frames], axis=0, prepend=part.values[:1])
    stray = np.maximum(part.noise, np.sqrt((steps**2).mean(axis=0) / 2.0))
    return examples_prior(
        bases, keys, columns, own, seen / density, n_frames / density,
        stray / np.sqrt(density), prior.smooth,
    )  # fmt: skip


def _roughly(noisy: Array, frame_rate: float, pattern_rate: float, window: int) -> Rough:
    length = max(round(window * frame_rate / pattern_rate), 2)
    padded = np.full((max(len(noisy), length), noisy.shape[1]), np.nan)
    padded[: len(noisy)] = noisy
    tame = hampel(padded, SPIKE_HALF_WIDTH, SPIKE_TOLERANCE)
    noise = np.maximum(rough_noise(tame), SMALLEST_NOISE)
    windows = Windows(len(padded), length, length / window)
    return Rough(padded, interpolated(tame), noise, np.isfinite(tame).sum(axis=0), windows)


def _told(channels: Channels, bases: FilterBases | None) -> NDArray[np.bool_]:
    """Return which channels the examples tell of."""
    known = set()
    if bases is not None:
        known = {(str(bases.keys[channel // 3]), channel % 3) for channel in bases.moving}
    return np.array(
        [(key, axis) in known for key in channels.keys for axis in range(3)], dtype=bool
    )


def groups_of(noisy: Array, rough: Array, told: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """Sort the channels that move: those of the examples first.

    The channels of a joint stay together, but for those that the examples know nothing of.
    """
    missing = np.isnan(noisy)
    moves = (np.ptp(rough, axis=0) > CONSTANT) | missing.all(axis=0)
    moves |= told & missing.any(axis=0)
    groups = []
    for kind in (moves & told, moves & ~told):
        columns = np.flatnonzero(kind)
        if not len(columns):
            continue
        starts = np.append(np.unique(columns // 3, return_index=True)[1], len(columns))
        n_groups = -(-len(columns) // (LARGEST_GROUP - 2))
        even = np.arange(1, n_groups) * len(columns) / n_groups
        nearest = np.abs(starts[:, None] - even).argmin(axis=0)
        groups += np.split(columns, starts[nearest])
    return groups


def _sentence(bases: FilterBases | None, shares: list[float], n_channels: int) -> str:
    if bases is None:
        return "The take's own patterns: no examples were given."
    n_clips = int(bases.n_clips)
    clips = f"{n_clips} example clip" + "s" * (n_clips != 1)
    if not shares:
        return f"The take's own patterns: no joint of it is in the {clips}."
    foreign = float(np.mean(shares))
    if foreign >= 1.0:
        return f"The take's own patterns: the movement of {clips} is too different to help."
    if foreign > FOREIGN:
        return f"Patterns of {clips}, at part weight: they fit the take only roughly."
    if len(shares) < n_channels / 3:
        return f"Patterns of {clips} for the joints that they have; else the take's own."
    return f"Patterns of {clips}, adapted to the take."
