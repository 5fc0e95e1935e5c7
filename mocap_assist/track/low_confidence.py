"""Low-confidence ranges of a tracked motion in the list of Check."""

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from .solve_tracking import LowConfidenceRange

MAX_LISTED = 100


def list_low_confidence(
    scene: bpy.types.Scene,
    action: bpy.types.Action,
    frames: NDArray[np.float64],
    ranges: Sequence[LowConfidenceRange],
    report: str,
) -> None:
    """Show the low-confidence ranges of an action in the list, worst first.

    `frames` are the scene frames of the motion; `report` is shown above the list.
    """
    shown = scene.mocap_assist
    shown.issues.clear()
    shown.active_issue = 0
    shown.checked_action, shown.report = action, report
    for interval in ranges[:MAX_LISTED]:
        item = shown.issues.add()
        item.name, item.kind = interval.joint, "low confidence"
        item.start, item.stop = np.round(frames[[interval.first, interval.last]], 2)
        item.severity = float(interval.last - interval.first + 1)
        item.sentence = f"{interval.joint} is hidden or fits poorly; its pose is estimated."
