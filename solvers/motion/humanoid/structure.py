"""Read which joint plays which humanoid role from the rest pose, when names say nothing."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..skeletons import Skeleton

# Lengths of the upper and lower limb as parts of body height (Drillis & Contini 1966, as
# tabled by Winter 2009, Biomechanics and Motor Control of Human Movement, figure 4.1).
ARM = (0.186, 0.146)
LEG = (0.245, 0.246)
SHOULDER = 0.129
"""From the middle of the body to the shoulder; collar bones begin nearer to it."""
HAND = 0.13
"""Longest way from wrist to fingertip (0.108), with some room."""
FEET = 0.15
"""Feet end in the lowest part of the body, arms above half its height."""


def roles_by_structure(skeleton: Skeleton) -> tuple[dict[str, str], float]:
    """Return joint names by role, and how human the proportions are, 0 to 1.

    The rest pose must stand upright and face -Y, so that the character's left is +X. Hips are
    where the ways to the lowest joint of either side part; the upper chest where the ways to
    the farthest joint of either side do. Along each limb, knee and ankle, elbow and wrist are
    the joints that divide it most like a human limb. Fingers get no role.

    Returns
    -------
    dict of role to joint name, and float; empty and 0.0 where there are not two legs.
    """
    body = _Body(skeleton)
    feet = body.outermost(-body.positions[:, 2], body.positions[:, 2] <= FEET * body.height)
    if feet is None:
        return {}, 0.0
    hips, legs = body.part(feet)
    roles, misfits = {"hips": hips}, []
    for side, leg in legs.items():
        found, misfit = body.limb(leg, LEG)
        names = (f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot")
        roles |= dict(zip(names, found, strict=False))
        if found and (toes := body.toes(found[-1])) is not None:
            roles[f"{side}Toes"] = toes
        misfits.append(misfit)
    hands = body.outermost(
        np.abs(body.positions[:, 0] - body.positions[hips, 0]),
        (body.positions[:, 2] > 0.4 * body.height) & ~body.below(hips, legs),
    )
    if hands is not None:
        found_above, misfits_above = _upper_body(body, hips, hands)
        roles |= found_above
        misfits += misfits_above
    share = len(misfits) / 4
    first_role: dict[int, str] = {}
    for role, joint in roles.items():  # In what is no body, a joint may seem to be two things.
        first_role.setdefault(joint, role)
    return (
        {role: skeleton.names[joint] for joint, role in first_role.items()},
        float(share * np.exp(-np.mean(misfits))),
    )


def _upper_body(
    body: "_Body", hips: int, hands: dict[str, int]
) -> tuple[dict[str, int], list[float]]:
    """Return spine, neck, head and arms, and how far the arms are from human ones."""
    chest, arms = body.part(hands)
    roles = _trunk(body, hips, chest, arms)
    misfits = []
    for side, arm in arms.items():
        found, misfit = body.limb(body.without_fingers(arm), ARM, SHOULDER)
        names = (f"{side}UpperArm", f"{side}LowerArm", f"{side}Hand")
        roles |= dict(zip(names, found, strict=False))
        if found and arm[0] != found[0]:
            roles[f"{side}Shoulder"] = arm[0]
        misfits.append(misfit)
    return roles, misfits


def _trunk(body: "_Body", hips: int, chest: int, arms: dict[str, list[int]]) -> dict[str, int]:
    spine = body.way(hips, chest)
    roles = dict(zip(("spine", "chest"), spine, strict=False))
    if len(spine) > 2:
        roles["chest"] = spine[(len(spine) - 1) // 2]
        roles["upperChest"] = spine[-1]
    arm_joints = body.below(chest, arms)
    above = [j for j in body.skeleton.subtree(chest) if j != chest and not arm_joints[j]]
    if above:
        top = max(above, key=lambda joint: body.positions[joint, 2])
        neck = body.rotating(body.way(chest, top))
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
        self, far: NDArray[np.float64], allowed: NDArray[np.bool_]
    ) -> dict[str, int] | None:
        """Return the farthest allowed joint on each side of the root, or None."""
        across = self.positions[:, 0] - self.positions[0, 0]
        found = {}
        for side, sign in (("left", 1.0), ("right", -1.0)):
            there = np.flatnonzero(allowed & (sign * across > 0.01 * self.height))
            if not len(there):
                return None
            found[side] = int(there[far[there].argmax()])
        return found

    def part(self, ends: dict[str, int]) -> tuple[int, dict[str, list[int]]]:
        """Return the joint at which the ways to both ends part, and the rest of both ways."""
        ways = {s: [end, *self.skeleton.ancestors(end)][::-1] for s, end in ends.items()}
        common = sum(a == b for a, b in zip(ways["left"], ways["right"], strict=False))
        return ways["left"][common - 1], {
            s: self._whole(way[common:]) for s, way in ways.items()
        }

    def _whole(self, way: list[int]) -> list[int]:
        """Go on to the tip: the lowest joint, a heel perhaps, need not be the last."""
        while way and (children := self.skeleton.children[way[-1]]):
            way = [*way, children[0]]
        return way

    def way(self, start: int, stop: int) -> list[int]:
        """Return the joints from below `start` down to `stop`."""
        up = [stop, *self.skeleton.ancestors(stop)]
        return up[: up.index(start)][::-1] if start in up else []

    def rotating(self, joints: Sequence[int]) -> list[int]:
        """Return these joints without end sites."""
        return [joint for joint in joints if not self.skeleton.is_end_site(joint)]

    def without_fingers(self, arm: list[int]) -> list[int]:
        """Return the arm down to where it last branches, which leaves three joints at least.

        Where more than a hand follows, what branches off there is a twist bone.
        """
        forks = [i for i, joint in enumerate(arm) if len(self.skeleton.children[joint]) > 1]
        if not forks or forks[-1] < 2:
            return arm
        beyond = np.diff(self.positions[arm[forks[-1] :]], axis=0)
        is_hand = np.linalg.norm(beyond, axis=-1).sum() <= HAND * self.height
        return arm[: forks[-1] + 1] if is_hand else arm

    def toes(self, foot: int) -> int | None:
        """Return the foremost joint that hangs on the foot, if it is before the ankle."""
        children = self.rotating(self.skeleton.children[foot])
        front = min(children, key=lambda joint: self.positions[joint, 1], default=foot)
        return front if self.positions[front, 1] < self.positions[foot, 1] else None

    def below(self, start: int, limbs: dict[str, list[int]]) -> NDArray[np.bool_]:
        """Tell which joints belong to the limbs that leave from `start`."""
        inside = np.zeros(self.skeleton.n_joints, dtype=bool)
        for first in (joint for limb in limbs.values() for joint in limb[:1]):
            inside[self.skeleton.subtree(first)] = True
        return inside

    def limb(
        self, way: Sequence[int], human: tuple[float, float], aside: float | None = None
    ) -> tuple[list[int], float]:
        """Return upper joint, hinge and end of a limb, and the misfit.

        The misfit is the sum of both bones' absolute log ratios to human lengths. Of several
        upper joints, that is preferred which is as far `aside` from the middle as a human's,
        in parts of the height. A way of less than three joints is no limb.
        """
        joints = self.rotating(way)
        if len(joints) < 3:
            return [], 1.0
        places = self.positions[joints]
        bones = np.linalg.norm(places[:, None] - places, axis=-1) / self.height
        ahead = np.triu(np.ones_like(bones, dtype=bool), k=1)
        upper, lower = (
            np.where(ahead, np.abs(np.log(np.maximum(bones, 1e-9) / length)), np.inf)
            for length in human
        )
        preferred = upper + (0.0 if aside is None else self._far_from(aside, places)[:, None])
        # Both bones meet at the hinge; given the hinge, each is chosen for itself.
        hinge = int((preferred.min(axis=0) + lower.min(axis=1)).argmin())
        start, end = int(preferred[:, hinge].argmin()), int(lower[hinge].argmin())
        misfit = float(upper[start, hinge] + lower[hinge, end])
        return [joints[place] for place in (start, hinge, end)], misfit

    def _far_from(self, aside: float, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return absolute log ratios of the distances from the middle to `aside`."""
        across = np.abs(places[:, 0] - self.positions[0, 0]) / self.height
        return np.asarray(np.abs(np.log(np.maximum(across, 1e-9) / aside)))
