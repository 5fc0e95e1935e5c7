"""Learn from a few examples of one behaviour how it varies."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import count

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import Motion, resample
from ..progress import Progress, unwatched, within
from ..rotations import inverse, mean_rotation, multiply, rotation_vector_from_quaternion
from .align_examples import Alignment, align_examples
from .curve_sampling import between_frames, sample_curves
from .far_joints import CALM, tell_far_joints
from .footing import footing_of
from .loops import loops
from .mixing_kernel import MixingKernel
from .motion_curves import (
    HEIGHT,
    IMPOSSIBLE,
    MotionCurves,
    curves_from_motion,
    headings_from_motion,
    remove_heading,
)
from .stepwise_model import learn_stepwise
from .variation_model import VariationModel
from .vary_settings import USUAL, Method, VarySettings

Array = NDArray[np.float64]

ODD = 2.0
"""An example that is so many times farther from the others than usual is of another kind."""
MEMORY = 600_000_000
"""Numbers in all curves together; more would not fit."""


def learn_variation_model(
    motions: Sequence[Motion],
    *,
    settings: VarySettings = USUAL,
    progress: Progress = unwatched,
) -> VariationModel:
    """Learn from examples of one behaviour how it varies.

    The examples are lined up in time; what varies are their curves in common time and how fast
    that passes.

    Parameters
    ----------
    motions : Motion, one or more
        Of one rig, without gaps; other bone lengths and frame rates are brought to those of
        the first. One alone tells nothing of how it varies: see `borrow_variation`.
    settings : VarySettings
        Only the method counts: what it needs is learned.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There is none, rigs differ, a clip has gaps or less than two frames, or no body.
    """
    motions = _of_one_rig(list(motions))
    turns = [headings_from_motion(motion) for motion in motions]
    progress(0.1, "Lining up")
    alignment = align_examples(motions, turns)
    progress(0.6, "Learning")
    plain = [remove_heading(motion, turn) for motion, turn in zip(motions, turns, strict=True)]
    usual = mean_rotation(np.concatenate(plain))
    courses = [
        _in_common_time(curves_from_motion(motion, turn, usual), footing_of(motion), times)
        for motion, turn, times in zip(motions, turns, alignment.times, strict=True)
    ]
    rate = motions[0].frame_rate
    root = np.stack([course.root for course in courses])
    joints = np.stack([course.joints for course in courses])
    is_loop = all(map(loops, motions, turns))
    joints, usual, carrier = tell_far_joints(
        joints, usual, plain, alignment.times, alignment.centre, CALM * rate, is_loop
    )
    joints = _same_turns(joints, alignment.centre)
    footing = np.stack([course.footing for course in courses if course.footing is not None])
    haste = (
        np.log(np.gradient(alignment.times, axis=1)) if root.shape[1] > 1 else 0 * root[..., 0]
    )
    warning = " ".join(filter(None, (*map(_flip, motions, count(1)), _odd_one(alignment))))
    stepwise = None
    if settings.method is not Method.MIXTURE:
        published = settings.method is Method.PUBLISHED
        stepwise = learn_stepwise(
            motions[0].skeleton,
            joints,
            root,
            rate,
            published,
            progress=within(progress, 0.6, 1.0),
        )
    progress(1.0)
    return VariationModel(
        motions[0].skeleton, rate, usual, root, joints, haste, footing, carrier,
        MixingKernel(), alignment.centre, is_loop, warning, stepwise,
    )  # fmt: skip


def _of_one_rig(motions: list[Motion]) -> list[Motion]:
    """Bring examples to the rate and the size of the first, or say why that cannot be."""
    if not motions:
        raise InvalidMotionError("There is no example to vary.")
    first = motions[0]
    for place, motion in enumerate(motions):
        if motion.skeleton.names != first.skeleton.names or (
            motion.skeleton.parents != first.skeleton.parents
        ):
            raise InvalidMotionError(
                f"Example {place + 1} is of another rig than the first; retarget it first."
            )
        if motion.n_frames < 2:
            raise InvalidMotionError(f"Example {place + 1} has one frame; it shows no motion.")
        observed = (
            np.isfinite(motion.rotations).all() and np.isfinite(motion.root_positions).all()
        )
        if not observed:
            raise InvalidMotionError(f"Example {place + 1} has gaps; clean it first.")
    if (
        sum(motion.n_frames for motion in motions) * len(motions) * first.skeleton.n_joints
        > MEMORY
    ):
        raise InvalidMotionError("The examples are too long to vary; cut out what is to vary.")
    return [_as_first(motion, first) for motion in motions]


def _as_first(motion: Motion, first: Motion) -> Motion:
    if motion.frame_rate != first.frame_rate:
        motion = resample(motion, first.frame_rate)
    sizes = [np.linalg.norm(one.skeleton.offsets, axis=-1).sum() for one in (first, motion)]
    places = motion.root_positions * (sizes[0] / max(sizes[1], 1e-9))
    return replace(motion, skeleton=first.skeleton, root_positions=places)


def _in_common_time(course: MotionCurves, footing: Array, times: Array) -> MotionCurves:
    """Return a course at its frames `times`; ways are those between them."""
    joints = sample_curves(course.joints, times)
    places = np.column_stack([
        np.cumsum(course.root[:, :HEIGHT], axis=0),
        course.root[:, HEIGHT:],
    ])
    root = sample_curves(places, times)
    root[:, :HEIGHT] = np.diff(root[:, :HEIGHT], axis=0, prepend=root[:1, :HEIGHT])
    return MotionCurves(root, joints, between_frames(footing, times))


def _same_turns(joints: Array, centre: int) -> Array:
    """Tell rotation vectors that mean the same by the one nearer to the centre's."""
    length = np.linalg.norm(joints, axis=-1, keepdims=True)
    other = joints * (1.0 - 2.0 * np.pi / np.where(length > 0.0, length, np.inf))
    stay = np.linalg.norm(joints - joints[centre], axis=-1, keepdims=True).mean(axis=1)
    turn = np.linalg.norm(other - joints[centre], axis=-1, keepdims=True).mean(axis=1)
    return np.where((turn < stay)[:, None], other, joints)


def _flip(motion: Motion, number: int) -> str:
    """Return a sentence about a joint that turns as none can; empty without one."""
    steps = multiply(inverse(motion.rotations[:-1]), motion.rotations[1:])
    angles = np.linalg.norm(rotation_vector_from_quaternion(steps), axis=-1)
    if not (angles > IMPOSSIBLE).any():
        return ""
    frame, joint = divmod(int((angles > IMPOSSIBLE).argmax()), angles.shape[1])
    return (
        f"{motion.skeleton.names[joint]} of example {number} turns by"
        f" {np.degrees(angles[frame, joint]):.0f} degrees within a frame at"
        f" {(frame + 1) / motion.frame_rate:.2f} s: clean it first, or variants jump too."
    )


def _odd_one(alignment: Alignment) -> str:
    """Return a sentence about the example that is not like the others; empty without one."""
    n = len(alignment.distances)
    if n < 3:
        return ""
    apart = alignment.distances.sum(axis=0) / (n - 1)
    worst = int(apart.argmax())
    if apart[worst] <= ODD * np.median(apart):
        return ""
    return (
        f"Example {worst + 1} is {apart[worst] / np.median(apart):.1f} times as far from the"
        " others as they are from each other: it seems to be of another behaviour."
    )
