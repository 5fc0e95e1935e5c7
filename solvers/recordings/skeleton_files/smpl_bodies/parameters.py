"""Rotations of the joints in the arrays of an SMPL body, by the names that programs use."""

import re
from collections.abc import Collection, Mapping
from pathlib import Path

import numpy as np

from ....arrays import Array
from ....errors import InvalidFileError
from .joints import BODY, FINGERS

ROTATIONS = (
    "poses", "smpl_poses", "fullpose", "smpl_pose", "pred_rotmat", "pose_world", "pose",
)  # fmt: skip
"""Names of all rotations; of the last two, WHAM's, the first one is in the world."""
OF_CAMERA = frozenset((
    "pred_rotmat", "pose", "cam_trans", "pred_cam_t_full", "cam_t_full", "pred_cam_t", "cam_t",
))  # fmt: skip
"""Names of rotations and positions that video models give relative to the camera."""
ROOT = ("root_orient", "global_orient")
BODY_POSE = ("pose_body", "body_pose")
HANDS = ("pose_hand",)
LEFT_HAND, RIGHT_HAND = ("left_hand_pose",), ("right_hand_pose",)
POSITIONS = (
    "trans_world", "trans", "transl", "translation", "smpl_trans", "pred_trans",
    "body_translation", "cam_trans", "pred_cam_t_full", "cam_t_full", "pred_cam_t", "cam_t",
)  # fmt: skip
"""Names of the position of the root; from `cam_trans` on in the axes of the camera."""
RATES = ("mocap_frame_rate", "mocap_framerate", "frame_rate", "framerate", "fps")
SCALES = ("smpl_scaling",)
BODY_SCALES = ("scale",)
"""Size of the body relative to that of the model, of EasyMocap."""
OF_EASYMOCAP = ("Rh", "Th", *BODY_SCALES)
"""Names of the rotation, translation and size of the posed body (`with_root_at_pelvis`)."""
POSES = frozenset((*ROTATIONS, *ROOT, *BODY_POSE)) - {"pose"}
"""Names that no other archives have; joints may be called `pose`, too."""
NAMES = frozenset(
    (*POSES, *HANDS, *LEFT_HAND, *RIGHT_HAND, *POSITIONS, *RATES,
     *SCALES, *OF_EASYMOCAP, "shapes", "expression", "betas", "gender", "dmpls",
     "surface_model_type",
     "pose_jaw", "pose_eye", "num_betas", "marker_data", "marker_labels",
     "mocap_time_length", "trans_vel", "head_pose")
)  # fmt: skip
ALL_ROTATIONS = frozenset((
    *ROTATIONS,
    *ROOT,
    *BODY_POSE,
    *HANDS,
    *LEFT_HAND,
    *RIGHT_HAND,
    "Rh",
))
"""Names of arrays that hold rotations."""
READ_ARRAYS = (
    *ROTATIONS, *ROOT, *BODY_POSE, *HANDS, *LEFT_HAND, *RIGHT_HAND, *POSITIONS, *RATES, *SCALES,
    *OF_EASYMOCAP,
)  # fmt: skip
OF_SMPL = frozenset((*POSITIONS, "betas"))
"""Names; one of them is next to a `pose` of SMPL."""
N_BODY = len(BODY)
N_HAND = 9 * len(FINGERS)
"""Numbers of one hand: three joints of each finger, with an axis and angle each."""
FIRST_HAND = {52: 22, 55: 25}
"""Index of the first finger joint, by the number of joints: SMPL-H and SMPL-X."""
N_WITH_COMPONENTS = {78, 87}
"""Numbers of a pose of EasyMocap's SMPL-H and SMPL-X: 22 joints, two hands as six principal
components each, and the jaw and both eyes of SMPL-X."""
N_NUMBERS = {66, 69, 72, 156, 165, 168} | N_WITH_COMPONENTS
"""Numbers of a pose: 22 joints, SMPL's 23 and 24, SMPL-H's 52, SMPL-X's 55, and with a jaw."""
N_BODY_POSE = {63, 69}
"""Numbers of a pose without its root: SMPL-X and SMPL-H, and SMPL with its hands."""
SIZES = dict.fromkeys(ROTATIONS, N_NUMBERS) | dict.fromkeys(BODY_POSE, N_BODY_POSE)


def rotation_vectors(path: Path | str, arrays: Mapping[str, Array]) -> Array:
    """Return axis times angle, radians, of body and moving fingers, (n_frames, n, 3).

    Raises InvalidFileError if the arrays hold no rotations of such a body.
    """
    poses = member(arrays, ROTATIONS)
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


def _joined_parts(arrays: Mapping[str, Array]) -> Array | None:
    """Return root, body and hands side by side, as SMPL-H has them; None without a body."""
    root, body = member(arrays, ROOT), member(arrays, BODY_POSE)
    if root is None and body is not None and body.ndim > 1 and body[0].size == 3 * N_BODY:
        rows = body.reshape(len(body), -1)  # as in Meshcapade's .smpl
        root, body = rows[:, :3], rows[:, 3:]
    if root is None or body is None or min(root.ndim, body.ndim) < 2 or not len(root):
        return None
    n_frames = len(root)
    root = root.reshape(n_frames, -1)
    if len(body) != n_frames or root.shape[1] != 3 or body[0].size not in N_BODY_POSE:
        return None
    parts = [root, body.reshape(n_frames, -1)[:, : 3 * N_BODY - 3]]
    hands = [member(arrays, names) for names in (HANDS, LEFT_HAND, RIGHT_HAND)]
    found = [each for each in hands if each is not None and each.ndim > 1]
    found = [hand for hand in found if len(hand) == n_frames]
    found = [hand.reshape(n_frames, -1) for hand in found]
    if sum(hand.shape[1] for hand in found) == 2 * N_HAND:
        parts += found
    return np.asarray(np.concatenate(parts, axis=1))


def plain_name(name: str) -> str:
    """Return a name such as `bodyPose` or `BODY_POSE` as `body_pose`.

    Those of EasyMocap remain.
    """
    return name if name in OF_EASYMOCAP else re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()


def member(arrays: Mapping[str, Array], names: Collection[str]) -> Array | None:
    """Return the first of these arrays that the file has; (1, n, k) becomes (n, k)."""
    array = next((arrays[name] for name in names if name in arrays), None)
    if array is None:
        return None
    return array[0] if array.ndim == 3 and len(array) == 1 else array
