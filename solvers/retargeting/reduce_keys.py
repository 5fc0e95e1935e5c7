"""Unbake: replace a key on every frame with few keys and handles."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..archives import ArchiveLayout
from ..errors import InvalidMotionError, InvalidSettingError
from ..motion import Motion, Skeleton
from ..npz_members import MAX_BYTES, integers, numbers, quaternions, words
from ..progress import Progress, unwatched, within
from ..rotations import IDENTITY
from ..settings import Settings, setting
from .key_curves import KeyCurve
from .key_thinning import ROOT, Thinning
from .rotation_channels import RotationChannels

MAX_FRAMES = 10_000_000
"""Limit of a file: more than a day at 100 Hz."""
BYTES_PER_POSE = 32
"""Of a quaternion in double precision, by definition."""
LAYOUT = ArchiveLayout(
    "keys of a motion",
    1,
    {
        "names": words("joints"),
        "parents": integers("joints", minimum=-1),
        "offsets": numbers("joints", 3),
        "counts": integers("curves", minimum=0),
        "frames": integers("keys", minimum=0, maximum=MAX_FRAMES),
        "rotations": numbers("values"),
        "turning": numbers("values"),
        "orders": words("joints"),
        "axes": quaternions("joints"),
        "places": numbers("places", 3),
        "moving": numbers("places", 3),
        "length": numbers(3),
    },
    holds="an incomplete set of keys",
    remedy="Unbake again.",
)


@dataclass(frozen=True, kw_only=True)
class UnbakeSettings(Settings):
    """Settings of the reduction of keys."""

    key_poses: bool = setting(
        False,
        "Key all joints at the same frames, as in pose-to-pose animation; needs more keys",
    )


@dataclass(frozen=True, eq=False)
class SparseMotion:
    """A motion with few keys.

    Attributes
    ----------
    skeleton : Skeleton
    rotations : tuple of KeyCurve, one for each joint
        In the joint's channels; without keys for joints that stay in the rest pose. Between
        keys a quaternion is that of the four curves, normalized.
    channels : tuple of RotationChannels, one for each joint
    root : KeyCurve
        Root positions, three channels, meters.
    n_frames : int
    frame_rate : float, hertz
    error : float, meters
        Maximum error of any joint at any frame; not between frames.
    """

    skeleton: Skeleton
    rotations: tuple[KeyCurve, ...]
    channels: tuple[RotationChannels, ...]
    root: KeyCurve
    n_frames: int
    frame_rate: float
    error: float

    @property
    def n_keys(self) -> int:
        """Number of keys, each channel counted, as Blender's Graph Editor does."""
        curves = (*self.rotations, self.root)
        return sum(curve.values.size for curve in curves)

    def save(self, path: Path | str) -> None:
        """Save as npz, atomically; `load_sparse_motion` reads it.

        Raises
        ------
        InvalidMotionError
            The motion is too long to be loaded again.
        """
        if self.n_frames > _max_frames(self.skeleton):
            raise InvalidMotionError(
                f"{self.n_frames:,} frames of {self.skeleton.n_joints:,} joints cannot be saved"
                " as keys. Unbake a shorter part."
            )
        curves = (*self.rotations, self.root)
        arrays = {
            "names": np.array(self.skeleton.names),
            "parents": np.array(self.skeleton.parents),
            "offsets": self.skeleton.offsets,
            "counts": np.array([len(curve.frames) for curve in curves]),
            "frames": np.concatenate([curve.frames for curve in curves]),
            "rotations": np.concatenate([curve.values.ravel() for curve in self.rotations]),
            "turning": np.concatenate([curve.slopes.ravel() for curve in self.rotations]),
            "orders": np.array([each.order for each in self.channels]),
            "axes": np.array([each.axes for each in self.channels]),
            "places": self.root.values,
            "moving": self.root.slopes,
            "length": np.array([self.n_frames, self.frame_rate, self.error]),
        }
        LAYOUT.write(path, arrays)

    def dense(self) -> Motion:
        """Return the motion with a pose at every frame, as F-Curves evaluate it.

        Raises
        ------
        InvalidMotionError
            At a frame the quaternion of a joint is zero, so that it is no rotation.
        """
        frames = np.arange(self.n_frames)
        rotations = np.tile(IDENTITY, (self.n_frames, self.skeleton.n_joints, 1))
        for joint, (curve, each) in enumerate(zip(self.rotations, self.channels, strict=True)):
            if len(curve.frames):
                rotations[:, joint] = each.to_rotations(curve.at(frames))
        if not np.isfinite(rotations).all():
            raise InvalidMotionError("A joint has keys that are no rotations. Unbake again.")
        return Motion(self.skeleton, rotations, self.root.at(frames), self.frame_rate)


def _max_frames(skeleton: Skeleton) -> int:
    return min(MAX_FRAMES, MAX_BYTES // (BYTES_PER_POSE * skeleton.n_joints))


def load_sparse_motion(path: Path | str) -> SparseMotion:
    """Load a motion that `SparseMotion.save` saved.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or not an archive of keys.
    """
    arrays = LAYOUT.read(path)
    try:
        return _motion_from_arrays(arrays)
    except InvalidMotionError as error:
        raise LAYOUT.damaged(path, str(error).removesuffix(".")) from None


def _motion_from_arrays(arrays: dict[str, NDArray[Any]]) -> SparseMotion:
    """Build the motion from the arrays of a file; raises InvalidMotionError if they differ."""
    skeleton = Skeleton(
        tuple(arrays["names"].tolist()), tuple(arrays["parents"].tolist()), arrays["offsets"]
    )
    channels = tuple(
        RotationChannels(str(order), axes)
        for order, axes in zip(arrays["orders"], arrays["axes"], strict=True)
    )
    counts, lengths = arrays["counts"].tolist(), arrays["length"].tolist()
    widths = np.array([3 if each.order else 4 for each in channels], dtype=np.intp)
    n_frames, frame_rate, error = int(lengths[0]), lengths[1], lengths[2]
    if (
        len(counts) != skeleton.n_joints + 1
        or sum(counts) != len(arrays["frames"])
        or counts[-1] != len(arrays["places"])
        or arrays["counts"][:-1] @ widths != len(arrays["rotations"])
    ):
        raise InvalidMotionError("The keys do not fit the joints.")
    if not 0 < n_frames <= _max_frames(skeleton) or frame_rate <= 0.0 or not counts[-1]:
        raise InvalidMotionError("The motion length is invalid.")
    frames = np.split(arrays["frames"], np.cumsum(counts)[:-1])
    if any((np.diff(keys) <= 0).any() for keys in frames):
        raise InvalidMotionError("The frames of the keys are not in ascending order.")
    stops = np.cumsum(arrays["counts"][:-1] * widths)[:-1]
    parts = zip(
        frames[:-1],
        np.split(arrays["rotations"], stops),
        np.split(arrays["turning"], stops),
        widths.tolist(),
        strict=True,
    )
    curves = tuple(
        KeyCurve(keys, values.reshape(-1, width), slopes.reshape(-1, width))
        for keys, values, slopes, width in parts
    )
    root = KeyCurve(frames[-1], arrays["places"], arrays["moving"])
    return SparseMotion(skeleton, curves, channels, root, n_frames, frame_rate, error)


def reduce_keys(
    motion: Motion,
    tolerance: float,
    *,
    channels: Sequence[RotationChannels] | None = None,
    settings: UnbakeSettings = UnbakeSettings(),
    progress: Progress = unwatched,
) -> SparseMotion:
    """Replace a key on every frame with few keys, within the tolerance at every frame.

    Each joint's curves are a least-squares fit of the values and slopes of their keys. First,
    the curves of each joint alone are split until the error of its descendants is a small
    multiple of the tolerance. Then, wherever the error of a joint exceeds the tolerance, the
    ancestor with the largest contribution gets another key, until all are within it. This is
    the splitting of [1]_ at the middle of the worst segment, with errors in world space.

    Parameters
    ----------
    motion : Motion
        Without gaps.
    tolerance : float, meters
        Maximum error of any joint at any frame. For a hand, foot or head without further
        joints, it also applies to two points that show its rotation.
    channels : sequence of RotationChannels, one for each joint
        How the rig keys its rotations; by default as quaternions in the world's axes.
    settings : UnbakeSettings
    progress : Progress

    Returns
    -------
    SparseMotion

    Raises
    ------
    InvalidMotionError
        The motion has gaps, or there are not as many channels as joints.
    InvalidSettingError
        The tolerance is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Schneider (1990). An algorithm for automatically fitting digitized curves. Graphics
       Gems, 612-626.
    """
    channels = tuple(channels or [RotationChannels()] * motion.n_joints)
    _check(motion, tolerance, len(channels))
    thinning = Thinning(motion, tolerance, channels, together=settings.key_poses)
    thinning.begin(within(progress, 0.0, 0.3))
    error = thinning.finish(within(progress, 0.3, 1.0))
    progress(1.0, "Unbaked")
    return SparseMotion(
        motion.skeleton,
        tuple(thinning.curves[joint] for joint in range(motion.n_joints)),
        channels,
        thinning.curves[ROOT],
        motion.n_frames,
        motion.frame_rate,
        error,
    )


def _check(motion: Motion, tolerance: float, n_channels: int) -> None:
    if n_channels != motion.n_joints:
        raise InvalidMotionError(
            f"{motion.n_joints} joints need as many rotation channels, not {n_channels}."
        )
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise InvalidSettingError(f"A tolerance of {tolerance} m is not positive.")
    gaps = ~motion.observed
    if gaps.any():
        names = [motion.skeleton.names[joint] for joint in np.flatnonzero(gaps.any(axis=0))]
        raise InvalidMotionError(
            "Only keys of a motion without gaps can be reduced; these joints have gaps:"
            f" {', '.join(names)}. Clean the take first."
        )
