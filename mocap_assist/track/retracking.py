"""What the button Track from Here reads from the scene, and what it writes back."""

from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.depth_tracking import Retracked, RetrackSettings
from ...solvers.depth_tracking.body import JOINTS, SEGMENTS, scene_from_camera
from ...solvers.errors import InvalidMotionError, MocapAssistError
from ..actions.armature_write import Output, check_writable, put_to_use, write_take
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps
from ..depth.depth_preview import open_recording
from ..jobs.protocol import PreviewSolve
from ..runtime.selection import played_source, selected_armature
from ..runtime.subject import Subject, check_unchanged
from ..scene import history
from .hand_pose import HandPose
from .live_body import LiveBody, Stage
from .low_confidence import list_doubts
from .solve_retracking import Correction, Played, retrack_recording
from .solve_tracking import Doubt, doubts_of, mean_cm
from .tracked_body import TrackedBody, armature_from_motion, is_tracked
from .tracked_checks import check_in_time
from .tracked_curves import mend_trust, write_residual
from .tracked_take import TrackedTake, read_tracked_take
from .tracking import WatchChoices

Array = NDArray[np.float64]

OPERATION = "retrack"
SUFFIX = ".retracked"
DIGITS = 2
SIDES = ("before", "after")
EXTREME, KEYFRAME = 1, 0
"""Blender's types of keys: what the animator posed, and the rest."""


class RetrackBundle(NamedTuple):
    """All that the button offers."""

    retracking: RetrackSettings
    watching: WatchChoices = WatchChoices()


def why_not_retrack(context: bpy.types.Context) -> str:
    """Return why nothing can be tracked again, or nothing."""
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
    """Read what an armature plays and how it is posed; return what is to be solved."""
    check_writable(armature)
    here = Subject.of(scene, armature)
    check_in_time(armature, played_source(armature))
    take, played = yield from _played(armature)
    scene, armature = here.find()
    source = played_source(armature)
    place = (scene.frame_current_final - take.frames[0]) / take.tracked.shown.step
    frame = round(place)
    if not 0 <= frame < len(take.frames):
        raise InvalidMotionError(
            f"Frame {scene.frame_current_final:g} is not in the recording. Go to one from"
            f" {take.frames[0]:.2f} to {take.frames[-1]:.2f}, and pose {armature.name} there."
        )
    correction = Correction(frame, take.pose(armature), _fixed(source, take, frame))
    return PreviewSolve(retrack_recording, played, correction, settings.retracking)


def watch_retracking(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: RetrackBundle
) -> "_View | None":
    """Return what shows the body while it is tracked again, if that is wanted."""
    return _View(scene, armature) if settings.watching.watch else None


class _View(LiveBody):
    """Shows the body; then the armature is posed as by the animator again."""

    def __init__(self, scene: bpy.types.Scene, armature: bpy.types.Object) -> None:
        super().__init__(scene, _stage_of)
        self._pose = HandPose(armature)

    def close(self) -> None:
        """Go back to the frame of before, and to the pose of the armature there."""
        super().close()
        self._pose.restore()


def _stage_of(armature: bpy.types.Object) -> Stage:
    tracked = TrackedBody.read(armature)
    armature_from_camera = armature_from_motion(armature, tracked.body) @ scene_from_camera(
        tracked.floor
    )
    return Stage(np.array(armature.matrix_world) @ armature_from_camera, tracked.shown)


@Sliced
def write_retracked(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: RetrackBundle,
    result: Retracked,
    asked: str | None = None,
) -> Steps[str]:
    """Write the result as a new action and put it to use; return a sentence about it.

    Raises InvalidMotionError if the armature plays something else than what was `asked`.
    """
    here = Subject.of(scene, armature)
    take, played = yield from _played(armature)
    scene, armature = here.find()
    source = played_source(armature)
    check_unchanged(armature, asked, played)
    rows = slice(result.first, result.last + 1)
    new = take.with_motion(result.motion, result.first, result.last)
    names = [take.bones[name] for name in SEGMENTS]
    types = np.full(len(new.frames), KEYFRAME, np.uint8)
    types[result.frame - result.first] = EXTREME
    made = write_take(armature, source, new, names, dict.fromkeys(names, types), suffix=SUFFIX)
    write_residual(armature, made, new.frames, result.residual)
    trusted = mend_trust(armature, made, take.frames, rows, _trust_of(take, result))
    said = _said(take, result)
    list_doubts(scene, made[0], take.frames, _doubts(scene, trusted), said)
    history.record(made[0], source, _entry(settings, take, result))
    put_to_use(armature, *made, Output.ACTION)
    return f"{made[0].name}: {said}"


def _played(armature: bpy.types.Object) -> Steps[tuple[TrackedTake, Played]]:
    """Return what an armature plays, and that with all that tracking needs."""
    tracked = TrackedBody.read(armature)
    recording = open_recording(tracked.shown)
    take = yield from read_tracked_take.steps(
        armature, played_source(armature), recording.n_frames, recording.frame_rate
    )
    return take, Played(
        recording, tracked.actor, tracked.body, tracked.floor, take.first, take.motion
    )


def _fixed(source: Source, take: TrackedTake, frame: int) -> tuple[int, ...]:
    """Return the other frames that were corrected before."""
    pictures = [
        int(entry["picture"]) - take.first
        for entry in history.history(source[0])
        if entry.get("operation") == OPERATION and "picture" in entry
    ]
    inside = {place for place in pictures if 0 <= place < len(take.frames)}
    return tuple(sorted(inside - {frame}))


def _trust_of(take: TrackedTake, result: Retracked) -> dict[str, Array]:
    """Return how far the joint of each bone is trusted in the frames that were changed."""
    told = result.joints.confidence
    columns = () if told is None else zip(JOINTS, told.T, strict=True)
    return {take.bones[joint]: values for joint, values in columns if joint in take.bones}


def _doubts(scene: bpy.types.Scene, trusted: dict[str, Array]) -> tuple[Doubt, ...]:
    if not trusted:
        return ()
    flags = np.stack(list(trusted.values()), axis=1) < scene.mocap_assist.track.doubtful
    return doubts_of(tuple(trusted), flags)


def _said(take: TrackedTake, result: Retracked) -> str:
    rows = [result.first, result.frame, result.last]
    first, frame, last = np.round(take.frames[rows], DIGITS)
    said = f"re-tracked frames {first:g} to {last:g} from frame {frame:g}."
    open_ends = [side for side, met in zip(SIDES, result.met, strict=True) if not met]
    if not open_ends:
        return f"{said} It joins the old motion on both sides."
    return (
        f"{said} {' and '.join(open_ends).capitalize()} it the new motion does not join the old"
        " one: the take or the reach ends, or the old motion fits better."
    )


def _entry(settings: RetrackBundle, take: TrackedTake, result: Retracked) -> dict[str, object]:
    return {
        "operation": OPERATION,
        "settings": history.plain(settings.retracking),
        "picture": take.first + result.frame,
        "first_picture": take.first + result.first,
        "last_picture": take.first + result.last,
        "mean_residual_cm": mean_cm(result.residual),
    }
