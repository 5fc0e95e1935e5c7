"""Measure the actor in the first images of a recording."""

from collections.abc import Sequence

from ...depth_scene import (
    Actor,
    Camera,
    DepthImage,
    DepthRecording,
    ForegroundSettings,
    find_actor,
)
from ...depth_tracking.body import BodyModel
from ...depth_tracking.capturing import find_body
from ...depth_tracking.forest import load_pixel_forest
from ...progress import Progress, unwatched, within

ACTOR_FRACTION = 0.2
"""Fraction of the progress of the measurement for the separation of actor and room."""


def measure_followed(
    images: Sequence[DepthImage],
    camera: Camera,
    frame_rate: float,
    body: BodyModel | None = None,
    *,
    empty: Sequence[int] = (),
    foreground: ForegroundSettings,
    refine: bool = True,
    progress: Progress = unwatched,
) -> tuple[Actor, BodyModel]:
    """Separate the actor from the room, and fit a body, in the first images.

    Parameters
    ----------
    images : sequence of DepthImage
    camera : Camera
        Of these images.
    frame_rate : float, hertz
    body : BodyModel, optional
        By default it is fitted to the images.
    empty : sequence of int
        Indices of images of the empty room.
    foreground : ForegroundSettings
    refine : bool
        Whether lengths and radii are fitted, next to the stature.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        No person is visible.
    """
    recording = DepthRecording(camera, len(images), frame_rate, images.__getitem__)
    fraction = ACTOR_FRACTION if body is None else 1.0
    actor = find_actor(
        recording, foreground, empty=empty, progress=within(progress, 0.0, fraction)
    )
    if body is None:
        body = find_body(
            actor.recording, load_pixel_forest(), refine=refine,
            progress=within(progress, fraction, 1.0),
        )  # fmt: skip
    return actor, body
