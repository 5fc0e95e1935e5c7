"""Stop feet from sliding: foot-skate cleanup."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, Flags
from ..errors import InvalidMotionError
from ..motion import Motion, forward_kinematics
from ..motion.humanoid import HumanoidMap, find_humanoid_map
from ..motion.skeletons import find_shot_boundaries, is_short_shot, shot_ranges
from ..motion_fitting import FittedMotion, fit_in_pieces, fit_motion
from ..progress import Progress, Remark, collect_remarks, unwatched, within
from .foot_contact import FootContact, find_foot_contact
from .foot_goals import planting_goals
from .legs import SIDES, LegJoints, find_legs
from .plant_settings import PlantSettings
from .standing_feet import detect_standing_feet

DEFAULT_SETTINGS = PlantSettings()


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
    remarks : tuple of str
        What went wrong, such as feet that no leg can keep where they are.
    """

    motion: Motion
    contacts: Flags
    slide_before: float
    slide_after: float
    remarks: tuple[str, ...] = ()


def plant_feet(
    motion: Motion,
    contacts: Flags | None = None,
    *,
    humanoid_map: HumanoidMap | None = None,
    settings: PlantSettings = DEFAULT_SETTINGS,
    ankle_weights: Array | None = None,
    progress: Progress = unwatched,
) -> Planted:
    """Return the motion with each foot fixed to the floor while in contact.

    As in Kovar et al. [1]_ footplants are met, and the motion is otherwise smooth and close to
    the original. A foot in contact may roll; only the loaded part of the sole, heel, ball or
    both, must not move. The rotations of the legs and the position of the root in all frames
    are found at once: they hold the soles with the least smooth change of knees, feet and root
    (`planting_goals`, `fit_motion`). Bones never stretch, and no joint above the hips rotates.
    Segments of a joined take are planted separately; a segment of less than a quarter of a
    second has no contact.

    Parameters
    ----------
    motion : Motion
        Without gaps.
    contacts : bool, shape (n_frames, 2), left and right
        When each foot is in contact; detected if not given. All False changes nothing.
    humanoid_map : HumanoidMap
        Identifies the legs; found by name and structure if not given.
    settings : PlantSettings
    ankle_weights : shape (n_frames, 2), left and right
        How firmly the ankle of a foot in contact keeps its path: 1 by default, more where it
        was measured well. A contact in which such an ankle moves is held less.
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
    if ankle_weights is None:
        ankle_weights = np.ones((motion.n_frames, len(SIDES)))
    remarks: list[Remark] = []
    progress = collect_remarks(progress, remarks)
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
            weights = ankle_weights[start:stop]
            results.append(_plant_segment(segment, legs, standing, weights, settings, step))
    progress(1.0, "Planted the feet")
    planted = _join_segments(motion, results) if cuts else results[0]
    return replace(planted, remarks=tuple(remarks))


def _plant_segment(
    motion: Motion,
    legs: Sequence[LegJoints],
    contacts: Flags,
    ankle_weights: Array,
    settings: PlantSettings,
    progress: Progress,
) -> Planted:
    """Plant the feet of a motion without cuts."""
    standing = [leg for leg in legs if contacts[:, SIDES.index(leg.side)].any()]
    if not standing:
        progress(1.0, "No foot is in contact")
        return Planted(motion, contacts, 0.0, 0.0)
    poses = forward_kinematics(motion)
    feet = [
        find_foot_contact(motion, poses, leg, contacts[:, SIDES.index(leg.side)])
        for leg in standing
    ]

    def plant_piece(start: int, stop: int, progress: Progress) -> Motion:
        pieces = [foot.slice(start, stop) for foot in feet]
        weights = ankle_weights[start:stop]
        return _plant_piece(motion.slice(start, stop), pieces, weights, settings, progress)

    result = fit_in_pieces(motion, plant_piece, progress)
    after = forward_kinematics(result)
    return Planted(
        result,
        contacts,
        slide_before=sum(foot.slide(poses) for foot in feet),
        slide_after=sum(foot.slide(after) for foot in feet),
    )


def _plant_piece(
    motion: Motion,
    feet: Sequence[FootContact],
    ankle_weights: Array,
    settings: PlantSettings,
    progress: Progress,
) -> Motion:
    """Return the piece of a take with its feet planted."""
    legs = [foot.leg for foot in feet]
    joints = [joint for leg in legs for joint in (*leg.chain, leg.toe) if joint is not None]
    start = FittedMotion(motion, motion, tuple(joints), settings.move_root)
    weights = [ankle_weights[:, SIDES.index(leg.side)] for leg in legs]
    goals = planting_goals(start, feet, settings, weights)
    fit = fit_motion(start, goals, progress, "Planting the feet")
    progress(1.0, "Planted the feet")
    return fit.motion


def _join_segments(motion: Motion, results: Sequence[Planted]) -> Planted:
    rotations = np.concatenate([result.motion.rotations for result in results])
    roots = np.concatenate([result.motion.root_positions for result in results])
    return Planted(
        motion.with_poses(rotations, roots),
        np.concatenate([result.contacts for result in results]),
        slide_before=sum(result.slide_before for result in results),
        slide_after=sum(result.slide_after for result in results),
    )


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
