"""Stop feet, hands, knees and hips from sliding: foot-skate cleanup."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, Flags
from ..errors import InvalidMotionError
from ..motion import Motion, forward_kinematics
from ..motion.humanoid import SIDES, HumanoidMap, find_humanoid_map
from ..motion.skeletons import (
    find_path_jumps,
    find_shot_boundaries,
    is_short_shot,
    move_root,
    path_offsets,
    shot_ranges,
)
from ..motion_fitting import fit_in_windows
from ..progress import Progress, Remark, collect_remarks, unwatched, within
from ..signals import find_runs
from .body_supports import SUPPORTS, detect_supports
from .legs import LegJoints, find_legs
from .limb_goals import find_limb_contacts
from .plant_in_window import plant_in_window
from .plant_settings import PlantSettings
from .sole_contact import find_foot_contact
from .standing_feet import detect_standing_feet

DEFAULT_SETTINGS = PlantSettings()
N_FEET = len(SIDES)


@dataclass(frozen=True, eq=False)
class Planted:
    """A motion whose planted feet, hands, knees and hips do not slide.

    Attributes
    ----------
    motion : Motion
    contacts : bool, shape (n_frames, 2), left and right
        When each foot is in contact: as given, or as detected.
    supports : bool, shape (n_frames, 5), or None
        When each of `SUPPORTS` is in contact; None where only feet are planted.
    slide_before, slide_after : float, meters
        Distance that soles, hands, knees and hips cover over the floor while in contact.
    remarks : tuple of str
        What went wrong, such as feet that no leg can keep where they are.
    """

    motion: Motion
    contacts: Flags
    slide_before: float
    slide_after: float
    supports: Flags | None = None
    remarks: tuple[str, ...] = ()

    @property
    def all_contacts(self) -> Flags:
        """Contacts of all parts, (n_frames, 7), or of feet alone, (n_frames, 2)."""
        if self.supports is None:
            return self.contacts
        return np.hstack([self.contacts, self.supports])


def plant_feet(
    motion: Motion,
    contacts: Flags | Array | None = None,
    *,
    humanoid_map: HumanoidMap | None = None,
    settings: PlantSettings = DEFAULT_SETTINGS,
    ankle_weights: Array | None = None,
    progress: Progress = unwatched,
) -> Planted:
    """Return the motion with each foot fixed to the floor while in contact.

    As in Kovar et al. [1]_ footplants are met, and the motion is otherwise smooth and close to
    the original. A foot in contact may roll; only the loaded part of the sole, heel, ball or
    both, must not move. Nor must hands and knees that bear on the floor, and the pelvis where
    its contact is given, with `settings.hands_and_knees`; a pelvis rolls with the root. The
    rotations of the legs, of such arms, and the position of the root in all frames are found
    at once: they hold what is loaded with the least smooth change of knees, feet, arms and
    root (`planting_goals`, `fit_motion`). A foot that is detected in contact, but could only be
    held by moving leg or root far, is held less (`plant_in_window`). Bones never stretch, and
    no joint of the trunk rotates.
    Segments of a joined take are planted separately; a segment of less than a quarter of a
    second has no contact. Where the body is put elsewhere in one frame, and stays, its feet are
    put there with it (`find_path_jumps`).

    Parameters
    ----------
    motion : Motion
        Without gaps.
    contacts : bool or float, shape (n_frames, 2) or (n_frames, 7)
        When the left and the right foot, and each of `SUPPORTS`, are in contact; detected if
        not given, and where NaN. All False changes nothing. A contact that is given in any of
        its frames is held as given.
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
        Only the root position and the rotations of legs and arms differ from the input.

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
    given = _check_contacts(contacts, motion)
    if ankle_weights is None:
        ankle_weights = np.ones((motion.n_frames, len(SIDES)))
    remarks: list[Remark] = []
    progress = collect_remarks(progress, remarks)
    cuts, results = find_shot_boundaries(motion), []
    offsets = path_offsets(find_path_jumps(motion, cuts), motion.n_frames)
    motion = move_root(motion, -offsets)
    for start, stop in shot_ranges(motion, cuts):
        segment = motion.slice(start, stop) if cuts else motion
        if bool(cuts) and is_short_shot(stop - start, motion.frame_rate):
            results.append(_planted(segment, given[start:stop] == 1.0, settings))
            continue
        found = _find_contacts(segment, given[start:stop], humanoid_map, legs, settings)
        may_yield = _find_yielding(found[:, :N_FEET], given[start:stop, :N_FEET])
        step = within(progress, start / motion.n_frames, stop / motion.n_frames)
        weights = ankle_weights[start:stop]
        results.append(
            _plant_segment(
                segment, humanoid_map, legs, found, weights, settings, may_yield, step
            )
        )
    progress(1.0, "Planted the feet")
    planted = _join_segments(motion, results) if cuts else results[0]
    return replace(planted, motion=move_root(planted.motion, offsets), remarks=tuple(remarks))


def _find_contacts(
    motion: Motion,
    given: Array,
    humanoid_map: HumanoidMap,
    legs: Sequence[LegJoints],
    settings: PlantSettings,
) -> Flags:
    """Return the contacts of all parts, (n_frames, 7), as given, or detected where NaN.

    Hips are held only where contacts are given, such as those that an animator keyed: hips of
    real actors who lie shift by some centimeters, and to hold all that is detected moves clean
    takes by 1.8 cm (docs/benchmarks/contacts.md). They must be free to move, as nothing else
    could hold them.
    """
    is_missing, hips = np.isnan(given), N_FEET + SUPPORTS.index("hips")
    contacts = np.asarray(given == 1.0)
    if is_missing[:, :N_FEET].any():
        feet = detect_standing_feet(motion, humanoid_map, legs)
        contacts[:, :N_FEET] |= is_missing[:, :N_FEET] & feet
    if not settings.hands_and_knees:
        contacts[:, N_FEET:] = False
    elif is_missing[:, N_FEET:hips].any():
        found = detect_supports(motion, humanoid_map, legs)[:, : hips - N_FEET]
        contacts[:, N_FEET:hips] |= is_missing[:, N_FEET:hips] & found
    contacts[:, hips] &= settings.move_root
    return contacts


def _find_yielding(contacts: Flags, given: Array) -> Flags:
    """Return the frames in which a foot may be held less, shape (n_frames, 2).

    These are the frames without a given contact, except in a contact that has one.
    """
    may_yield = np.isnan(given)
    for foot in range(N_FEET):
        for start, stop in find_runs(contacts[:, foot]):
            if not may_yield[start:stop, foot].all():
                may_yield[start:stop, foot] = False
    return may_yield


def _plant_segment(
    motion: Motion,
    humanoid_map: HumanoidMap,
    legs: Sequence[LegJoints],
    contacts: Flags,
    ankle_weights: Array,
    settings: PlantSettings,
    may_yield: Flags,
    progress: Progress,
) -> Planted:
    """Plant what bears on the floor of a motion without cuts; contacts are (n_frames, 7)."""
    if not contacts.any():
        progress(1.0, "No foot is in contact")
        return _planted(motion, contacts, settings)
    poses = forward_kinematics(motion)
    limbs = find_limb_contacts(motion, poses, humanoid_map, contacts[:, N_FEET:])
    knees = {each.limb.chain[1] for each in limbs if each.limb.is_leg}
    feet = [
        find_foot_contact(motion, poses, leg, contacts[:, SIDES.index(leg.side)])
        for leg in legs
        if leg.knee in knees or contacts[:, SIDES.index(leg.side)].any()
    ]

    def plant_window(start: int, stop: int, progress: Progress) -> Motion:
        windows = [foot.slice(start, stop) for foot in feet]
        on_limbs = [limb.slice(start, stop) for limb in limbs]
        weights = ankle_weights[start:stop]
        window = motion.slice(start, stop)
        may = may_yield[start:stop]
        return plant_in_window(window, windows, on_limbs, weights, settings, may, progress)

    result = fit_in_windows(motion, plant_window, progress)
    before_and_after = poses, forward_kinematics(result)
    slides = [sum(each.slide(one) for each in (*feet, *limbs)) for one in before_and_after]
    return _planted(result, contacts, settings, slides)


def _planted(
    motion: Motion,
    contacts: Flags,
    settings: PlantSettings,
    slides: Sequence[float] = (0.0, 0.0),
) -> Planted:
    before, after = slides
    supports = contacts[:, N_FEET:] if settings.hands_and_knees else None
    return Planted(motion, contacts[:, :N_FEET], before, after, supports)


def _join_segments(motion: Motion, results: Sequence[Planted]) -> Planted:
    rotations = np.concatenate([result.motion.rotations for result in results])
    roots = np.concatenate([result.motion.root_positions for result in results])
    return Planted(
        motion.with_poses(rotations, roots),
        np.concatenate([result.contacts for result in results]),
        supports=_join_supports(results),
        slide_before=sum(result.slide_before for result in results),
        slide_after=sum(result.slide_after for result in results),
    )


def _join_supports(results: Sequence[Planted]) -> Flags | None:
    supports = [result.supports for result in results if result.supports is not None]
    return np.concatenate(supports) if supports else None


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


def _check_contacts(contacts: Flags | Array | None, motion: Motion) -> Array:
    """Return given contacts, shape (n_frames, 7): 1, 0, or NaN where they are detected."""
    n_frames, widths = motion.n_frames, (N_FEET, N_FEET + len(SUPPORTS))
    checked = np.full((n_frames, widths[1]), np.nan)
    if contacts is None:
        return checked
    given = np.array(contacts, dtype=np.float64)
    if given.shape not in [(n_frames, width) for width in widths]:
        raise InvalidMotionError(
            f"Contacts need shape ({n_frames}, 2), left and right, or ({n_frames}, 7) with"
            f" hands, knees and hips, not {given.shape}."
        )
    checked[:, : given.shape[1]] = np.where(np.isnan(given), np.nan, given != 0.0)
    return checked
