"""Read the parameter files of SMPL bodies: AMASS, SMPL-X and what video models write."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError, InvalidSettingError
from ...motion import Motion, Skeleton
from ...motion.humanoid import ADULT_STATURE_M
from ...progress import Progress, Remark, unwatched
from ...rotations import quaternion_from_rotation_vector
from ..containers import archive_names, read_archive_members
from ..conventions import (
    DEFAULT_FRAME_RATE,
    Bodies,
    UpAxisName,
    check_scale,
    common_rate,
    file_conventions,
    observed_body,
    put_on_floor,
    rotations_z_up_from_y_up,
    stand_upright,
    z_up_from_y_up,
)
from .kimodo import open_kimodo
from .smpl_bodies import (
    BODY,
    FINGERS,
    smpl_joints,
    split_people,
    with_root_at_pelvis,
    with_rotation_vectors,
)

ROTATIONS = (
    "poses", "smpl_poses", "fullpose", "smpl_pose", "pred_rotmat", "pose_world", "pose",
)  # fmt: skip
"""Names of all rotations; of the last two, WHAM's, the first one is in the world."""
OF_CAMERA = ("pred_rotmat", "pose")
"""Names of rotations that video models give relative to the camera."""
ROOT = ("root_orient", "global_orient")
BODY_POSE = ("pose_body", "body_pose")
HANDS = ("pose_hand",)
LEFT_HAND, RIGHT_HAND = ("left_hand_pose",), ("right_hand_pose",)
POSITIONS = ("trans_world", "trans", "transl", "translation", "smpl_trans", "pred_trans")
RATES = ("mocap_frame_rate", "mocap_framerate", "frame_rate", "framerate", "fps")
SCALES = ("smpl_scaling",)
OF_EASYMOCAP = ("Rh", "Th")
"""Names of the rotation and translation of the posed body (`with_root_at_pelvis`)."""
POSES = frozenset((*ROTATIONS, *ROOT, *BODY_POSE)) - {"pose"}
"""Names that no other archives have; joints may be called `pose`, too."""
NAMES = frozenset(
    (*POSES, *HANDS, *LEFT_HAND, *RIGHT_HAND, *POSITIONS, *RATES,
     *SCALES, *OF_EASYMOCAP, "shapes", "betas", "gender", "dmpls", "surface_model_type",
     "pose_jaw", "pose_eye", "num_betas", "marker_data", "marker_labels",
     "mocap_time_length", "trans_vel")
)  # fmt: skip
READ_ARRAYS = (
    *ROTATIONS, *ROOT, *BODY_POSE, *HANDS, *LEFT_HAND, *RIGHT_HAND, *POSITIONS, *RATES, *SCALES,
    *OF_EASYMOCAP,
)  # fmt: skip
OF_SMPL = frozenset((*POSITIONS, "betas"))
"""Names of which one is next to a `pose` of SMPL."""
N_BODY = len(BODY)
N_HAND = 9 * len(FINGERS)
"""Numbers of one hand: three joints of each finger, with an axis and angle each."""
FIRST_HAND = {52: 22, 55: 25}
"""Index of the first finger joint, by the number of joints: SMPL-H and SMPL-X."""
N_NUMBERS = {66, 69, 72, 156, 165, 168}
"""Numbers of a pose: 22 joints, SMPL's 23 and 24, SMPL-H's 52, SMPL-X's 55, and with a jaw."""
N_BODY_POSE = {63, 69}
"""Numbers of a pose without its root: SMPL-X and SMPL-H, and SMPL with its hands."""
SIZES = dict.fromkeys(ROTATIONS, N_NUMBERS) | dict.fromkeys(BODY_POSE, N_BODY_POSE)
MAX_HEIGHT_M = 10.0
AMASS_UP: dict[UpAxisName, float] = {"Z": 0.8, "Y": 0.0}
"""Weight of the evidence of AMASS for each axis (`estimate_up_axis`), by definition Z."""
VIDEO_UP: dict[UpAxisName, float] = {"Y": 0.1, "Z": 0.05, "-Y": 0.0}
"""The same weight of video models: mostly Y and, in the camera's axes, -Y. Chosen by hand below
`FLOOR_WEIGHT`, 0.3."""


def is_smpl(head: bytes) -> bool:
    """Return whether the first bytes are an archive of the parameters of SMPL.

    One name of poses is enough; without one, all names are parameters.
    """
    names = {*archive_names(head)}
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
    those of several people (`split_people`).

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the positions, or None
        None: 1, or 1 / `smpl_scaling` where the file has it (AIST++).
    height : float, meters
        Stature of the actor.
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
    check_scale(scale)
    if not 0.0 < height < MAX_HEIGHT_M:
        raise InvalidSettingError(f"height is {height:g} m; it must be above 0 and below 10.")
    arrays = read_archive_members(path, (*READ_ARRAYS, "posed_joints"))
    if "posed_joints" in arrays and not {*ROTATIONS, *ROOT} & arrays.keys():
        return open_kimodo(path, scale=scale, progress=progress)
    arrays = with_rotation_vectors(
        arrays, {*ROTATIONS, *ROOT, *BODY_POSE, *HANDS, *LEFT_HAND, *RIGHT_HAND, "Rh"}
    )
    people = [with_root_at_pelvis(path, each) for each in split_people(arrays, SIZES)]
    vectors = [_rotation_vectors(path, person) for person in people]
    rate = _rate(arrays, unwatched)
    listed = tuple(
        observed_body(
            str(number), np.flatnonzero(np.isfinite(each).all(axis=(1, 2))), len(each),
            len(each) / rate,
        )
        for number, each in enumerate(vectors, start=1)
    )  # fmt: skip

    def read(index: int, progress: Progress) -> Motion:
        motion = _motion(path, people[index], vectors[index], scale, height, progress)
        return put_on_floor(motion) if on_floor else motion

    return Bodies(str(path), listed, read)


def _motion(
    path: Path | str,
    arrays: dict[str, Array],
    vectors: Array,
    scale: float | None,
    height: float,
    progress: Progress,
) -> Motion:
    """Return the motion of one person from axes times angles."""
    n_frames = len(vectors)
    hands = vectors.shape[1] > N_BODY
    positions = _member(arrays, POSITIONS)
    if positions is None:
        positions = np.zeros((n_frames, 3))
        progress(0.5, Remark("The file has no positions, so the body stays in place"))
    if positions.shape == (n_frames, 1, 3):
        positions = positions[:, 0]
    if positions.shape != (n_frames, 3):
        raise InvalidFileError(
            f"{path} has {n_frames} poses but positions of shape {positions.shape}."
        )
    named = next((name for name in (*ROTATIONS, *ROOT) if name in arrays), "")
    if named in OF_CAMERA:
        progress(
            0.5,
            Remark("Poses are relative to the camera: if it moved, the actor moves with it"),
        )
    rate = _rate(arrays, progress)
    unit = scale if scale is not None else 1.0 / _number(arrays, SCALES, 1.0)
    names, parents, offsets = smpl_joints(hands, height)
    rotations = rotations_z_up_from_y_up(quaternion_from_rotation_vector(vectors))
    motion = Motion(
        Skeleton(names, parents, z_up_from_y_up(offsets)),
        rotations,
        z_up_from_y_up(positions * unit),
        rate,
        replace(file_conventions("Y", unit=unit), has_floor=False),
    )
    is_amass = not {"mocap_frame_rate", "mocap_framerate"}.isdisjoint(arrays)
    return stand_upright(motion, progress, AMASS_UP if is_amass else VIDEO_UP)


def _rotation_vectors(path: Path | str, arrays: dict[str, Array]) -> Array:
    """Return axis times angle, radians, of body and moving fingers, (n_frames, n, 3)."""
    poses = _member(arrays, ROTATIONS)
    if poses is None:
        poses = _joined_parts(arrays)
    if (
        poses is None
        or poses.ndim < 2
        or not poses.size
        or poses[0].size < 3 * N_BODY
        or poses[0].size % 3
    ):
        raise InvalidFileError(
            f"{path} has no rotations of an SMPL body: neither poses nor root_orient and"
            " pose_body. Save the parameters of one person, with their names."
        )
    if poses.ndim > 2 and (poses.ndim != 3 or poses.shape[2] != 3):
        raise InvalidFileError(
            f"{path} has poses of shape {poses.shape}, which are neither rotation vectors nor"
            " matrices. Save rotation vectors of three numbers for each joint."
        )
    if poses[0].size not in N_NUMBERS:
        raise InvalidFileError(
            f"{path} has {poses[0].size} numbers in each pose, which no SMPL body has. Save"
            " rotation vectors of three numbers for each joint."
        )
    vectors = poses.reshape(len(poses), -1, 3)
    vectors = np.where(np.isfinite(vectors).all(axis=(1, 2), keepdims=True), vectors, np.nan)
    body, first = vectors[:, :N_BODY], FIRST_HAND.get(vectors.shape[1])
    fingers = vectors[:, first:] if first else vectors[:, :0]
    if np.nan_to_num(fingers).any():
        return np.concatenate([body, fingers], axis=1)
    return body


def _joined_parts(arrays: dict[str, Array]) -> Array | None:
    """Return root, body and hands side by side, as SMPL-H has them; None without a body."""
    root, body = _member(arrays, ROOT), _member(arrays, BODY_POSE)
    if root is None or body is None or min(root.ndim, body.ndim) < 2 or not len(root):
        return None
    n_frames = len(root)
    root = root.reshape(n_frames, -1)
    if len(body) != n_frames or root.shape[1] != 3 or body[0].size not in N_BODY_POSE:
        return None
    parts = [root, body.reshape(n_frames, -1)[:, : 3 * N_BODY - 3]]
    hands = [_member(arrays, names) for names in (HANDS, LEFT_HAND, RIGHT_HAND)]
    found = [each for each in hands if each is not None and each.ndim > 1]
    found = [hand for hand in found if len(hand) == n_frames]
    found = [hand.reshape(n_frames, -1) for hand in found]
    if sum(hand.shape[1] for hand in found) == 2 * N_HAND:
        parts += found
    return np.asarray(np.concatenate(parts, axis=1))


def _member(arrays: dict[str, Array], names: tuple[str, ...]) -> Array | None:
    """Return the first of these arrays that the file has; without a leading batch of one."""
    array = next((arrays[name] for name in names if name in arrays), None)
    if array is None:
        return None
    return array[0] if array.ndim == 3 and len(array) == 1 else array


def _number(arrays: dict[str, Array], names: tuple[str, ...], default: float) -> float:
    array = _member(arrays, names)
    value = float(array.ravel()[0]) if array is not None and array.size else default
    return value if 0.0 < value < np.inf else default


def _rate(arrays: dict[str, Array], progress: Progress) -> float:
    rate = _number(arrays, RATES, 0.0)
    if rate > 0.0:
        return common_rate(rate)
    progress(0.5, Remark(f"The file has no frame rate; {DEFAULT_FRAME_RATE:g} Hz is assumed"))
    return DEFAULT_FRAME_RATE
