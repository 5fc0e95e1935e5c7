"""What the button Clean reads from the scene and writes back."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import partial

import bpy
import numpy as np
from numpy.typing import NDArray

from ..solvers.denoising import Denoised, DenoiseSettings
from ..solvers.errors import InvalidMotionError
from ..solvers.settings import Settings, setting
from .jobs.cleaning import Cleaned, Examples, clean
from .scene import compat, history
from .scene.armature_read import action_of, read_take
from .scene.armature_write import Output, check_writable, put_to_use, write_take
from .scene.curves import GENERATED, MEASURED
from .scene.frames import FrameRange
from .scene.take import ArmatureTake

UNSURE = 0.5  # confidence below which a key counts as generated


class Bones(Enum):
    """Bones to clean."""

    ALL = "all"
    SELECTED = "selected"


@dataclass(frozen=True, kw_only=True)
class CleanChoices(Settings):
    """What is cleaned, and where the result goes."""

    bones: Bones = setting(
        Bones.ALL, "Change all bones, or only the selected ones; all of them guide the estimate"
    )
    frame_range: FrameRange = setting(
        FrameRange.ACTION, "Change all frames of the action, or only a part of them"
    )
    output: Output = setting(
        Output.ACTION,
        "Put the result in the place of the action, or on an NLA track of its own",
    )


def selected_armature(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object if it is an armature."""
    active = context.view_layer.objects.active
    return active if active is not None and active.type == "ARMATURE" else None


def read_cleaning(
    context: bpy.types.Context, choices: CleanChoices, settings: DenoiseSettings
) -> Callable[..., Cleaned]:
    """Read the active armature; return what is to be solved, which may be pickled."""
    armature = selected_armature(context)
    check_writable(armature)
    chosen_bones(armature, choices.bones)
    take = _read(context, choices)
    return partial(clean, take.recordings, settings, Examples())


def write_cleaned(
    context: bpy.types.Context,
    choices: CleanChoices,
    settings: DenoiseSettings,
    cleaned: Cleaned,
) -> str:
    """Write the result as a new action and put it to use; return a sentence about it."""
    armature = selected_armature(context)
    source = history.raw_source(armature) or action_of(armature)
    raw = _read(context, choices)
    bones = chosen_bones(armature, choices.bones)
    types = key_types(raw, cleaned.denoised)
    action, slot = write_take(
        armature, source, raw.with_recordings(cleaned.recordings), bones, types
    )
    entry = {"operation": "denoise", "settings": history.plain(settings, choices)}
    entry["prior_used"] = cleaned.denoised[0].prior_used
    history.record(action, *source, entry)
    put_to_use(armature, action, slot, choices.output)
    return (
        f"Cleaned {len(bones)} bones over {len(raw.frames)} frames into {action.name}."
        f" {cleaned.denoised[0].prior_used}"
    )


def chosen_bones(armature: bpy.types.Object, choice: Bones) -> set[str]:
    """Return the names of the bones to change, of which there must be one."""
    bones = armature.pose.bones
    if choice is Bones.ALL:
        return {bone.name for bone in bones}
    selected = {bone.name for bone in bones if compat.is_selected(bone)}
    if not selected:
        raise InvalidMotionError(
            "No bones are selected. Select some in Pose Mode, or clean all bones."
        )
    return selected


def key_types(
    raw: ArmatureTake, denoised: tuple[Denoised, ...]
) -> dict[str, NDArray[np.uint8]]:
    """Paint the keys of each bone: what was filled or corrected is GENERATED, the rest not."""
    types = {}
    for recording, result in zip(raw.recordings, denoised, strict=True):
        generated = result.outliers | (result.confidence < UNSURE)
        names = getattr(recording, "names", None) or recording.skeleton.names
        for name, unsure in zip(names, generated.T, strict=True):
            painted = np.where(unsure, GENERATED, MEASURED).astype(np.uint8)
            types[name] = np.maximum(painted, types.get(name, 0))
    return types


def _read(context: bpy.types.Context, choices: CleanChoices) -> ArmatureTake:
    armature = selected_armature(context)
    action, slot = history.raw_source(armature) or action_of(armature)
    return read_take(armature, context.scene, choices.frame_range, action, slot)
