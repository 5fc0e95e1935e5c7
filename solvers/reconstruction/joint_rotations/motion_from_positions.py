"""The rotations of a skeleton whose joints go where they were tracked or rebuilt."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import (
    Motion,
    Skeleton,
    Tracks,
    local_rotations,
    roles_by_name,
    skeleton_from_points,
)
from ...motion.humanoid import FEWEST, RELIABLE, posture_positions
from ...rotations import IDENTITY, best_turns, multiply, rotate, rotation_between, slerp
from .clavicles import add_clavicle_joints
from .limb_twist import (
    HINGES,
    UNKNOWN_HINGES,
    HingeAxes,
    Limb,
    rotations_from_flexion,
    rotations_from_thumb,
    smooth_direction,
)
from .reach_ankles import pelvis_offsets, reach_ankles
from .trunk_twist import LimbTwists, hinges_from_twists

Array = NDArray[np.float64]
MIN_LENGTH_M = 1e-3
"""Metres. Bones and ways that are shorter tell no direction."""
FREE_LENGTH_M, AIMED_LENGTH_M = 0.1, 0.2
"""Metres. Shorter bones keep the direction that was seen, longer ones make for the place."""
GRANDCHILD_WEIGHT = 0.3
"""How much a child that has a joint of its own to point with tells of the one above."""
LIMBS = {
    f"{side}{upper}": (f"{side}{lower}", f"{side}{end}")
    for side in ("left", "right")
    for upper, lower, end in (
        ("UpperArm", "LowerArm", "Hand"),
        ("UpperLeg", "LowerLeg", "Foot"),
    )
}
HANDS = ("leftHand", "rightHand")


class _ChildDirections(NamedTuple):
    """Where the children of a joint are, as it is in the rest pose and as it was seen."""

    rest: Array
    """Shape (n, 3), metres."""
    seen: Array
    """Shape (n_frames, n, 3)."""
    hard: Array
    """Whether the joint alone points there, shape (n,)."""
    known: NDArray[np.bool_]
    """Whether both ends were seen, shape (n_frames, n)."""


class _RotationSolver:
    """A skeleton that is turned joint by joint, from the root on."""

    def __init__(self, skeleton: Skeleton, places: Array, trust: Array, frame_rate: float):
        self.skeleton, self.places, self.trust = skeleton, places, trust
        self.frame_rate = frame_rate
        roles = roles_by_name(skeleton.names)
        self.roles = {role: skeleton.names.index(name) for role, name in roles.items()}
        self.limbs = self._limbs()
        self.hands = {self.roles[role] for role in HANDS if role in self.roles}
        self.world = np.empty((*places.shape[:2], 4))
        self.at = np.array(places)
        """Where the joints come to be."""
        self.hinges: dict[str, HingeAxes] = {}
        """Where like postures have the hinges of limbs, by the roles of their upper joints."""

    def _limbs(self) -> dict[int, Limb]:
        found = {}
        for upper, below in LIMBS.items():
            first, second, end = (self.roles.get(role, -1) for role in (upper, *below))
            parents = [self.skeleton.parents[joint] for joint in (second, end)]
            if parents == [first, second] and first > 0:
                found[first] = Limb(first, second, end, HINGES[upper[-3:]], upper)
        return found

    def legs(self) -> dict[int, Limb]:
        """Return those limbs that are legs, by their upper joints."""
        uppers = [self.roles.get(f"{side}UpperLeg", -1) for side in ("left", "right")]
        return {upper: limb for upper, limb in self.limbs.items() if upper in uppers}

    def give_way(self) -> None:
        """Move the pelvis to where straight legs reach the ankles."""
        legs = list(self.legs().values())
        self.at[:, 0] += pelvis_offsets(self.places, self.at, self.trust, legs, self.frame_rate)

    def turn_all(self) -> None:
        """Turn every joint and put its children in place."""
        trunk = self._trunk()
        for joint, parent in enumerate(self.skeleton.parents):
            if parent >= 0:
                moved = rotate(self.world[:, parent], self.skeleton.offsets[joint])
                known = self.at[:, parent] + moved
                told = np.isfinite(known).all(axis=-1, keepdims=True)
                self.at[:, joint] = np.where(told, known, self.places[:, joint])
            above = self._above(joint, parent, trunk)
            self.world[:, joint] = self._turned(joint, above)
            self.world[:, joint] = self._twisted(joint)

    def _twisted(self, joint: int) -> Array:
        """Twist an upper arm, a thigh or a hand about itself; all else stays."""
        turns = self.world[:, joint]
        if joint in self.limbs:
            limb, body = self.limbs[joint], self.skeleton
            known = self.hinges.get(limb.role, UNKNOWN_HINGES)
            return rotations_from_flexion(
                turns, limb, body, self.places, self.trust, self.frame_rate, known
            )
        if joint in self.hands and len(self.skeleton.children[joint]) > 1:
            hand, thumb = self.skeleton.children[joint][:2]
            along, aside = (self.skeleton.offsets[each] for each in (hand, thumb))
            seen = self.places[:, thumb] - self.places[:, joint]
            return rotations_from_thumb(
                turns, along, aside, seen, self.trust[:, thumb], self.frame_rate
            )
        return turns

    def _above(self, joint: int, parent: int, trunk: dict[int, float]) -> Array:
        """Return what a joint turns out of: its parent's turn; a spine shares the chest's."""
        if parent < 0:
            return np.broadcast_to(IDENTITY, self.world[:, 0].shape)
        if joint not in trunk:
            return self.world[:, parent]
        chest = best_turns(*self._ways(self.chest)[:2])
        mixed = slerp(self.world[:, parent], chest, trunk[joint])
        return np.where(np.isfinite(mixed), mixed, self.world[:, parent])

    def _trunk(self) -> dict[int, float]:
        """Return the joints between hips and chest, and what share of the rest of the twist
        each of them takes over.
        """
        arms = [self.roles.get(f"{side}UpperArm", -1) for side in ("left", "right")]
        if min(arms) < 0:
            return {}
        chains = [self.skeleton.ancestors(arm) for arm in arms]
        shared = [joint for joint in chains[0] if joint in chains[1]]
        if len(shared) < 3:
            return {}
        self.chest = shared[0]
        between = shared[1:-1][::-1]
        return {joint: 1.0 / (len(between) + 1 - at) for at, joint in enumerate(between)}

    def _ways(self, joint: int) -> _ChildDirections:
        rest, seen, hard = [], [], []
        children = self.skeleton.children[joint]
        if joint in self.hands:  # a thumb tells less of a hand than it shakes
            children = children[:1]
        for child in children:
            if np.linalg.norm(self.skeleton.offsets[child]) > MIN_LENGTH_M:
                rest.append(self.skeleton.offsets[child])
                seen.append(self._way(joint, child))
                hard.append(True)
                continue
            for beyond in self.skeleton.children[child]:
                rest.append(GRANDCHILD_WEIGHT * self.skeleton.offsets[beyond])
                seen.append(
                    GRANDCHILD_WEIGHT * (self.places[:, beyond] - self.places[:, joint])
                )
                hard.append(False)
        shape = (len(self.places), len(rest), 3)
        ways = np.stack(seen, axis=1) if seen else np.zeros(shape)
        known = np.isfinite(ways).all(axis=-1)
        lengths = np.linalg.norm(np.nan_to_num(ways), axis=-1, keepdims=True)
        ways = np.where(lengths > MIN_LENGTH_M, ways, np.nan)
        return _ChildDirections(
            np.array(rest).reshape(-1, 3), ways, np.array(hard, bool), known
        )

    def _way(self, joint: int, child: int) -> Array:
        """Return the way to a child: to its very place where the bone is long."""
        length = float(np.linalg.norm(self.skeleton.offsets[child]))
        above = self.skeleton.parents[joint]
        if self.hands & {joint, above}:
            seen = self.places[:, child] - self.places[:, joint]
            return smooth_direction(
                seen, self.world[:, above], self.skeleton.offsets[joint],
                self.trust[:, child], self.frame_rate,
            )  # fmt: skip
        share = np.clip((length - FREE_LENGTH_M) / (AIMED_LENGTH_M - FREE_LENGTH_M), 0.0, 1.0)
        astray = self.places[:, joint] - self.at[:, joint]
        return np.asarray(
            self.places[:, child] - self.places[:, joint] + share * np.nan_to_num(astray)
        )

    def _turned(self, joint: int, above: Array) -> Array:
        """World rotations of a joint, shape (n_frames, 4), that turns out of `above`.

        Where children were seen but lie too near to tell a direction, it goes on as it was.
        """
        ways = self._ways(joint)
        if not len(ways.rest):
            return above
        turns = above
        if len(ways.rest) > 1:
            turns = _fill_undefined(best_turns(ways.rest, ways.seen), above, ways.known)
        aims = np.flatnonzero(ways.hard) if ways.hard.any() else np.arange(len(ways.rest))
        if len(aims) > 1:
            return turns
        way, rest = ways.seen[:, aims[0]], rotate(turns, ways.rest[aims[0]])
        told = (np.isfinite(way) & np.isfinite(rest)).all(axis=-1)[:, None]
        swing = rotation_between(np.where(told, rest, 1.0), np.where(told, way, 1.0))
        return _fill_undefined(
            np.where(told, multiply(swing, turns), np.nan), turns, ways.known[:, aims]
        )


def _fill_undefined(turns: Array, otherwise: Array, known: NDArray[np.bool_]) -> Array:
    """Fill what is not told, in frames in which all children were seen."""
    lost = np.isnan(turns).any(axis=-1) & known.all(axis=-1)
    return np.where(lost[:, None], otherwise, turns)


def motion_from_positions(
    tracks: Tracks,
    parents: Sequence[int],
    reliability: Array | None = None,
    *,
    skeleton: Skeleton | None = None,
    twists: LimbTwists | None = None,
) -> Motion:
    """Let a skeleton of constant bone lengths go where joints were tracked or rebuilt.

    The root is where it was seen, or as near as straight legs let it be (`pelvis_shift`); knees
    bend until ankles are where they were seen (`reach_ankles`). Pelvis and chest turn so that
    hips, shoulders, spine and neck come nearest to where they are (`best_turns`), and the spine
    between them shares the twist. All else points at the place of its child, so that an error
    is not handed down. How far an upper arm or a thigh is twisted is told by the plane in which
    elbow or knee bends, where it bends; where it is straight, by the bends before and after,
    like postures and the trunk (`hinge_turns`). A thumb tells the same of its hand, whose palm
    and tip are steadied. Everywhere else a joint turns the short way out of its parent's turn.

    Parameters
    ----------
    tracks : Tracks
        One point for each joint, in any order.
    parents : sequence of int, length n_points
        The point that each hangs on; -1 for the only root.
    reliability : shape (n_frames, n_points), 0 to 1, optional
        Bones are as long as in reliable frames, and reliable bends tell the twist.
    skeleton : Skeleton, optional
        Of these points, in a T-pose that faces -Y; by default that of `skeleton_from_points`,
        with shoulders and spine that move on the trunk (`with_girdles`).
    twists : LimbTwists, optional
        How like postures have limbs twisted; weighed against the planes of bends, or all that
        tells the twist where they are to be `alone`.

    Returns
    -------
    Motion
        Rotations are NaN where nothing tells them, as in `motion_from_points`.

    Raises
    ------
    InvalidMotionError
        The points do not form one tree of which anything was seen, or the skeleton has joints
        that are not among them.
    """
    trust = np.ones(tracks.positions.shape[:2]) if reliability is None else reliability
    if trust.shape != tracks.positions.shape[:2]:
        raise InvalidMotionError(
            f"Reliability needs shape {tracks.positions.shape[:2]}, not {trust.shape}."
        )
    made = skeleton or add_clavicle_joints(
        skeleton_from_points(_without_unreliable(tracks, trust), parents)
    )
    points = _points_of_joints(made, tracks.names)
    body = _RotationSolver(
        made, tracks.positions[:, points], trust[:, points], tracks.frame_rate
    )
    if twists is not None:
        body.hinges = hinges_from_twists(posture_positions(tracks), twists)
    body.turn_all()
    if body.legs():
        body.give_way()
        body.turn_all()
    rotations = local_rotations(made, body.world)
    rotations[:, [not children for children in made.children]] = IDENTITY
    motion = Motion(made, rotations, body.at[:, 0], tracks.frame_rate)
    return reach_ankles(motion, body.places, body.legs())


def _points_of_joints(skeleton: Skeleton, names: Sequence[str]) -> list[int]:
    """Return the point of each joint; one of no length is where the one above it is."""
    points: list[int] = []
    for joint, name in enumerate(skeleton.names):
        if name in names:
            points.append(list(names).index(name))
        elif np.linalg.norm(skeleton.offsets[joint]) <= MIN_LENGTH_M and joint > 0:
            points.append(points[skeleton.parents[joint]])
        else:
            raise InvalidMotionError(
                f"The skeleton has a joint that was not tracked: {name}. Give none, or that of"
                " these points."
            )
    return points


def _without_unreliable(tracks: Tracks, trust: Array) -> Tracks:
    """Leave out what is not reliable, of joints that have enough that is."""
    sure = (trust > RELIABLE) & tracks.visible
    kept = sure | (sure.sum(axis=0) < FEWEST)
    return tracks.with_positions(np.where(kept[..., None], tracks.positions, np.nan))
