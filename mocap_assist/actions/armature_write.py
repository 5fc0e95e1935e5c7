"""Write a cleaned take into a copy of its action; the source is never touched."""

import re
from collections.abc import Collection, Mapping
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.settings import Choice
from ..blender import compat
from ..blender.block_references import (
    BlockReference,
    SourceReference,
    changed_during_solve,
    kept_when_complete,
)
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps, in_thread, should_yield
from ..scene import history
from .bone_channels import (
    Curves,
    animated_curves,
    bone_path,
    location_curves,
    rotation_curves,
    sampled_rotation,
)
from .curve_modifiers import act_on_keys
from .curves import Channel, write_values
from .nla_strips import keep_action, new_strip, play_in_place, remove_deltas, strip_of_result
from .rotation_modes import channels_from_quaternions
from .take import ArmatureTake, BoneChannels, BonePoses
from .unchanged_samples import RecordedChannels, UnchangedSamples

KeyTypes = Mapping[str, NDArray[np.uint8]]
SUFFIX = ".clean"
NUMBERED = re.compile(r"\.(clean|delta|physics|reconstructed|retracked)(\.\d{3,})?$")
"""As Blender names a second result."""


class Output(Choice):
    """Output of a button."""

    ACTION = (
        "action",
        "Assign the result as a new action; the original stays in the file",
        "New Action",
    )
    NLA_TRACK = "NLA track", "Put the result on a new NLA track above the original"


@Sliced
def write_take(
    armature: bpy.types.Object,
    source: Source,
    take: ArmatureTake,
    bones: Collection[str],
    key_types: KeyTypes,
    *,
    suffix: str = SUFFIX,
    recorded: RecordedChannels | None = None,
) -> Steps[Source]:
    """Copy an action and replace the rotation and location keys of some of its bones.

    Parameters
    ----------
    armature : the armature that the take was read from
    source : action and slot that the take was read from; may be linked
    take : ArmatureTake
        The result, over the frames to replace. Keys outside of them are kept.
    bones : names of the bones to change
        All else is copied bit for bit; so are muted channels, channels of other rotation modes
        than the bone's own, and Euler or location channels that have no keys.
    key_types : per bone name, shape (n_frames,)
        Blender's type of each key.
    suffix : ending of the result's name
    recorded : RecordedChannels, optional
        Samples that are the recording's get its values to the last bit.

    Returns
    -------
    action, slot
        Named like the source with the suffix, and with a fake user.
    """
    here, origin = BlockReference.of(armature), SourceReference.of(source)
    playing = identify_played(armature)
    poses = yield from in_thread.steps(take.bone_poses)
    unchanged = None
    if recorded is not None:
        before = yield from in_thread.steps(recorded.take.bone_poses)
        unchanged = UnchangedSamples(recorded, before, poses)
    original = origin.find()
    action = copy_of(original[0], suffix)
    made = SourceReference.of((action, same_slot(action, original[1])))
    indices = [index for index, name in enumerate(take.rig.bones) if name in bones]
    with kept_when_complete(action):
        armature, curves = here.find(), animated_curves(*made.find())
        for number, bone in enumerate(indices):
            _BoneWriter.of(armature, curves, take, bone, key_types).write(poses, unchanged)
            if should_yield():
                yield number / len(indices)
                armature, curves = here.find(), animated_curves(*made.find())
                if identify_played(armature) != playing:
                    raise changed_during_solve(here.name)
                if unchanged:
                    unchanged.find_again()
    return made.find()


def identify_played(armature: bpy.types.Object) -> tuple[int, int] | None:
    """Return an identifier of the action of an armature and its slot."""
    animation = armature.animation_data
    if animation is None or animation.action is None:
        return None
    return animation.action.session_uid, animation.action_slot_handle


class _BoneWriter(NamedTuple):
    """Writes the keys of one bone."""

    number: int
    keyed: BoneChannels
    bone: bpy.types.PoseBone
    curves: Curves
    frames: Array
    types: NDArray[np.uint8] | None

    @classmethod
    def of(
        cls,
        armature: bpy.types.Object,
        curves: Curves,
        take: ArmatureTake,
        number: int,
        key_types: KeyTypes,
    ) -> "_BoneWriter":
        """Look up a bone and its curves; raise InvalidMotionError if it was deleted."""
        name = take.rig.bones[number]
        bone = armature.pose.bones.get(name)
        if bone is None:
            raise changed_during_solve(armature.name)
        return cls(
            number, take.channels[number], bone, curves, take.frames, key_types.get(name)
        )

    def write(self, poses: BonePoses, unchanged: UnchangedSamples | None) -> None:
        """Replace the rotation and location keys."""
        if self.keyed.rotation_keyed and self.number in poses.rotations:
            channels = rotation_curves(self.bone, self.curves)
            near = sampled_rotation(self.bone, channels, self.frames[:1])
            rotations = poses.rotations[self.number]
            values = channels_from_quaternions(rotations, self.bone.rotation_mode, near)
            if unchanged is not None:
                values = unchanged.rotations(self.bone, self.number, values)
            self._write(channels, values)
        if self.keyed.location_keyed and self.number in poses.locations:
            values = poses.locations[self.number]
            if unchanged is not None:
                values = unchanged.locations(self.bone, self.number, values)
            self._write(location_curves(self.bone, self.curves), values)

    def _write(self, channels: Mapping[int, Channel], values: Array) -> None:
        for index, channel in channels.items():
            write_values(channel.curve, self.frames, values[:, index], self.types)


def count_modified(source: Source, bones: Collection[str]) -> int:
    """Count the F-Curves of these bones with modifiers that change the keyed values."""
    owned = tuple(bone_path(bone, "") for bone in bones)
    curves = animated_curves(*source).items()
    return sum(act_on_keys(each.curve) for (path, _), each in curves if path.startswith(owned))


def assign_result(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    output: Output,
) -> None:
    """Let the armature play a result: as its action, or on an NLA track of its own.

    Where an earlier result of the same take plays on a strip of our own, the new one plays
    there. A delta layer of it is removed: it would be added. All other NLA strips stay.

    Raises
    ------
    InvalidMotionError
        Nothing can be assigned to the armature; see `check_writable`.
    """
    check_writable(armature)
    raw, animation = history.raw_of(action, slot), armature.animation_data
    strip = None
    if animation is not None:
        keep_replaced(animation, (action, raw[0] if raw else None))
    if raw and animation is not None:
        remove_deltas(animation, raw[0])
        strip = strip_of_result(armature, raw)
    if output is Output.ACTION and strip is None:
        compat.assign(armature, action, slot)
        return
    animation.action = None
    if strip is None:
        new_strip(animation, (action, slot))
    else:
        play_in_place(strip, (action, slot))


def keep_replaced(
    animation: bpy.types.AnimData, known: Collection[bpy.types.Action | None]
) -> None:
    """Let the assigned action, such as a fix by hand, stay in the file when it is replaced.

    Those that are `known`, the recording and the result, stay anyway.
    """
    if animation.action not in known:
        keep_action(animation.action)


def check_writable(armature: bpy.types.Object) -> None:
    """Raise InvalidMotionError where an armature cannot be given another action."""
    if armature.library is not None:
        raise InvalidMotionError(
            f"{armature.name} is linked from {armature.library.name}. Make a library override"
            " of it, so that the result can be assigned."
        )
    check_not_tweaked(armature)


def check_not_tweaked(armature: bpy.types.Object) -> None:
    """Raise InvalidMotionError where Tweak Mode locks the action of an armature."""
    if armature.animation_data is not None and armature.animation_data.use_tweak_mode:
        raise InvalidMotionError(
            f"{armature.name} is in tweak mode, which locks its action. Leave it in the NLA"
            " Editor (Tab)."
        )


FIX_CARD = "mocap_assist_fix"
"""Custom property of an action: the card of Fix My Take, which is about that action alone."""


def copy_of(original: bpy.types.Action, suffix: str = SUFFIX) -> bpy.types.Action:
    """Return a copy, named like the original with an ending."""
    action = original.copy()
    if FIX_CARD in action:
        del action[FIX_CARD]
    action.name = NUMBERED.sub("", original.name) + suffix
    return action


def same_slot(copy: bpy.types.Action, slot: bpy.types.ActionSlot) -> bpy.types.ActionSlot:
    """Return the slot of a copied action that was `slot` of the original."""
    return next(each for each in copy.slots if each.handle == slot.handle)
