"""Remove jitter, spikes and gaps from a recording, guided by how bodies move."""

from dataclasses import replace

import numpy as np

from ..arrays import Flags
from ..errors import InvalidMotionError
from ..motion import JointLimits, Motion, Tracks
from ..motion.skeletons import find_shot_boundaries, is_short_shot, shot_ranges
from ..progress import Progress, unwatched, within
from .baked_takes import describe_baking, find_baking, recorded_samples, restore_rate
from .denoise_segment import denoise_segment, joint_strengths
from .denoise_settings import DEFAULT_SETTINGS, DenoiseMethod, DenoiseSettings
from .denoised import Denoised, between_samples, join_segments, unchanged
from .edge_poses import (
    describe_edge_poses,
    find_edge_poses,
    hide_edge_poses,
    restore_edge_poses,
)
from .held_samples import (
    describe_held_samples,
    find_held_samples,
    held_joints,
    hide_held_samples,
    restore_held_samples,
)
from .limits import clamp_to_limits
from .observed_samples import observed_mask
from .window_priors import FilterBases


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
    separate pose keeps its samples too.

    Samples that a tracker repeated while the body moved on are treated as missing, unless their
    strength is below 1: then they are blended like others (`find_held_samples`). A take that
    was recorded at a lower rate and interpolated linearly is cleaned at that rate, because
    interpolated noise looks like movement (`find_baking`).

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
    baking = find_baking(recording) if settings.method is DenoiseMethod.DEFAULT else None
    if baking is None:
        return _denoise_take(recording, bases, limits, settings, progress)
    samples = recorded_samples(recording, baking)
    result = _denoise_take(samples, bases, limits, settings.at_full_strength(), progress)
    restored = restore_rate(recording, result.recording, result.cuts, baking)
    message = f"{describe_baking(recording, baking)} {result.prior_used}"
    result = between_samples(result, recording, baking.neighbors(recording.n_frames))
    observed = observed_mask(recording)
    if isinstance(recording, Motion):
        has_root = np.isfinite(recording.root_positions).all(axis=1)
        observed = np.column_stack([observed, has_root])
    cleaned = _blend(recording, restored, observed, limits, settings)
    return replace(result, recording=cleaned, prior_used=message)


def _denoise_take(
    recording: Motion | Tracks,
    bases: FilterBases | None,
    limits: JointLimits | None,
    settings: DenoiseSettings,
    progress: Progress,
) -> Denoised:
    """Denoise the segments of a take, each of whose frames was recorded."""
    held, cuts = _find_held_and_cuts(recording, settings)
    seen = hide_held_samples(recording, held)
    edge_poses = find_edge_poses(seen, cuts)
    take = hide_edge_poses(seen, edge_poses)
    results = []
    for start, stop in shot_ranges(take, cuts):
        segment = take.slice(start, stop) if cuts else take
        step = within(progress, start / recording.n_frames, stop / recording.n_frames)
        if cuts and is_short_shot(stop - start, recording.frame_rate):
            unchanged_settings = replace(settings, strength=0.0)
            results.append(
                unchanged(segment)
                if observed_mask(segment).all()
                else denoise_segment(segment, bases, None, unchanged_settings, step)
            )
        else:
            results.append(denoise_segment(segment, bases, limits, settings, step))
    progress(1.0, "Done")
    result = join_segments(take, results, cuts) if cuts else results[0]
    complete, confidence = restore_edge_poses(
        seen, result.recording, result.confidence, edge_poses
    )
    sentences = result.prior_used, describe_edge_poses(edge_poses), describe_held_samples(held)
    return replace(
        result,
        recording=_blend(recording, complete, held, limits, settings),
        confidence=confidence,
        held=held_joints(recording, held),
        prior_used=" ".join(filter(None, sentences)),
    )


def _find_held_and_cuts(
    recording: Motion | Tracks, settings: DenoiseSettings
) -> tuple[Flags, tuple[int, ...]]:
    """Return what a tracker held, except in segments that are kept, and the cuts."""
    held = find_held_samples(recording)
    if settings.method is DenoiseMethod.PUBLISHED:
        held[:] = False
    cuts = find_shot_boundaries(hide_held_samples(recording, held))
    for start, stop in shot_ranges(recording, cuts):
        if cuts and is_short_shot(stop - start, recording.frame_rate):
            held[start:stop] = False
    return held, cuts


def _blend(
    recording: Motion | Tracks,
    cleaned: Motion | Tracks,
    samples: Flags,
    limits: JointLimits | None,
    settings: DenoiseSettings,
) -> Motion | Tracks:
    """Blend these samples with what was recorded, by the strength of each joint."""
    weights = 1.0 - joint_strengths(recording, settings)
    if limits is not None and isinstance(recording, Motion) and samples.any() and weights.any():
        recording = clamp_to_limits(recording, limits)
    return restore_held_samples(recording, cleaned, samples, weights)
