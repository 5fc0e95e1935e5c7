"""Takes of a Kinect that ask for clips of an optical library."""

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from scipy.io import loadmat
from scipy.ndimage import gaussian_filter1d

from solvers.motion import Tracks
from solvers.motion.humanoid.posture_heading import mirror_postures
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS
from solvers.retrieval.published.observed_signals import observed_signals

from ..shared import clips
from .retrieval_clips import LabeledClip, sensor_tracks

SMOOTHING_S = 0.15
"""Seconds."""
STILL_SPEED_FRACTION = 0.25
"""Fraction of the maximum speed of all joints together below which a take stands still."""
FRAME_RATE = 30.0
OF_UTD = (
    "head", "chest", "spine", "hips",
    "leftUpperArm", "leftLowerArm", "leftHand", "leftHandEnd",
    "rightUpperArm", "rightLowerArm", "rightHand", "rightHandEnd",
    "leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes",
    "rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToes",
)  # fmt: skip
"""Joints of UTD-MHAD, by what postures call them."""


@dataclass(frozen=True)
class QuerySet:
    """Takes that should find clips of one class."""

    name: str
    label: str
    files: str
    mirror: bool = False


SETS = (
    QuerySet("squat (UI-PRMD, v2)", "squat1Reps", "kinect/ui_prmd/m01_s*_e0[258].npz"),
    QuerySet("squat (UTD, v1)", "squat1Reps", "depth/utd_mhad/a27_*_skeleton.mat"),
    QuerySet("basketball (UTD)", "throwBasketball", "depth/utd_mhad/a7_*_skeleton.mat"),
    QuerySet("kick (MSR)", "kickLFront1Reps", "kinect/msr_action3d/a14_*.txt", mirror=True),
    QuerySet("jog (UTD)", "jogLeftCircle4StepsRstart", "depth/utd_mhad/a22_*_skeleton.mat"),
    QuerySet("jog (MSR)", "jogLeftCircle4StepsRstart", "kinect/msr_action3d/a16_*.txt"),
    QuerySet("walk (UTD)", "walk", "depth/utd_mhad/a23_*_skeleton.mat"),
)
"""Kicks are with the right leg, the library's with the left: their mirror images ask. Joggers
and walkers stay in place, while those of the library travel."""


@cache
def kinect_queries() -> tuple[LabeledClip, ...]:
    """All takes of the sets; the actor of a clip is its set. Confidences tell of a sensor."""
    found = []
    for each in SETS:
        for path in sorted(clips.DATA.glob(each.files)):
            tracks = moving(_of_utd(path) if path.suffix == ".mat" else sensor_tracks(path))
            if each.mirror:
                tracks = replace(tracks, positions=mirror_postures(tracks.positions))
            tracks = replace(tracks, confidence=np.ones(tracks.positions.shape[:2]))
            found.append(LabeledClip(path.stem, each.label, each.name, tracks))
    return tuple(found)


def _of_utd(path: Path) -> Tracks:
    x, y, z = np.transpose(loadmat(path)["d_skel"], (1, 2, 0)).astype(float)
    is_observed = np.stack([x, -z, y], axis=-1)
    order = [OF_UTD.index(name) for name in POSTURE_JOINTS]
    return Tracks(POSTURE_JOINTS, is_observed[:, order], FRAME_RATE)


def moving(tracks: Tracks) -> Tracks:
    """Cut off what stands still before and after, as one would of a query."""
    signals, is_observed = observed_signals(tracks.positions)
    smooth = gaussian_filter1d(signals[:, is_observed], SMOOTHING_S * tracks.frame_rate, axis=0)
    speeds = np.linalg.norm(np.gradient(smooth, axis=0), axis=1)
    fast = np.flatnonzero(speeds > STILL_SPEED_FRACTION * speeds.max())
    return replace(tracks, positions=tracks.positions[fast[0] : fast[-1] + 1])
