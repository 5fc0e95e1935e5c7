"""Clean one segment of a take: what lies between two cuts."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..motion import JointLimits, Motion, Tracks
from ..progress import Progress, within
from .channels import CENTIMETERS, Channels, Estimate, decode, encode
from .default_method import OUTLIER_THRESHOLD, apply_default_method
from .denoise_settings import DenoiseMethod, DenoiseSettings, joint_factors
from .denoised import Denoised
from .limb_gaps import keep_standing_feet
from .limits import clamp_to_limits, find_impossible_rotations
from .marker_gaps import FilledMarkers, fill_markers
from .observed_samples import max_per_joint, observed_mask, restore_observed
from .published import filter_as_published
from .window_priors import FilterBases

MIN_REPORTED_SPIKE = 2.0
"""Degrees or centimeters: a sample closer to the estimate is not reported as a spike. Chosen by
hand; `make sensitivity` varies it."""
HALF_CONFIDENCE_DEVIATION = 5.0
"""Standard deviation, degrees or centimeters, at which confidence is one half. By definition of
the confidence."""


def denoise_segment(
    segment: Motion | Tracks,
    bases: FilterBases | None,
    limits: JointLimits | None,
    settings: DenoiseSettings,
    progress: Progress,
) -> Denoised:
    """Denoise one segment of the take."""
    filled = _fill_gaps(segment, settings, within(progress, 0.0, 0.05))
    complete = filled.tracks if filled else segment
    channels = encode(complete, bases.reference_of if bases else None)
    two_passes = limits is not None and bases is not None
    first_progress = within(progress, 0.05, 0.5 if two_passes else 0.95)
    estimate, prior_used = _estimate(
        channels, segment.frame_rate, bases, settings, first_progress
    )
    if limits is not None and bases is not None and isinstance(segment, Motion):
        estimated_motion = decode(
            segment, channels, estimate.values.reshape(channels.values.shape)
        )
        assert isinstance(estimated_motion, Motion)
        impossible_mask = find_impossible_rotations(segment, estimated_motion, limits)[
            :, channels.joints
        ]
        impossible_mask[:, -1] = False  # the root position has no limit
        if impossible_mask.any():
            values = np.where(impossible_mask[..., None], np.nan, channels.values)
            possible_channels = replace(channels, values=values)
            second_progress = within(progress, 0.5, 0.95)
            estimate, prior_used = _estimate(
                possible_channels, segment.frame_rate, bases, settings, second_progress
            )
    spikes = (estimate.inliers < OUTLIER_THRESHOLD) & (
        np.abs(channels.flat - estimate.values) > MIN_REPORTED_SPIKE
    )
    cleaned = _blend(segment, complete, channels, estimate.values, settings)
    if isinstance(cleaned, Motion):
        if settings.method is DenoiseMethod.DEFAULT:
            cleaned = keep_standing_feet(cleaned, observed_mask(segment))
        cleaned = cleaned if limits is None else clamp_to_limits(cleaned, limits)
    confidence = _confidence(max_per_joint(segment, channels, estimate.deviation), filled)
    if isinstance(cleaned, Tracks):
        unknown_mask = _unknown_points(cleaned.names, segment, bases)
        confidence[:, unknown_mask] = 0.0
        cleaned = cleaned.with_positions(
            np.where(unknown_mask[:, None], np.nan, cleaned.positions)
        )
    return Denoised(
        cleaned,
        (max_per_joint(segment, channels, spikes) > 0.0) & observed_mask(segment),
        np.zeros(confidence.shape, dtype=np.bool_),
        confidence,
        estimate.iterations,
        estimate.converged,
        prior_used,
    )


def _blend(
    segment: Motion | Tracks,
    complete: Motion | Tracks,
    channels: Channels,
    estimate: Array,
    settings: DenoiseSettings,
) -> Motion | Tracks:
    """Blend from the recorded to the estimated channels, by the strength of each joint."""
    strengths = joint_strengths(segment, settings)
    weights = np.repeat(strengths[channels.joints], channels.values.shape[2])
    noisy = channels.flat
    blended = noisy + weights * (estimate - noisy)
    values = np.where(np.isfinite(noisy), blended, estimate)
    cleaned = decode(complete, channels, values.reshape(channels.values.shape))
    return restore_observed(segment, cleaned, strengths == 0.0)


def joint_strengths(segment: Motion | Tracks, settings: DenoiseSettings) -> Array:
    """Return the strength of each joint or point, shape (n_joints,)."""
    if isinstance(segment, Motion):
        factors = joint_factors(segment.skeleton, settings.part_strengths())
        return np.asarray(settings.strength * factors)
    return np.full(segment.n_points, settings.strength)


def _unknown_points(
    names: Sequence[str], segment: Motion | Tracks, bases: FilterBases | None
) -> NDArray[np.bool_]:
    """Return which points neither this segment nor the examples show, shape (n_points,)."""
    known_means = bases.reference_of if bases else {}
    return np.asarray(
        ~observed_mask(segment).any(axis=0) & [name not in known_means for name in names]
    )


def _fill_gaps(
    segment: Motion | Tracks, settings: DenoiseSettings, progress: Progress
) -> FilledMarkers | None:
    """Fill gaps of points, so that the filter treats predicted samples as observed."""
    if isinstance(segment, Tracks) and settings.method is DenoiseMethod.DEFAULT:
        return fill_markers(segment, progress)
    return None


def _confidence(deviation: Array, filled: FilledMarkers | None) -> Array:
    if filled is not None:
        deviation = np.where(filled.filled, CENTIMETERS * filled.deviation, deviation)
    return np.asarray(1.0 / (1.0 + (deviation / HALF_CONFIDENCE_DEVIATION) ** 2))


def _estimate(
    channels: Channels,
    frame_rate: float,
    bases: FilterBases | None,
    settings: DenoiseSettings,
    progress: Progress,
) -> tuple[Estimate, str]:
    if settings.method is DenoiseMethod.PUBLISHED:
        return filter_as_published(channels, frame_rate, bases, progress)
    return apply_default_method(channels, frame_rate, bases, progress)
