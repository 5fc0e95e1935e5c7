"""Learn the range of motion of each joint from clean motions."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
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

Key = tuple[bool, str]
"""Whether it is a humanoid role, and the name of the role or joint."""


@dataclass(frozen=True, kw_only=True)
class JointLimitsSettings(Settings):
    """Settings of `learn_joint_limits`."""

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
    """Learn joint limits from motions that cover the range of motion.

    Joints with a humanoid role are measured from the canonical T-pose, so the limits apply to
    any rig; other joints match by name. For each joint the method takes the mean rotation, the
    rotation vectors from it, and their principal axes. The limits along each axis are
    percentiles of the examples, widened. A hinge therefore gets one long and two narrow sides
    without knowing its axis. Unobserved combinations of angles are not excluded. Rotation
    vectors do not jump unless a joint is half a turn away from its mean. Hips have no limits.

    Parameters
    ----------
    motions : sequence of Motion
        NaN is skipped.
    humanoid_maps : sequence of HumanoidMap, one for each motion
        Found if not given.
    settings : JointLimitsSettings
    progress : Progress

    Returns
    -------
    JointLimits
        One for each humanoid role, or joint name, that any of the motions has.

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
    for index, (motion, humanoid) in enumerate(zip(motions, humanoid_maps, strict=True)):
        for key, rotations in _observed_rotations(motion, humanoid).items():
            examples.setdefault(key, []).append(rotations)
        progress(0.5 * (index + 1) / len(motions), "Reading the examples")
    boxes = {}
    for index, (key, rotations_list) in enumerate(examples.items()):
        boxes[key] = _learn_limit(np.concatenate(rotations_list), settings)
        progress(0.5 + 0.5 * (index + 1) / len(examples), "Learning joint limits")
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


def _observed_rotations(motion: Motion, humanoid: HumanoidMap) -> dict[Key, Array]:
    """Return the observed rotations, (n, 4), of each joint below the hips."""
    skeleton = motion.skeleton
    canonical = canonical_rotations(motion, humanoid)
    hips = humanoid.indices(skeleton).get("hips", 0)
    free = {0, hips, *skeleton.ancestors(hips)}
    result = {}
    for joint, name in enumerate(skeleton.names):
        if joint in free or skeleton.is_end_site(joint):
            continue
        role = humanoid.role(name)
        rotations = motion.rotations[:, joint] if role is None else canonical[:, joint]
        rotations = rotations[np.isfinite(rotations).all(axis=1)]
        if len(rotations):
            result[role is not None, role or name] = rotations
    return result


def _learn_limit(
    rotations: Array, settings: JointLimitsSettings
) -> tuple[Array, Array, Array, Array]:
    """Return left, right, lower and upper of one limit."""
    mean = mean_rotation(rotations)
    vectors = rotation_vector_from_quaternion(multiply(inverse(mean), rotations))
    _, axes = np.linalg.eigh(vectors.T @ vectors)
    axes = axes[:, ::-1] * np.sign(np.linalg.det(axes[:, ::-1]))
    coordinates = vectors @ axes
    percentiles = (settings.percentile, 100.0 - settings.percentile)
    low, high = np.percentile(coordinates, percentiles, axis=0)
    widening = settings.margin + settings.stretch * (high - low)
    axes_rotation = quaternion_from_matrix(axes)
    # left^-1 L right rotates by axes^T vector where mean^-1 L rotates by vector.
    return multiply(mean, axes_rotation), axes_rotation, low - widening, high + widening
