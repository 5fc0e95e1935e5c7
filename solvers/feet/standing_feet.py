"""Find the feet that stand: those of captured legs, while the hips are off the floor."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, forward_kinematics
from ..motion.humanoid import SIDES, HumanoidMap, detect_contacts, known_foot_points
from ..motion.skeletons import still_joints
from ..signals import find_runs
from .dragged_feet import find_dragged_feet
from .legs import LegJoints

MIN_HIP_HEIGHT = 0.2
"""Height of the lowest joint of the pelvis above the feet, as a ratio to the length of a leg,
below which the body sits or lies. Measured: the pelvis of four HDM05 takes that lie down comes
to rest at 0.05, that of the deepest squat at 0.28. `test_feet_are_planted_until_the_actor_lies`
fails without it."""
MAX_PELVIS_SIZE = 0.3
"""Distance of the hips from the hip joints, as a ratio to the length of a leg, up to which they
are a joint of the pelvis. It guards rigs whose hips are at the floor."""
GROUND_PERCENTILE = 5.0
"""Percentile of the height of the lower foot that is the ground; lower ones are noise. Chosen
by hand, as for the detection of contacts.
`test_root_that_drops_through_the_floor_for_a_frame_does_not_lower_the_ground` fails without
it."""
MIN_CONTACT_S = 0.1
"""Seconds: shorter contacts before and after the body rests on its hips do not count. It guards
bodies whose hips leave the floor for some frames."""


def detect_standing_feet(
    motion: Motion, humanoid_map: HumanoidMap, legs: Sequence[LegJoints]
) -> NDArray[np.bool_]:
    """Return the contacts of both feet, (n_frames, 2), without legs that were not captured.

    The leg of a suit that only captures the upper body hangs stiff from the hips. Its foot
    slides as the hips rotate; to plant it would flex the knee for nothing. Nor do the feet of
    a body that sits or lies on the floor bear its weight: they touch the floor and may move.
    A foot that is dragged over the floor moves, too.
    """
    contacts = detect_contacts(motion, humanoid_map)
    rests = rests_on_hips(motion, humanoid_map, legs, MIN_HIP_HEIGHT)
    moves = rests[:, None] | find_dragged_feet(motion, legs, contacts)
    if (contacts & moves).any():
        contacts = without_short_contacts(contacts & ~moves, MIN_CONTACT_S * motion.frame_rate)
    hips = humanoid_map.indices(motion.skeleton).get("hips", 0)
    is_still = still_joints(motion)
    if is_still[hips]:
        return contacts
    for leg in legs:
        if is_still[list(leg.chain)].all():
            contacts[:, SIDES.index(leg.side)] = False
    return contacts


def rests_on_hips(
    motion: Motion, humanoid_map: HumanoidMap, legs: Sequence[LegJoints], min_height: float
) -> NDArray[np.bool_]:
    """Return when the pelvis is on the floor, shape (n_frames,).

    That is when its lowest joint is below a height, a ratio to the length of a leg.

    On the back with flexed legs it tilts, so that the hip joints are above its center.
    """
    heights = forward_kinematics(motion).positions[..., 2]
    feet = known_foot_points(motion.skeleton, humanoid_map).ravel()
    ground = np.percentile(heights[:, feet].min(axis=1), GROUND_PERCENTILE)
    pelvis = [leg.hip for leg in legs]
    length = np.mean([leg.length(motion.skeleton) for leg in legs])
    rest = motion.skeleton.rest_positions
    hips = humanoid_map.indices(motion.skeleton).get("hips", pelvis[0])
    if np.linalg.norm(rest[hips] - rest[pelvis].mean(axis=0)) < MAX_PELVIS_SIZE * length:
        pelvis.append(hips)
    lowest = heights[:, pelvis].min(axis=1)
    return np.asarray(lowest - ground < min_height * length)


def without_short_contacts(contacts: NDArray[np.bool_], min_frames: float) -> NDArray[np.bool_]:
    """Return contacts (n_frames, n) without shorter ones, except at the ends of the take."""
    kept = contacts.copy()
    for foot in kept.T:
        for start, stop in find_runs(foot):
            if stop - start < min_frames and start > 0 and stop < len(foot):
                foot[start:stop] = False
    return kept
