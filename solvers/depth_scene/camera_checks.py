"""Check whether camera intrinsics are plausible for the recorded images."""

import numpy as np

from .camera import Camera

MAX_LOG_ASPECT = 0.06
"""Maximum relative difference of the focal lengths: pixels of real cameras are square. It
guards against a wrong calibration (`test_check_intrinsics_warns_about_another_image_size`)."""
MAX_CENTER_OFFSET = 0.2
"""Maximum distance from principal point to image center, as a fraction of the image size. It
guards against a wrong calibration (`test_check_intrinsics_warns_about_another_image_size`)."""
FIELD_OF_VIEW_RANGE_DEG = (38.0, 130.0)
"""Along the longer side: Kinects see 57 and 70, Azure Kinects 65 to 120. It guards against a
wrong calibration (`test_check_intrinsics_warns_about_another_image_size`)."""


def field_of_view(camera: Camera) -> float:
    """Return the field of view along the longer side of the image, degrees."""
    sides = (camera.width, camera.cx, camera.fx), (camera.height, camera.cy, camera.fy)
    n_pixels, center, focal = max(sides, key=lambda side: side[0])
    before, after = (
        np.arctan((center + 0.5) / focal),
        np.arctan((n_pixels - 0.5 - center) / focal),
    )
    return float(np.degrees(before + after))


def check_intrinsics(camera: Camera) -> tuple[str, ...]:
    """Return one warning for each implausible intrinsic parameter.

    Intrinsics of another image size, such as the full size for an image of half the size,
    give an implausible principal point and field of view. Smaller errors show in the height
    of the actor.
    """
    warnings = []
    if abs(np.log(camera.fx / camera.fy)) > MAX_LOG_ASPECT:
        warnings.append(
            f"The focal lengths {camera.fx:g} and {camera.fy:g} differ, but pixels are usually"
            " square: check fx and fy."
        )
    offset_x = abs(camera.cx - (camera.width - 1) / 2.0) / camera.width
    offset_y = abs(camera.cy - (camera.height - 1) / 2.0) / camera.height
    if max(offset_x, offset_y) > MAX_CENTER_OFFSET:
        warnings.append(
            f"The optical axis at {camera.cx:g}, {camera.cy:g} is far from the center of"
            f" images of {camera.width} x {camera.height} pixels: check cx and cy."
        )
    view = field_of_view(camera)
    if not FIELD_OF_VIEW_RANGE_DEG[0] <= view <= FIELD_OF_VIEW_RANGE_DEG[1]:
        warnings.append(
            f"The field of view would be {view:.0f} degrees, which few depth cameras have:"
            f" check that the focal length {camera.fx:g} belongs to images of"
            f" {camera.width} x {camera.height} pixels."
        )
    return tuple(warnings)
