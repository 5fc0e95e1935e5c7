"""Stop feet from sliding: foot-skate cleanup."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array, Flags
from ...errors import InvalidMotionError
from ...motion import Motion, WorldPoses, forward_kinematics
from ...motion.humanoid import HumanoidMap, find_humanoid_map
from ...motion.skeletons import (
    ReachSettings,
    find_shot_boundaries,
    is_short_shot,
    reach,
    shot_ranges,
)
from ...progress import Progress, unwatched, within
from ...rotations import inverse, multiply
from ...settings import Settings, setting
from .foot_trajectory import FootTrajectory, plan_foot_trajectory
from .knee_smoothing import smooth_knees
from .legs import SIDES, LegJoints, find_legs
from .root_offset import compute_root_offset
from .standing_feet import detect_standing_feet


@dataclass(frozen=True, kw_only=True)
class PlantSettings(Settings):
    """Settings of `plant_feet`."""

    blend: float = setting(
        0.3,
        "Time to blend a planted foot back to its own motion; higher is softer and longer",
        unit="s", minimum=0.02, maximum=2.0,
    )  # fmt: skip
    hold: float = setting(
        10.0,
        "Longest time a sliding foot stays fixed before it may creep; higher is stricter",
        unit="s",
        minimum=0.5,
        maximum=1000.0,
        advanced=True,
        label="Max Contact Time",
    )
    hold_rotation: bool = setting(
        True,
        "Also keep feet that stand flat from turning and tilting",
        label="Lock Foot Rotation",
    )
    floor: bool = setting(
        True,
        "Level planted feet that are near the floor, all at one height",
        label="Level Floor",
    )
    softness: float = setting(
        0.01,
        "Fraction of the leg length held in reserve; higher bends knees and lowers hips more",
        minimum=0.0, maximum=0.2, advanced=True, label="Leg Stretch Limit",
    )  # fmt: skip
    spare_knees: bool = setting(
        True, "Let the heel of a rolling foot lift so that the knee bends smoothly",
        label="Protect Knees",
    )  # fmt: skip
    move_root: bool = setting(
        True, "Shift the hips slightly and smoothly where a leg cannot reach", label="Move Hips"
    )


@dataclass(frozen=True, eq=False)
class Planted:
    """A motion whose planted feet do not slide.

    Attributes
    ----------
    motion : Motion
    contacts : bool, shape (n_frames, 2), left and right
        When each foot is in contact: as given, or as detected.
    slide_before, slide_after : float, meters
        Distance that both soles cover over the floor while in contact.
    """

    motion: Motion
    contacts: Flags
    slide_before: float
    slide_after: float


def plant_feet(
    motion: Motion,
    contacts: Flags | None = None,
    *,
    humanoid_map: HumanoidMap | None = None,
    settings: PlantSettings = PlantSettings(),
    progress: Progress = unwatched,
) -> Planted:
    """Return the motion with each foot fixed to the floor while in contact.

    As in Kovar et al. [1]_ footplants are met exactly, and the motion is otherwise smooth and
    close to the original. A foot in contact may roll; only the loaded part of the sole, heel,
    ball or both, must not move. Subtracting its motion leaves one free offset per contact. One
    banded linear system (`smooth_correction`) yields the offsets, and the curve between them,
    with the least displacement and curvature. Where a leg would be too short the root is
    shifted smoothly; bones never stretch. Then hip and knee rotate so that the ankle follows
    (`reach`). No joint above the hips rotates. Segments of a joined take are planted
    separately; a segment of less than a quarter of a second has no contact.

    Parameters
    ----------
    motion : Motion
        Without gaps.
    contacts : bool, shape (n_frames, 2), left and right
        When each foot is in contact; detected if not given. All False changes nothing.
    humanoid_map : HumanoidMap
        Identifies the legs; found by name and structure if not given.
    settings : PlantSettings
    progress : Progress

    Returns
    -------
    Planted
        Only the root position and the rotations of the legs differ from the input.

    Raises
    ------
    InvalidMotionError
        Joints are not observed, there is no leg, or the contacts do not fit the motion.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Kovar, Schreiner, Gleicher (2002). Footskate cleanup for motion capture editing.
       Symposium on Computer Animation. doi:10.1145/545261.545277
    """
    humanoid_map = humanoid_map or find_humanoid_map(motion.skeleton)
    legs = _require_legs(motion, humanoid_map)
    contacts = None if contacts is None else _check_contacts(contacts, motion)
    cuts, results = find_shot_boundaries(motion), []
    for start, stop in shot_ranges(motion, cuts):
        segment = motion.slice(start, stop) if cuts else motion
        too_short = bool(cuts) and is_short_shot(stop - start, motion.frame_rate)
        if contacts is not None:
            standing = contacts[start:stop]
        elif too_short:
            standing = np.zeros((stop - start, len(SIDES)), dtype=np.bool_)
        else:
            standing = detect_standing_feet(segment, humanoid_map, legs)
        if too_short:
            results.append(Planted(segment, standing, 0.0, 0.0))
        else:
            step = within(progress, start / motion.n_frames, stop / motion.n_frames)
            results.append(_plant_segment(segment, legs, standing, settings, step))
    progress(1.0, "Planted the feet")
    return _join_segments(motion, results) if cuts else results[0]


def _plant_segment(
    motion: Motion,
    legs: Sequence[LegJoints],
    contacts: Flags,
    settings: PlantSettings,
    progress: Progress,
) -> Planted:
    """Plant the feet of a motion without cuts."""
    standing = [leg for leg in legs if contacts[:, SIDES.index(leg.side)].any()]
    if not standing:
        progress(1.0, "No foot is in contact")
        return Planted(motion, contacts, 0.0, 0.0)
    progress(0.2, "Planning the feet")
    poses = forward_kinematics(motion)
    trajectories = _plan_trajectories(motion, poses, standing, contacts, settings)
    progress(0.4, "Moving the hips")
    root_offset = _root_offset(motion, poses, trajectories, settings)
    progress(0.6, "Solving the legs")
    if settings.spare_knees:
        trajectories, root_offset = smooth_knees(
            trajectories, poses, root_offset, motion.frame_rate
        )
    result = motion.with_poses(root_positions=motion.root_positions + root_offset)
    for trajectory in trajectories:
        result = _apply_trajectory(result, poses, trajectory, settings.softness)
    after = forward_kinematics(result)
    return Planted(
        result,
        contacts,
        slide_before=sum(
            trajectory.slide(motion.skeleton, poses) for trajectory in trajectories
        ),
        slide_after=sum(
            trajectory.slide(motion.skeleton, after) for trajectory in trajectories
        ),
    )


def _join_segments(motion: Motion, results: Sequence[Planted]) -> Planted:
    rotations = np.concatenate([result.motion.rotations for result in results])
    roots = np.concatenate([result.motion.root_positions for result in results])
    return Planted(
        motion.with_poses(rotations, roots),
        np.concatenate([result.contacts for result in results]),
        slide_before=sum(result.slide_before for result in results),
        slide_after=sum(result.slide_after for result in results),
    )


def _plan_trajectories(
    motion: Motion,
    poses: WorldPoses,
    legs: Sequence[LegJoints],
    contacts: Flags,
    settings: PlantSettings,
) -> list[FootTrajectory]:
    """Plan the trajectory of each foot separately."""
    return [
        plan_foot_trajectory(
            motion,
            poses,
            leg,
            contacts[:, SIDES.index(leg.side)],
            blend=settings.blend,
            hold=settings.hold,
            hold_rotation=settings.hold_rotation,
            floor=settings.floor,
        )
        for leg in legs
    ]


def _root_offset(
    motion: Motion,
    poses: WorldPoses,
    trajectories: Sequence[FootTrajectory],
    settings: PlantSettings,
) -> Array:
    """Return the root offset that lets the legs reach, (n_frames, 3); 0 if it may not move."""
    if not settings.move_root or motion.n_frames == 1:
        return np.zeros_like(motion.root_positions)
    return compute_root_offset(
        motion.skeleton,
        poses,
        trajectories,
        motion.frame_rate,
        softness=settings.softness,
        blend=settings.blend,
    )


def _apply_trajectory(
    motion: Motion, poses: WorldPoses, trajectory: FootTrajectory, softness: float
) -> Motion:
    """Return the motion whose ankle, foot and toes follow the trajectory.

    `poses` are those of the unchanged motion.
    """
    leg = trajectory.leg
    result = reach(motion, leg.chain, trajectory.ankle, ReachSettings(softness=softness))
    for joint, foot_rotation in (
        (leg.ankle, trajectory.foot_rotation),
        (leg.toe, trajectory.toe_rotation),
    ):
        if joint is not None:
            parent_rotations = forward_kinematics(result).rotations[
                :, motion.skeleton.parents[joint]
            ]
            rotations = result.rotations.copy()
            target = multiply(foot_rotation, poses.rotations[:, joint])
            rotations[:, joint] = multiply(inverse(parent_rotations), target)
            result = result.with_poses(rotations)
    return result


def _require_legs(motion: Motion, humanoid_map: HumanoidMap) -> tuple[LegJoints, ...]:
    legs = find_legs(motion.skeleton, humanoid_map)
    if not legs:
        raise InvalidMotionError(
            "No leg was found: hip, knee and ankle need the humanoid roles UpperLeg, LowerLeg"
            " and Foot. Choose their joints in the humanoid map."
        )
    gaps = ~motion.observed
    if gaps.any():
        names = [motion.skeleton.names[joint] for joint in np.flatnonzero(gaps.any(axis=0))]
        raise InvalidMotionError(
            f"Feet can be planted only without gaps; these have gaps: {', '.join(names)}."
            " Clean the take first."
        )
    return legs


def _check_contacts(contacts: Flags, motion: Motion) -> Flags:
    contacts = np.array(contacts, dtype=np.bool_)
    if contacts.shape != (motion.n_frames, len(SIDES)):
        raise InvalidMotionError(
            f"Contacts need shape ({motion.n_frames}, 2), left and right, not {contacts.shape}."
        )
    return contacts
