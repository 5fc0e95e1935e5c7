"""Takes whose feet bear no weight: nothing of them may be planted.

Of captures the frames are listed that the pictures show, at 30 Hz; of CMU's playground there is
the complete take, whose floor other frames show, and the window alone, whose floor is nowhere.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from solvers.arrays import Array
from solvers.motion import Motion
from solvers.recordings import read_acclaim
from solvers.rotations import quaternion_from_rotation_vector
from solvers.rotations.representations import IDENTITY
from solvers.samples import walker_skeleton

from ..first_press import takes
from ..shared import clips

RATE_HZ = 30.0
LYING = {
    "bk_lieDownFloor_005": 115, "bk_lieDownFloor_006": 105, "bk_lieDownFloor_008": 115,
    "bk_lieDownFloor_010": 105, "dg_lieDownFloor_011": 62, "dg_lieDownFloor_012": 62,
    "dg_lieDownFloor_013": 62, "dg_lieDownFloor_014": 62,
}  # fmt: skip
"""Takes of HDM05, and the frame from which on the hips are on the floor for good."""
HANGING = {
    "01_06 legs dangle": ("01_06", 210, 350),
    "01_09 legs dangle": ("01_09", 240, 395),
    "01_09 hangs": ("01_09", 840, 965),
}
"""Takes of CMU's playground, first frame and the frame after the last."""
MADE_S = 5.0


@dataclass(frozen=True, eq=False)
class WeightlessFeet:
    """A motion, and the frames in which no foot bears weight."""

    motion: Motion
    frames: slice


def weightless_takes() -> Iterator[tuple[str, WeightlessFeet]]:
    """Return the takes by name."""
    for name, first in LYING.items():
        motion = read_acclaim(clips.HDM05 / f"HDM_{name}_120.amc")
        yield f"{name}, lies", _from(clips.every(motion, clips.STEP), first)
    for name, (take, first, stop) in HANGING.items():
        motion = takes.read_variety(take)
        motion = clips.every(motion, round(motion.frame_rate / RATE_HZ))
        yield name, _from(motion, first, stop)
        yield f"{name}, window alone", _from(motion.slice(first, stop), 0)
    for name, motion in made_takes().items():
        yield f"made: {name}", _from(motion, 0)


def made_takes() -> dict[str, Motion]:
    """Return bodies that hang, float, lie, sit on the floor, and turn a cartwheel."""
    time = np.arange(round(MADE_S * RATE_HZ)) / RATE_HZ
    swing, slide = np.sin(2.0 * np.pi * 0.5 * time), 1.0 - np.cos(time)
    return {
        "hangs from a bar and swings": _body(
            _about_x(0.25 * swing), [0.0, 0.0, 1.6],
            {"UpLeg": 0.1 * swing, "Leg": 0.1 - 0.1 * swing},
        ),
        "floats on its front": _body(
            _about_x(np.full_like(time, np.pi / 2)), [0.0, 0.0, 1.0],
            {"UpLeg": 0.25 * swing}, opposite=True,
        ),
        "lies on its back, a leg slides": _body(
            _about_x(np.full_like(time, -np.pi / 2)), [0.0, 0.0, 0.1],
            {"UpLeg": -0.35 * slide, "Leg": 0.8 * slide},
            sides=("Left",),
        ),
        "sits on the floor, a leg slides": _body(
            _about_x(np.zeros_like(time)), [0.0, 0.0, 0.12],
            {"UpLeg": -np.pi / 2 - 0.25 * slide, "Leg": 0.5 * slide},
        ),
        "cartwheel": _cartwheel(time),
    }  # fmt: skip


def _cartwheel(time: Array) -> Motion:
    """Turn sideways about the hips, legs and arms spread, in two seconds, over and over."""
    angle = np.pi * time
    rotation = quaternion_from_rotation_vector(angle[:, None] * (0.0, 1.0, 0.0))
    motion = _body(rotation, [0.0, 0.0, 1.0], {})
    rotations = motion.rotations.copy()
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        spread = quaternion_from_rotation_vector([0.0, -sign * 0.6, 0.0])
        rotations[:, motion.skeleton.index(f"{side}UpLeg")] = spread
        raised = quaternion_from_rotation_vector([0.0, -sign * 1.1, 0.0])
        rotations[:, motion.skeleton.index(f"{side}Arm")] = raised
    root = motion.root_positions.copy()
    root[:, 0] = 1.0 * angle
    return motion.with_poses(rotations, root)


def _body(
    body: Array,
    hips: list[float],
    legs: dict[str, Array],
    *,
    sides: tuple[str, ...] = ("Left", "Right"),
    opposite: bool = False,
) -> Motion:
    """Return a body with the given rotations of hips (n_frames, 4) and flexions of the legs."""
    skeleton = walker_skeleton()
    rotations = np.tile(IDENTITY, (len(body), skeleton.n_joints, 1))
    rotations[:, 0] = body
    for number, side in enumerate(sides):
        sign = -1.0 if opposite and number else 1.0
        for joint, angle in legs.items():
            rotations[:, skeleton.index(side + joint)] = _about_x(sign * angle)
    return Motion(skeleton, rotations, np.tile(hips, (len(body), 1)), RATE_HZ)


def _about_x(angle: Array) -> Array:
    return quaternion_from_rotation_vector(np.asarray(angle)[:, None] * (1.0, 0.0, 0.0))


def _from(motion: Motion, first: int, stop: int | None = None) -> WeightlessFeet:
    return WeightlessFeet(motion, slice(first, stop))
