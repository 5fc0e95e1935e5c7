"""Read the chosen bodies of a file, and all takes of each, for the button Import."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...solvers.errors import InvalidFileError
from ...solvers.motion import Motion
from ...solvers.recordings import ALL_BODIES, Bodies, Body
from ...solvers.recordings.conventions import MIN_BODY_JOINTS, observed_body
from ..jobs.in_blender import BlendClip, BlendRead, LeftOut

MAX_LISTED = 3
"""Bones that a sentence lists."""


@dataclass(frozen=True, eq=False)
class SkeletonAction:
    """One of several actions of a skeleton."""

    name: str
    motion: Motion
    armature: str = ""
    """Name of the armature in the file."""
    left_out: LeftOut = LeftOut()


def bodies_of_scene(path: str, found: BlendRead) -> Bodies[tuple[SkeletonAction, ...]]:
    """Return the armatures of a file that Blender has read, each with its takes.

    Raises InvalidFileError if there is none.
    """
    if not found.clips:
        raise InvalidFileError(
            found.refused[0] if found.refused else f"{path} has no animation of a skeleton."
        )
    groups = _group_by_armature(found.clips)
    longest = max(clip.motion.n_frames for group in groups for clip in group)
    listed = tuple(_body(name, group, longest) for name, group in _name_groups(groups))
    takes = [
        tuple(
            SkeletonAction(clip.item, clip.motion, clip.armature, clip.left_out)
            for clip in group
        )
        for group in groups
    ]
    return Bodies(path, listed, lambda index, progress: takes[index])


def choice_in_scene(wanted: str, bodies: Bodies[tuple[SkeletonAction, ...]]) -> list[int]:
    """Return the indices of the wanted armatures: all, unless another is named."""
    if wanted.strip().lower() in {"", ALL_BODIES}:
        return list(range(len(bodies.listed)))
    return bodies.choose(wanted)


def describe_left_out(takes: Sequence[LeftOut]) -> tuple[str, ...]:
    """Return one message for each kind of motion that the takes of a skeleton leave out."""
    shifting: dict[str, float] = {}
    for take in takes:
        for name, meters in take.shifts:
            shifting[name] = max(meters, shifting.get(name, 0.0))
    growing = dict.fromkeys(name for take in takes for name in take.growing)
    found = []
    if shifting:
        largest = 100.0 * max(shifting.values())
        found.append(
            "Bones change their distance to their parents, which is left out:"
            f" {_join_names(shifting)}, by up to {largest:.0f} cm"
        )
    if growing:
        found.append(f"Bones change their size, which is left out: {_join_names(growing)}")
    return tuple(found)


def _group_by_armature(clips: Sequence[BlendClip]) -> list[list[BlendClip]]:
    """Put together the clips of each armature with the same joints.

    Bone lengths that an action changes by constant keys are those of the group's first clip.
    """
    groups: list[list[BlendClip]] = []
    for clip in clips:
        for group in groups:
            first = group[0]
            same_joints = first.motion.skeleton.same_joints(clip.motion.skeleton)
            if first.armature == clip.armature and same_joints:
                group.append(clip)
                break
        else:
            groups.append([clip])
    return groups


def _name_groups(groups: list[list[BlendClip]]) -> list[tuple[str, list[BlendClip]]]:
    """Name groups after their armatures; of one armature, also after the first take."""
    armatures = [group[0].armature for group in groups]
    return [
        (armature if armatures.count(armature) == 1 else f"{armature} {group[0].item}", group)
        for armature, group in zip(armatures, groups, strict=True)
    ]


def _body(name: str, group: list[BlendClip], longest: int) -> Body:
    motion = max((clip.motion for clip in group), key=lambda each: each.n_frames)
    return observed_body(
        name,
        np.arange(motion.n_frames),
        longest,
        longest / motion.frame_rate,
        is_person=motion.skeleton.n_joints >= MIN_BODY_JOINTS,
    )


def _join_names(names: Mapping[str, object]) -> str:
    more = len(names) - MAX_LISTED
    return ", ".join([*names][:MAX_LISTED]) + (f" and {more} more" if more > 0 else "")
