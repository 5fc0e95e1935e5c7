"""Say when a camera's numbers can hardly be those of its pictures."""

import numpy as np

from .camera import Camera

NARROW, WIDE = np.radians(15.0), np.radians(150.0)
"""Angles of view, across the longer side, between which those of depth cameras lie."""
OFF_MIDDLE = 0.2
"""Of the picture's width or height, how far from the middle an axis hardly ever is."""
UNEQUAL = 1.25
"""Ratio of focal lengths from which pixels would be far from square."""


def camera_doubts(camera: Camera) -> tuple[str, ...]:
    """Return what is odd about a camera, in sentences; nothing for a usual one.

    Numbers for pictures of another size, such as those of the full picture for one of half the
    size, put the axis into a corner. What is not so wrong shows in the size of the actor.
    """
    doubts = []
    angle = 2.0 * np.arctan(max(camera.width / camera.fx, camera.height / camera.fy) / 2.0)
    if not NARROW <= angle <= WIDE:
        doubts.append(
            f"The camera would see an angle of {np.degrees(angle):.0f} degrees: check its focal"
            " length, in pixels."
        )
    across = (camera.cx + 0.5) / camera.width - 0.5
    down = (camera.cy + 0.5) / camera.height - 0.5
    if max(abs(across), abs(down)) > OFF_MIDDLE:
        doubts.append(
            f"The camera's axis would meet pixel {camera.cx:.0f}, {camera.cy:.0f} of"
            f" {camera.width} x {camera.height}: are its numbers for pictures of another size?"
        )
    if not 1.0 / UNEQUAL <= camera.fx / camera.fy <= UNEQUAL:
        doubts.append(
            f"The camera's focal lengths are {camera.fx:.0f} across and {camera.fy:.0f} up:"
            " check both."
        )
    return tuple(doubts)
