"""Check the up axis and the unit that files of other programs state by the body in them."""

from collections.abc import Sequence
from dataclasses import replace

from ...motion import Motion, find_humanoid_map
from ...motion.skeletons.file_conventions import MIN_CERTAIN_CONFIDENCE
from .axes import rotation_to_z_up
from .body_axes import UpAxis, describe_guessed_axis, judge_up_axis, rotate_to_z_up
from .file_axes import conventions_of, rotated_conventions, with_conventions

BODY_ROLES = ("hips", "head", "leftFoot", "rightFoot")
"""Roles of a body whose up axis is judged: other skeletons keep the axis of their file."""
GUESSED_CONFIDENCE = 0.5
"""Confidence, a probability, in the axis of a file where the bodies suggest others. By
definition: two axes are equally likely."""


def stand_takes_upright(takes: Sequence[Motion]) -> list[Motion]:
    """Rotate the takes of a skeleton that lie because their file states another up axis.

    All takes are rotated alike, and only if each clear judgement (`judge_up_axis`) is for the
    same other axis: a take that lies next to one that stands was recorded lying. Likewise,
    a rest pose that stands confirms the axis of the file. Where no judgement is clear, the
    conventions note a lower confidence in that axis.
    """
    judged = [judge_up_axis(take) for take in takes if _has_body(take)]
    clear = [
        each for each in judged if each.is_clear and (each.axis == "Y" or each.rest_axis != "Y")
    ]
    axes = {each.axis for each in clear}
    if "Y" in axes or not judged:
        return list(takes)
    if len(axes) == 1:
        return [_rotated(take, clear[0]) for take in takes]
    confidence = min(
        each.confidence if each.axis == "Y" else GUESSED_CONFIDENCE for each in judged
    )
    return [
        with_conventions(take, replace(conventions_of(take), confidence=confidence))
        for take in takes
    ]


def describe_guesses(motion: Motion) -> list[str]:
    """Return a message for each convention of a file that the body does not show clearly."""
    conventions = conventions_of(motion)
    is_certain = conventions.confidence >= MIN_CERTAIN_CONFIDENCE
    return [] if is_certain else [describe_guessed_axis(conventions.up)]


def _has_body(motion: Motion) -> bool:
    return find_humanoid_map(motion.skeleton).has(*BODY_ROLES)


def _rotated(motion: Motion, judged: UpAxis) -> Motion:
    before = conventions_of(motion)
    noted = rotated_conventions(before, rotation_to_z_up(judged.axis))
    if judged.rest_axis != judged.axis:
        rest = rotated_conventions(before, rotation_to_z_up(judged.rest_axis))
        noted = replace(noted, rest_up=rest.up)
    return with_conventions(rotate_to_z_up(motion, judged.axis, judged.rest_axis), noted)
