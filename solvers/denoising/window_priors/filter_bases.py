"""Learn the patterns of movement in windows of two thirds of a second."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...archives import ArchiveLayout
from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import Motion, Tracks
from ...npz_members import (
    are_covariances,
    are_unit_vectors,
    flags,
    integers,
    numbers,
    words,
)
from ...progress import Progress, unwatched, within
from ...settings import Settings, setting
from ..channels import BODY_POSITION, ExampleChannels, Moments
from .lag_covariance import LagCovariance, find_leading_eigenpairs
from .window_prior import count_slow_coefficients
from .windows import Windows

KEPT_ENERGY = 0.99
"""Fraction of the movement that the stored patterns contain, as in [LC10]."""
MIN_CHANNEL_DEVIATION = 0.05
"""Standard deviation, degrees or centimeters, below which a channel does not move. It guards
against channels without any pattern: x0.001 costs 0.7 %, x1000 costs 11.4 %."""
MIN_ANY_DEVIATION = 1e-6
"""Degrees or centimeters: the same where no channel moves; smaller values are rounding
errors."""
N_REFERENCE = 12
"""Numbers stored of the reference of a channel, by definition of the file."""
MIN_RATE_HZ, MAX_RATE_HZ, MAX_WINDOW_S = 5.0, 240.0, 3.0
"""Hertz, hertz and seconds: limits of the settings. They bound the run time of Clean."""
MIN_EIGENVALUE_RATIO = -1e-9
"""Fraction of the largest element of a covariance. By definition the rounding of a sum of many
windows in double precision."""
LAYOUT = ArchiveLayout(
    "filter bases",
    3,
    {
        "keys": words("parts"),
        "references": numbers("parts", N_REFERENCE),
        "mean": numbers("3*parts"),
        "vectors": numbers("bases", "window", "3*parts"),
        "values": numbers("bases", minimum=0.0),
        "moving": integers("moving", minimum=0),
        "slow": numbers("slow", "moving", "slow", "moving"),
        "fast": numbers("fast", "moving", minimum=0.0),
        "clip_means": numbers("pieces", "moving"),
        "frame_rate": numbers(),
        "n_clips": integers(minimum=1),
        "of_points": flags(),
    },
    holds="damaged bases",
    remedy="Learn them again.",
)


@dataclass(frozen=True, kw_only=True)
class FilterBasesSettings(Settings):
    """Settings of `learn_filter_bases`."""

    window: float = setting(
        20 / 30, "Length of the motion patterns; longer patterns cover more of a movement",
        unit="s", minimum=0.1, maximum=MAX_WINDOW_S,
    )  # fmt: skip
    frame_rate: float = setting(
        30.0, "Frame rate of the stored patterns; higher keeps faster movements",
        unit="Hz", minimum=MIN_RATE_HZ, maximum=MAX_RATE_HZ, advanced=True,
    )  # fmt: skip

    @property
    def n_frames(self) -> int:
        """Length of the patterns in frames."""
        return max(round(self.window * self.frame_rate), 2)


@dataclass(frozen=True, eq=False)
class FilterBases:
    """Patterns of clean recordings over a short window.

    Channels are degrees or centimeters; each part (joint, point or root position) has three.

    Attributes
    ----------
    keys : shape (n_parts,), str
        Names of the parts: humanoid roles or names.
    references : shape (n_parts, 12)
        Origin of each part's values (see `encode_motion`), padded with 0.
    mean : shape (n_parts * 3,)
    vectors : shape (n_bases, window, n_parts * 3)
        The filter bases of [LC10]: orthonormal patterns, strongest first, that contain 99 % of
        the movement.
    values : shape (n_bases,)
        Mean square of each pattern's weight.
    moving : shape (n_moving,), int
        Channels that move; the only ones in `slow` and `fast`.
    slow : shape (n_slow, n_moving, n_slow, n_moving)
        Covariance of the low-frequency DCT coefficients of a window about the mean of its
        clip: all patterns, however weak.
    fast : shape (window - n_slow, n_moving)
        Variances of the other coefficients.
    clip_means : shape (n_pieces, n_moving)
        Mean pose of each segment of an example; the mean of all for channels that it lacks.
    frame_rate : shape (), hertz
    n_clips : shape (), int
    of_points : shape (), bool
        Learned from tracks rather than from motions.
    """

    keys: NDArray[np.str_]
    references: Array
    mean: Array
    vectors: Array
    values: Array
    moving: NDArray[np.intp]
    slow: Array
    fast: Array
    clip_means: Array
    frame_rate: Array
    n_clips: NDArray[np.intp]
    of_points: NDArray[np.bool_]

    @property
    def window(self) -> int:
        """Length of the patterns, frames."""
        return int(self.vectors.shape[1])

    @property
    def reference_of(self) -> dict[str, Array]:
        """Mean rotation or position of each key."""
        return dict(zip(map(str, self.keys), self.references, strict=True))

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_filter_bases` reads."""
        LAYOUT.write(path, {one.name: getattr(self, one.name) for one in fields(self)})


def load_filter_bases(path: Path | str) -> FilterBases:
    """Read the archive that `FilterBases.save` wrote.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or contains something else.
    """
    bases = FilterBases(**LAYOUT.read(path))
    if fault := _fault(bases):
        raise LAYOUT.damaged(path, fault)
    return bases


def _fault(bases: FilterBases) -> str:
    """Return why bases from a file cannot be used, or nothing."""
    if not len(bases.clip_means) or not len(bases.slow):
        return "nothing was learned"
    n_slow = len(bases.slow)
    if not bases.vectors.size or len(bases.fast) != bases.window - n_slow:
        return "the shapes do not fit, first that of fast"
    rate = float(bases.frame_rate)
    if not MIN_RATE_HZ <= rate <= MAX_RATE_HZ:
        return f"a frame rate of {rate:g} Hz"
    if bases.window > round(MAX_WINDOW_S * rate):
        return f"their patterns are longer than {MAX_WINDOW_S:g} s"
    if len(set(bases.keys)) < len(bases.keys):
        return "a joint is there twice"
    if not set(bases.moving) <= set(range(len(bases.mean))):
        return "they refer to channels that do not exist"
    if not bases.of_points and not _are_rotations(
        bases.references[bases.keys != BODY_POSITION]
    ):
        return "the reference of a joint is not a rotation"
    slow = bases.slow.reshape(n_slow * len(bases.moving), -1)
    return "" if are_covariances(slow, MIN_EIGENVALUE_RATIO) else "slow is not a covariance"


def _are_rotations(references: Array) -> bool:
    """Return whether these are the three unit quaternions of each joint."""
    return are_unit_vectors(references.reshape(len(references), -1, 4))


def learn_filter_bases(
    examples: Sequence[Motion | Tracks],
    *,
    weights: Sequence[float] | None = None,
    settings: FilterBasesSettings = FilterBasesSettings(),
    progress: Progress = unwatched,
) -> FilterBases:
    """Learn filter bases from clean recordings by multichannel singular spectrum analysis.

    The bases are the eigenvectors of the lag covariance of all channels [1]_. A recursion over
    lags yields the covariance clip by clip, so the matrix of all windows is never built. Clips
    are encoded a minute at a time: many frames need no more memory than few. Rigs may differ
    if their joints have humanoid roles; clips without a joint do not affect it. No window spans
    a cut.

    Parameters
    ----------
    examples : sequence of Motion or Tracks
        All of one kind. Frame rates may differ; gaps are bridged by straight lines.
    weights : sequence of float, optional
        Weight of each example's frames, more than 0; equal if not given.
    settings : FilterBasesSettings
    progress : Progress

    Returns
    -------
    FilterBases
        Its keys are the joints or points of the first example.

    Raises
    ------
    InvalidMotionError
        There is no example, kinds are mixed, weights do not fit them, no example is as long
        as the window, or nothing in them moves.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Lou, Chai (2010). Example-based human motion denoising. IEEE TVCG 16(5), section 3.
    """
    normalized_weights = _normalize_weights(examples, weights)
    window = settings.n_frames
    channels = ExampleChannels(examples, settings.frame_rate, window, normalized_weights)
    moments = Moments(channels.n_channels)
    for weight, clips in channels.read(within(progress, 0.0, 0.4)):
        moments.add(clips, weight)
    if not len(moments.means):
        raise InvalidMotionError(
            f"No example is as long as the window of {settings.window:.2g} s; choose longer"
            " ones or a shorter window."
        )
    mean, spread = moments.total()
    if spread.max() < MIN_ANY_DEVIATION:
        raise InvalidMotionError(
            "Nothing that was observed in the examples moves; choose clips with movement."
        )
    moving = np.flatnonzero(spread >= min(MIN_CHANNEL_DEVIATION, spread.max()))
    around_common_mean, around_clip_means = (
        LagCovariance(len(moving), window) for _ in range(2)
    )
    reading = channels.read(within(progress, 0.4, 0.8))
    for (weight, clips), own in zip(reading, moments.means, strict=True):
        for clip in clips:
            around_common_mean.add(clip[:, moving], mean[moving], weight)
            around_clip_means.add(clip[:, moving], own[moving], weight)
    progress(0.8, "Finding patterns")
    values, vectors = find_leading_eigenpairs(around_common_mean.total(), KEPT_ENERGY)
    patterns = np.zeros((len(values), window, len(mean)))
    patterns[:, :, moving] = vectors.T.reshape(len(values), window, len(moving))
    slow, fast = _dct_covariance(around_clip_means.total(), window)
    progress(1.0, "Learned")
    rows = np.zeros((len(channels.keys), N_REFERENCE))
    for row, key in zip(rows, channels.keys, strict=True):
        row[: len(channels.references[key])] = channels.references[key]
    means = moments.means[:, moving]
    return FilterBases(
        np.array(channels.keys), rows, mean, patterns, values, moving, slow, fast,
        np.where(np.isfinite(means), means, mean[moving]),
        np.array(settings.frame_rate), np.array(len(examples)),
        np.array(isinstance(examples[0], Tracks)),
    )  # fmt: skip


def _normalize_weights(
    examples: Sequence[Motion | Tracks], weights: Sequence[float] | None
) -> tuple[float, ...]:
    """Return the weights of the examples, scaled to a mean of 1."""
    if not examples:
        raise InvalidMotionError("There is no example to learn from; choose clean clips.")
    if len({isinstance(example, Motion) for example in examples}) > 1:
        raise InvalidMotionError("Learn from motions or from tracks, not from both at once.")
    given = np.ones(len(examples)) if weights is None else np.array(weights, dtype=float)
    if given.shape != (len(examples),) or not (np.isfinite(given) & (given > 0.0)).all():
        raise InvalidMotionError(
            f"{given.size} weights for {len(examples)} examples; give each one above 0."
        )
    return tuple(map(float, given / given.mean()))


def _dct_covariance(covariance: Array, window: int) -> tuple[Array, Array]:
    """Return the covariance of the slow DCT coefficients, and the variances of the others."""
    n_channels = len(covariance) // window
    blocks = covariance.reshape(window, -1)
    basis = Windows(window, window, 1.0).dct_basis(window)
    halfway = (basis.T @ blocks).reshape(window, n_channels, window, n_channels)
    coefficients = np.asarray(basis.T @ halfway)
    n_slow = count_slow_coefficients(window)
    fast = np.einsum("kckc->kc", coefficients)[n_slow:]
    return coefficients[:n_slow, :, :n_slow].copy(), np.maximum(fast, 0.0)
