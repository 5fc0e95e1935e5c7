"""Track from Here: read the scene and write the result."""

from collections.abc import Sequence
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.depth_tracking import Retracked, RetrackSettings
from ...solvers.depth_tracking.body import JOINTS, SEGMENTS, scene_from_camera
from ...solvers.errors import InvalidMotionError, MocapAssistError
from ..actions.armature_write import Output, assign_result, check_writable, write_take
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps
from ..depth.depth_preview import open_recording
from ..jobs.protocol import PreviewSolve
from ..runtime.played import Played
from ..runtime.selection import played_source, selected_armature, timeline_frames
from ..runtime.subject import Subject, check_unchanged
from ..scene import history
from ..scene.played_time import played_time
from .hand_pose import HandPose
from .live_body import BodyDisplay, LiveBody
from .low_confidence import list_low_confidence
from .solve_retracking import Correction, TrackedActor, retrack_recording
from .solve_tracking import LowConfidenceRange, low_confidence_ranges, mean_cm
from .tracked_armature.body import TrackedBody, armature_from_motion, is_tracked
from .tracked_armature.checks import check_in_time
from .tracked_armature.curves import update_reliability, write_residual
from .tracked_armature.take import TrackedTake, read_tracked_take
from .tracking import WatchChoices

OPERATION = "retrack"
SUFFIX = ".retracked"
DIGITS = 2
"""Number of decimals of a frame in a message. It bounds the length of the message."""
ENDS = ("before", "after")
EXTREME, KEYFRAME = 1, 0
"""Blender's key types: for the corrected frame, and for the others."""


class RetrackBundle(NamedTuple):
    """Settings of the button."""

    retracking: RetrackSettings
    watching: WatchChoices = WatchChoices()


def why_not_retrack(context: bpy.types.Context) -> str:
    """Return why the selection cannot be re-tracked, or an empty text."""
    armature = selected_armature(context)
    if not is_tracked(armature):
        return "Select a tracked armature and correct its pose at a wrong frame."
    try:
        check_writable(armature)
        check_in_time(armature, played_source(armature))
    except MocapAssistError as error:
        return str(error)
    return ""


@Sliced
def read_retracking(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: RetrackBundle
) -> Steps[PreviewSolve[Retracked]]:
    """Read the action and current pose of an armature; return the solve."""
    check_writable(armature)
    here = Subject.of(scene, armature)
    check_in_time(armature, played_source(armature))
    take, played = yield from _read_played_take(armature)
    scene, armature = here.find()
    source = played_source(armature)
    time = played_time(armature, scene.frame_current_final)
    now = time.action_frame(scene.frame_current_final)
    frame = round((now - take.frames[0]) / take.tracked.shown.step)
    if not 0 <= frame < len(take.frames):
        first, last = time.scene_range(take.frames[0], take.frames[-1])
        raise InvalidMotionError(
            f"Frame {scene.frame_current_final:g} is not in the recording. Go to one from"
            f" {first:.2f} to {last:.2f}, and pose {armature.name} there."
        )
    correction = Correction(
        frame, take.pose(armature), _earlier_corrections(source, take, frame)
    )
    return PreviewSolve(retrack_recording, played, correction, settings.retracking)


def watch_retracking(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: RetrackBundle
) -> "_View | None":
    """Return the view of the body during re-tracking, if *Live Preview* is on."""
    return _View(scene, armature) if settings.watching.watch else None


class _View(LiveBody):
    """Shows the body, then restores the animator's pose of the armature."""

    def __init__(self, scene: bpy.types.Scene, armature: bpy.types.Object) -> None:
        super().__init__(scene, _stage_of)
        self._pose = HandPose(armature)

    def close(self) -> None:
        """Restore the frame, and the pose of the armature there."""
        super().close()
        self._pose.restore()


def _stage_of(armature: bpy.types.Object) -> BodyDisplay:
    tracked = TrackedBody.read(armature)
    armature_from_camera = armature_from_motion(armature, tracked.body) @ scene_from_camera(
        tracked.floor
    )
    return BodyDisplay(np.array(armature.matrix_world) @ armature_from_camera, tracked.shown)


@Sliced
def write_retracked(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: RetrackBundle,
    result: Retracked,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Write the result as a new action and assign it; return a message.

    Raises InvalidMotionError if the armature plays another motion than the one that was solved.
    """
    read = Played.of(scene, armature)
    take, problem = yield from _read_played_take(armature)
    yield from check_unchanged.steps(read.find()[1], solved_digest, problem)
    _, armature, source = read.find()
    rows = slice(result.first, result.last + 1)
    new = take.with_motion(result.motion, result.first, result.last)
    names = [take.bones[name] for name in SEGMENTS]
    types = np.full(len(new.frames), KEYFRAME, np.uint8)
    types[result.frame - result.first] = EXTREME
    source_new = yield from write_take.steps(
        armature, source, new, names, dict.fromkeys(names, types), suffix=SUFFIX
    )
    scene, armature, source = read.find()
    write_residual(armature, source_new, new.frames, result.residual)
    confidence = update_reliability(
        armature, source_new, take.frames, rows, _confidence_by_bone(take, result)
    )
    report = _report(timeline_frames(armature, take.frames), result)
    ranges = _find_low_confidence(scene, confidence)
    list_low_confidence(scene, source_new[0], take.frames, ranges, report)
    history.record(source_new[0], source, _entry(settings, take, result))
    assign_result(armature, *source_new, Output.ACTION)
    return f"{source_new[0].name}: {report}"


def _read_played_take(armature: bpy.types.Object) -> Steps[tuple[TrackedTake, TrackedActor]]:
    """Return the take of an armature, and the same with the data for tracking."""
    tracked = TrackedBody.read(armature)
    recording = open_recording(tracked.shown)
    take = yield from read_tracked_take.steps(
        armature, played_source(armature), recording.n_frames, recording.frame_rate
    )
    return take, TrackedActor(
        recording, tracked.actor, tracked.body, tracked.floor, take.first, take.motion,
        tracked.person,
    )  # fmt: skip


def _earlier_corrections(source: Source, take: TrackedTake, frame: int) -> tuple[int, ...]:
    """Return the other frames with earlier corrections."""
    image_indices = [
        int(entry["picture"]) - take.first
        for entry in history.history(source[0])
        if entry.get("operation") == OPERATION and "picture" in entry
    ]
    inside = {index for index in image_indices if 0 <= index < len(take.frames)}
    return tuple(sorted(inside - {frame}))


def _confidence_by_bone(take: TrackedTake, result: Retracked) -> dict[str, Array]:
    """Return the confidence of each bone's joint in the changed frames."""
    confidence = result.joints.confidence
    columns = () if confidence is None else zip(JOINTS, confidence.T, strict=True)
    return {take.bones[joint]: values for joint, values in columns if joint in take.bones}


def _find_low_confidence(
    scene: bpy.types.Scene, confidence: dict[str, Array]
) -> tuple[LowConfidenceRange, ...]:
    if not confidence:
        return ()
    flags = (
        np.stack(list(confidence.values()), axis=1) < scene.mocap_assist.track.low_confidence
    )
    return low_confidence_ranges(tuple(confidence), flags)


def _report(frames: Sequence[float], result: Retracked) -> str:
    rows = (result.first, result.frame, result.last)
    first, frame, last = (round(frames[row], DIGITS) for row in rows)
    message = f"re-tracked frames {first:g} to {last:g} from frame {frame:g}."
    open_ends = [side for side, met in zip(ENDS, result.met, strict=True) if not met]
    if not open_ends:
        return f"{message} It meets the old motion on both sides."
    where = "before and after" if len(open_ends) > 1 else open_ends[0]
    return (
        f"{message} The new motion does not meet the old one {where} this range: the take or"
        " the time range ends, or the old motion fits better."
    )


def _entry(settings: RetrackBundle, take: TrackedTake, result: Retracked) -> dict[str, object]:
    return {
        "operation": OPERATION,
        "settings": history.json_ready(settings.retracking),
        "picture": take.first + result.frame,
        "first_picture": take.first + result.first,
        "last_picture": take.first + result.last,
        "mean_residual_cm": mean_cm(result.residual),
    }
