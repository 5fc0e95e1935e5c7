"""A library of distinct clean poses that shows how natural bodies stand and move."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...archives import ArchiveLayout
from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import Motion, resample
from ...motion.humanoid import (
    N_JOINTS,
    bone_directions,
    mirror_postures,
    normalize_postures,
    postures_from_motion,
    rates_from_directions,
)
from ...npz_members import integers, words
from ...progress import Progress, unwatched, within
from ...settings import Settings, setting
from ..joint_rotations import N_TWISTED_LIMBS, mirror_twists
from .clip_twists import ClipTwists, combine_clip_twists, read_clip_twists
from .posture_groups import group_postures
from .subsample import subsample_postures

SHIPPED_LIBRARY = Path(__file__).parent / "postures.npz"
DIRECTION_STEP = 1.0 / 500.0
"""Ratio: step of stored components of unit vectors. By definition of the file format."""
CHANGE_STEP = 1.0 / 8.0
"""Step in which their changes are stored, a ratio per second. By definition of the file
format."""
TWIST_STEP = 1.0 / 127.0
"""Step in which cosines and sines of twists are stored, a ratio. By definition of the file
format."""
LAYOUT = ArchiveLayout(
    "posture library",
    1,
    {
        "directions": integers("postures", N_JOINTS - 1, 3),
        "changes": integers("postures", N_JOINTS - 1, 3, minimum=-128, maximum=127),
        "groups": integers("postures", minimum=0),
        "n_seen": integers(minimum=0),
        "trained_on": words(),
        "twists": integers(
            "postures", N_TWISTED_LIMBS, 2, minimum=-128, maximum=127, optional=True
        ),
    },
    holds="damaged postures",
    remedy="Build them again.",
)
PACE_S = 0.1
"""Seconds that convert velocity differences of poses to distances, where clips are thinned out.
Sweep: from x0.001 to x1000 0.02 %. The shipped library was made with it."""
MAX_LENGTH_ERROR = 0.05
"""Ratio by which a direction's length may differ from 1. It guards damaged files."""


@dataclass(frozen=True, kw_only=True)
class PostureLibrarySettings(Settings):
    """Settings of `build_posture_library`."""

    frame_rate: float = setting(
        15.0, "Poses sampled per second of a clip; more captures faster movements",
        unit="Hz", minimum=1.0, maximum=120.0,
    )  # fmt: skip
    spacing: float = setting(
        0.01, "Minimum distance between two kept poses, as a mean over joints; higher keeps"
        " fewer", unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    n_postures: int = setting(
        2500, "Maximum number of poses, the most distinct ones; more covers more and is slower",
        minimum=1, maximum=1_000_000,
    )  # fmt: skip
    mirror: bool = setting(True, "Also learn the mirror image of each pose")


@dataclass(frozen=True, eq=False)
class PostureLibrary:
    """Poses without heading, position and body size.

    Attributes
    ----------
    directions : float32, shape (n_postures, 20, 3)
        Unit vectors from the joint above to each of `POSTURE_JOINTS`, in an actor who faces -Y
        with his left at +X; zero for the hips.
    changes : float32, shape (n_postures, 20, 3)
        How the directions change, per second.
    groups : int32, shape (n_postures,)
        Index of the group of similar poses that each belongs to.
    n_seen : int
        Number of poses of the clips before subsampling.
    trained_on : str
        Description of the source clips.
    twists : complex64, shape (n_postures, 4), optional
        Axial rotations of upper arms and thighs relative to the trunk (`LimbTwists.vectors`).
        None in files that were written before twists were stored.
    """

    directions: NDArray[np.float32]
    changes: NDArray[np.float32]
    groups: NDArray[np.int32]
    n_seen: int
    trained_on: str = ""
    twists: NDArray[np.complex64] | None = None

    @property
    def n_postures(self) -> int:
        """Number of poses."""
        return len(self.directions)

    @property
    def twists_or_zero(self) -> NDArray[np.complex64]:
        """Twists, shape (n_postures, 4); 0 where they are unknown."""
        if self.twists is None:
            return np.zeros((self.n_postures, N_TWISTED_LIMBS), np.complex64)
        return self.twists

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_posture_library` reads."""
        arrays = {
            "directions": np.round(self.directions[:, 1:] / DIRECTION_STEP).astype(np.int16),
            "changes": np.clip(np.round(self.changes[:, 1:] / CHANGE_STEP), -127, 127).astype(
                np.int8
            ),
            "groups": self.groups,
            "n_seen": np.array(self.n_seen),
            "trained_on": np.array(self.trained_on),
        }
        if self.twists is not None:
            parts = np.stack([self.twists.real, self.twists.imag], axis=-1)
            arrays["twists"] = np.round(parts / TWIST_STEP).astype(np.int8)
        LAYOUT.write(path, arrays)


def load_posture_library(path: Path | str = SHIPPED_LIBRARY) -> PostureLibrary:
    """Read an archive that `PostureLibrary.save` wrote; by default the shipped library.

    Older files without twists are read too. Limbs then get their axial rotation from flexion
    only.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = LAYOUT.read(path)
    if fault := _find_fault(arrays):
        raise LAYOUT.damaged(path, fault)
    directions, changes = (
        np.pad(arrays[name] * np.float32(step), ((0, 0), (1, 0), (0, 0)))
        for name, step in (("directions", DIRECTION_STEP), ("changes", CHANGE_STEP))
    )
    sizes = np.linalg.norm(directions[:, 1:], axis=-1, keepdims=True)
    directions[:, 1:] /= sizes
    twists = None
    if "twists" in arrays:
        parts = arrays["twists"] * np.float32(TWIST_STEP)
        twists = (parts[..., 0] + 1j * parts[..., 1]).astype(np.complex64)
    return PostureLibrary(
        directions, changes, arrays["groups"], int(arrays["n_seen"]),
        str(arrays["trained_on"]), twists,
    )  # fmt: skip


def merge_posture_libraries(
    first: PostureLibrary, second: PostureLibrary, words: str = "{}, and {}"
) -> PostureLibrary:
    """Return a library of the poses of two; `words` formats the description of both sources."""
    directions = np.concatenate([first.directions, second.directions])
    has_twists = first.twists is not None or second.twists is not None
    return PostureLibrary(
        directions,
        np.concatenate([first.changes, second.changes]),
        group_postures(directions),
        first.n_seen + second.n_seen,
        words.format(first.trained_on, second.trained_on),
        np.concatenate([first.twists_or_zero, second.twists_or_zero]) if has_twists else None,
    )


def _find_fault(arrays: dict[str, NDArray[Any]]) -> str:
    """Return why the arrays of a file cannot be used, or an empty string."""
    if not len(arrays["directions"]):
        return "it holds no poses"
    if (arrays["groups"] >= len(arrays["groups"])).any():
        return "groups has indices out of range"
    sizes = np.linalg.norm(arrays["directions"] * DIRECTION_STEP, axis=-1)
    is_unit = np.abs(sizes - 1.0) < MAX_LENGTH_ERROR
    return "" if is_unit.all() else "directions are not of length 1"


def build_posture_library(
    motions: Sequence[Motion],
    *,
    settings: PostureLibrarySettings = PostureLibrarySettings(),
    trained_on: str = "",
    progress: Progress = unwatched,
) -> PostureLibrary:
    """Collect the poses of clean clips, and keep the most distinct ones.

    As in the motion database of [SHJT13]_, heading and position are removed, and poses too
    similar to a kept one are dropped. The neighbors of a pose then show how it may vary. The
    library stores bone directions, so that the recorded actor's bone lengths can be applied
    later. Unlike the paper, the distance between two poses includes their velocities
    (`PACE_S`).

    Parameters
    ----------
    motions : sequence of Motion
        Clean clips. Skeletons may differ; each needs hips, arms and legs.
    settings : PostureLibrarySettings
    trained_on : str
        Description of the clips, stored with the library.
    progress : Progress

    Returns
    -------
    PostureLibrary
        The most distinct poses first.

    Raises
    ------
    InvalidMotionError
        There is no clip, or a skeleton lacks hips, arms or legs.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [SHJT13] Shum, Ho, Jiang, Takagi (2013). Real-time posture reconstruction for Microsoft
       Kinect. IEEE Transactions on Cybernetics 43(5), section V-A.
    """
    if not motions:
        raise InvalidMotionError("There are no clips to learn poses from. Choose clean clips.")
    clips = []
    for index, motion in enumerate(motions):
        progress(0.5 * index / len(motions), "Reading poses")
        clips.append(_read_clip(motion, settings))
    directions, changes = (np.concatenate([each[part] for each in clips]) for part in (0, 1))
    twists_of_clips = [each[2] for each in clips]
    clip_twist_vectors = combine_clip_twists(
        [motion.skeleton for motion in motions], twists_of_clips
    )
    twists = np.concatenate([
        _with_mirror_images(each, mirror_twists, settings) for each in clip_twist_vectors
    ])
    complete = np.isfinite(directions).all(axis=(1, 2)) & np.isfinite(changes).all(axis=(1, 2))
    directions, changes, twists = directions[complete], changes[complete], twists[complete]
    if not len(directions):
        raise InvalidMotionError("No pose of the clips is complete. Fill their gaps first.")
    kept = subsample_postures(
        np.concatenate([directions, PACE_S * changes], axis=1),
        settings.n_postures,
        settings.spacing,
        within(progress, 0.5, 1.0),
    )
    single = directions[kept].astype(np.float32)
    return PostureLibrary(
        single, changes[kept].astype(np.float32), group_postures(single), len(directions),
        trained_on, twists[kept].astype(np.complex64),
    )  # fmt: skip


def _read_clip(
    motion: Motion, settings: PostureLibrarySettings
) -> tuple[Array, Array, ClipTwists]:
    """Return directions and changes, also mirrored, and the twists of a clip."""
    fine = max(settings.frame_rate, min(motion.frame_rate, 2.0 / PACE_S))
    if abs(motion.frame_rate - fine) > 1e-6:
        motion = resample(motion, fine)
    positions = postures_from_motion(motion)
    directions = bone_directions(normalize_postures(positions, fine).postures)
    changes = rates_from_directions(directions, fine)
    step = max(round(fine / settings.frame_rate), 1)
    twists = read_clip_twists(motion, positions)
    return (
        _with_mirror_images(directions[::step], mirror_postures, settings),
        _with_mirror_images(changes[::step], mirror_postures, settings),
        ClipTwists(
            twists.from_rotations[::step],
            twists.from_flexion[::step],
            twists.flexion_fractions[::step],
        ),
    )


def _with_mirror_images(
    values: NDArray[Any],
    mirror: Callable[[NDArray[Any]], NDArray[Any]],
    settings: PostureLibrarySettings,
) -> NDArray[Any]:
    """Append the mirror images of values if the settings ask for them."""
    return np.concatenate([values, mirror(values)]) if settings.mirror else values
