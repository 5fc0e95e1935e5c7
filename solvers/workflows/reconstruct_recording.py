"""Reconstruct clean motion with planted feet from the joints of a depth camera."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..denoising import Planted, PlantSettings
from ..motion import JointRecording, Motion, Skeleton
from ..progress import Progress, unwatched, within
from ..reconstruction import PostureLibrary, ReconstructSettings, ResidualPrior, reconstruct
from ..reconstruction.joint_rotations import Reconstruction
from ..recordings.conventions import keep_on_floor
from .changed_joints import find_changed_joints, shift_remarks
from .planting import plant_feet_if_possible
from .standard_joints import check_size, gap_remarks, standardize_joint_names

PLANT_SETTINGS = PlantSettings()
RECONSTRUCT_SETTINGS = ReconstructSettings()


@dataclass(frozen=True, eq=False)
class ReconstructedMotion:
    """Clean motion and the steps that led to it.

    Attributes
    ----------
    motion : Motion
        Without gaps; feet are planted if requested and possible.
    reconstruction : Reconstruction
        Joints, confidence and the motion before planting.
    planted : Planted or None
    rebuilt : bool, shape (n_frames, n_joints)
        Joints that were missing or were moved.
    remarks : tuple of str
        Sentences the animator should read.
    """

    motion: Motion
    reconstruction: Reconstruction
    planted: Planted | None
    rebuilt: NDArray[np.bool_]
    remarks: tuple[str, ...]


def reconstruct_recording(
    recording: JointRecording,
    postures: PostureLibrary | None = None,
    prior: ResidualPrior | None = None,
    *,
    skeleton: Skeleton | None = None,
    settings: ReconstructSettings = RECONSTRUCT_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    progress: Progress = unwatched,
) -> ReconstructedMotion:
    """Rebuild the poses of a recording, fit a skeleton to them and plant its feet.

    A recording that stands on height 0 does so afterwards (`keep_on_floor`).

    Parameters
    ----------
    recording : JointRecording
        Joints of a body, from any tracker whose names are recognized.
    postures : PostureLibrary, optional
    prior : ResidualPrior, optional
    skeleton : Skeleton, optional
        The skeleton to move; by default one with the bone lengths of the recording. Its joints
        must be a subset of those of the recording.
    settings : ReconstructSettings
    planting : PlantSettings or None
        None skips planting.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        Nothing is tracked, no body is recognized, or it is not of human size.
    SolveCancelled
        Raised by `progress`.
    """
    standardized = standardize_joint_names(recording)
    check_size(standardized)
    rebuilt = reconstruct(
        standardized, postures, prior, settings=settings, progress=within(progress, 0.0, 0.6)
    )
    motion = (
        rebuilt.motion
        if skeleton is None
        else rebuilt.motion_of(skeleton, within(progress, 0.6, 0.8))
    )
    motion = keep_on_floor(recording, motion)
    planting_result = plant_feet_if_possible(
        motion,
        planting,
        reliability=_for_skeleton_joints(
            motion.skeleton, standardized.names, rebuilt.reliability.combined
        ),
        progress=within(progress, 0.8, 1.0),
    )
    progress(1.0, "Done")
    remarks = (
        *gap_remarks(standardized), *shift_remarks(rebuilt), *planting_result.remarks,
    )  # fmt: skip
    changed = find_changed_joints(standardized, rebuilt)
    return ReconstructedMotion(
        planting_result.motion, rebuilt, planting_result.planted, changed, remarks
    )


def _for_skeleton_joints(
    skeleton: Skeleton, names: tuple[str, ...], reliability: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the reliability of the joints of a skeleton; NaN for untracked ones."""
    result = np.full((len(reliability), skeleton.n_joints), np.nan)
    for joint, name in enumerate(skeleton.names):
        if name in names:
            result[:, joint] = reliability[:, names.index(name)]
    return result
