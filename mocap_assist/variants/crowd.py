"""Assign variants to many armatures, each with its own delay, position and heading."""

from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Euler

from ...solvers.errors import InvalidMotionError
from ..actions.armature_write import check_writable
from ..find_similar.nla import add_strip
from ..scene.scene_rate import scene_rate
from ..scene.units import unit_of
from . import listing
from .button_settings import CrowdBundle, CrowdChoices
from .tags import is_variant

NO_ARMATURE = "The armature of the variants was deleted. Press Vary again."


class CrowdMember(NamedTuple):
    """Variant and placement of one armature of a crowd."""

    variant: int
    delay: float
    """Seconds."""
    offset: tuple[float, float]
    """Meters from its position."""
    angle: float
    """Radians."""


def draw_members(n_members: int, n_variants: int, choices: CrowdChoices) -> list[CrowdMember]:
    """Draw a crowd: each variant is used once before any is repeated.

    The first members do not depend on the number of members.
    """
    members: list[CrowdMember] = []
    orders: list[int] = []
    for member_index in range(n_members):
        rng = np.random.default_rng([choices.crowd_seed, member_index])
        if not orders:
            permutations = np.random.default_rng([choices.crowd_seed, member_index, n_variants])
            orders = permutations.permutation(n_variants).tolist()
        distance, angle, delay, rotation = rng.uniform(size=4)
        radius = choices.spread * np.sqrt(distance)  # even over the disc
        members.append(
            CrowdMember(
                orders.pop(0),
                float(choices.delay * delay),
                (
                    float(radius * np.cos(2 * np.pi * angle)),
                    float(radius * np.sin(2 * np.pi * angle)),
                ),
                float(choices.turn * (2.0 * rotation - 1.0)),
            )
        )
    return members


def why_not_assign(context: bpy.types.Context) -> str:
    """Return why the variants cannot be assigned, or an empty text."""
    if reason := listing.why_none(context):
        return reason
    if not crowd_of(context):
        return "Select the armatures that receive the variants."
    return ""


def crowd_of(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return the selected armatures, by name."""
    selected = [each for each in context.view_layer.objects if each.select_get()]
    return sorted(
        (each for each in selected if each.type == "ARMATURE"), key=lambda each: each.name
    )


def assign(
    context: bpy.types.Context, armatures: list[bpy.types.Object], settings: CrowdBundle
) -> str:
    """Assign each armature a variant on a new NLA track; return a message.

    A member is moved and rotated by its delta transforms, so that a second press replaces
    what the first did, and its own location stays free.

    Raises
    ------
    InvalidMotionError
        An armature cannot play them; nothing is changed then.
    """
    scene, actions = context.scene, listing.chosen_variants(context.scene)
    members = draw_members(len(armatures), len(actions), settings.choices)
    given = []
    for armature, member in zip(armatures, members, strict=True):
        check_writable(armature)
        given.append(listing.source_for(armature, actions[member.variant]))
    ours = {action for action in bpy.data.actions if is_variant(action)}
    for armature, member, (action, slot) in zip(armatures, members, given, strict=True):
        _clear(armature, ours)
        frame = scene.frame_current + round(member.delay * scene_rate(scene))
        strip = add_strip(armature, action, slot, frame, 1.0)
        strip.extrapolation = "HOLD"  # before it begins a member waits in its first pose
        _stand(armature, member, unit_of(scene))
    shown = "1 armature" if len(armatures) == 1 else f"{len(armatures)} armatures"
    return f"Assigned {min(len(armatures), len(actions))} variants to {shown} on NLA tracks."


def _clear(armature: bpy.types.Object, ours: set[bpy.types.Action]) -> None:
    """Remove the variants that the armature played before."""
    animation = armature.animation_data
    if animation is None:
        return
    if animation.action in ours:
        animation.action = None
    for track in list(animation.nla_tracks):
        if len(track.strips) and all(strip.action in ours for strip in track.strips):
            animation.nla_tracks.remove(track)


def _stand(armature: bpy.types.Object, member: CrowdMember, meters_per_unit: float) -> None:
    armature.delta_location = (*(each / meters_per_unit for each in member.offset), 0.0)
    rotation = Euler((0.0, 0.0, member.angle))
    armature.delta_rotation_euler = rotation
    armature.delta_rotation_quaternion = rotation.to_quaternion()


def why_not_stack(context: bpy.types.Context) -> str:
    """Return why the variants cannot become strips, or an empty text."""
    if reason := listing.why_none(context):
        return reason
    armature = listing.armature_of(context.scene)
    if armature is None:
        return NO_ARMATURE
    try:
        check_writable(armature)
    except InvalidMotionError as error:
        return str(error)
    return ""


def put_on_tracks(context: bpy.types.Context) -> str:
    """Put the variants on NLA tracks of their armature in sequence; return a message."""
    scene = context.scene
    armature, actions = listing.armature_of(scene), listing.chosen_variants(scene)
    if armature is None:
        raise InvalidMotionError(NO_ARMATURE)
    sources = [listing.source_for(armature, action) for action in actions]
    _clear(armature, set(actions))
    frame = scene.frame_current
    for action, slot in sources:
        strip = add_strip(armature, action, slot, frame, 1.0)
        frame = int(np.ceil(strip.frame_end)) + 1
    return f"{len(actions)} strips on the NLA of {armature.name}."
