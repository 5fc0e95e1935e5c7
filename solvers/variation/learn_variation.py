"""Learn from a few examples of one behavior how it varies."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import count

import numpy as np

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import Motion, resample
from ..progress import Progress, unwatched, within
from ..rotations import inverse, mean_rotation, multiply, rotation_vector_from_quaternion
from .align_examples import AlignedExamples, align_examples
from .contact_state import measure_contact_state
from .curves import (
    HEIGHT_COLUMN,
    MAX_FRAME_ROTATION_RAD,
    MotionCurves,
    curves_from_motion,
    headings_from_motion,
    remove_heading,
    sample_curves,
    sample_linearly,
)
from .loops import detect_loop
from .mixing_kernel import MixingKernel
from .moving_references import REFERENCE_SMOOTHING_S, split_moving_references
from .published import StepwiseModel
from .variation_model import VariationModel
from .vary_settings import DEFAULT_SETTINGS, VaryMethod, VarySettings

MAX_DISTANCE_RATIO = 2.0
"""Distance to the other examples, relative to the median, beyond which an example is reported
as an outlier. It guards sets of examples with a clip of another behavior, and only decides a
warning."""
MAX_VALUES = 600_000_000
"""Maximum count of values in all curves together, so that they fit in memory. It bounds the
memory."""


def learn_variation_model(
    motions: Sequence[Motion],
    *,
    settings: VarySettings = DEFAULT_SETTINGS,
    progress: Progress = unwatched,
) -> VariationModel:
    """Learn from examples of one behavior how it varies.

    The examples are aligned in time. Their curves in common time vary, and so does the speed at
    which the common time passes.

    Parameters
    ----------
    motions : Motion, one or more
        Of one rig, without gaps; bone lengths and frame rates are converted to those of the
        first. A single example shows no variation: see `borrow_variation`.
    settings : VarySettings
        Only the method is used: it decides which parameters are learned.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There is no example, rigs differ, a clip has gaps or fewer than two frames, or no body.
    """
    motions = _validate_examples(list(motions))
    headings = [headings_from_motion(motion) for motion in motions]
    progress(0.1, "Aligning")
    alignment = align_examples(motions, headings)
    progress(0.6, "Learning")
    rotations = list(map(remove_heading, motions, headings))
    reference_rotations = mean_rotation(np.concatenate(rotations))
    curves = [
        _sample_in_common_time(
            curves_from_motion(motion, heading, reference_rotations),
            measure_contact_state(motion),
            times,
        )
        for motion, heading, times in zip(motions, headings, alignment.times, strict=True)
    ]
    frame_rate = motions[0].frame_rate
    root = np.stack([one.root for one in curves])
    joints = np.stack([one.joints for one in curves])
    all_loop = all(map(detect_loop, motions, headings))
    joints, reference_rotations, moving_references = split_moving_references(
        joints,
        reference_rotations,
        rotations,
        alignment.times,
        alignment.center,
        REFERENCE_SMOOTHING_S * frame_rate,
        all_loop,
    )
    joints = _choose_nearest_vectors(joints, alignment.center)
    contact_states = np.stack([
        one.contact_state for one in curves if one.contact_state is not None
    ])
    log_warp_rates = (
        np.log(np.gradient(alignment.times, axis=1)) if root.shape[1] > 1 else 0 * root[..., 0]
    )
    warning = " ".join(
        filter(None, (*map(_describe_flip, motions, count(1)), _describe_outlier(alignment)))
    )
    stepwise = None
    if settings.method is not VaryMethod.MIXTURE:
        stepwise = StepwiseModel.learn(
            motions[0].skeleton,
            joints,
            root,
            frame_rate,
            settings.method is VaryMethod.PUBLISHED,
            progress=within(progress, 0.6, 1.0),
        )
    progress(1.0)
    return VariationModel(
        motions[0].skeleton, frame_rate, reference_rotations, root, joints, log_warp_rates,
        contact_states, moving_references, MixingKernel(), alignment.center, all_loop, warning,
        stepwise,
    )  # fmt: skip


def _validate_examples(motions: list[Motion]) -> list[Motion]:
    """Convert examples to the rate and size of the first; raise if that is impossible."""
    if not motions:
        raise InvalidMotionError("There is no example to vary.")
    first = motions[0]
    for index, motion in enumerate(motions):
        if motion.skeleton.names != first.skeleton.names or (
            motion.skeleton.parents != first.skeleton.parents
        ):
            raise InvalidMotionError(
                f"Example {index + 1} has a different rig than the first. Retarget it first."
            )
        if motion.n_frames < 2:
            raise InvalidMotionError(f"Example {index + 1} has one frame; it shows no motion.")
        observed = (
            np.isfinite(motion.rotations).all() and np.isfinite(motion.root_positions).all()
        )
        if not observed:
            raise InvalidMotionError(f"Example {index + 1} has gaps; clean it first.")
    if (
        sum(motion.n_frames for motion in motions) * len(motions) * first.skeleton.n_joints
        > MAX_VALUES
    ):
        raise InvalidMotionError("The examples are too long to vary; cut out the part to vary.")
    return [_match_first(motion, first) for motion in motions]


def _match_first(motion: Motion, first: Motion) -> Motion:
    if motion.frame_rate != first.frame_rate:
        motion = resample(motion, first.frame_rate)
    sizes = [np.linalg.norm(each.skeleton.offsets, axis=-1).sum() for each in (first, motion)]
    positions = motion.root_positions * (sizes[0] / max(sizes[1], 1e-9))
    return replace(motion, skeleton=first.skeleton, root_positions=positions)


def _sample_in_common_time(
    curves: MotionCurves, contact_state: Array, times: Array
) -> MotionCurves:
    """Return curves at the frames `times`; displacements become those between the samples."""
    joints = sample_curves(curves.joints, times)
    positions = np.column_stack([
        np.cumsum(curves.root[:, :HEIGHT_COLUMN], axis=0),
        curves.root[:, HEIGHT_COLUMN:],
    ])
    root = sample_curves(positions, times)
    root[:, :HEIGHT_COLUMN] = np.diff(
        root[:, :HEIGHT_COLUMN], axis=0, prepend=root[:1, :HEIGHT_COLUMN]
    )
    return MotionCurves(root, joints, sample_linearly(contact_state, times))


def _choose_nearest_vectors(joints: Array, center: int) -> Array:
    """Choose, of the two vectors of each rotation, the one nearer to the center's."""
    length = np.linalg.norm(joints, axis=-1, keepdims=True)
    other = joints * (1.0 - 2.0 * np.pi / np.where(length > 0.0, length, np.inf))
    distance_same = np.linalg.norm(joints - joints[center], axis=-1, keepdims=True).mean(axis=1)
    distance_other = np.linalg.norm(other - joints[center], axis=-1, keepdims=True).mean(axis=1)
    return np.where((distance_other < distance_same)[:, None], other, joints)


def _describe_flip(motion: Motion, number: int) -> str:
    """Return a message about a joint that flips within a frame; empty without one."""
    steps = multiply(inverse(motion.rotations[:-1]), motion.rotations[1:])
    angles = np.linalg.norm(rotation_vector_from_quaternion(steps), axis=-1)
    if not (angles > MAX_FRAME_ROTATION_RAD).any():
        return ""
    frame, joint = divmod(int((angles > MAX_FRAME_ROTATION_RAD).argmax()), angles.shape[1])
    return (
        f"{motion.skeleton.names[joint]} of example {number} rotates by"
        f" {np.degrees(angles[frame, joint]):.0f} degrees within a frame at"
        f" {(frame + 1) / motion.frame_rate:.2f} s. Clean it first, or variants jump too."
    )


def _describe_outlier(alignment: AlignedExamples) -> str:
    """Return a message about an example that differs from the others; empty without one."""
    n = len(alignment.distances)
    if n < 3:
        return ""
    distances = alignment.distances.sum(axis=0) / (n - 1)
    farthest = int(distances.argmax())
    if distances[farthest] <= MAX_DISTANCE_RATIO * np.median(distances):
        return ""
    ratio = distances[farthest] / np.median(distances)
    return (
        f"Example {farthest + 1} is {ratio:.1f} times as far from the others as they are from"
        " each other: it seems to be of another behavior."
    )
