"""Planting next to pins of Blender's own inverse kinematics, really run in Blender."""

from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from solvers.arrays import Array, Flags
from solvers.feet.legs import LegJoints, find_legs
from solvers.feet.sole_contact import find_foot_contact
from solvers.feet.standing_feet import detect_standing_feet
from solvers.motion import Motion, find_humanoid_map, forward_kinematics
from solvers.motion.humanoid import SIDES

from ..peers.blender_ik import has_blender, pin_in_blender
from ..shared.tables import number, table
from .part_takes import COLUMNS, INPUTS, take_figures
from .part_walks import PLANTERS, eased_ankles, feet_joints, joint_slide, locked_ankles

PINS = {
    "Blender's IK, pins": locked_ankles,
    "Blender's IK, pins with easing": eased_ankles,
}
"""Positions of the ankles: an animator keys them with and without easing."""
PINNED_INPUTS = ("as they are", "a root that jitters by 1 cm")
TABLE_COLUMNS = (
    "slide of the sole, cm/s", "slide of the joints, cm/s", "below the floor, mm",
    "knee, times given", "worst", "largest change, deg", "worst change", "hips moved, cm",
    "ms a frame",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Take:
    given: Motion
    contacts: Flags
    legs: Sequence[LegJoints]


def pin_tables(motions: Sequence[Motion]) -> list[str]:
    """Return a table for each kind of input.

    The slide of the joints is that of the slower of ankle and toes. Below the floor: how far
    the lowest point of a sole in contact is under its height of standing, in the mean. The time
    of Blender is that of baking; without Blender its rows are "-".
    """
    return [_table(name, [_take(INPUTS[name](motion)) for motion in motions])
            for name in PINNED_INPUTS]  # fmt: skip


def _take(given: Motion) -> _Take:
    humanoid = find_humanoid_map(given.skeleton)
    legs = find_legs(given.skeleton, humanoid)
    return _Take(given, detect_standing_feet(given, humanoid, legs), legs)


def _table(what: str, takes: Sequence[_Take]) -> str:
    rows = {}
    for name, plant in PLANTERS.items():
        figures = []
        for take in takes:
            started = perf_counter()
            planted = plant(take.given, take.contacts)
            figures.append(_figures(take, planted, perf_counter() - started))
        rows[name] = _cells(figures)
    for name, ankles in PINS.items():
        if has_blender():
            jobs = [(take.given, ankles(take.given, take.contacts)) for take in takes]
            results = zip(takes, pin_in_blender(jobs), strict=True)
            rows[name] = _cells([_figures(take, *result) for take, result in results])
        else:
            rows[name] = ["-"] * len(TABLE_COLUMNS)
    title = f"**Pins of Blender's own IK, {what}, {len(takes)} takes**"
    return f"{title}\n\n{table(['method', *TABLE_COLUMNS], rows)}\n"


def _figures(take: _Take, planted: Motion, seconds: float) -> list[float]:
    given = take.given
    of_take = dict(
        zip(COLUMNS, take_figures(given, planted, take.legs, take.contacts), strict=False)
    )
    joints = joint_slide(feet_joints(planted, take.legs), take.contacts, given.frame_rate)
    return [
        of_take["slide, cm/s"], 100.0 * joints, 1000.0 * _depth(take, planted),
        of_take["knee, times given"], of_take["worst"], of_take["largest change, deg"],
        of_take["worst change"], of_take["hips moved, cm"],
        1000.0 * seconds / given.n_frames,
    ]  # fmt: skip


def _cells(figures: Sequence[Sequence[float]]) -> list[str]:
    worst = [column.startswith("worst") for column in TABLE_COLUMNS]
    columns = np.transpose(figures)
    return [
        number(float(column.max() if is_worst else column.mean()))
        for column, is_worst in zip(columns, worst, strict=True)
    ]


def _depth(take: _Take, planted: Motion) -> float:
    """Return how far soles in contact are below the floor in the mean, meters."""
    before, after = forward_kinematics(take.given), forward_kinematics(planted)
    depths: list[Array] = [np.zeros(0)]
    for leg in take.legs:
        contact = take.contacts[:, SIDES.index(leg.side)]
        foot = find_foot_contact(take.given, before, leg, contact)
        heights = np.stack([point.position(after)[:, 2] for point in foot.points], axis=1)
        above = (heights - foot.standing_heights - foot.floor).min(axis=1)
        depths.append(np.maximum(-above[contact], 0.0))
    found = np.concatenate(depths)
    return float(found.mean()) if len(found) else 0.0
