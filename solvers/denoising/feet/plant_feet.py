"""Stop feet from sliding: foot-skate clean-up."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import Motion, WorldPoses, forward_kinematics
from ...motion.humanoid import HumanoidMap, detect_contacts, find_humanoid_map
from ...motion.skeletons import ReachSettings, find_cuts, is_short, pieces, reach
from ...progress import Progress, unwatched, within
from ...rotations import inverse, multiply
from ...settings import Settings, setting
from .knee_relief import knee_relief
from .legs import SIDES, Leg, find_legs
from .planted_path import Plant, planted_path
from .root_shift import root_shift

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class PlantSettings(Settings):
    """How feet are planted."""

    blend: float = setting(
        0.3,
        "Time to blend a planted foot back to its own motion; higher is softer and lasts"
        " longer",
        unit="s",
        minimum=0.02,
        maximum=2.0,
    )
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
        "Put planted feet that are near the floor onto it, all at one height",
        label="Level Floor",
    )
    softness: float = setting(
        0.01,
        "Fraction of the leg length kept in reserve; higher bends knees more and lowers the"
        " hips",
        minimum=0.0,
        maximum=0.2,
        advanced=True,
        label="Leg Stretch Limit",
    )
    spare_knees: bool = setting(
        True,
        "Let the heel of a rolling foot lift so that the knee bends smoothly",
        label="Protect Knees",
    )
    move_root: bool = setting(
        True, "Shift the hips slightly and smoothly where a leg cannot reach", label="Move Hips"
    )


@dataclass(frozen=True, eq=False)
class Planted:
    """A motion whose feet stand still.

    Attributes
    ----------
    motion : Motion
    contacts : bool, shape (n_frames, 2), left and right
        When each foot stands: as given, or as detected.
    slide_before, slide_after : float, metres
        Way that both soles cover over the floor while they should stand.
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
    """Return the motion with the feet at rest wherever they stand.

    The aim is that of Kovar, Schreiner and Gleicher [1]_, footplants that are met exactly and
    a motion that is otherwise close to the original and smooth; the way differs. A foot that
    stands may roll: what must not move is the part of the sole that carries the load, heel,
    ball or both. Subtracting that part's motion leaves one free shift per contact; the shifts,
    and the curve that joins them through the air, are those of least displacement and bending,
    from one banded linear system (`smooth_correction`). Where a leg would be too short the
    root is shifted smoothly; bones never stretch. Then hip and knee are turned so that the
    ankle follows (`reach`). Nothing above the hips turns. The pieces of a take that was joined
    of several are planted apart; in one of less than a quarter of a second no foot stands.

    Parameters
    ----------
    motion : Motion
        Without gaps.
    contacts : bool, shape (n_frames, 2), left and right
        When each foot stands; detected where it is not given. All False changes nothing.
    humanoid_map : HumanoidMap
        Says which joints are legs; found by name and structure where it is not given.
    settings : PlantSettings
    progress : Progress

    Returns
    -------
    Planted
        Of its motion, only the root's place and the legs' rotations differ from the input.

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
    legs = _legs(motion, humanoid_map)
    contacts = None if contacts is None else _checked(contacts, motion)
    cuts, parts = find_cuts(motion), []
    for start, stop in pieces(motion, cuts):
        piece = motion.slice(start, stop) if cuts else motion
        too_short = bool(cuts) and is_short(stop - start, motion.frame_rate)
        if contacts is not None:
            standing = contacts[start:stop]
        elif too_short:
            standing = np.zeros((stop - start, len(SIDES)), dtype=np.bool_)
        else:
            standing = detect_contacts(piece, humanoid_map)
        if too_short:
            parts.append(Planted(piece, standing, 0.0, 0.0))
        else:
            step = within(progress, start / motion.n_frames, stop / motion.n_frames)
            parts.append(_planted_piece(piece, legs, standing, settings, step))
    progress(1.0, "Planted the feet")
    return _joined(motion, parts) if cuts else parts[0]


def _planted_piece(
    motion: Motion,
    legs: Sequence[Leg],
    contacts: Flags,
    settings: PlantSettings,
    progress: Progress,
) -> Planted:
    """Plant the feet of a motion without cuts."""
    standing = [leg for leg in legs if contacts[:, SIDES.index(leg.side)].any()]
    if not standing:
        progress(1.0, "No foot stands")
        return Planted(motion, contacts, 0.0, 0.0)
    progress(0.2, "Planning the feet")
    poses = forward_kinematics(motion)
    plants = _plants(motion, poses, standing, contacts, settings)
    progress(0.4, "Moving the hips")
    shift = _hips_shift(motion, poses, plants, settings)
    progress(0.6, "Solving the legs")
    if settings.spare_knees:
        plants, shift = knee_relief(plants, poses, shift, motion.frame_rate)
    result = motion.with_poses(root_positions=motion.root_positions + shift)
    for plant in plants:
        result = _followed(result, poses, plant, settings.softness)
    after = forward_kinematics(result)
    return Planted(
        result,
        contacts,
        slide_before=sum(plant.slide(motion.skeleton, poses) for plant in plants),
        slide_after=sum(plant.slide(motion.skeleton, after) for plant in plants),
    )


def _joined(motion: Motion, parts: Sequence[Planted]) -> Planted:
    rotations = np.concatenate([part.motion.rotations for part in parts])
    roots = np.concatenate([part.motion.root_positions for part in parts])
    return Planted(
        motion.with_poses(rotations, roots),
        np.concatenate([part.contacts for part in parts]),
        slide_before=sum(part.slide_before for part in parts),
        slide_after=sum(part.slide_after for part in parts),
    )


def _plants(
    motion: Motion,
    poses: WorldPoses,
    legs: Sequence[Leg],
    contacts: Flags,
    settings: PlantSettings,
) -> list[Plant]:
    """Plan the course of each foot for itself."""
    return [
        planted_path(
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


def _hips_shift(
    motion: Motion, poses: WorldPoses, plants: Sequence[Plant], settings: PlantSettings
) -> Array:
    """Return how the root must move for the legs to reach, (n_frames, 3); 0 if it may not."""
    if not settings.move_root or motion.n_frames == 1:
        return np.zeros_like(motion.root_positions)
    return root_shift(
        motion.skeleton,
        poses,
        plants,
        motion.frame_rate,
        softness=settings.softness,
        blend=settings.blend,
    )


def _followed(motion: Motion, poses: WorldPoses, plant: Plant, softness: float) -> Motion:
    """Return the motion whose ankle follows its course and whose foot and toes are turned.

    `poses` are those of the motion before anything was changed.
    """
    leg = plant.leg
    result = reach(motion, leg.chain, plant.ankle, ReachSettings(softness=softness))
    for joint, turn in ((leg.ankle, plant.turn), (leg.toe, plant.toe_turn)):
        if joint is not None:
            above = forward_kinematics(result).rotations[:, motion.skeleton.parents[joint]]
            rotations = result.rotations.copy()
            wanted = multiply(turn, poses.rotations[:, joint])
            rotations[:, joint] = multiply(inverse(above), wanted)
            result = result.with_poses(rotations)
    return result


def _legs(motion: Motion, humanoid_map: HumanoidMap) -> tuple[Leg, ...]:
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
            f"Feet can be planted only where all is known; these have gaps: {', '.join(names)}."
            " Clean the take first."
        )
    return legs


def _checked(contacts: Flags, motion: Motion) -> Flags:
    contacts = np.array(contacts, dtype=np.bool_)
    if contacts.shape != (motion.n_frames, len(SIDES)):
        raise InvalidMotionError(
            f"Contacts need shape ({motion.n_frames}, 2), left and right, not {contacts.shape}."
        )
    return contacts
