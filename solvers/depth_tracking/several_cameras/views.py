"""One body before several cameras: their images in one frame, and hypotheses in each."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...arrays import Array
from ...depth_scene import DepthRecording
from ...rotations import skew_matrices
from ..body import BodyModel, cast_rays, segment_frames, segment_twists
from ..terms import Hypothesis, Observation, observe
from .align_tracks import CameraAlignment


@dataclass(frozen=True, eq=False)
class View:
    """The image of one camera.

    Attributes
    ----------
    observation : Observation
    camera_from_first : shape (4, 4)
        Transform from the frame of the first camera, in which poses are expressed.
    displacement : shape (36,)
        Change of the pose from the time of the frame to the time of this image.
    """

    observation: Observation
    camera_from_first: Array
    displacement: Array

    def every(self, step: int) -> "View":
        """Return the view with every `step`-th column and row."""
        return View(self.observation.every(step), self.camera_from_first, self.displacement)


@dataclass(frozen=True, eq=False)
class ViewHypothesis(Hypothesis):
    """A pose under test, as one camera shows it.

    `pose` is in the frame of the first camera and at the time of the frame; `frames`, `image`
    and the twists are in the frame of this camera, at the time of its image. So the normal
    equations of all cameras have the same coordinates, and their sum is one body's.

    Attributes
    ----------
    camera_from_first : shape (4, 4)
    first_frames : shape (17, 4, 4)
        The segment transforms in the frame of the first camera.
    displacement : shape (36,)
    """

    camera_from_first: Array
    first_frames: Array
    displacement: Array

    @cached_property
    def twists(self) -> Array:
        """Twist of each segment per unit of each coordinate, shape (17, 6, 36)."""
        twists = segment_twists(self.pose + self.displacement, self.first_frames)
        return adjoint(self.camera_from_first) @ twists


def adjoint(transform: Array) -> Array:
    """Return the matrix (6, 6) that expresses twists in another frame.

    A twist moves a point p by w x p + v. With q = R p + t, the same movement R (w x p + v) is
    (R w) x q + R v + t x (R w).
    """
    rotation = transform[:3, :3]
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = matrix[3:, 3:] = rotation
    matrix[3:, :3] = skew_matrices(transform[:3, 3]) @ rotation
    return matrix


def render_view(body: BodyModel, pose: Array, view: View) -> ViewHypothesis:
    """Render `body` in `pose` (36,) as the camera of a view shows it."""
    first_frames = segment_frames(body, pose + view.displacement)
    frames = view.camera_from_first @ first_frames
    image = cast_rays(body, frames, view.observation.camera)
    return ViewHypothesis(
        body, pose, frames, image, view.camera_from_first, first_frames, view.displacement
    )


@dataclass(frozen=True, eq=False)
class CameraTake:
    """The recording of one of several cameras.

    Attributes
    ----------
    depth : DepthRecording
        Contains only the actor.
    alignment : CameraAlignment
        Relative to the first camera.
    """

    depth: DepthRecording
    alignment: CameraAlignment

    def image_at(self, time: float) -> int | None:
        """Return the frame nearest to a time of the first camera, or None outside the take."""
        frame = round((time - self.alignment.offset) * self.depth.frame_rate)
        return frame if 0 <= frame < self.depth.n_frames else None

    def time_of(self, frame: int) -> float:
        """Return the time of a frame, in seconds of the first camera."""
        return frame / self.depth.frame_rate + self.alignment.offset


def views_at(
    cameras: Sequence[CameraTake], time: float, velocity: Array, image_width: int
) -> list[View]:
    """Return the images that show the actor nearest to a time.

    Parameters
    ----------
    cameras : sequence of CameraTake
    time : float, seconds
        Of the first camera.
    velocity : shape (36,)
        Change of the pose per second: images of other cameras are up to half a frame earlier
        or later.
    image_width : int
        Columns of the subsampled images.
    """
    views = []
    for camera in cameras:
        frame = camera.image_at(time)
        if frame is None:
            continue
        observation = observe(camera.depth, frame, image_width)
        if not observation.empty:
            lag = camera.time_of(frame) - time
            views.append(View(observation, camera.alignment.camera_from_first, lag * velocity))
    return views
