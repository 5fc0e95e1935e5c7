"""Unbake: replace a key on every frame by few keys with handles."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import InvalidFileError, InvalidMotionError, InvalidSettingError
from ..files import read_archive, write_archive
from ..motion import Motion, Skeleton
from ..motion.rotations import IDENTITY, normalize
from ..progress import Progress, unwatched, within
from ..settings import Settings, setting
from .key_curves import KeyCurve
from .thinning import ROOT, Thinning

KIND, VERSION = "keys of a motion", 1


@dataclass(frozen=True, kw_only=True)
class UnbakeSettings(Settings):
    """How keys are thinned out."""

    key_poses: bool = setting(
        False, "Key all joints at the same frames, as an animator blocks poses; takes more keys"
    )


@dataclass(frozen=True, eq=False)
class SparseMotion:
    """A motion by few keys.

    Attributes
    ----------
    skeleton : Skeleton
    rotations : tuple of KeyCurve, one for each joint
        Local quaternions, four channels w x y z; without keys for joints that rest throughout.
        Between keys the quaternion is that of the four curves, brought to length one.
    root : KeyCurve
        Root positions, three channels, metres.
    n_frames : int
    frame_rate : float, hertz
    error : float, metres
        By how much any end of a limb is off at most.
    """

    skeleton: Skeleton
    rotations: tuple[KeyCurve, ...]
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
        """Save as npz, whole or not at all; `load_sparse_motion` reads it."""
        curves = (*self.rotations, self.root)
        arrays = {
            "names": np.array(self.skeleton.names),
            "parents": np.array(self.skeleton.parents),
            "offsets": self.skeleton.offsets,
            "counts": np.array([len(curve.frames) for curve in curves]),
            "frames": np.concatenate([curve.frames for curve in curves]),
            "rotations": np.concatenate([curve.values for curve in self.rotations]),
            "turning": np.concatenate([curve.slopes for curve in self.rotations]),
            "places": self.root.values,
            "moving": self.root.slopes,
            "length": np.array([self.n_frames, self.frame_rate, self.error]),
        }
        write_archive(path, KIND, VERSION, arrays)

    def dense(self) -> Motion:
        """Return the motion with a pose at every frame, as F-Curves would give it."""
        frames = np.arange(self.n_frames)
        rotations = np.tile(IDENTITY, (self.n_frames, self.skeleton.n_joints, 1))
        for joint, curve in enumerate(self.rotations):
            if len(curve.frames):
                rotations[:, joint] = normalize(curve.at(frames))
        return Motion(self.skeleton, rotations, self.root.at(frames), self.frame_rate)


def load_sparse_motion(path: Path | str) -> SparseMotion:
    """Load what `SparseMotion.save` saved.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = read_archive(path, KIND, VERSION)
    try:
        skeleton = Skeleton(
            tuple(arrays["names"].tolist()), tuple(arrays["parents"]), arrays["offsets"]
        )
        stops = np.cumsum(arrays["counts"])[:-1]
        frames = np.split(arrays["frames"], stops)
        parts = zip(
            frames[:-1],
            np.split(arrays["rotations"], stops[:-1]),
            np.split(arrays["turning"], stops[:-1]),
            strict=True,
        )
        curves = tuple(KeyCurve(*part) for part in parts)
        root = KeyCurve(frames[-1], arrays["places"], arrays["moving"])
        n_frames, frame_rate, error = arrays["length"].tolist()
        sparse = SparseMotion(skeleton, curves, root, int(n_frames), frame_rate, error)
        sparse.dense()
    except (KeyError, ValueError, IndexError, TypeError) as fault:
        raise InvalidFileError(f"{path} holds no whole set of keys ({fault}).") from None
    return sparse


def reduce_keys(
    motion: Motion,
    tolerance: float,
    *,
    settings: UnbakeSettings = UnbakeSettings(),
    progress: Progress = unwatched,
) -> SparseMotion:
    """Replace a key on every frame by few keys, no end of a limb being off by more.

    Each joint's curves are fitted by least squares through their keys, values and slopes. At
    first a joint gets keys until it alone moves the ends of its limbs by less than half the
    tolerance; then, wherever an end of a limb is off by more than the tolerance, the joint
    above it that does most of that gets another key, until none is. This is the splitting of
    [1]_ with the error measured where it is seen, at hands, feet and head.

    Parameters
    ----------
    motion : Motion
        Without gaps.
    tolerance : float, metres
        Greatest distance by which an end may be off: the ends of the tree, and points that
        show how hands and feet without further joints are turned.
    settings : UnbakeSettings
    progress : Progress

    Returns
    -------
    SparseMotion

    Raises
    ------
    InvalidMotionError
        The motion has gaps.
    InvalidSettingError
        The tolerance is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Schneider (1990). An algorithm for automatically fitting digitized curves. Graphics
       Gems, 612-626.
    """
    _check(motion, tolerance)
    thinning = Thinning(motion, tolerance, settings.key_poses)
    thinning.begin(within(progress, 0.0, 0.3))
    error = thinning.finish(within(progress, 0.3, 1.0))
    progress(1.0, "Unbaked")
    return SparseMotion(
        motion.skeleton,
        tuple(thinning.curves[joint] for joint in range(motion.n_joints)),
        thinning.curves[ROOT],
        motion.n_frames,
        motion.frame_rate,
        error,
    )


def _check(motion: Motion, tolerance: float) -> None:
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise InvalidSettingError(f"A tolerance of {tolerance} m is not positive.")
    gaps = ~motion.observed
    if gaps.any():
        names = [motion.skeleton.names[joint] for joint in np.flatnonzero(gaps.any(axis=0))]
        raise InvalidMotionError(
            "Keys can be thinned out only where all is known; these have gaps:"
            f" {', '.join(names)}. Clean the take first."
        )
