"""Contacts of the feet, keyed on custom properties that the animator can edit."""

import hashlib

import bpy
import numpy as np
from bpy.app import handlers
from numpy.typing import NDArray

from ...solvers.arrays import Array, Flags
from ..blender import compat
from ..blender.compat import Source
from ..scene import history
from .bone_channels import animated_curves
from .curves import CONSTANT, GENERATED, write_values

PROPERTIES = ("mocap_contact_left", "mocap_contact_right")
GROUP = "Foot contacts"
DETECTED = "mocap_assist_detected_contacts"
"""Property of an action: a digest of its contact keys, if they were detected."""


def read_contacts(
    action: bpy.types.Action, slot: bpy.types.ActionSlot, frames: NDArray[np.float64]
) -> Flags | None:
    """Return the contacts of the left and the right foot, shape (n_frames, 2).

    None where the action has no such keys for all of these frames: they were not cleaned yet.
    """
    curves = animated_curves(action, slot)
    standing = []
    for channel in [curves.get((_path(name), 0)) for name in PROPERTIES]:
        if channel is None or not len(times := channel.keys[:, 0]):
            return None
        if times[0] > frames[0] or times[-1] < frames[-1]:
            return None
        standing.append(channel.values(frames) > 0.5)
    return np.stack(standing, axis=1)


def contact_keys(action: bpy.types.Action, slot: bpy.types.ActionSlot) -> list[Array]:
    """Return frame and value of the keys of each foot, shape (n_keys, 2); none if muted."""
    curves = animated_curves(action, slot)
    channels = [curves.get((_path(name), 0)) for name in PROPERTIES]
    return [np.empty((0, 2)) if each is None else each.keys for each in channels]


def animators_contacts(source: Source, frames: NDArray[np.float64]) -> Flags | None:
    """Return the contacts, but only if the animator keyed them or edited those detected."""
    return None if _untouched(*source) else read_contacts(*source, frames)


def write_contacts(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    frames: NDArray[np.float64],
    contacts: Flags,
    *,
    detected: bool = False,
) -> None:
    """Key the two custom properties of the armature wherever a foot comes down or lifts off.

    The keys are held until the next one: 1 the foot stands, 0 it does not. Few as they are,
    they are moved, added and removed like any others in the Dope Sheet. The first and the last
    frame are keyed too, and so mark which frames have contacts.

    Keys that were `detected` have the type GENERATED, and the action remembers them: unless
    one of them is edited, contacts are detected again next time.
    """
    bag = compat.ensure_channelbag(action, slot)
    detected &= _untouched(action, slot) or not any(map(len, contact_keys(action, slot)))
    for name, standing in zip(PROPERTIES, contacts.T, strict=True):
        _declare(armature, name, int(standing[0]))
        curve = bag.fcurves.find(_path(name), index=0)
        if curve is None:
            curve = compat.new_curve(bag, _path(name), 0, GROUP)
        changes = np.flatnonzero(np.diff(standing)) + 1
        keyed = np.unique([0, *changes, len(frames) - 1])
        values = standing[keyed].astype(np.float64)
        types = np.full(len(keyed), GENERATED, np.uint8) if detected else None
        write_values(curve, frames[keyed], values, types, interpolation=CONSTANT)
    if detected:
        action[DETECTED] = _digest(action, slot)


def register() -> None:
    """Give the properties back to overrides when a file is loaded."""
    handlers.load_post.append(_give_back)


def unregister() -> None:
    """Remove the handler."""
    handlers.load_post.remove(_give_back)


@handlers.persistent
def _give_back(*_: object) -> None:
    """A library override loses properties that its library does not have; its keys stay."""
    for armature in bpy.data.objects:
        if armature.override_library is None or armature.animation_data is None:
            continue
        animation = armature.animation_data
        played = history.played_result(armature) or (animation.action, animation.action_slot)
        if None in played:
            continue
        curves = animated_curves(*played)
        for name in PROPERTIES:
            if (_path(name), 0) in curves and name not in armature:
                value = curves[_path(name), 0].curve.evaluate(
                    bpy.context.scene.frame_current_final
                )
                _declare(armature, name, int(value > 0.5))  # NaN is not


def _declare(armature: bpy.types.Object, name: str, value: int) -> None:
    armature[name] = value
    armature.id_properties_ui(name).update(
        min=0,
        max=1,
        description="1 while the foot is planted, 0 while it moves",
    )


def _untouched(action: bpy.types.Action, slot: bpy.types.ActionSlot) -> bool:
    """Whether the contact keys are as they were detected."""
    return bool(action.get(DETECTED) == _digest(action, slot))


def _digest(action: bpy.types.Action, slot: bpy.types.ActionSlot) -> str:
    keys = [each.ravel().tolist() for each in contact_keys(action, slot)]
    return hashlib.sha256(repr(keys).encode()).hexdigest()


def _path(name: str) -> str:
    return f'["{name}"]'
