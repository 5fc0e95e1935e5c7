"""Learn which movements over two thirds of a second belong together."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from ..errors import InvalidFileError, InvalidMotionError
from ..files import read_archive, write_archive
from ..motion import Motion, Tracks
from ..progress import Progress, unwatched
from ..settings import Settings, setting
from .channels import Channels
from .channels_motion import encode_motion
from .channels_tracks import encode_tracks
from .noise import interpolated

Array = NDArray[np.float64]

KIND = "filter bases"
VERSION = 1
KEPT_ENERGY = 0.9995
FIRST_GUESS = 240
STILL = 0.05
"""Standard deviation, degrees or centimetres, below which a channel does not move."""


@dataclass(frozen=True, kw_only=True)
class FilterBasesSettings(Settings):
    """How movement patterns are learned."""

    window: float = setting(
        20 / 30, "Length of the patterns; longer ones know more of the course of a movement",
        unit="s", minimum=0.1, maximum=3.0,
    )  # fmt: skip
    frame_rate: float = setting(
        30.0, "Rate at which patterns are stored; higher keeps faster movements",
        unit="Hz", minimum=5.0, maximum=240.0, advanced=True,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class FilterBases:
    """Movement patterns: eigenvectors of the lag covariance of clean recordings.

    Attributes
    ----------
    keys : tuple of str, length n_parts
    references : shape (n_parts, 4)
        Mean rotation, or mean position followed by 0, that each part is told relative to.
    mean : shape (n_parts * 3,)
    vectors : shape (n_bases, window, n_parts * 3)
        Orthonormal patterns, strongest first.
    values : shape (n_bases,)
        Mean square of each pattern's weight, degrees or centimetres squared.
    frame_rate : float, hertz
    n_clips : int
    """

    keys: tuple[str, ...]
    references: Array
    mean: Array
    vectors: Array
    values: Array
    frame_rate: float
    n_clips: int
    of_points: bool

    @property
    def window(self) -> int:
        """Length of the patterns, frames."""
        return self.vectors.shape[1]

    @property
    def reference_of(self) -> dict[str, Array]:
        """Mean rotation or position of each key."""
        width = 3 if self.of_points else 4
        return {key: row[:width] for key, row in zip(self.keys, self.references, strict=True)}

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_filter_bases` reads."""
        arrays = {
            "keys": np.array(self.keys),
            "references": self.references,
            "mean": self.mean,
            "vectors": self.vectors,
            "values": self.values,
            "frame_rate": np.array(self.frame_rate),
            "n_clips": np.array(self.n_clips),
            "of_points": np.array(self.of_points),
        }
        write_archive(path, KIND, VERSION, arrays)


def load_filter_bases(path: Path | str) -> FilterBases:
    """Read what `FilterBases.save` wrote.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = read_archive(path, KIND, VERSION)
    try:
        bases = FilterBases(
            tuple(str(key) for key in arrays["keys"]),
            arrays["references"],
            arrays["mean"],
            arrays["vectors"],
            arrays["values"],
            float(arrays["frame_rate"]),
            int(arrays["n_clips"]),
            bool(arrays["of_points"]),
        )
        fault = _fault(bases)
    except (KeyError, TypeError, ValueError) as error:
        fault = str(error)
    if fault:
        raise InvalidFileError(
            f"{path} holds damaged filter bases ({fault}). Learn them again."
        )
    return bases


def _fault(bases: FilterBases) -> str:
    """Return what keeps bases from a file from being used, or nothing."""
    n_keys, n_bases = len(bases.keys), len(bases.values)
    expected = ((n_keys, 4), (3 * n_keys,), (n_bases,))
    arrays = (bases.references, bases.mean, bases.values)
    patterns = (n_bases, *bases.vectors.shape[1:2], 3 * n_keys)
    if (*(array.shape for array in arrays), bases.vectors.shape) != (*expected, patterns):
        return "their shapes do not fit"
    if not all(np.isfinite(array).all() for array in (*arrays, bases.vectors)):
        return "not all numbers are finite"
    return "" if 0.0 < bases.frame_rate < np.inf else f"a frame rate of {bases.frame_rate:g} Hz"


def learn_filter_bases(
    examples: Sequence[Motion | Tracks],
    *,
    settings: FilterBasesSettings = FilterBasesSettings(),
    progress: Progress = unwatched,
) -> FilterBases:
    """Learn filter bases from clean recordings by multichannel singular spectrum analysis.

    The eigenvectors of the lag covariance of all channels [1]_. The covariance comes from a
    recursion over lags, clip by clip, so the matrix of all windows is never built.

    Parameters
    ----------
    examples : sequence of Motion or Tracks
        Of one kind, with the same joints or points. Gaps are bridged by straight lines.
    settings : FilterBasesSettings
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There is no example, kinds are mixed, or no example is as long as the window.

    References
    ----------
    .. [1] Lou, Chai (2010). Example-based human motion denoising. IEEE TVCG 16(5), section 2.
    """
    if not examples:
        raise InvalidMotionError("There is no example to learn from; choose clean clips.")
    if len({type(example) for example in examples}) > 1:
        raise InvalidMotionError("Learn from motions or from tracks, not from both at once.")
    window = max(round(settings.window * settings.frame_rate), 2)
    references: dict[str, Array] = {}
    keys: tuple[str, ...] = ()
    clips = []
    for index, example in enumerate(examples):
        channels = encode(example, references)
        keys = keys or channels.keys
        references = references or dict(channels.references)
        clips += phases(_columns(channels, keys), example.frame_rate, settings.frame_rate)
        progress(0.8 * (index + 1) / len(examples), "Reading examples")
    clips = [clip for clip in clips if len(clip) >= window]
    if not clips:
        raise InvalidMotionError(
            f"No example is as long as the window of {settings.window:.2g} s; choose longer."
        )
    mean = np.concatenate(clips).mean(axis=0)
    n_windows = sum(len(clip) - window + 1 for clip in clips)
    spread = np.concatenate(clips).std(axis=0)
    moving = np.flatnonzero(spread > min(STILL, spread.max() / 2))
    covariance = sum(lag_products(clip[:, moving] - mean[moving], window) for clip in clips)
    values, vectors = strongest(np.asarray(covariance) / n_windows, KEPT_ENERGY)
    patterns = np.zeros((len(values), window, len(mean)))
    patterns[:, :, moving] = vectors.T.reshape(len(values), window, len(moving))
    progress(1.0, "Learned")
    rows = [np.append(references[key], 0.0)[:4] for key in keys]
    return FilterBases(
        keys, np.array(rows), mean, patterns, values,
        settings.frame_rate, len(examples), isinstance(examples[0], Tracks),
    )  # fmt: skip


def strongest(covariance: Array, energy: float) -> tuple[Array, Array]:
    """Return the largest eigenvalues that hold this share of the trace, and their vectors."""
    size, total = len(covariance), float(np.trace(covariance))
    wanted = min(size, FIRST_GUESS)
    while True:
        values, vectors = eigh(covariance, subset_by_index=(size - wanted, size - 1))
        values, vectors = np.maximum(values[::-1], 0.0), vectors[:, ::-1]
        enough = int(np.searchsorted(np.cumsum(values), energy * total)) + 1
        if enough <= wanted or wanted == size:
            return values[:enough], vectors[:, :enough]
        wanted = min(2 * wanted, size)


def lag_products(values: Array, window: int) -> Array:
    """Return the sum over all windows of the outer product of a window with itself.

    The block of lags (j + 1, k + 1) is that of (j, k) without its first frame and with one
    more at the end, so only the first row of blocks costs a pass over the frames.

    Parameters
    ----------
    values : shape (n_frames, n_channels)
    window : int, frames

    Returns
    -------
    Array
        Shape (window * n_channels, window * n_channels), frames outermost.
    """
    n_frames, n_channels = values.shape
    n_windows = n_frames - window + 1
    blocks = np.empty((window, window, n_channels, n_channels))
    for lag in range(window):
        blocks[0, lag] = values[:n_windows].T @ values[lag : lag + n_windows]
    for row in range(window - 1):
        for column in range(row, window - 1):
            first = np.multiply.outer(values[row], values[column])
            last = np.multiply.outer(values[row + n_windows], values[column + n_windows])
            blocks[row + 1, column + 1] = blocks[row, column] - first + last
    for row in range(window):
        for column in range(row):
            blocks[row, column] = blocks[column, row].T
    size = window * n_channels
    return blocks.transpose(0, 2, 1, 3).reshape(size, size)


def encode(
    recording: Motion | Tracks, references: Mapping[str, Array] | None = None
) -> Channels:
    """Turn a recording of either kind into channels."""
    if isinstance(recording, Motion):
        return encode_motion(recording, references)
    return encode_tracks(recording, references)


def phases(values: Array, frame_rate: float, wanted: float) -> list[Array]:
    """Split channels into interleaved ones whose frame rate is about the wanted one."""
    step = min(max(round(frame_rate / wanted), 1), len(values))
    return [values[start::step] for start in range(step)]


def _columns(channels: Channels, keys: tuple[str, ...]) -> Array:
    """Put channels in the order of `keys`; NaN bridged, 0 where a key is missing."""
    place = {key: index for index, key in enumerate(channels.keys)}
    columns = np.zeros((len(channels.values), len(keys), 3))
    for index, key in enumerate(keys):
        if key in place:
            columns[:, index] = channels.values[:, place[key]]
    return interpolated(columns.reshape(len(columns), -1))
