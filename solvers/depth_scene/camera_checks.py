"""Say when a camera's numbers can hardly be those of its pictures."""

import numpy as np

from .camera import Camera

SQUARE = 0.06
"""Share by which the focal lengths of a real camera may differ: pixels are square."""
MIDDLE = 0.2
"""Share of the picture's size by which the optical axis may miss its middle."""
USUAL_VIEW = (38.0, 130.0)
"""Degrees along the longer side: Kinects see 57 and 70, Azure Kinects 65 to 120."""


def field_of_view(camera: Camera) -> float:
    """Return how much of the scene the longer side of the picture shows, degrees."""
    sides = (camera.width, camera.cx, camera.fx), (camera.height, camera.cy, camera.fy)
    n_pixels, centre, focal = max(sides, key=lambda side: side[0])
    before, after = (
        np.arctan((centre + 0.5) / focal),
        np.arctan((n_pixels - 0.5 - centre) / focal),
    )
    return float(np.degrees(before + after))


def check_intrinsics(camera: Camera) -> tuple[str, ...]:
    """Return a sentence for each thing in which a camera differs from those that there are.

    Numbers for pictures of another size, such as those of the full picture for one of half the
    size, show in the axis and in the field of view. What is not so wrong shows in the size of
    the actor.
    """
    doubts = []
    if abs(np.log(camera.fx / camera.fy)) > SQUARE:
        doubts.append(
            f"The focal lengths {camera.fx:g} and {camera.fy:g} differ, though pixels usually"
            " are square: check fx and fy."
        )
    aside = abs(camera.cx - (camera.width - 1) / 2.0) / camera.width
    above = abs(camera.cy - (camera.height - 1) / 2.0) / camera.height
    if max(aside, above) > MIDDLE:
        doubts.append(
            f"The optical axis at {camera.cx:g}, {camera.cy:g} is far from the middle of"
            f" pictures of {camera.width} x {camera.height} pixels: check cx and cy."
        )
    seen = field_of_view(camera)
    if not USUAL_VIEW[0] <= seen <= USUAL_VIEW[1]:
        doubts.append(
            f"The pictures would show {seen:.0f} degrees of the scene, which few depth cameras"
            f" do: check that the focal length {camera.fx:g} is that of pictures of"
            f" {camera.width} x {camera.height} pixels."
        )
    return tuple(doubts)
