"""Draw the result of a command as stick figures."""

from pathlib import Path

import bpy

from ...solvers.command_line.batches import Screen
from ...solvers.errors import MocapAssistError
from ...solvers.files import unwritable_error
from ...solvers.pictures import StickFigureSettings, draw_stick_figures
from ..actions.armature_read import read_take
from ..check.scene_checking import read_played
from ..runtime.selection import played_source
from ..scene import history

SIZE = StickFigureSettings(n_figures=9, height=150)


def draw_result(
    scene: bpy.types.Scene, subject: bpy.types.Object, path: Path, screen: Screen
) -> None:
    """Draw the motion of an armature or markers, over its raw motion if known.

    A failed drawing is reported on `screen`, is not an error, and keeps an existing file.
    """
    try:
        figures = {"result": read_played(scene, subject).recordings[0]}
        if subject.type == "ARMATURE" and (raw := history.raw_of(played_source(subject)[0])):
            given = read_take(subject, scene, source=raw).parts[0].motion
            if given.n_frames == figures["result"].n_frames:
                figures = {"given": given, **figures}
        # Without the folders above: a batch's output folder that vanished stays away.
        path.parent.mkdir(exist_ok=True)
        draw_stick_figures(figures, SIZE).save(path)
    except MocapAssistError as error:
        screen.write_line(str(error))
    except OSError as error:
        screen.write_line(str(unwritable_error(path, error)))
