"""Collect remarks on a capture for the animator."""

import numpy as np

from ...depth_scene import Actor
from ...depth_tracking.body import default_body
from ...depth_tracking.capturing import Capture

MAX_OCCLUDED_FRACTION = 0.2
"""Fraction of occluded joints above which the report mentions them. Chosen by hand: 3 of 17
joints on average; it decides a sentence of the report only."""
MIN_OVERLAP, MAX_DEPTH_OFFSET_M = 0.55, 0.035
"""Minimum fraction of pixels covered by both body and actor, and maximum distance between them
in depth, for a good fit. Measured: typical values are 0.8 and 0.02 m. They decide a sentence of
the report only."""
MAX_THICKNESS_RATIO = 1.3
"""Maximum thickness of a body for its length, relative to the default body. A wrong focal
length changes how long and wide a body appears, but not how deep. Chosen by hand, see
`test_very_thick_body_is_reported_as_a_possible_wrong_focal_length`."""


def capture_remarks(
    actor: Actor, captured: Capture, *, fitted: bool, live: bool = False
) -> tuple[str, ...]:
    """Return sentences on the actor and on the quality of the tracking.

    Parameters
    ----------
    actor : Actor
        Its remarks come first.
    captured : Capture
    fitted : bool
        Whether the body was fitted to the recording rather than given.
    live : bool
        Whether each frame was tracked without those after it. Then frames of confidence 0,
        most of which had no image, are not counted.
    """
    remarks = [*actor.remarks]
    if actor.floor is None:
        remarks.append("No floor is visible, so the camera is assumed to be level.")
    confidence = captured.joints.confidence
    counted = np.ones(len(captured.residual), dtype=bool) if live else actor.visible
    if live and confidence is not None and confidence.any():
        counted = confidence.any(axis=1)
    occluded = float(captured.low_confidence[counted].mean())
    if occluded > MAX_OCCLUDED_FRACTION:
        remarks.append(
            f"{100 * occluded:.0f} % of the joints were occluded or fitted poorly; they are"
            " estimated from the frames before."
            if live
            else f"{100 * occluded:.0f} % of the joints were occluded or fitted poorly; they"
            " are estimated from the frames before and after."
        )
    has_pose = np.isfinite(captured.residual)
    tracked = has_pose[counted]
    if actor.visible.all() and not tracked.all():
        remarks.append(
            f"In {int((~tracked).sum())} of {len(tracked)} frames no person is detected."
        )
    ratio = relative_thickness(captured)
    if fitted and ratio > MAX_THICKNESS_RATIO:
        remarks.append(
            f"The actor would be {ratio:.1f} times as thick as the default body. Check the"
            " focal length of the camera, the scale, and whether the actor carries something."
        )
    elif actor.feet_visible and has_pose.any():
        remarks += _fit_remarks(
            float(np.median(captured.coverage[has_pose])),
            np.median(captured.residual[has_pose]),
        )
    return tuple(remarks)


def _fit_remarks(overlap: float, offset: float) -> list[str]:
    if overlap >= MIN_OVERLAP and offset <= MAX_DEPTH_OFFSET_M:
        return []
    return [
        f"Body and depth images match poorly ({100 * overlap:.0f} % overlap, {100 * offset:.1f}"
        " cm distance in depth). Check the focal length, the scale, and whether the images"
        " show anything but the actor."
    ]


def relative_thickness(captured: Capture) -> float:
    """Return the thickness of the body for its length, relative to the default body."""
    default = default_body()
    radii = np.median(captured.body.radii / default.radii)
    return float(radii / np.median(captured.body.lengths / default.lengths))
