"""Fit the motion of any rig to target poses."""

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import (
    HumanoidMap,
    Motion,
    find_humanoid_map,
    forward_kinematics,
    local_rotations,
)
from ...motion.humanoid import (
    CHEST,
    HIPS,
    N_JOINTS,
    POSTURE_JOINTS,
    SIDES,
    postures_from_motion,
)
from ...motion.skeletons import MIN_BONE_M
from ...rotations import fit_rotations, inverse, multiply, rotate, rotation_between, slerp
from ...signals import fill_gaps, fill_rotation_gaps

AIMS = {
    f"{side}{part}": f"{side}{end}"
    for side in SIDES
    for part, end in (
        ("Shoulder", "UpperArm"), ("UpperArm", "LowerArm"), ("LowerArm", "Hand"),
        ("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"), ("Foot", "Toes"),
    )
} | {"neck": "head"}  # fmt: skip
"""Roles of joints that point at another joint."""
PELVIS = tuple(
    POSTURE_JOINTS.index(role) for role in ("leftUpperLeg", "rightUpperLeg", "spine")
)
TRUNK = tuple(POSTURE_JOINTS.index(role) for role in ("leftUpperArm", "rightUpperArm", "head"))


def fit_motion_to_postures(
    motion: Motion, postures: Array, humanoid_map: HumanoidMap | None = None
) -> Motion:
    """Rotate the joints of a motion by the shortest rotations that match target poses.

    Pelvis and chest rotate with hips and shoulders, and the spine between them is interpolated.
    Limbs point at the target position of their child. Everything else, including axial
    rotation, stays unchanged: hands and fingers follow the forearm. Gaps are filled first.

    Parameters
    ----------
    motion : Motion
    postures : shape (n_frames, 20, 3), meters
        Target positions of `POSTURE_JOINTS`; NaN: no target.
    humanoid_map : HumanoidMap, optional
        Found by `find_humanoid_map` where it is not given.

    Returns
    -------
    Motion
        Of the same skeleton.

    Raises
    ------
    InvalidMotionError
        The postures do not fit the motion, or the skeleton lacks hips, arms or legs.
    """
    if postures.shape != (motion.n_frames, N_JOINTS, 3):
        raise InvalidMotionError(
            f"Postures for this motion need shape ({motion.n_frames}, {N_JOINTS}, 3), not"
            f" {postures.shape}."
        )
    humanoid_map = humanoid_map or find_humanoid_map(motion.skeleton)
    gap_free = fill_motion_gaps(motion)
    return _PostureFit(gap_free, postures, humanoid_map).fit()


def fill_motion_gaps(motion: Motion) -> Motion:
    """Fill gaps by interpolation, joint by joint; hold the first and last known frames."""
    joints = np.nan_to_num(fill_gaps(motion.root_positions))
    return motion.with_poses(fill_rotation_gaps(motion.rotations), joints)


class _PostureFit:
    """A motion whose joints are rotated to their targets, parents first."""

    def __init__(self, motion: Motion, postures: Array, humanoid_map: HumanoidMap) -> None:
        self.motion, self.skeleton = motion, motion.skeleton
        self.original = forward_kinematics(motion)
        self.before = postures_from_motion(motion, humanoid_map)
        self.targets = np.where(np.isfinite(postures), postures, self.before)
        joints = humanoid_map.indices(self.skeleton)
        self.roles = {joint: role for role, joint in joints.items()}
        self.joints = joints
        arms = [self.skeleton.ancestors(joints[f"{side}UpperArm"]) for side in SIDES]
        self.chest = next(joint for joint in arms[0] if joint in arms[1])
        chain = [self.chest, *self.skeleton.ancestors(self.chest)]
        self.hips = joints["hips"]
        self.trunk = chain[: chain.index(self.hips) + 1][::-1]
        self.swings = np.tile((1.0, 0.0, 0.0, 0.0), (motion.n_frames, motion.n_joints, 1))
        """World rotation of each joint in addition to its original one."""
        self.positions = np.array(self.original.positions)

    def fit(self) -> Motion:
        pelvis, chest = self._fit_trunk(HIPS, PELVIS), self._fit_trunk(CHEST, TRUNK)
        displacement = self.targets[:, HIPS] - self.before[:, HIPS]
        for joint, parent in enumerate(self.skeleton.parents):
            if parent < 0:
                self.positions[:, joint] += displacement
            else:
                offset = self.original.positions[:, joint] - self.original.positions[:, parent]
                self.positions[:, joint] = self.positions[:, parent] + rotate(
                    self.swings[:, parent], offset
                )
                self.swings[:, joint] = self.swings[:, parent]
            if joint in self.trunk:
                fraction = self.trunk.index(joint) / max(len(self.trunk) - 1, 1)
                self.swings[:, joint] = slerp(pelvis, chest, fraction)
                if 0.0 < fraction < 1.0:
                    self.swings[:, joint] = self._aim(joint, self.chest, CHEST)
            elif (role := AIMS.get(self.roles.get(joint, ""), "")) in self.joints:
                child = self.joints[role]
                self.swings[:, joint] = self._aim(joint, child, POSTURE_JOINTS.index(role))
        world = multiply(self.swings, self.original.rotations)
        rotations = local_rotations(self.skeleton, world)
        root = self.motion.root_positions + displacement
        return self.motion.with_poses(rotations, root)

    def _fit_trunk(self, middle: int, around: tuple[int, ...]) -> Array:
        """Return the best-fit rotation from joints around `middle` to their targets."""
        original = self.before[:, around] - self.before[:, [middle]]
        new = self.targets[:, around] - self.targets[:, [middle]]
        is_known = np.isfinite(original).all(axis=(0, 2)) & np.isfinite(new).all(axis=(0, 2))
        median_offsets = np.median(original[:, is_known], axis=0)
        swings = multiply(
            fit_rotations(median_offsets, new[:, is_known]),
            inverse(fit_rotations(median_offsets, original[:, is_known])),
        )
        return np.where(np.isfinite(swings), swings, (1.0, 0.0, 0.0, 0.0))

    def _aim(self, joint: int, goal: int, posture_joint: int) -> Array:
        """Rotate a joint further so that a joint below it points at its target."""
        above = self.swings[:, joint]
        correction = self.original.positions[:, goal] - self.before[:, posture_joint]
        current = rotate(
            above, self.original.positions[:, goal] - self.original.positions[:, joint]
        )
        offset = self.targets[:, posture_joint] + correction - self.positions[:, joint]
        lengths = [np.linalg.norm(each, axis=-1, keepdims=True) for each in (current, offset)]
        is_known = np.isfinite(offset).all(axis=-1, keepdims=True) & (
            np.minimum(*lengths) > MIN_BONE_M
        )
        swing = rotation_between(
            np.where(is_known, current, 1.0), np.where(is_known, offset, 1.0)
        )
        return np.where(is_known, multiply(swing, above), above)
