"""Learn from clean motions how far each joint turns."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import Motion
from ...motion.humanoid import HumanoidMap, canonical_rotations, find_humanoid_map
from ...motion.skeletons import ROTATION_VECTOR, JointLimits
from ...progress import Progress, unwatched
from ...rotations import (
    inverse,
    mean_rotation,
    multiply,
    quaternion_from_matrix,
    rotation_vector_from_quaternion,
)
from ...settings import Settings, setting

Array = NDArray[np.float64]
Key = tuple[bool, str]
"""Whether it is a humanoid role, and the role's or the joint's name."""


@dataclass(frozen=True, kw_only=True)
class JointLimitsSettings(Settings):
    """How tightly limits follow the examples."""

    percentile: float = setting(
        0.5,
        "Percent of the examples' extremes ignored as errors at each end; higher tightens"
        " limits",
        unit="%",
        minimum=0.0,
        maximum=25.0,
    )
    margin: float = setting(
        np.radians(10.0),
        "Rotation allowed beyond the examples; higher widens the limits",
        unit="rad",
        minimum=0.0,
        maximum=np.pi,
    )
    stretch: float = setting(
        0.2,
        "Rotation allowed beyond the examples, as fraction of their range; higher widens"
        " limits",
        minimum=0.0,
        maximum=10.0,
    )


def learn_joint_limits(
    motions: Sequence[Motion],
    humanoid_maps: Sequence[HumanoidMap] | None = None,
    *,
    settings: JointLimitsSettings = JointLimitsSettings(),
    progress: Progress = unwatched,
) -> JointLimits:
    """Learn how far joints turn from motions in which they turn as far as they may.

    Joints with a humanoid role are seen from the canonical T-pose, so that the motions, and
    those that the limits will be used on, may be of different rigs; other joints count for
    joints of the same name. Of each joint the mean rotation is taken, then the rotation
    vectors from it, then the principal axes of those: along each axis the limits are
    percentiles of the examples, widened. So a hinge gets one long and two narrow sides without
    being told its axis. Combinations of angles that were never seen are not excluded. Rotation
    vectors do not jump unless a joint is half a turn away from its mean. Hips are free.

    Parameters
    ----------
    motions : sequence of Motion
        NaN is left out.
    humanoid_maps : sequence of HumanoidMap, one for each motion
        Found where they are not given.
    settings : JointLimitsSettings
    progress : Progress

    Returns
    -------
    JointLimits
        One for each humanoid role, or else joint name, that any of the motions shows.

    Raises
    ------
    InvalidMotionError
        There is no motion, or no joint is ever observed.
    SolveCancelled
        Raised by `progress`.
    """
    if not motions:
        raise InvalidMotionError("Joint limits need at least one example motion.")
    if humanoid_maps is None:
        humanoid_maps = [find_humanoid_map(motion.skeleton) for motion in motions]
    examples: dict[Key, list[Array]] = {}
    for place, (motion, humanoid) in enumerate(zip(motions, humanoid_maps, strict=True)):
        for key, rotations in _turning(motion, humanoid).items():
            examples.setdefault(key, []).append(rotations)
        progress(0.5 * (place + 1) / len(motions), "Reading the examples")
    boxes = {}
    for place, (key, parts) in enumerate(examples.items()):
        boxes[key] = _box(np.concatenate(parts), settings)
        progress(0.5 + 0.5 * (place + 1) / len(examples), "Learning joint limits")
    if not boxes:
        raise InvalidMotionError("No joint of the examples is ever observed.")
    lefts, rights, lowers, uppers = zip(*boxes.values(), strict=True)
    return JointLimits(
        names=tuple(name for _, name in boxes),
        by_role=np.array([by_role for by_role, _ in boxes]),
        left=np.array(lefts),
        right=np.array(rights),
        orders=(ROTATION_VECTOR,) * len(boxes),
        lower=np.array(lowers),
        upper=np.array(uppers),
    )


def _turning(motion: Motion, humanoid: HumanoidMap) -> dict[Key, Array]:
    """Return the observed rotations, (n, 4), of each joint below the hips."""
    skeleton = motion.skeleton
    canonical = canonical_rotations(motion, humanoid)
    hips = humanoid.indices(skeleton).get("hips", 0)
    free = {0, hips, *skeleton.ancestors(hips)}
    found = {}
    for joint, name in enumerate(skeleton.names):
        if joint in free or skeleton.is_end_site(joint):
            continue
        role = humanoid.role(name)
        rotations = motion.rotations[:, joint] if role is None else canonical[:, joint]
        rotations = rotations[np.isfinite(rotations).all(axis=1)]
        if len(rotations):
            found[role is not None, role or name] = rotations
    return found


def _box(rotations: Array, settings: JointLimitsSettings) -> tuple[Array, Array, Array, Array]:
    """Return left, right, lower and upper of one limit."""
    middle = mean_rotation(rotations)
    vectors = rotation_vector_from_quaternion(multiply(inverse(middle), rotations))
    _, axes = np.linalg.eigh(vectors.T @ vectors)
    axes = axes[:, ::-1] * np.sign(np.linalg.det(axes[:, ::-1]))
    along = vectors @ axes
    ends = (settings.percentile, 100.0 - settings.percentile)
    low, high = np.percentile(along, ends, axis=0)
    wider = settings.margin + settings.stretch * (high - low)
    turn = quaternion_from_matrix(axes)
    # left^-1 L right turns by axes^T vector where middle^-1 L turns by vector.
    return multiply(middle, turn), turn, low - wider, high + wider
