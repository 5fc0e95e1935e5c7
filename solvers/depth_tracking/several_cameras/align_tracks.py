"""Find where and when a second camera recorded, from the skeletons of both."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import Tracks
from ...rotations import nearest_rotations
from ...settings import Settings, setting
from .lagged_fits import LaggedFits, fit_all_lags

MIN_MOVEMENT_M = 0.06
"""Root mean square movement of the joints below which an actor stands still. It guards
actors who only sway (`test_actor_who_stands_still_aligns_no_camera`)."""
MAX_MISMATCH_RATIO = 0.25
"""Largest mismatch of one motion before two cameras, as a ratio to that of unrelated motions.
It guards unrelated takes (`test_takes_of_other_motions_are_refused`)."""
MIN_PEAK_DISTANCE_S = 0.25
"""Seconds between two time offsets that count as different. By definition a quarter of the
shortest stride."""
MIN_REPEAT_RATIO = 1.15
"""Mismatch of another time offset, as a ratio to that of the best, below which the motion
repeats itself. It guards exercises in place
(`test_repeated_motion_has_no_unique_offset`)."""
MIN_EVIDENCE_RATIO = 0.5
"""Evidence of another time offset, as a ratio to the largest, from which it can be the right
one. It guards short walks, whose steps are similar
(`test_two_strides_of_a_straight_walk_are_enough`)."""
_EPSILON = 1e-8
"""Square meters that are no distance. It guards a logarithm."""
_N_PEAKS = 8
"""Number of time offsets that are examined. It bounds the run time."""
_N_ROUNDS, _SMALL_CHANGE_S = 30, 1e-5
"""Rounds of the robust fit, and the change of the offset in seconds that ends them. They bound
the run time."""
_OUTLIER_FACTOR = 3.0
"""Multiple of the median distance at which a pair of joints has a quarter of its weight: a
factor. By definition of an outlier, the three-sigma rule."""


@dataclass(frozen=True, kw_only=True)
class AlignmentSettings(Settings):
    """Settings of the alignment of a second camera."""

    max_offset: float = setting(
        30.0, "Longest time between the starts of two recordings; lower excludes repetitions",
        unit="s", minimum=0.0, maximum=86_400.0,
    )  # fmt: skip
    min_overlap: float = setting(
        0.5, "Shortest time that both cameras must show the actor",
        unit="s", minimum=0.1, maximum=3600.0,
    )  # fmt: skip


DEFAULT_ALIGNMENT = AlignmentSettings()


@dataclass(frozen=True, eq=False)
class CameraAlignment:
    """Where and when a camera recorded, relative to the first.

    Attributes
    ----------
    camera_from_first : shape (4, 4)
        Transform from the frame of the first camera to that of this one, meters.
    offset : float, seconds
        Time of the first camera at which this one recorded its frame 0.
    mismatch : float, meters
        Median distance of the joints of both skeletons.
    """

    camera_from_first: Array
    offset: float
    mismatch: float

    def angle_to(self, other: Array) -> float:
        """Return the angle in degrees to the rotation of another transform (4, 4)."""
        turned = self.camera_from_first[:3, :3] @ other[:3, :3].T
        return float(np.degrees(np.arccos(np.clip((np.trace(turned) - 1.0) / 2.0, -1.0, 1.0))))


FIRST_CAMERA = CameraAlignment(np.eye(4), 0.0, 0.0)
"""The first camera, relative to itself."""


def align_tracks(
    first: Tracks, other: Tracks, *, settings: AlignmentSettings = DEFAULT_ALIGNMENT
) -> CameraAlignment:
    """Find the transform and the time offset between two tracks of the same actor.

    The offset is the one with the largest evidence that both tracks show the same motion: the
    number of joints times the logarithm of the ratio of movement and mismatch, the likelihood
    ratio of Gaussian errors. Time in which the actor stands still contributes nothing. A robust
    fit then refines transform and offset between frames: rotation and translation follow from
    the pairs [1]_, the offset from their distances along the velocities, and distant pairs
    lose weight.

    Parameters
    ----------
    first, other : Tracks
        Joints of one actor, each in the frame of its camera, at any frame rates. Points of the
        same name are compared, weighted by the product of their confidence.
    settings : AlignmentSettings

    Raises
    ------
    InvalidMotionError
        The actor stands still, the takes do not overlap, show other motions, or repeat
        themselves.

    References
    ----------
    .. [1] Kabsch (1976). A solution for the best rotation to relate two sets of vectors. Acta
       Crystallographica A32. doi:10.1107/S0567739476001873
    """
    first, other = _common_points(first, other)
    rate = first.frame_rate
    n_resampled = int((other.n_frames - 1) / other.frame_rate * rate) + 1
    resampled = _sampled(other, np.arange(n_resampled) / rate)[:2]
    fits = fit_all_lags(_weighted(first), resampled)
    offsets = _possible_offsets(fits, rate, settings)
    return _unique([_refine(first, other, offset) for offset in offsets])


def _unique(found: list[CameraAlignment]) -> CameraAlignment:
    """Return the first of alignments, the most evident; refuse it if another fits as well."""
    best = found[0]
    for other in found[1:]:
        is_other = abs(other.offset - best.offset) >= MIN_PEAK_DISTANCE_S
        if is_other and other.mismatch < MIN_REPEAT_RATIO * best.mismatch:
            raise InvalidMotionError(
                f"The motion repeats itself: the recordings fit with an offset of"
                f" {best.offset:.2f} s and of {other.offset:.2f} s. Let the actor do something"
                " unique, or set a lower maximum offset."
            )
    return best


def _common_points(first: Tracks, other: Tracks) -> tuple[Tracks, Tracks]:
    names = [name for name in first.names if name in other.names]
    if len(names) < 3:
        raise InvalidMotionError("Two skeletons need at least three joints of the same names.")
    return _selected(first, names), _selected(other, names)


def _selected(tracks: Tracks, names: list[str]) -> Tracks:
    columns = [tracks.names.index(name) for name in names]
    confidence = None if tracks.confidence is None else tracks.confidence[:, columns]
    return Tracks(tuple(names), tracks.positions[:, columns], tracks.frame_rate, confidence)


def _weighted(tracks: Tracks) -> tuple[Array, Array]:
    """Return positions without NaN, about their mean, and their weights."""
    valid = np.isfinite(tracks.positions).all(axis=-1)
    confidence = np.ones(valid.shape) if tracks.confidence is None else tracks.confidence
    if not valid.any():
        raise InvalidMotionError("A skeleton without positions aligns no camera.")
    center = tracks.positions[valid].mean(axis=0)
    positions = np.where(valid[..., np.newaxis], tracks.positions - center, 0.0)
    return positions, np.where(valid, confidence, 0.0)


def _sampled(tracks: Tracks, times: Array) -> tuple[Array, Array, Array]:
    """Return positions, weights and velocities at times, seconds; weight 0 outside."""
    positions, weights = _weighted(tracks)
    at = times * tracks.frame_rate
    before = np.clip(np.floor(at).astype(np.intp), 0, max(tracks.n_frames - 2, 0))
    after = np.minimum(before + 1, tracks.n_frames - 1)
    fraction = (at - before)[:, np.newaxis]
    inside = ((at >= 0.0) & (at <= tracks.n_frames - 1))[:, np.newaxis]
    step = positions[after] - positions[before]
    sampled = positions[before] + fraction[..., np.newaxis] * step
    sampled_weights = np.where(inside, np.minimum(weights[before], weights[after]), 0.0)
    return sampled, sampled_weights, step * tracks.frame_rate


def _possible_offsets(
    fits: LaggedFits, rate: float, settings: AlignmentSettings
) -> list[float]:
    """Return the time offsets with the largest evidence, seconds, best first."""
    ratio = (fits.mismatch + _EPSILON) / (fits.movement + _EPSILON)
    complete = float(fits.weights.max())
    per_frame = complete / min(fits.lags[-1] + 1, 1 - fits.lags[0])
    allowed = np.abs(fits.lags) <= settings.max_offset * rate
    allowed &= fits.weights >= per_frame * settings.min_overlap * rate
    if not allowed.any():
        raise InvalidMotionError(
            f"The recordings have less than {settings.min_overlap:g} s in common with the"
            " actor in reach of both cameras. Record longer, or lower the minimum overlap."
        )
    if np.sqrt(fits.movement[allowed].max() / 2.0) < MIN_MOVEMENT_M:
        raise InvalidMotionError(
            "The actor stands still, so the time between the recordings cannot be found. Let"
            " the actor walk or move the arms before both cameras."
        )
    evidence = np.where(allowed, -fits.weights * np.log(ratio), -np.inf)
    best = int(evidence.argmax())
    if ratio[best] > MAX_MISMATCH_RATIO:
        raise InvalidMotionError(
            "The recordings do not show the same motion at any time offset. Check that both"
            " show the same actor at the same time, and that each is tracked well alone."
        )
    peaks = np.flatnonzero(
        _is_peak(evidence) & (evidence > MIN_EVIDENCE_RATIO * evidence[best])
    )
    order = np.argsort(-evidence[peaks])[:_N_PEAKS]
    return [float(lag / rate) for lag in fits.lags[peaks[order]]]


def _is_peak(values: Array) -> NDArray[np.bool_]:
    padded = np.concatenate([[-np.inf], values, [-np.inf]])
    return np.asarray((values >= padded[:-2]) & (values >= padded[2:]))


def _refine(first: Tracks, other: Tracks, offset: float) -> CameraAlignment:
    """Refine the offset between frames and fit the transform, robustly."""
    times = np.arange(first.n_frames) / first.frame_rate
    targets, target_weights = _weighted(first)
    robust = np.ones(target_weights.shape)
    centers = _center(first), _center(other)
    for _ in range(_N_ROUNDS):
        points, weights, velocities = _sampled(other, times - offset)
        weights = weights * target_weights
        rotation, translation = _rigid(points, targets, robust * weights)
        separations = targets - points @ rotation.T - translation
        distances = np.linalg.norm(separations, axis=-1)
        median = float(np.median(distances[weights > 0.0]))
        robust = 1.0 / (1.0 + (distances / (_OUTLIER_FACTOR * median + 1e-9)) ** 2) ** 2
        # A later offset samples earlier positions: d(separations) = velocity d(offset).
        # The translation follows it, so only movement about the mean determines it.
        factor = (robust * weights)[..., np.newaxis]
        moved = velocities @ rotation.T
        moved = moved - (factor * moved).sum(axis=(0, 1)) / factor.sum()
        change = -float((factor * moved * separations).sum() / (factor * moved**2).sum())
        change = float(np.clip(change, -0.5 / first.frame_rate, 0.5 / first.frame_rate))
        offset += change
        if abs(change) < _SMALL_CHANGE_S:
            break
    # In camera frames: target - center = R (point - its center) + translation.
    first_from_camera = np.eye(4)
    first_from_camera[:3, :3] = rotation
    first_from_camera[:3, 3] = translation + centers[0] - rotation @ centers[1]
    return CameraAlignment(np.linalg.inv(first_from_camera), offset, median)


def _center(tracks: Tracks) -> Array:
    valid = np.isfinite(tracks.positions).all(axis=-1)
    center: Array = tracks.positions[valid].mean(axis=0)
    return center


def _rigid(points: Array, targets: Array, weights: Array) -> tuple[Array, Array]:
    """Return the rotation and translation that move points closest to targets."""
    flat = weights.ravel()[:, np.newaxis]
    total = flat.sum()
    points, targets = points.reshape(-1, 3), targets.reshape(-1, 3)
    centers = (flat * points).sum(axis=0) / total, (flat * targets).sum(axis=0) / total
    rotation = nearest_rotations((flat * (targets - centers[1])).T @ (points - centers[0]))[0]
    return rotation, centers[1] - rotation @ centers[0]
