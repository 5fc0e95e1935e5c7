"""Take jitter, spikes and gaps out of a recording, guided by how bodies move."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import Motion, Tracks
from ..progress import Progress, unwatched, within
from ..settings import Settings, setting
from .channels import Channels
from .channels_encode import decode, encode
from .denoise_groups import estimate_in_groups
from .filter_bases import FilterBases
from .published import filter_as_published

Array = NDArray[np.float64]

SMALLEST_SPIKE = 2.0
"""Degrees or centimetres: what is nearer to the estimate is not called an outlier."""
UNSURE = 5.0
"""Standard deviation, degrees or centimetres, at which confidence is one half."""


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
        advanced=True,
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
    """0 (a guess) to 1 (sure) that the cleaned joint is right, shape (n_frames, n_joints): one
    half where its standard deviation is 5 degrees or centimetres."""
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

    A Gaussian prior over short windows of all joints together [1]_, mixed with plain smoothness
    as far as it explains the take (examples of another movement are laid aside), adapts to the
    take; noise, spikes and missing joints are estimated with it. Bones keep their lengths. It
    does not keep feet on the ground: see `plant_feet`.

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
    InvalidMotionError
        The bases were learned from tracks and the recording is a motion, or the reverse; or
        nothing was observed.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Lou, Chai (2010). Example-based human motion denoising. IEEE TVCG 16(5).
    """
    if bases is not None and bool(bases.of_points) != isinstance(recording, Tracks):
        learned = "points" if bases.of_points else "joints"
        raise InvalidMotionError(f"The examples are of {learned}, the recording is not.")
    progress(0.0, "Reading")
    seen = recording.observed if isinstance(recording, Motion) else recording.visible
    if not seen.any():
        raise InvalidMotionError(
            "Nothing was observed in this take; there is nothing to clean."
        )
    channels = encode(recording, bases.reference_of if bases else None)
    inner = within(progress, 0.05, 0.95)
    if settings.method is Method.PUBLISHED:
        estimate, used = filter_as_published(channels, recording.frame_rate, bases, inner)
    else:
        estimate, used = estimate_in_groups(channels, recording.frame_rate, bases, inner)
    noisy, known = channels.flat, np.isfinite(channels.flat)
    spikes = (estimate.inliers < 0.5) & (np.abs(noisy - estimate.values) > SMALLEST_SPIKE)
    blended = noisy + settings.strength * (estimate.values - noisy)
    values = np.where(known, blended, estimate.values)
    cleaned = decode(recording, channels, values.reshape(channels.values.shape))
    progress(1.0, "Done")
    return Denoised(
        _kept_where_unchanged(recording, cleaned, settings),
        _worst(recording, channels, spikes) > 0.0,
        1.0 / (1.0 + (_worst(recording, channels, estimate.deviation) / UNSURE) ** 2),
        estimate.iterations,
        estimate.converged,
        used,
    )


def _kept_where_unchanged(
    recording: Motion | Tracks, cleaned: Motion | Tracks, settings: DenoiseSettings
) -> Motion | Tracks:
    """At strength 0, return what was observed as it was, to the last bit."""
    if settings.strength > 0.0:
        return cleaned
    if isinstance(recording, Motion) and isinstance(cleaned, Motion):
        rotations, roots = recording.rotations, recording.root_positions
        return recording.with_poses(
            np.where(np.isfinite(rotations), rotations, cleaned.rotations),
            np.where(np.isfinite(roots), roots, cleaned.root_positions),
        )
    assert isinstance(recording, Tracks)
    assert isinstance(cleaned, Tracks)
    places = recording.positions
    return recording.with_positions(np.where(np.isfinite(places), places, cleaned.positions))


def _worst(
    recording: Motion | Tracks, channels: Channels, values: NDArray[np.generic]
) -> Array:
    """Return the largest of each joint's channels, shape (n_frames, n_joints)."""
    parts = values.reshape(channels.values.shape).max(axis=2)
    n_joints = recording.n_joints if isinstance(recording, Motion) else recording.n_points
    result = np.zeros((len(parts), n_joints))
    for part, joint in enumerate(channels.joints):
        result[:, joint] = np.maximum(result[:, joint], parts[:, part])
    return result
