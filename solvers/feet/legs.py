"""Find the legs of a skeleton, and the points of its feet."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import Skeleton, Tracks
from ..motion.humanoid import SIDES, HumanoidMap, find_humanoid_map, roles_by_name


@dataclass(frozen=True)
class LegJoints:
    """Joint indices of one leg."""

    side: str
    hip: int
    knee: int
    ankle: int
    toe: int | None
    """Ball of the foot; None where the rig has no toes."""

    @property
    def chain(self) -> tuple[int, int, int]:
        """Hip, knee and ankle."""
        return self.hip, self.knee, self.ankle

    def length(self, skeleton: Skeleton) -> float:
        """Return the length of thigh and shin together, meters."""
        joints = skeleton.rest_positions[list(self.chain)]
        return float(np.linalg.norm(np.diff(joints, axis=0), axis=1).sum())


def find_legs(
    skeleton: Skeleton, humanoid_map: HumanoidMap | None = None
) -> tuple[LegJoints, ...]:
    """Return the legs that have hip, knee and ankle, left first."""
    joints = (humanoid_map or find_humanoid_map(skeleton)).indices(skeleton)
    legs = []
    for side in SIDES:
        chain = [joints.get(f"{side}{role}") for role in ("UpperLeg", "LowerLeg", "Foot")]
        if None in chain:
            continue
        hip, knee, ankle = (joint for joint in chain if joint is not None)
        if knee in skeleton.subtree(hip)[1:] and ankle in skeleton.subtree(knee)[1:]:
            toe = joints.get(f"{side}Toes")
            toe = toe if toe in skeleton.subtree(ankle)[1:] else None
            legs.append(LegJoints(side, hip, knee, ankle, toe))
    return tuple(legs)


def find_foot_joints(
    skeleton: Skeleton, humanoid_map: HumanoidMap | None = None
) -> NDArray[np.intp] | None:
    """Return the joints of ankle and toes, (2, 2): a row for the left and the right foot.

    Without toes the ankle appears twice. Returns None unless both feet are found.
    """
    return _ankles_and_toes((humanoid_map or find_humanoid_map(skeleton)).indices(skeleton))


def find_foot_points(
    tracks: Tracks, humanoid_map: HumanoidMap | None = None
) -> NDArray[np.intp] | None:
    """Return the points of both feet, (2, 2) as of `find_foot_joints`, by names of joints."""
    index_of_name = {name: index for index, name in enumerate(tracks.names)}
    roles = humanoid_map.joints if humanoid_map else roles_by_name(tracks.names)
    return _ankles_and_toes({
        role: index_of_name[name] for role, name in roles.items() if name in index_of_name
    })


def _ankles_and_toes(index_of_role: Mapping[str, int]) -> NDArray[np.intp] | None:
    """Return the indices of ankle and toes of both feet, shape (2, 2), if both exist."""
    ankles = [index_of_role.get(f"{side}Foot") for side in SIDES]
    if None in ankles:
        return None
    toes = [
        index_of_role.get(f"{side}Toes", ankle)
        for side, ankle in zip(SIDES, ankles, strict=True)
    ]
    return np.array([ankles, toes], dtype=np.intp).T
