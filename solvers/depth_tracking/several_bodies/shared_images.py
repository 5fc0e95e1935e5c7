"""Share the pixels of each depth image between the bodies, by their nearest surfaces."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ...arrays import Array, Integers
from ...depth_scene import (
    NO_OWNER,
    DepthImage,
    DepthRecording,
    enlarged,
    label_components,
    level_distances,
    share_pixels,
)
from ..body import BodyModel
from ..terms import subsampling_step
from .surface_distances import surface_distances

REACH_M = 0.5
"""Distance from a body, meters, beyond which a component of the image is no part of it. It
guards people who enter (`test_what_is_far_from_all_bodies_has_no_owner`)."""


@dataclass(frozen=True, eq=False)
class SharedImages:
    """The depth images of several people.

    Attributes
    ----------
    recording : DepthRecording
        Contains only the people.
    bodies : tuple of BodyModel
    centers : shape (n_people, n_frames, 3), meters
        Position of each person; NaN while absent.
    up : shape (3,)
        Unit vector against gravity.
    image_width : int
        Columns of the subsampled image in which pixels are shared.
    """

    recording: DepthRecording
    bodies: tuple[BodyModel, ...]
    centers: Array
    up: Array
    image_width: int

    def owners(self, frame: int, poses: Sequence[Array | None]) -> Integers:
        """Return the person of each pixel of a frame, (height, width); `NO_OWNER` for none.

        A pixel belongs to the nearest surface.

        Parameters
        ----------
        frame : int
        poses : sequence of shape (36,) arrays, or None
            Pose of each person. Without one, the horizontal distance from the center counts.
        """
        step = subsampling_step(self.recording.camera, self.image_width)
        camera = self.recording.camera.every(step)
        depth = self.recording.frame(frame)
        coarse = depth[::step, ::step].astype(np.float64)
        components, _ = label_components(coarse, camera)
        seen = coarse > 0.0
        points = camera.back_project(coarse)[seen]
        distances = np.full((len(points), len(self.bodies)), np.inf)
        for person, (body, pose) in enumerate(zip(self.bodies, poses, strict=True)):
            if pose is not None:
                distances[:, person] = surface_distances(body, pose, points)
            else:
                center = self.centers[person, frame][np.newaxis]
                distances[:, person] = level_distances(points, center, self.up)[:, 0]
        owners = np.full(coarse.shape, NO_OWNER)
        owners[seen] = share_pixels(distances, components[seen] - 1, REACH_M)
        return enlarged(owners, step, depth.shape)

    def recording_of(self, person: int, owners: Callable[[int], Integers]) -> DepthRecording:
        """Return the recording of one person, with the others as occluders.

        Parameters
        ----------
        person : int
        owners : callable
            Maps a frame to the person of each pixel, as returned by `owners`.
        """

        def depth(frame: int) -> DepthImage:
            own = owners(frame) == person
            return np.where(own, self.recording.frame(frame), np.float32(0.0))

        def occluders(frame: int) -> DepthImage:
            own = owners(frame) == person
            return np.where(own, np.float32(0.0), self.recording.frame(frame))

        return replace(self.recording, read_depth=depth, read_occluders=occluders)

    def recordings_of_poses(self, poses: Array) -> tuple[DepthRecording, ...]:
        """Return the recording of each person, given all poses (n_people, n_frames, 36)."""
        present = np.isfinite(self.centers).all(axis=-1)

        @lru_cache(maxsize=1)
        def owners(frame: int) -> Integers:
            people = zip(poses[:, frame], present[:, frame], strict=True)
            return self.owners(frame, [pose if here else None for pose, here in people])

        return tuple(self.recording_of(person, owners) for person in range(len(self.bodies)))
