"""From a depth camera's joints to clean motion of a skeleton whose feet stand."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..denoising import Planted, PlantSettings
from ..motion import JointRecording, Motion, Skeleton
from ..progress import Progress, unwatched, within
from ..reconstruction import PostureLibrary, ReconstructSettings, ResidualPrior, reconstruct
from ..reconstruction.joint_rotations import Reconstruction, follow_joints
from .plant_feet_if_possible import plant_feet_if_possible
from .rebuilt_joints import rebuilt_joints
from .standard_joints import check_size, gap_remarks, standardize_joint_names

PLANTING = PlantSettings()
REBUILDING = ReconstructSettings()


@dataclass(frozen=True, eq=False)
class ReconstructedMotion:
    """Clean motion, and what was done for it.

    Attributes
    ----------
    motion : Motion
        Without gaps; the feet are planted where that was asked for and can be done.
    reconstruction : Reconstruction
        Joints, confidence and the motion before feet were planted.
    planted : Planted or None
    rebuilt : bool, shape (n_frames, n_joints)
        Which joints of the reconstruction were lost, or are put elsewhere than recorded.
    remarks : tuple of str
        Sentences on what the animator should know.
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
    settings: ReconstructSettings = REBUILDING,
    planting: PlantSettings | None = PLANTING,
    progress: Progress = unwatched,
) -> ReconstructedMotion:
    """Rebuild the poses of a recording, let a skeleton follow them, and plant its feet.

    Parameters
    ----------
    recording : JointRecording
        Joints of a body, of any tracker whose names are known.
    postures : PostureLibrary, optional
    prior : ResidualPrior, optional
    skeleton : Skeleton, optional
        To move, in the place of one of the recording's own lengths; its joints are some of the
        recording's.
    settings : ReconstructSettings
    planting : PlantSettings or None
        None leaves the feet as they are.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        Nothing is tracked, no body is recognised, or it is not of human size.
    SolveCancelled
        Raised by `progress`.
    """
    known = standardize_joint_names(recording)
    check_size(known)
    rebuilt = reconstruct(
        known, postures, prior, settings=settings, progress=within(progress, 0.0, 0.8)
    )
    motion = rebuilt.motion
    if skeleton is not None:
        motion = follow_joints(
            rebuilt.tracks,
            known.parents,
            rebuilt.reliability.combined,
            twists=rebuilt.twists,
            skeleton=skeleton,
        )
    footing = plant_feet_if_possible(
        motion,
        planting,
        reliability=_of_joints(motion.skeleton, known.names, rebuilt.reliability.combined),
        progress=within(progress, 0.8, 1.0),
    )
    progress(1.0, "Done")
    remarks = (*gap_remarks(known), *footing.remarks)
    guessed = rebuilt_joints(known, rebuilt)
    return ReconstructedMotion(footing.motion, rebuilt, footing.planted, guessed, remarks)


def _of_joints(
    skeleton: Skeleton, names: tuple[str, ...], reliability: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the reliability of a skeleton's joints; NaN of those that were not tracked."""
    result = np.full((len(reliability), skeleton.n_joints), np.nan)
    for joint, name in enumerate(skeleton.names):
        if name in names:
            result[:, joint] = reliability[:, names.index(name)]
    return result
