"""Take jitter, spikes and gaps out of a recording, guided by how bodies move."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import JointLimits, Motion, Tracks
from ..motion.skeletons import find_cuts, is_short, pieces, tell_of_cuts
from ..progress import Progress, unwatched, within
from ..settings import Choice, Settings, setting
from .channels import CENTIMETRES, Channels, decode, encode
from .limits import impossible_turns, keep_within
from .marker_gaps import FilledMarkers, fill_markers
from .posterior import Estimate, estimate_in_groups
from .prior import FilterBases
from .published import filter_as_published

Array = NDArray[np.float64]

SMALLEST_SPIKE = 2.0
"""Degrees or centimetres: what is nearer to the estimate is not called an outlier."""
UNSURE = 5.0
"""Standard deviation, degrees or centimetres, at which confidence is one half."""


class Method(Choice):
    """Ways to denoise."""

    DEFAULT = "default", "Estimate the noise of the take and weight all patterns"
    PUBLISHED = "published", "Filter as printed by Lou and Chai (2010)", "Lou and Chai 2010"


@dataclass(frozen=True, kw_only=True)
class DenoiseSettings(Settings):
    """How a recording is denoised."""

    method: Method = setting(
        Method.DEFAULT,
        "Denoising method; the default measured best",
        advanced=True,
    )
    strength: float = setting(
        1.0, "Blend from recorded to cleaned motion; gaps are filled at any strength",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Denoised:
    """A clean recording, and how sure each part of it is."""

    recording: Motion | Tracks
    """Same joints or points, same frames; no NaN is left, but of points that neither the take
    nor the examples ever show."""
    outliers: NDArray[np.bool_]
    """Where the input was taken for a spike, shape (n_frames, n_joints)."""
    confidence: Array
    """0 (a guess) to 1 (sure) that the cleaned joint is right, shape (n_frames, n_joints): one
    half where its standard deviation is 5 degrees or centimetres."""
    iterations: int
    converged: bool
    prior_used: str
    """Which patterns guided the estimate, and why; and what was taken for a piece apart."""
    cuts: tuple[int, ...] = ()
    """First frames of the pieces of which the take was found to be made, but the first."""


def denoise(
    recording: Motion | Tracks,
    bases: FilterBases | None = None,
    *,
    limits: JointLimits | None = None,
    settings: DenoiseSettings = DenoiseSettings(),
    progress: Progress = unwatched,
) -> Denoised:
    """Estimate the true movement from a noisy recording with spikes and gaps.

    A Gaussian prior over short windows of all joints together [1]_, mixed with plain smoothness
    as far as it explains the take (examples of another movement are laid aside), adapts to the
    take; noise, spikes and missing joints are estimated with it. Bones keep their lengths. Long
    gaps of points are first filled from the points around them (`fill_markers`). It does not
    keep feet on the ground: see `plant_feet`.

    A take that was joined of several is cleaned piece by piece. A piece of less than a quarter
    of a second, such as the T-pose with which many recordings begin, is kept as it is, but for
    its gaps.

    Parameters
    ----------
    recording : Motion or Tracks
        NaN where not observed.
    bases : FilterBases, optional
        Patterns of clean recordings. Without them the take's own patterns are used.
    limits : JointLimits, optional
        How far the joints of a motion may turn. At any strength the result is held softly
        within them (`keep_within`); with bases, it is estimated again without what is far
        beyond, where the first estimate believed that.
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
    if not _seen(recording).any():
        raise InvalidMotionError(
            "Nothing was observed in this take; there is nothing to clean."
        )
    cuts = find_cuts(recording)
    parts = []
    for start, stop in pieces(recording, cuts):
        piece = recording.slice(start, stop) if cuts else recording
        step = within(progress, start / recording.n_frames, stop / recording.n_frames)
        if cuts and is_short(stop - start, recording.frame_rate):
            kept = replace(settings, strength=0.0)
            parts.append(
                _as_it_is(piece)
                if _seen(piece).all()
                else _denoised_piece(piece, bases, None, kept, step)
            )
        else:
            parts.append(_denoised_piece(piece, bases, limits, settings, step))
    progress(1.0, "Done")
    return _joined(recording, parts, cuts) if cuts else parts[0]


def _denoised_piece(
    piece: Motion | Tracks,
    bases: FilterBases | None,
    limits: JointLimits | None,
    settings: DenoiseSettings,
    progress: Progress,
) -> Denoised:
    """Denoise what is of one piece."""
    filled = _filled(piece, settings, within(progress, 0.0, 0.05))
    whole = filled.tracks if filled else piece
    channels = encode(whole, bases.reference_of if bases else None)
    halved = limits is not None and bases is not None
    first = within(progress, 0.05, 0.5 if halved else 0.95)
    estimate, used = _estimated(channels, piece.frame_rate, bases, settings, first)
    if limits is not None and bases is not None and isinstance(piece, Motion):
        believed = decode(piece, channels, estimate.values.reshape(channels.values.shape))
        assert isinstance(believed, Motion)
        impossible = impossible_turns(piece, believed, limits)[:, channels.joints]
        impossible[:, -1] = False  # the last part is the root's place, which no limit is about
        if impossible.any():
            values = np.where(impossible[..., None], np.nan, channels.values)
            possible = replace(channels, values=values)
            second = within(progress, 0.5, 0.95)
            estimate, used = _estimated(possible, piece.frame_rate, bases, settings, second)
    noisy, known = channels.flat, np.isfinite(channels.flat)
    spikes = (estimate.inliers < 0.5) & (np.abs(noisy - estimate.values) > SMALLEST_SPIKE)
    blended = noisy + settings.strength * (estimate.values - noisy)
    values = np.where(known, blended, estimate.values)
    cleaned = decode(whole, channels, values.reshape(channels.values.shape))
    cleaned = _kept_where_unchanged(piece, cleaned, settings)
    if limits is not None and isinstance(cleaned, Motion):
        cleaned = keep_within(cleaned, limits)
    confidence = _confidence(_worst(piece, channels, estimate.deviation), filled)
    if isinstance(cleaned, Tracks):
        unknown = _never_shown(cleaned.names, piece, bases)
        confidence[:, unknown] = 0.0
        cleaned = cleaned.with_positions(np.where(unknown[:, None], np.nan, cleaned.positions))
    return Denoised(
        cleaned,
        (_worst(piece, channels, spikes) > 0.0) & _seen(piece),
        confidence,
        estimate.iterations,
        estimate.converged,
        used,
    )


def _never_shown(
    names: Sequence[str], piece: Motion | Tracks, bases: FilterBases | None
) -> NDArray[np.bool_]:
    """Tell which points neither this piece nor the examples show, shape (n_points,)."""
    told = bases.reference_of if bases else {}
    return np.asarray(~_seen(piece).any(axis=0) & [name not in told for name in names])


def _filled(
    piece: Motion | Tracks, settings: DenoiseSettings, progress: Progress
) -> FilledMarkers | None:
    """Fill gaps of points: the filter then takes for seen what their companions foretell."""
    if isinstance(piece, Tracks) and settings.method is Method.DEFAULT:
        return fill_markers(piece, progress)
    return None


def _confidence(deviation: Array, filled: FilledMarkers | None) -> Array:
    if filled is not None:
        deviation = np.where(filled.filled, CENTIMETRES * filled.deviation, deviation)
    return np.asarray(1.0 / (1.0 + (deviation / UNSURE) ** 2))


def _estimated(
    channels: Channels,
    frame_rate: float,
    bases: FilterBases | None,
    settings: DenoiseSettings,
    progress: Progress,
) -> tuple[Estimate, str]:
    if settings.method is Method.PUBLISHED:
        return filter_as_published(channels, frame_rate, bases, progress)
    return estimate_in_groups(channels, frame_rate, bases, progress)


def _as_it_is(piece: Motion | Tracks) -> Denoised:
    shape = _seen(piece).shape
    return Denoised(piece, np.zeros(shape, dtype=np.bool_), np.ones(shape), 0, True, "")


def _joined(
    recording: Motion | Tracks, parts: Sequence[Denoised], cuts: tuple[int, ...]
) -> Denoised:
    """Join the pieces of a take again; the longest tells which patterns were used."""
    cleaned = [part.recording for part in parts]
    whole: Motion | Tracks
    if isinstance(recording, Motion):
        motions = [each for each in cleaned if isinstance(each, Motion)]
        whole = recording.with_poses(
            np.concatenate([motion.rotations for motion in motions]),
            np.concatenate([motion.root_positions for motion in motions]),
        )
    else:
        tracks = [each for each in cleaned if isinstance(each, Tracks)]
        whole = recording.with_positions(np.concatenate([each.positions for each in tracks]))
    longest = max(parts, key=lambda part: part.recording.n_frames * bool(part.prior_used))
    return Denoised(
        whole,
        np.concatenate([part.outliers for part in parts]),
        np.concatenate([part.confidence for part in parts]),
        max(part.iterations for part in parts),
        all(part.converged for part in parts),
        f"{longest.prior_used} {tell_of_cuts(recording, cuts)}".strip(),
        cuts,
    )


def _seen(recording: Motion | Tracks) -> NDArray[np.bool_]:
    """Where each joint or point was observed, shape (n_frames, n_joints)."""
    return recording.observed if isinstance(recording, Motion) else recording.visible


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
    result = np.zeros(_seen(recording).shape)
    for part, joint in enumerate(channels.joints):
        result[:, joint] = np.maximum(result[:, joint], parts[:, part])
    return result
