"""Record Live: read the rig, let it follow the stream, and write what was recorded."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import bpy
from mathutils import Matrix, Quaternion

from ...solvers.errors import InvalidMotionError
from ...solvers.recordings.streams import MAX_PEOPLE, StreamProtocol
from ...solvers.settings import Settings, setting
from ...solvers.version import version
from ...solvers.workflows import LiveTakeSettings
from ..actions.action_write import write_action
from ..actions.armature_write import check_writable
from ..actions.contact_keys import write_contacts
from ..actions.limits import target_limits
from ..actions.reliability_curves import write_reliability
from ..blender import compat
from ..blender.block_references import BlockReference
from ..blender.redrawing import redraw
from ..blender.stored_json import store_json
from ..jobs.protocol import PreviewSolve
from ..rigs.control_plan import Limbs
from ..rigs.target_read import find_roles, read_target
from ..runtime.selection import selected_armature
from ..scene import history
from ..scene.controls import BoneKeys
from ..scene.scene_rate import scene_rate
from .solve_live_rig import LiveBones, LiveRigChoices
from .solve_live_take import LiveProblem, RecordedTake, record_live, recorded_take
from .stream_preferences import allowed_addresses, live_port

NO_DURATION = "Set the duration of the recording: scripts and repeated presses have no Esc."
ESC_ENDS = "Esc ends the recording"
LOOK_INTERVAL_S = 1.0 / 120.0
"""Seconds between two looks at the poses that were solved. It bounds the delay of the rig; a
shorter one takes more of Blender's time."""
RECORDED_LIVE = "mocap_assist_recorded_live"
"""Custom property of the action: its origin as JSON. Clean treats it as raw."""


@dataclass(frozen=True, kw_only=True)
class LiveChoices(Settings):
    """How long Record Live records, and into which controls."""

    duration: float = setting(
        0.0, "Time to record after the actor was measured; 0 records until Esc", unit="s",
        minimum=0.0, maximum=3600.0,
    )  # fmt: skip
    live_protocol: StreamProtocol = setting(
        StreamProtocol.AUTO, "Protocol of the tracker that streams", label="Protocol"
    )
    live_person: int = setting(
        0,
        "Person to follow, numbered as they appear; 0 follows the first one",
        minimum=0,
        maximum=MAX_PEOPLE,
        label="Person",
    )
    live_limbs: Limbs = setting(
        Limbs.FK,
        "Controls of arms and legs to key, where the rig has FK and IK",
        label="Arms and Legs",
    )
    hold_feet: bool = setting(
        True, "Keep feet from sliding while they touch the ground, and key their contacts"
    )
    keep_limits: bool = setting(
        True,
        "Keep rotations softly within the Limit Rotation constraints of their bones",
        label="Joint Limits",
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
    check_writable(armature)
    rig, _ = read_target(scene, armature, find_roles(armature), choices.live_limbs, False)
    problem = LiveProblem(
        live_port(),
        choices.live_protocol,
        allowed_addresses(),
        rig,
        settings.taking,
        choices.duration,
        scene.frame_current_final,
        LiveRigChoices(
            choices.hold_feet, target_limits(armature, rig) if choices.keep_limits else None
        ),
        choices.live_person,
    )
    return PreviewSolve(record_live, problem)


def watch_live(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: LiveBundle
) -> "LivePoses":
    """Return the display that lets the rig follow the stream."""
    _, switches = read_target(
        scene, armature, find_roles(armature), settings.choices.live_limbs, False
    )
    return LivePoses(armature, switches)


def keep_on_esc(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: LiveBundle
) -> Callable[[list[Any]], RecordedTake]:
    """Return the function that makes a recording of the frames so far: Esc is its regular
    end."""
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
    frames = take.first_frame + take.frames * (scene_rate(scene) / take.frame_rate)
    name = f"{armature.name}.live"
    action, slot = write_action(armature, name, frames, take.keys, switches)
    write_reliability(armature, action, slot, frames, take.confidence)
    if take.contacts is not None:
        write_contacts(armature, action, slot, frames, take.contacts, detected=True)
    store_json(action, RECORDED_LIVE, {
        "version": version(),
        "operation": "record_live",
        "settings": history.json_ready(*settings),
        "frame_rate": take.frame_rate,
    })  # fmt: skip
    compat.assign(armature, action, slot)
    seconds = (take.frames[-1] + 1.0) / take.frame_rate
    message = f"{action.name}: recorded {seconds:.1f} s at {take.frame_rate:.3g} Hz."
    return f"{message} {take.remark}".strip()


class LivePoses:
    """Poses a rig by the newest preview until it is closed; then restores its pose."""

    def __init__(
        self, armature: bpy.types.Object, switches: Mapping[tuple[str, str], float]
    ) -> None:
        self._armature = BlockReference.of(armature)
        self._switches = switches
        self._bones: LiveBones | None = None
        self._poses: dict[str, Matrix] = {}
        self._old_switches: dict[tuple[str, str], Any] = {}

    def show(
        self, scene: bpy.types.Scene, target: bpy.types.Object, previews: Iterable[Any]
    ) -> None:
        """Let the rig take the pose of the last preview, if there is one."""
        newest = None
        for preview in previews:
            if isinstance(preview, LiveBones):
                self._begin(target, preview)
            else:
                newest = preview
        if newest is None or self._bones is None:
            return
        for name, channels in newest.keys(self._bones).items():
            _pose(target.pose.bones[name], channels)
        target.update_tag()
        redraw(bpy.context, "VIEW_3D")

    def close(self) -> None:
        """Restore the former pose of the rig."""
        try:
            armature = self._armature.find()
        except InvalidMotionError:  # deleted meanwhile
            return
        bones = armature.pose.bones
        for name in self._poses.keys() & set(bones.keys()):
            bones[name].matrix_basis = self._poses[name]
        for (bone, prop), value in self._old_switches.items():
            if bone in bones:
                bones[bone][prop] = value
        armature.update_tag()

    def _begin(self, target: bpy.types.Object, shown: LiveBones) -> None:
        """Remember the pose, and switch limbs to the controls that are keyed."""
        bones, self._bones = target.pose.bones, shown
        names = (*shown.rotating, *shown.moving)
        self._poses = {name: bones[name].matrix_basis.copy() for name in names}
        for (bone, prop), value in self._switches.items():
            if bone in bones and prop in bones[bone]:
                self._old_switches[bone, prop] = bones[bone][prop]
                bones[bone][prop] = value


def _pose(bone: bpy.types.PoseBone, channels: BoneKeys) -> None:
    location, rotation, scale = bone.matrix_basis.decompose()
    if channels.rotations is not None:
        rotation = Quaternion(channels.rotations[0])
    if channels.locations is not None:
        location = channels.locations[0]
    bone.matrix_basis = Matrix.LocRotScale(location, rotation, scale)
