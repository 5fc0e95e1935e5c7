"""Contacts of feet, hands, knees and hips, keyed on properties that the animator can edit."""

import bpy
import numpy as np
from bpy.app import handlers
from numpy.typing import NDArray

from ...solvers.arrays import Array, Flags
from ..blender import compat
from ..blender.compat import Source
from ..scene import history
from ..scene.played_time import played_time
from .bone_channels import animated_curves
from .curves import CONSTANT, GENERATED, MEASURED, ON_FRAME, Channel, write_values
from .detected_contacts import find_detected, store_detected

FOOT_PROPERTIES = ("mocap_contact_left", "mocap_contact_right")
SUPPORT_PROPERTIES = (
    "mocap_contact_left_hand",
    "mocap_contact_right_hand",
    "mocap_contact_left_knee",
    "mocap_contact_right_knee",
    "mocap_contact_hips",
)
"""In the order of `SUPPORTS` of the solvers."""
PROPERTIES = FOOT_PROPERTIES + SUPPORT_PROPERTIES
GROUP = "Contacts"


def read_contacts(
    action: bpy.types.Action, slot: bpy.types.ActionSlot, frames: NDArray[np.float64]
) -> Flags | None:
    """Return the contacts of the left and the right foot, shape (n_frames, 2).

    With keys of another part the shape is (n_frames, 7), in the order of `PROPERTIES`. None
    where the action has no keys of the feet for all of these frames: they were not cleaned yet.
    """
    curves = animated_curves(action, slot)
    standing = []
    for channel in [curves.get((_path(name), 0)) for name in FOOT_PROPERTIES]:
        if channel is None or not len(times := channel.keys[:, 0]):
            return None
        if times[0] > frames[0] or times[-1] < frames[-1]:
            return None
        standing.append(channel.values(frames) > 0.5)
    others = [curves.get((_path(name), 0)) for name in SUPPORT_PROPERTIES]
    if any(channel is not None and len(channel.keys) for channel in others):
        standing += [_read_contact(channel, frames) for channel in others]
    return np.stack(standing, axis=1)


def _read_contact(channel: Channel | None, frames: NDArray[np.float64]) -> Flags:
    """Return when a part bears on the floor: keys hold until the next one."""
    if channel is None or not len(channel.keys):
        return np.zeros(len(frames), dtype=np.bool_)
    last = np.searchsorted(channel.keys[:, 0], frames, side="right") - 1
    return np.asarray((last >= 0) & (channel.keys[last, 1] > 0.5))


def contact_keys(action: bpy.types.Action, slot: bpy.types.ActionSlot) -> list[Array]:
    """Return frame and value of the keys of each part, shape (n_keys, 2); none if muted.

    The parts are those of `PROPERTIES`.
    """
    curves = animated_curves(action, slot)
    channels = [curves.get((_path(name), 0)) for name in PROPERTIES]
    return [np.empty((0, 2)) if each is None else each.keys for each in channels]


def animators_contacts(source: Source, frames: NDArray[np.float64]) -> Array | None:
    """Return the contacts that the animator keyed, and those detected whose keys were edited.

    Shape (n_frames, 7), in the order of `PROPERTIES`: 1 in contact, 0 not, NaN where contacts
    are to be detected. None if that is everywhere. The contacts at both sides of a key that was
    moved or added are the animator's, and so is the time in which a deleted contact was. Feet
    are to be detected outside their keys; the last key of another part holds to the end.
    """
    keys = _keys_by_name(*source)
    detected = find_detected(*source, keys)
    contacts = np.full((len(frames), len(PROPERTIES)), np.nan)
    for column, (name, rows) in zip(contacts.T, keys.items(), strict=True):
        if not len(rows):
            continue
        key = np.searchsorted(rows[:, 0], frames + ON_FRAME, side="right") - 1
        is_animators = (key >= 0) & ~detected[name][key]
        if name in FOOT_PROPERTIES:
            is_animators &= frames <= rows[-1, 0] + ON_FRAME
        column[is_animators] = rows[key[is_animators], 1] > 0.5
    return None if np.isnan(contacts).all() else contacts


def write_contacts(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    frames: NDArray[np.float64],
    contacts: Flags,
    *,
    detected: bool = False,
    edited: Array | None = None,
) -> None:
    """Key custom properties of the armature wherever a foot comes down or lifts off.

    `contacts` have shape (n_frames, 2), or (n_frames, 7) with hands, knees and hips, whose
    properties are keyed only if one of them bears on the floor, or had keys.

    The keys are held until the next one: 1 the foot stands, 0 it does not. Few as they are,
    they are moved, added and removed like any others in the Dope Sheet. The first and the last
    frame are keyed too, and so mark which frames have contacts.

    Keys that were `detected` have the type GENERATED, and the action remembers them: contacts
    are detected again next time, but for those whose keys are edited. Those that are `edited`
    already, as `animators_contacts` returns them, are keyed as they are.
    """
    bag = compat.ensure_channelbag(action, slot)
    keys = _keys_by_name(action, slot)
    were_detected = find_detected(action, slot, keys)
    n_feet, n_parts = len(FOOT_PROPERTIES), contacts.shape[1]
    is_detected = np.full(contacts.shape, detected)
    if edited is not None:
        is_detected &= np.isnan(edited[:, :n_parts])
        contacts = np.where(np.isnan(edited[:, :n_parts]), contacts, edited[:, :n_parts] == 1.0)
    had_others = any(len(keys[name]) for name in SUPPORT_PROPERTIES)
    are_rare = not contacts[:, n_feet:].any() and not had_others
    for name, standing, found in zip(PROPERTIES, contacts.T, is_detected.T, strict=False):
        _declare(armature, name, int(standing[0]))
        if name in SUPPORT_PROPERTIES and are_rare:
            continue
        curve = bag.fcurves.find(_path(name), index=0)
        if curve is None:
            curve = compat.new_curve(bag, _path(name), 0, GROUP)
        changes = np.flatnonzero(np.diff(standing) | np.diff(found)) + 1
        keyed = np.unique([0, *changes, len(frames) - 1])
        values = standing[keyed].astype(np.float64)
        types = np.where(found[keyed], GENERATED, MEASURED).astype(np.uint8)
        write_values(curve, frames[keyed], values, types, interpolation=CONSTANT)
    written = _keys_by_name(action, slot)
    flags = {
        name: np.isin(rows[:, 0], keys[name][were_detected[name], 0])
        for name, rows in written.items()
    }
    for name, found in zip(PROPERTIES, is_detected.T, strict=False):
        times = written[name][:, 0]
        index = np.searchsorted(frames, times - ON_FRAME).clip(max=len(frames) - 1)
        is_new = np.abs(frames[index] - times) <= ON_FRAME
        flags[name][is_new] = found[index[is_new]]
    store_detected(action, slot, written, flags)


def _keys_by_name(action: bpy.types.Action, slot: bpy.types.ActionSlot) -> dict[str, Array]:
    return dict(zip(PROPERTIES, contact_keys(action, slot), strict=True))


def register() -> None:
    """Restore the properties of overrides when a file is loaded."""
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
                frame = bpy.context.scene.frame_current_final
                value = curves[_path(name), 0].curve.evaluate(
                    played_time(armature, frame).action_frame(frame)
                )
                _declare(armature, name, int(value > 0.5))  # NaN is not


def _declare(armature: bpy.types.Object, name: str, value: int) -> None:
    armature[name] = value
    armature.id_properties_ui(name).update(
        min=0,
        max=1,
        description="1 while this part of the body bears on the floor, 0 while it moves",
    )


def _path(name: str) -> str:
    return f'["{name}"]'
