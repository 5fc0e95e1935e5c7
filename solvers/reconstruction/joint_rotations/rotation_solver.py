"""Solve joint rotations from the root outward so that bones point at observed joints."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import Skeleton, roles_by_name
from ...motion.humanoid import SIDES
from ...motion.skeletons import MIN_BONE_M
from ...rotations import IDENTITY, fit_rotations, multiply, rotate, rotation_between, slerp
from .limb_twist import (
    HINGES,
    UNKNOWN_HINGES,
    HingeAxes,
    Limb,
    rotations_from_flexion,
    rotations_from_thumb,
    smooth_direction,
)

GRANDCHILD_WEIGHT = 0.3
"""Weight of a child of zero length for its parent; the child also points by its own rotation.
Half and twice gain less than 1 % (`make sensitivity`)."""
LIMBS = {
    f"{side}{upper}": (f"{side}{lower}", f"{side}{end}")
    for side in SIDES
    for upper, lower, end in (
        ("UpperArm", "LowerArm", "Hand"),
        ("UpperLeg", "LowerLeg", "Foot"),
    )
}
HANDS = ("leftHand", "rightHand")


class _ChildDirections(NamedTuple):
    """Directions to the children of a joint, in the rest pose and as observed."""

    rest: Array
    """Shape (n, 3), meters."""
    tracked: Array
    """Shape (n_frames, n, 3)."""
    is_exclusive: Array
    """Whether only this joint points there, shape (n,)."""
    observed: NDArray[np.bool_]
    """Whether both ends were observed, shape (n_frames, n)."""


class RotationSolver:
    """Solves the world rotations of a skeleton joint by joint, from the root on."""

    def __init__(
        self, skeleton: Skeleton, observed: Array, reliability: Array, frame_rate: float
    ):
        self.skeleton, self.observed, self.reliability = skeleton, observed, reliability
        self.frame_rate = frame_rate
        roles = roles_by_name(skeleton.names)
        self.roles = {role: skeleton.names.index(name) for role, name in roles.items()}
        self.limbs = self._limbs()
        self.hands = {self.roles[role] for role in HANDS if role in self.roles}
        self.world = np.empty((*observed.shape[:2], 4))
        self.has_length = np.linalg.norm(skeleton.offsets, axis=-1) > MIN_BONE_M
        self.hinges: dict[str, HingeAxes] = {}
        """Where similar poses have the hinges of limbs, by the roles of their upper joints."""

    def _limbs(self) -> dict[int, Limb]:
        limbs = {}
        for upper, below in LIMBS.items():
            first, second, end = (self.roles.get(role, -1) for role in (upper, *below))
            parents = [self.skeleton.parents[joint] for joint in (second, end)]
            if parents == [first, second] and first > 0:
                limbs[first] = Limb(first, second, end, HINGES[upper[-3:]], upper)
        return limbs

    def legs(self) -> dict[int, Limb]:
        """Return the limbs that are legs, by their upper joints."""
        uppers = [self.roles.get(f"{side}UpperLeg", -1) for side in SIDES]
        return {upper: limb for upper, limb in self.limbs.items() if upper in uppers}

    def solve_rotations(self) -> None:
        """Rotate every joint, parents first."""
        trunk = self._trunk_fractions()
        for joint, parent in enumerate(self.skeleton.parents):
            above = self._base_rotation(joint, parent, trunk)
            self.world[:, joint] = self._aim_joint(joint, above)
            self.world[:, joint] = self._twist_joint(joint)

    def _twist_joint(self, joint: int) -> Array:
        """Set the axial rotation of an upper arm, a thigh or a hand; others stay unchanged."""
        rotations = self.world[:, joint]
        if joint in self.limbs:
            limb, body = self.limbs[joint], self.skeleton
            hinges = self.hinges.get(limb.role, UNKNOWN_HINGES)
            return rotations_from_flexion(
                rotations, limb, body, self.observed, self.reliability, self.frame_rate, hinges
            )
        if joint in self.hands and len(self.skeleton.children[joint]) > 1:
            hand, thumb = self.skeleton.children[joint][:2]
            along, aside = (self.skeleton.offsets[each] for each in (hand, thumb))
            tracked = self.observed[:, thumb] - self.observed[:, joint]
            return rotations_from_thumb(
                rotations,
                along,
                aside,
                tracked,
                self.reliability[:, thumb],
                self.frame_rate,
            )
        return rotations

    def _base_rotation(self, joint: int, parent: int, trunk: dict[int, float]) -> Array:
        """Return the rotation that a joint starts from: its parent's, for a spine mixed with
        the chest's."""
        if parent < 0:
            return np.broadcast_to(IDENTITY, self.world[:, 0].shape)
        if joint not in trunk:
            return self.world[:, parent]
        chest = fit_rotations(*self._child_directions(self.chest)[:2])
        interpolated = slerp(self.world[:, parent], chest, trunk[joint])
        return np.where(np.isfinite(interpolated), interpolated, self.world[:, parent])

    def _trunk_fractions(self) -> dict[int, float]:
        """Return the joints between hips and chest, each with its fraction of the remaining
        twist."""
        arms = [self.roles.get(f"{side}UpperArm", -1) for side in SIDES]
        if min(arms) < 0:
            return {}
        chains = [self.skeleton.ancestors(arm) for arm in arms]
        common = [joint for joint in chains[0] if joint in chains[1]]
        if len(common) < 3:
            return {}
        self.chest = common[0]
        between = common[1:-1][::-1]
        return {joint: 1.0 / (len(between) + 1 - at) for at, joint in enumerate(between)}

    def _child_directions(self, joint: int) -> _ChildDirections:
        rest, tracked, is_exclusive = [], [], []
        children = self.skeleton.children[joint]
        if joint in self.hands:  # a thumb is too noisy to orient the hand
            children = children[:1]
        for child in children:
            if self.has_length[child]:
                rest.append(self.skeleton.offsets[child])
                tracked.append(self._child_direction(joint, child))
                is_exclusive.append(True)
                continue
            for grandchild in self.skeleton.children[child]:
                rest.append(GRANDCHILD_WEIGHT * self.skeleton.offsets[grandchild])
                tracked.append(
                    GRANDCHILD_WEIGHT * (self.observed[:, grandchild] - self.observed[:, joint])
                )
                is_exclusive.append(False)
        shape = (len(self.observed), len(rest), 3)
        directions = np.stack(tracked, axis=1) if tracked else np.zeros(shape)
        known = np.isfinite(directions).all(axis=-1)
        lengths = np.linalg.norm(directions, axis=-1, keepdims=True)
        directions = np.where(lengths > MIN_BONE_M, directions, np.nan)
        return _ChildDirections(
            np.array(rest).reshape(-1, 3), directions, np.array(is_exclusive, bool), known
        )

    def _child_direction(self, joint: int, child: int) -> Array:
        """Return the observed direction to a child, smoothed in a hand."""
        tracked = np.asarray(self.observed[:, child] - self.observed[:, joint])
        above = self.skeleton.parents[joint]
        if self.hands & {joint, above}:
            return smooth_direction(
                tracked, self.world[:, above], self.skeleton.offsets[joint],
                self.reliability[:, child], self.frame_rate,
            )  # fmt: skip
        return tracked

    def _aim_joint(self, joint: int, above: Array) -> Array:
        """Return the world rotations of a joint, shape (n_frames, 4), that starts from `above`.

        Where children are observed but too close to define a direction, the base rotation
        stays.
        """
        if not self.skeleton.children[joint]:
            return above
        directions = self._child_directions(joint)
        if not len(directions.rest):
            return above
        rotations = above
        if len(directions.rest) > 1:
            rotations = _fill_undefined(
                fit_rotations(directions.rest, directions.tracked),
                above,
                directions.observed,
            )
        aims = (
            np.flatnonzero(directions.is_exclusive)
            if directions.is_exclusive.any()
            else np.arange(len(directions.rest))
        )
        if len(aims) > 1:
            return rotations
        direction, rest = (
            directions.tracked[:, aims[0]],
            rotate(rotations, directions.rest[aims[0]]),
        )
        return _fill_undefined(
            multiply(rotation_between(rest, direction), rotations),
            rotations,
            directions.observed[:, aims],
        )


def _fill_undefined(rotations: Array, fallback: Array, known: NDArray[np.bool_]) -> Array:
    """Fill undefined rotations in frames with all children observed."""
    is_undefined = np.isnan(rotations).any(axis=-1) & known.all(axis=-1)
    return np.where(is_undefined[:, None], fallback, rotations)
