"""Check the unit and the up axis that files of other programs state by the body in them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...motion import FileConventions, Motion, find_humanoid_map
from .axes import ADULT_REACH_M, MIN_BODY_JOINTS, longest_bone_path, rotation_to_z_up
from .body_axes import describe_guessed_axis, estimate_up_axis
from .body_unit import MIN_MAP_SCORE
from .file_axes import conventions_of, rotated_conventions
from .unit_estimate import describe_guessed_unit

STATED_REACH_M = (0.25, 15.0)
"""Range of the longest path along the bones, meters, for which the unit of a file is believed.
Chosen by hand: from a cat, 0.25 m, to a dragon."""
STATED_UNITS = (1.0, *(10.0**power for power in (-3, -2, -1, 1, 2, 3)), 0.0254)
"""Factors to meters by which a file may state its unit wrongly: powers of ten, and the inch. By
definition of the units of length."""


def describe_guesses(motion: Motion) -> list[str]:
    """Return a message for each convention of a file that the body does not show clearly."""
    conventions = conventions_of(motion)
    found = []
    if not conventions.is_certain:
        found.append(describe_guessed_axis(conventions.up))
    if conventions.stated_up is not None:
        found.append(
            f"The file states that {conventions.stated_up} is up, but the actor stands along"
            f" {conventions.up}; set Up to {conventions.stated_up} if the actor lies"
        )
    if conventions.is_unit_guessed:
        found.append(describe_guessed_unit(conventions.unit))
    return found


def describe_lying(takes: Sequence[Motion]) -> list[str]:
    """Return a question where no take of a skeleton stands along the up axis of its file.

    The axis is kept: nothing in a file distinguishes a take recorded lying from one exported
    with a wrong axis.
    """
    estimated = [estimate_up_axis(take) for take in takes if _has_body(take)]
    if not estimated or any(each.axis == "Y" for each in estimated):
        return []
    stated = conventions_of(takes[0])
    other = rotated_conventions(stated, rotation_to_z_up(estimated[0].axis)).up
    return [
        f"The actor lies or is upside down: the file has {stated.up} up; set Up to {other} if"
        " that is wrong"
    ]


def _has_body(motion: Motion) -> bool:
    """Whether a take shows a person, whose trunk stands; that of an animal lies."""
    humanoid = find_humanoid_map(motion.skeleton)
    roles = "hips", "head", "leftFoot", "rightFoot"
    return humanoid.score >= MIN_MAP_SCORE and humanoid.has(*roles)


def correct_stated_unit(motion: Motion, stated: FileConventions, factor: float) -> Motion:
    """Return a take of plausible size, with its unit noted, whatever unit its file states.

    Programs that exchange scenes err by powers of ten and by inches; Acclaim units, which
    only BVH files are written in, are never guessed (`guess_unit`).

    Parameters
    ----------
    motion : Motion
    stated : what the file states
    factor : by which the reader multiplied the lengths of the file, in meters, already
    """
    skeleton, conventions = motion.skeleton, stated
    reach = longest_bone_path(skeleton.parents, skeleton.offsets) / factor
    guessed = _plausible_factor(reach) if skeleton.n_joints >= MIN_BODY_JOINTS else factor
    if guessed != 1.0:
        unit = float(f"{guessed * conventions.unit:.6g}")  # as unit_name has it
        conventions = replace(conventions, unit=unit, is_unit_guessed=True)
    if guessed == factor:
        return replace(motion, conventions=conventions)
    return replace(
        motion,
        skeleton=replace(skeleton, offsets=guessed / factor * skeleton.offsets),
        root_positions=guessed / factor * motion.root_positions,
        conventions=conventions,
    )


def _plausible_factor(reach: float) -> float:
    """Return the factor that makes a body of a path along its bones, in meters; otherwise 1."""
    low, high = STATED_REACH_M
    if not reach > 0.0 or low <= reach <= high:
        return 1.0
    guessed = min(STATED_UNITS, key=lambda unit: abs(np.log(reach * unit / ADULT_REACH_M)))
    return guessed if low <= guessed * reach <= high else 1.0
