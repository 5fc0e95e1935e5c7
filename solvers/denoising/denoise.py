"""Take jitter, spikes and gaps out of a recording, guided by how bodies move."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray
from scipy.fft import idct

from ..motion import Motion, Tracks
from ..progress import Progress, unwatched
from ..settings import Settings, setting
from .channels import Channels
from .channels_motion import decode_motion
from .channels_tracks import decode_tracks
from .denoise_estimate import Estimate
from .filter_bases import FilterBases, FilterBasesSettings, encode, phases
from .noise import hampel, interpolated, rough_noise
from .prior import WindowPrior, prior_from_bases, prior_from_take, with_smooth_rest
from .published import filter_as_published

Array = NDArray[np.float64]

OUTLIER_DENSITY = 1.0 / 120.0
"""Of an outlier's error, per degree: anything within +-60 is as likely."""
MAX_ITERATIONS = 30
SETTLED = 0.02
"""Change, in degrees or centimetres, below which the estimate is taken as settled."""
SMALLEST_NOISE = 0.01
SLOW_WAVES = 0.6
STILL = 0.05


class Method(Enum):
    """Ways to denoise."""

    DEFAULT = "default"
    PUBLISHED = "published"


@dataclass(frozen=True, kw_only=True)
class DenoiseSettings(Settings):
    """How a recording is denoised."""

    method: Method = setting(
        Method.DEFAULT,
        "Default estimates the noise and weighs every pattern; published is the filter of"
        " Lou and Chai (2010) as printed",
    )
    strength: float = setting(
        1.0, "How far to go from recording to estimate; gaps are filled at any strength",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Denoised:
    """A clean recording, and how sure each part of it is."""

    recording: Motion | Tracks
    """Same joints or points, same frames; no NaN is left."""
    outliers: NDArray[np.bool_]
    """Where the input was taken for a spike, shape (n_frames, n_joints)."""
    confidence: Array
    """0 (a guess) to 1 (as good as measured), shape (n_frames, n_joints)."""
    iterations: int
    converged: bool
    prior_used: str
    """A sentence: which patterns guided the estimate, and why."""


def denoise(
    recording: Motion | Tracks,
    bases: FilterBases | None = None,
    *,
    settings: DenoiseSettings = DenoiseSettings(),
    progress: Progress = unwatched,
) -> Denoised:
    """Estimate the true movement from a noisy recording with spikes and gaps.

    Parameters
    ----------
    recording : Motion or Tracks
        NaN where not observed.
    bases : FilterBases, optional
        Patterns of clean recordings. Without them the take's own patterns are used.
    settings : DenoiseSettings
    progress : Progress

    Returns
    -------
    Denoised

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    channels = encode(recording, bases.reference_of if bases else None)
    noisy = channels.flat
    rate = bases.frame_rate if bases else FilterBasesSettings().frame_rate
    takes = phases(noisy, recording.frame_rate, rate)
    noise = np.maximum(rough_noise(takes[0]), SMALLEST_NOISE)
    rough = [interpolated(hampel(take, 4, 3.5)) for take in takes]
    prior = prior_from_bases(bases, channels.keys) if bases else None
    if prior is None:
        window = max(min(round(FilterBasesSettings().window * rate), len(takes[-1])), 1)
        prior = prior_from_take(rough, window, noise)
    prior = with_smooth_rest(prior)
    estimates = []
    for index, (take, start) in enumerate(zip(takes, rough, strict=True)):
        if settings.method is Method.PUBLISHED:
            estimates.append(filter_as_published(take, prior))
        else:
            estimates.append(_filter_moving(take, start, prior, noise))
        progress((index + 1) / len(takes), "Denoising")
    step = len(takes)
    values, inliers, deviation = (np.empty_like(noisy) for _ in range(3))
    for phase, estimate in enumerate(estimates):
        values[phase::step] = estimate.values
        inliers[phase::step] = estimate.inliers
        deviation[phase::step] = estimate.deviation
    known = np.isfinite(noisy)
    values = np.where(known, noisy + settings.strength * (values - noisy), values)
    return Denoised(
        _decoded(channels, values.reshape(channels.values.shape)),
        _by_joint(channels, np.where(known & (inliers < 0.5), 1.0, 0.0)) > 0,
        1.0 - _by_joint(channels, np.where(known, 1.0 - inliers, 0.8)),
        max(estimate.iterations for estimate in estimates),
        all(estimate.converged for estimate in estimates),
        prior.description,
    )


def _filter_moving(noisy: Array, start: Array, prior: WindowPrior, noise: Array) -> Estimate:
    """Filter the channels that ever move; the others keep the mean of the prior."""
    variance = np.diag(prior.covariance).reshape(prior.window, -1).mean(axis=0)
    moving = np.flatnonzero(variance > STILL**2)
    if not len(moving):
        moving = np.array([0])
    part = prior.restricted(moving)
    inner = _filter(noisy[:, moving], start[:, moving], part, noise[moving])
    values = np.tile(prior.mean, (len(noisy), 1))
    inliers = np.isfinite(noisy).astype(float)
    deviation = np.tile(noise, (len(noisy), 1))
    values[:, moving], inliers[:, moving] = inner.values, inner.inliers
    deviation[:, moving] = inner.deviation
    return Estimate(values, inliers, deviation, inner.iterations, inner.converged)


def _filter(noisy: Array, start: Array, prior: WindowPrior, noise: Array) -> Estimate:
    """Alternate between an outlier mixture and the Wiener filter of all windows."""
    window = min(prior.window, len(noisy))
    gain, vectors, back = _gains(prior, window, noise)
    known = np.isfinite(noisy)
    observed = np.nan_to_num(noisy - prior.mean)
    variance = 1.3 * noise**2 + 0.05
    estimate, rate, converged = start - prior.mean, 0.05, False
    iteration = 0
    while iteration < MAX_ITERATIONS and not converged:
        iteration += 1
        error = observed - estimate
        inside = (1 - rate) * np.exp(-0.5 * error**2 / variance) / np.sqrt(2 * np.pi * variance)
        weight = known * inside / (inside + rate * OUTLIER_DENSITY)
        if known.any():
            rate = float(np.clip(1 - weight[known].mean(), 0.001, 0.5))
        mixed = estimate + weight * error
        new = _filtered(mixed, window, gain, vectors, back)
        change = float(np.abs(new - estimate).max())
        estimate = new
        converged = change < SETTLED
    deviation = np.broadcast_to(noise, noisy.shape)
    return Estimate(estimate + prior.mean, weight, deviation, iteration, converged)


def _gains(prior: WindowPrior, window: int, noise: Array) -> tuple[Array, Array, Array]:
    """Return the Wiener gain of each pattern, and matrices that weigh and rebuild a window."""
    n_channels = len(noise)
    size = window * n_channels
    # Nothing in a body moves faster than the slowest waves of the window can tell.
    waves = idct(np.eye(window)[:, : max(round(SLOW_WAVES * window), 1)], axis=0, norm="ortho")
    spread = np.einsum(
        "jw,jckd,kv->wcvd",
        waves,
        prior.covariance.reshape(prior.window, n_channels, prior.window, n_channels)[
            :window, :, :window, :
        ],
        waves,
        optimize=True,
    )
    n_weights = waves.shape[1] * n_channels
    scale = np.tile(noise, waves.shape[1])
    values, vectors = np.linalg.eigh(
        spread.reshape(n_weights, n_weights) / np.outer(scale, scale)
    )
    kept = values > 0.05
    gain = values[kept] / (values[kept] + 1.0)
    patterns = (waves @ vectors[:, kept].reshape(waves.shape[1], -1)).reshape(size, -1)
    scale = np.tile(noise, window)[:, None]
    vectors, back = patterns / scale, patterns * scale
    return gain, vectors, back


def _filtered(motion: Array, window: int, gain: Array, vectors: Array, back: Array) -> Array:
    """Filter every window and average where they overlap."""
    windows = np.lib.stride_tricks.sliding_window_view(motion, window, axis=0)
    flat = windows.transpose(0, 2, 1).reshape(len(windows), -1)
    fitted = ((flat @ vectors) * gain @ back.T).reshape(len(windows), window, -1)
    total, count = np.zeros_like(motion), np.zeros((len(motion), 1))
    for place in range(window):
        total[place : place + len(fitted)] += fitted[:, place]
        count[place : place + len(fitted)] += 1.0
    return np.asarray(total / count)


def _decoded(channels: Channels, values: Array) -> Motion | Tracks:
    if isinstance(channels.recording, Motion):
        return decode_motion(channels.recording, channels, values)
    return decode_tracks(channels.recording, channels, values)


def _by_joint(channels: Channels, values: Array) -> Array:
    """Reduce (n_frames, n_channels) to the largest per joint, (n_frames, n_joints)."""
    parts = values.reshape(channels.values.shape).max(axis=2)
    recording = channels.recording
    n_joints = recording.n_joints if isinstance(recording, Motion) else recording.n_points
    result = np.zeros((len(parts), n_joints))
    for part, joint in enumerate(channels.joints):
        result[:, joint] = np.maximum(result[:, joint], parts[:, part])
    return result
