"""Draw the result of a command as stick figures."""

from pathlib import Path

import bpy

from ...solvers.errors import MocapAssistError
from ...solvers.motion import Motion, Tracks
from ...solvers.pictures import StickFigureSettings, draw_stick_figures
from ..actions.armature_read import read_take
from ..actions.markers.take import read_markers
from ..runtime.selection import played_source
from ..scene import history

SIZE = StickFigureSettings(n_figures=9, height=150)


def draw_result(scene: bpy.types.Scene, subject: bpy.types.Object, path: Path) -> None:
    """Draw the motion of an armature or markers, over its raw motion if known.

    A failed drawing leaves no picture, and is not an error.
    """
    try:
        figures = {"result": _played_motion(scene, subject)}
        if subject.type == "ARMATURE" and (raw := history.raw_of(played_source(subject)[0])):
            given = read_take(subject, scene, source=raw).parts[0].motion
            if given.n_frames == figures["result"].n_frames:
                figures = {"given": given, **figures}
        # Without the folders above: a batch's output folder that vanished stays away.
        path.parent.mkdir(exist_ok=True)
        draw_stick_figures(figures, SIZE).save(path)
    except (MocapAssistError, OSError):
        path.unlink(missing_ok=True)


def _played_motion(scene: bpy.types.Scene, subject: bpy.types.Object) -> Motion | Tracks:
    if subject.type == "ARMATURE":
        return read_take(subject, scene, source=played_source(subject)).parts[0].motion
    return read_markers(subject, scene).tracks
