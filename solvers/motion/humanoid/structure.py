"""Assign humanoid roles to joints by the structure of the rest pose."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..skeletons import Skeleton

# Lengths of the upper and lower limb as fractions of body height (Drillis & Contini 1966, as
# tabled by Winter 2009, Biomechanics and Motor Control of Human Movement, figure 4.1).
ARM_FRACTIONS = (0.186, 0.146)
LEG_FRACTIONS = (0.245, 0.246)
SHOULDER_FRACTION = 0.129
"""Distance of the shoulder from the midline; collar bones start nearer to it."""
MAX_HAND_FRACTION = 0.13
"""Maximum length from wrist to fingertip (0.108 in the tables, plus a margin)."""
MAX_FOOT_HEIGHT_FRACTION = 0.15
"""Maximum height of the ends of the feet."""


def roles_by_structure(skeleton: Skeleton) -> tuple[dict[str, str], float]:
    """Return joint names by role, and how human the proportions are, 0 to 1.

    The rest pose must stand upright and face -Y, so that the character's left is +X. The hips
    are the joint where the paths to the lowest joint of each side branch; the upper chest is
    where the paths to the outermost joint of each side branch. Knee and ankle, elbow and wrist
    are the joints that divide each limb most like a human limb. Fingers get no role.

    Returns
    -------
    dict of role to joint name, and float; empty and 0.0 without two legs.
    """
    body = _Body(skeleton)
    feet = body.outermost(
        -body.positions[:, 2], body.positions[:, 2] <= MAX_FOOT_HEIGHT_FRACTION * body.height
    )
    if feet is None:
        return {}, 0.0
    hips, legs = body.branch(feet)
    roles, misfits = {"hips": hips}, []
    for side, leg in legs.items():
        found, misfit = body.limb(leg, LEG_FRACTIONS)
        names = (f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot")
        roles |= dict(zip(names, found, strict=False))
        if found and (toes := body.toes(found[-1])) is not None:
            roles[f"{side}Toes"] = toes
        misfits.append(misfit)
    hands = body.outermost(
        np.abs(body.positions[:, 0] - body.positions[hips, 0]),
        (body.positions[:, 2] > 0.4 * body.height) & ~body.limb_joints(hips, legs),
    )
    if hands is not None:
        found_above, misfits_above = _upper_body(body, hips, hands)
        roles |= found_above
        misfits += misfits_above
    limb_fraction = len(misfits) / 4
    first_role: dict[int, str] = {}
    for (
        role,
        joint,
    ) in roles.items():  # In a skeleton that is not a body, a joint may match two roles.
        first_role.setdefault(joint, role)
    return (
        {role: skeleton.names[joint] for joint, role in first_role.items()},
        float(limb_fraction * np.exp(-np.mean(misfits))),
    )


def _upper_body(
    body: "_Body", hips: int, hands: dict[str, int]
) -> tuple[dict[str, int], list[float]]:
    """Return spine, neck, head and arms, and the misfits of the arms."""
    chest, arms = body.branch(hands)
    roles = _trunk(body, hips, chest, arms)
    misfits = []
    for side, arm in arms.items():
        found, misfit = body.limb(body.without_fingers(arm), ARM_FRACTIONS, SHOULDER_FRACTION)
        names = (f"{side}UpperArm", f"{side}LowerArm", f"{side}Hand")
        roles |= dict(zip(names, found, strict=False))
        if found and arm[0] != found[0]:
            roles[f"{side}Shoulder"] = arm[0]
        misfits.append(misfit)
    return roles, misfits


def _trunk(body: "_Body", hips: int, chest: int, arms: dict[str, list[int]]) -> dict[str, int]:
    spine = body.path(hips, chest)
    roles = dict(zip(("spine", "chest"), spine, strict=False))
    if len(spine) > 2:
        roles["chest"] = spine[(len(spine) - 1) // 2]
        roles["upperChest"] = spine[-1]
    arm_joints = body.limb_joints(chest, arms)
    above = [j for j in body.skeleton.subtree(chest) if j != chest and not arm_joints[j]]
    if above:
        top = max(above, key=lambda joint: body.positions[joint, 2])
        neck = body.without_end_sites(body.path(chest, top))
        branch = [j for j in neck if len(body.skeleton.children[j]) > 1]
        neck = neck[: neck.index(branch[0]) + 1] if branch else neck
        roles |= dict(zip(("neck", "head"), (neck[0], neck[-1]), strict=True)) if neck else {}
        if len(neck) == 1:
            del roles["neck"]
    return roles


class _Body:
    """A skeleton with its rest pose measured from the floor."""

    def __init__(self, skeleton: Skeleton) -> None:
        self.skeleton = skeleton
        self.height = max(skeleton.height, 1e-9)
        self.positions: NDArray[np.float64] = skeleton.rest_positions.copy()
        self.positions[:, 2] -= self.positions[:, 2].min()

    def outermost(
        self, extent: NDArray[np.float64], allowed: NDArray[np.bool_]
    ) -> dict[str, int] | None:
        """Return the farthest allowed joint on each side of the root, or None."""
        across = self.positions[:, 0] - self.positions[0, 0]
        found = {}
        for side, sign in (("left", 1.0), ("right", -1.0)):
            candidates = np.flatnonzero(allowed & (sign * across > 0.01 * self.height))
            if not len(candidates):
                return None
            found[side] = int(candidates[extent[candidates].argmax()])
        return found

    def branch(self, ends: dict[str, int]) -> tuple[int, dict[str, list[int]]]:
        """Return the joint where the paths to both ends branch, and the rest of both paths."""
        paths = {s: [end, *self.skeleton.ancestors(end)][::-1] for s, end in ends.items()}
        common = sum(a == b for a, b in zip(paths["left"], paths["right"], strict=False))
        return paths["left"][common - 1], {
            s: self._to_tip(path[common:]) for s, path in paths.items()
        }

    def _to_tip(self, path: list[int]) -> list[int]:
        """Extend a path to the tip: the lowest joint, such as a heel, may not be the last."""
        while path and (children := self.skeleton.children[path[-1]]):
            path = [*path, children[0]]
        return path

    def path(self, start: int, stop: int) -> list[int]:
        """Return the joints from below `start` down to `stop`."""
        up = [stop, *self.skeleton.ancestors(stop)]
        return up[: up.index(start)][::-1] if start in up else []

    def without_end_sites(self, joints: Sequence[int]) -> list[int]:
        """Return these joints without end sites."""
        return [joint for joint in joints if not self.skeleton.is_end_site(joint)]

    def without_fingers(self, arm: list[int]) -> list[int]:
        """Return the arm up to its last branch, with at least three joints.

        If the rest is longer than a hand, the branch is a twist bone and the arm is complete.
        """
        forks = [i for i, joint in enumerate(arm) if len(self.skeleton.children[joint]) > 1]
        if not forks or forks[-1] < 2:
            return arm
        beyond = np.diff(self.positions[arm[forks[-1] :]], axis=0)
        is_hand = np.linalg.norm(beyond, axis=-1).sum() <= MAX_HAND_FRACTION * self.height
        return arm[: forks[-1] + 1] if is_hand else arm

    def toes(self, foot: int) -> int | None:
        """Return the foremost child of the foot, if it is in front of the ankle."""
        children = self.without_end_sites(self.skeleton.children[foot])
        front = min(children, key=lambda joint: self.positions[joint, 1], default=foot)
        return front if self.positions[front, 1] < self.positions[foot, 1] else None

    def limb_joints(self, start: int, limbs: dict[str, list[int]]) -> NDArray[np.bool_]:
        """Return which joints belong to the limbs, shape (n_joints,)."""
        inside = np.zeros(self.skeleton.n_joints, dtype=bool)
        for first in (joint for limb in limbs.values() for joint in limb[:1]):
            inside[self.skeleton.subtree(first)] = True
        return inside

    def limb(
        self, path: Sequence[int], human: tuple[float, float], lateral: float | None = None
    ) -> tuple[list[int], float]:
        """Return upper joint, hinge and end of a limb, and the misfit.

        The misfit is the sum of both bones' absolute log ratios to human lengths. Of several
        upper joints, the one nearest to the human distance `lateral` from the midline, as a
        fraction of the height, is preferred. A limb needs at least three joints.
        """
        joints = self.without_end_sites(path)
        if len(joints) < 3:
            return [], 1.0
        positions = self.positions[joints]
        bones = np.linalg.norm(positions[:, None] - positions, axis=-1) / self.height
        later = np.triu(np.ones_like(bones, dtype=bool), k=1)
        upper, lower = (
            np.where(later, np.abs(np.log(np.maximum(bones, 1e-9) / length)), np.inf)
            for length in human
        )
        preferred = upper + (
            0.0 if lateral is None else self._lateral_misfit(lateral, positions)[:, None]
        )
        # Both bones meet at the hinge; given the hinge, each is chosen independently.
        hinge = int((preferred.min(axis=0) + lower.min(axis=1)).argmin())
        start, end = int(preferred[:, hinge].argmin()), int(lower[hinge].argmin())
        misfit = float(upper[start, hinge] + lower[hinge, end])
        return [joints[index] for index in (start, hinge, end)], misfit

    def _lateral_misfit(
        self, lateral: float, positions: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return absolute log ratios of the distances from the midline to `lateral`."""
        across = np.abs(positions[:, 0] - self.positions[0, 0]) / self.height
        return np.asarray(np.abs(np.log(np.maximum(across, 1e-9) / lateral)))
