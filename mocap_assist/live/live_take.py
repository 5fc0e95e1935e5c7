"""Record Live: read the rig, let it follow the stream, and write what was recorded."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import bpy
import numpy as np
from mathutils import Matrix, Quaternion

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.recordings.live import PORT
from ...solvers.settings import Settings, setting
from ...solvers.version import version
from ...solvers.workflows import LiveTakeSettings
from ..actions.action_write import write_action
from ..actions.armature_write import check_writable
from ..actions.reliability_curves import write_reliability
from ..blender import compat
from ..blender.stored_json import store_json
from ..jobs.protocol import PreviewSolve
from ..panels.preference_values import preferences, preferred
from ..rigs.control_plan import Limbs
from ..rigs.target_read import find_roles, read_target
from ..runtime.selection import selected_armature
from ..scene import history
from ..scene.controls import BoneKeys
from ..scene.scene_rate import scene_rate
from .solve_live_take import LiveProblem, RecordedTake, record_live, recorded_take

RECORDED_LIVE = "mocap_assist_recorded_live"
"""Custom property of the action: its origin as JSON. Clean treats it as raw."""


@dataclass(frozen=True, kw_only=True)
class LiveChoices(Settings):
    """How long Record Live records, and into which controls."""

    duration: float = setting(
        0.0, "Time to record after the actor was measured; 0 records until Esc", unit="s",
        minimum=0.0, maximum=3600.0,
    )  # fmt: skip
    live_limbs: Limbs = setting(
        Limbs.FK,
        "Controls of arms and legs to key, where the rig has FK and IK",
        label="Arms and Legs",
    )


class LiveBundle(NamedTuple):
    """Settings of the button."""

    choices: LiveChoices
    taking: LiveTakeSettings


def why_not_record(context: bpy.types.Context) -> str:
    """Return why no rig can follow the stream, or an empty text."""
    if selected_armature(context) is None:
        return "Select the armature that follows the actor."
    return ""


def read_live(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: LiveBundle
) -> PreviewSolve[RecordedTake]:
    """Read the rest pose of the rig; return the picklable solve."""
    choices = settings.choices
    if bpy.app.background and not choices.duration:
        raise InvalidMotionError("Without a window, set the duration of the recording.")
    check_writable(armature)
    rig, _ = read_target(scene, armature, find_roles(armature), choices.live_limbs, False)
    port = preferred("live_port") if preferences() is not None else PORT
    return PreviewSolve(record_live, LiveProblem(port, rig, settings.taking, choices.duration))


def watch_live(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: LiveBundle
) -> "LivePoses":
    """Return what lets the rig follow the stream."""
    _, switches = read_target(
        scene, armature, find_roles(armature), settings.choices.live_limbs, False
    )
    return LivePoses(armature, switches)


def keep_on_esc(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: LiveBundle
) -> Callable[[list[Any]], RecordedTake]:
    """Return what makes a recording of the frames so far: Esc is its regular end."""
    return recorded_take


def write_live(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: LiveBundle,
    take: RecordedTake,
    solved_digest: str | None = None,
) -> str:
    """Write the recording as a new action, from the current frame on; return a message."""
    _, switches = read_target(
        scene, armature, find_roles(armature), settings.choices.live_limbs, False
    )
    step = scene_rate(scene) / take.frame_rate
    frames, chosen = np.unique(np.round(take.frames * step), return_index=True)
    frames = frames + scene.frame_current
    keys = {bone: _at(channels, chosen) for bone, channels in take.keys.items()}
    action, slot = write_action(armature, f"{armature.name}.live", frames, keys, switches)
    confidence = {bone: values[chosen] for bone, values in take.confidence.items()}
    write_reliability(armature, action, slot, frames, confidence)
    store_json(action, RECORDED_LIVE, {
        "version": version(),
        "operation": "record_live",
        "settings": history.plain(*settings),
        "frame_rate": take.frame_rate,
    })  # fmt: skip
    compat.assign(armature, action, slot)
    seconds = (take.frames[-1] + 1.0) / take.frame_rate
    message = f"{action.name}: recorded {seconds:.1f} s at {take.frame_rate:.3g} Hz."
    return f"{message} {take.remark}".strip()


def _at(channels: BoneKeys, frames: Array) -> BoneKeys:
    return BoneKeys(
        *(
            None if each is None else each[frames]
            for each in (channels.rotations, channels.locations)
        )
    )


class LivePoses:
    """Poses a rig by the newest preview until it is closed; then restores its pose."""

    def __init__(
        self, armature: bpy.types.Object, switches: Mapping[tuple[str, str], float]
    ) -> None:
        self._armature = partial(bpy.data.objects.get, armature.name)
        self._switches = switches
        self._before: dict[str, Any] | None = None

    def show(
        self, scene: bpy.types.Scene, target: bpy.types.Object, previews: Iterable[Any]
    ) -> None:
        """Let the rig take the pose of the last preview, if there is one."""
        newest = list(previews)
        if not newest:
            return
        bones = target.pose.bones
        if self._before is None:
            self._before = {name: bones[name].matrix_basis.copy() for name in newest[-1].keys}
            self._old_switches = {
                (bone, prop): bones[bone][prop] for bone, prop in self._switches
                if bone in bones and prop in bones[bone]
            }  # fmt: skip
            for bone, prop in self._old_switches:
                bones[bone][prop] = self._switches[bone, prop]
        for name, channels in newest[-1].keys.items():
            _pose(bones[name], channels)
        target.update_tag()

    def close(self) -> None:
        """Give the rig its former pose."""
        armature = self._armature()
        if self._before is None or armature is None:
            return
        for name, matrix in self._before.items():
            armature.pose.bones[name].matrix_basis = matrix
        for (bone, prop), value in self._old_switches.items():
            armature.pose.bones[bone][prop] = value
        self._before = None


def _pose(bone: bpy.types.PoseBone, channels: BoneKeys) -> None:
    location, rotation, scale = bone.matrix_basis.decompose()
    if channels.rotations is not None:
        rotation = Quaternion(channels.rotations[0])
    if channels.locations is not None:
        location = channels.locations[0]
    bone.matrix_basis = Matrix.LocRotScale(location, rotation, scale)
