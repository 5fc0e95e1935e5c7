"""Read the parameter files of SMPL bodies: AMASS, SMPL-X and what video models write."""

from collections.abc import Mapping
from pathlib import Path

from ...arrays import Array
from ...motion import Motion
from ...motion.humanoid import ADULT_STATURE_M
from ...progress import Progress, Remark, unwatched
from ..containers import (
    archive_names,
    describe_frame_files,
    frame_files,
    read_archive_members,
)
from ..conventions import Bodies
from .kimodo import open_kimodo
from .smpl_bodies import (
    NAMES,
    OF_SMPL,
    POSES,
    READ_ARRAYS,
    ROOT,
    ROTATIONS,
    bodies_of_parameters,
    joined_frames,
    people_of_parameters,
    plain_name,
    rows_of_frames,
)


def is_smpl(head: bytes) -> bool:
    """Return whether the first bytes are an archive of the parameters of SMPL.

    One name of poses is enough; without one, all names are parameters.
    """
    names = {plain_name(name) for name in archive_names(head)}
    is_pose = "pose" in names and not OF_SMPL.isdisjoint(names)
    return bool(names) and (names <= NAMES or is_pose or not POSES.isdisjoint(names))


def open_smpl(
    path: Path | str,
    *,
    scale: float | None = None,
    height: float = ADULT_STATURE_M,
    on_floor: bool = True,
    progress: Progress = unwatched,
) -> Bodies[Motion]:
    """Open the pose parameters of an SMPL, SMPL-H or SMPL-X body from an `.npz` archive.

    Both layouts of AMASS [1]_ are read, as one array `poses` or in parts (`root_orient`,
    `pose_body`, `pose_hand`), and the names that video models use (`global_orient`,
    `body_pose`, `transl`, `pose_world`, `pred_rotmat`), as rotation vectors or matrices; so are
    the rotation `Rh` and the translation `Th` of EasyMocap.
    Rotations are exact. Bone lengths depend on a licensed model that is neither read nor
    needed: they are those of an adult, scaled to `height`. The height above the floor depends
    on them too, so the feet are put on the floor. Which way is up is estimated from the body
    (`estimate_up_axis`): AMASS has Z up, most video models Y. Poses with an axis too many are
    those of several people (`split_people`). A file of one frame stands for all files of its
    take (`frame_files`).

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the positions, or None
        None: 1, or 1 / `smpl_scaling` where the file has it (AIST++).
    height : float, meters
        Stature of the actor, which `scale` of EasyMocap multiplies.
    on_floor : bool
        Whether the feet are put on the floor.
    progress : Progress

    Returns
    -------
    Bodies of Motion
        22 joints, and 30 of the fingers where the file has hands that move.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged or has no rotations of a body.
    InvalidSettingError
        Scale or height is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Mahmood, Ghorbani, Troje, Pons-Moll, Black (2019). AMASS: Archive of motion capture
       as surface shapes. ICCV.
    """
    arrays = _arrays(path)
    if "posed_joints" in arrays and not {*ROTATIONS, *ROOT} & arrays.keys():
        return open_kimodo(path, scale=scale, progress=progress)
    files = frame_files(path).frames() if _has_one_frame(arrays) else []
    if len(files) > 1:
        frames = [{} if file is None else {"1": _arrays(file)} for file in files]
        arrays = joined_frames(path, "1", frames)
        progress(0.5, Remark(describe_frame_files(len(files))))
    people = enumerate(people_of_parameters(arrays), start=1)
    named = {str(number): person for number, person in people}
    return bodies_of_parameters(path, named, scale=scale, height=height, on_floor=on_floor)


def is_frame_smpl(path: Path | str) -> bool:
    """Return whether a file holds the pose of one frame."""
    return _has_one_frame(_arrays(path))


def _arrays(path: Path | str) -> dict[str, Array]:
    return rows_of_frames(
        read_archive_members(path, (*READ_ARRAYS, "posed_joints"), plain_name)
    )


def _has_one_frame(arrays: Mapping[str, Array]) -> bool:
    lengths = [len(arrays[name]) for name in POSES if name in arrays and arrays[name].ndim]
    return max(lengths, default=0) == 1
