"""Identify the origin of a take by its content."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import DepthRecording
from ...markers import find_marker_set
from ...motion import JointRecording, Motion, Sensor, Tracks
from ...motion.humanoid import naming_scheme

VIDEO_SCHEMES = {"SMPL", "SMPL in robotics", "SOMA", "MHR"}
"""Names of joints that video models write."""


class TakeOrigin(Enum):
    """Origin of a take, as its content shows."""

    SKELETON = "suit or file of a skeleton"
    VIDEO = "video model"
    CAMERA = "joints of a depth camera"
    DEPTH = "depth images"
    MARKERS = "optical markers"
    POINTS = "points without a known marker set"


@dataclass(frozen=True, eq=False)
class MotionFromJoints:
    """A motion that was solved from the joints of a depth camera.

    Attributes are those of `reconstruct_motion`.
    """

    motion: Motion
    source: JointRecording | None = None
    tracking_state: NDArray[np.int8] | None = None
    sensor: Sensor = Sensor.OTHER
    resize: bool = False


Take = Motion | Tracks | JointRecording | MotionFromJoints | DepthRecording


def find_origin(take: Take) -> TakeOrigin:
    """Identify the origin of a take by its kind and the names of its joints or markers.

    Markers that are named but never observed do not count.
    """
    match take:
        case JointRecording() | MotionFromJoints():
            return TakeOrigin.CAMERA
        case DepthRecording():
            return TakeOrigin.DEPTH
        case Motion():
            is_video = naming_scheme(take.skeleton.names) in VIDEO_SCHEMES
            return TakeOrigin.VIDEO if is_video else TakeOrigin.SKELETON
        case Tracks():
            observed = take.visible.any(axis=0)
            names = [
                name
                for name, is_observed in zip(take.names, observed, strict=True)
                if is_observed
            ]
            missing = find_marker_set(names).missing_landmarks()
            return TakeOrigin.POINTS if missing else TakeOrigin.MARKERS
