"""Doubtful ranges of what was tracked, in the list of Check."""

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from .solve_tracking import Doubt

MOST_SPOTS = 100


def list_doubts(
    scene: bpy.types.Scene,
    action: bpy.types.Action,
    frames: NDArray[np.float64],
    doubts: Sequence[Doubt],
    report: str,
) -> None:
    """Show the doubtful ranges of an action in the list, worst first.

    `frames` are those of the scene, for each frame of the motion; `report` is shown above.
    """
    shown = scene.mocap_assist
    shown.spots.clear()
    shown.active_spot = 0
    shown.checked, shown.report = action.name, report
    for doubt in doubts[:MOST_SPOTS]:
        item = shown.spots.add()
        item.name, item.kind = doubt.joint, "doubtful"
        item.start, item.stop = np.round(frames[[doubt.first, doubt.last]], 2)
        item.severity = float(doubt.last - doubt.first + 1)
        item.sentence = (
            f"{doubt.joint} is hidden or fits badly from frame {item.start:g} to"
            f" {item.stop:g}; its pose is estimated."
        )
