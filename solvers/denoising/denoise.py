"""Remove jitter, spikes and gaps from a recording, guided by how bodies move."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Flags
from ..errors import InvalidMotionError
from ..motion import JointLimits, Motion, Tracks
from ..motion.skeletons import is_short_shot, shot_ranges
from ..progress import Progress, unwatched, within
from .channels import CENTIMETERS, Channels, Estimate, decode, encode
from .default_method import OUTLIER_THRESHOLD, apply_default_method
from .denoise_settings import (
    DEFAULT_SETTINGS,
    DenoiseMethod,
    DenoiseSettings,
    joint_factors,
    settings_at_rate,
)
from .denoised import Denoised, join_segments, keep_as_recorded
from .discontinuities import find_held_and_cuts, remove_path_jumps, restore_path_jumps
from .edge_poses import (
    find_edge_poses,
    hide_edge_poses,
    restore_edge_poses,
)
from .held_samples import (
    describe_held_samples,
    held_joints,
    hide_held_samples,
    restore_held_samples,
)
from .limb_gaps import keep_standing_feet
from .limits import clamp_to_limits, find_impossible_rotations
from .marker_gaps import FilledMarkers, fill_markers
from .noise_sections import clean_sections
from .observed_samples import max_per_joint, observed_mask, restore_observed
from .published import filter_as_published
from .window_priors import FilterBases

MIN_REPORTED_SPIKE = 2.0
"""Degrees or centimeters: a sample closer to the estimate is not reported as a spike. Chosen by
hand; `make sensitivity` varies it."""
HALF_CONFIDENCE_DEVIATION = 5.0
"""Standard deviation, degrees or centimeters, at which confidence is one half. By definition of
the confidence."""


def denoise(
    recording: Motion | Tracks,
    bases: FilterBases | None = None,
    *,
    limits: JointLimits | None = None,
    settings: DenoiseSettings = DEFAULT_SETTINGS,
    progress: Progress = unwatched,
) -> Denoised:
    """Estimate the true movement from a noisy recording with spikes and gaps.

    The prior is Gaussian over short windows of all joints together [1]_. It is mixed with plain
    smoothness where the examples explain the take poorly, and it adapts to the take. The method
    estimates noise, spikes and missing joints with it. Bone lengths stay constant. Long gaps of
    points are first filled from the points around them (`fill_markers`). Feet are not kept on
    the ground: see `plant_feet`.

    A take that was joined from several recordings is cleaned segment by segment. A segment of
    less than a quarter of a second keeps its samples; only its gaps are filled. Such a segment
    is the T-pose at the start of many recordings. A single limb that starts or ends in a
    separate pose keeps its samples too, and so does a take of poses far apart
    (`settings_at_rate`).

    Samples that a tracker repeated while the body moved on are treated as missing, unless their
    strength is below 1: then they are blended like others (`find_held_samples`).

    Where the body is put elsewhere in one frame, and stays, the path of its root is cleaned
    without this jump (`find_path_jumps`).

    Parameters
    ----------
    recording : Motion or Tracks
        NaN where not observed.
    bases : FilterBases, optional
        Patterns of clean recordings. Without them the take's own patterns are used.
    limits : JointLimits, optional
        Range of motion of the joints. At any strength the result is softly limited to it
        (`clamp_to_limits`). With bases, samples far beyond the limits are discarded where the
        first estimate followed them, and the take is estimated again.
    settings : DenoiseSettings
    progress : Progress

    Returns
    -------
    Denoised

    Raises
    ------
    InvalidMotionError
        The bases were learned from tracks and the recording is a motion, or the reverse; no
        frame was observed; or points are to be cleaned with strengths of body parts.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Lou, Chai (2010). Example-based human motion denoising. IEEE TVCG 16(5).
    """
    if bases is not None and bool(bases.of_points) != isinstance(recording, Tracks):
        learned = "points" if bases.of_points else "joints"
        raise InvalidMotionError(f"The examples are of {learned}, the recording is not.")
    if isinstance(recording, Tracks) and set(settings.part_strengths().values()) != {1.0}:
        raise InvalidMotionError(
            "Points have no body parts. Leave their strengths at 1, and use Strength alone."
        )
    progress(0.0, "Reading")
    if not observed_mask(recording).any():
        raise InvalidMotionError(
            "Nothing was observed in this take; there is nothing to clean."
        )
    settings, note = settings_at_rate(settings, recording.frame_rate)
    held, cuts = find_held_and_cuts(recording, settings)
    seen = hide_held_samples(recording, held)
    edge_poses = find_edge_poses(seen, cuts)
    take, offsets = remove_path_jumps(hide_edge_poses(seen, edge_poses), cuts, settings)
    results = _denoise_segments(take, cuts, bases, limits, settings, progress)
    progress(1.0, "Done")
    result = join_segments(take, results, cuts) if cuts else results[0]
    kept = _strengths(recording, settings) == 0.0
    restored = restore_path_jumps(seen, result.recording, offsets, kept)
    complete, confidence = restore_edge_poses(seen, restored, result.confidence, edge_poses)
    report = f"{note} {result.prior_used}".strip()
    result = replace(result, recording=complete, confidence=confidence, edge_poses=edge_poses,
                     prior_used=report)  # fmt: skip
    possible = recording
    if limits is not None and isinstance(recording, Motion) and held.any():
        possible = clamp_to_limits(recording, limits)
    return _blend_held(possible, result, held, settings)


def _denoise_segments(
    take: Motion | Tracks,
    cuts: tuple[int, ...],
    bases: FilterBases | None,
    limits: JointLimits | None,
    settings: DenoiseSettings,
    progress: Progress,
) -> list[Denoised]:
    """Denoise the segments of a take; one that is too short keeps its samples."""

    def clean(segment: Motion | Tracks, progress: Progress) -> Denoised:
        return _denoise_segment(segment, bases, limits, settings, progress)

    results = []
    for start, stop in shot_ranges(take, cuts):
        segment = take.slice(start, stop) if cuts else take
        step = within(progress, start / take.n_frames, stop / take.n_frames)
        if cuts and is_short_shot(stop - start, take.frame_rate):
            unchanged_settings = replace(settings, strength=0.0)
            results.append(
                keep_as_recorded(segment)
                if observed_mask(segment).all()
                else _denoise_segment(segment, bases, None, unchanged_settings, step)
            )
        elif isinstance(segment, Motion) and settings.method is DenoiseMethod.DEFAULT:
            results.append(clean_sections(segment, clean, step))
        else:
            results.append(clean(segment, step))
    return results


def _denoise_segment(
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
    strengths = _strengths(segment, settings)
    weights = np.repeat(strengths[channels.joints], channels.values.shape[2])
    noisy = channels.flat
    blended = noisy + weights * (estimate - noisy)
    values = np.where(np.isfinite(noisy), blended, estimate)
    cleaned = decode(complete, channels, values.reshape(channels.values.shape))
    return restore_observed(segment, cleaned, strengths == 0.0)


def _blend_held(
    recording: Motion | Tracks, result: Denoised, held: Flags, settings: DenoiseSettings
) -> Denoised:
    """Blend what a tracker held as well as what it observed, by the strength of each joint."""
    strengths = _strengths(recording, settings)
    cleaned = restore_held_samples(recording, result.recording, held, 1.0 - strengths)
    message = f"{result.prior_used} {describe_held_samples(held)}".strip()
    joints = held_joints(recording, held)
    return replace(result, recording=cleaned, held=joints, prior_used=message)


def _strengths(segment: Motion | Tracks, settings: DenoiseSettings) -> Array:
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
