"""Takes of a real Kinect (UTD-MHAD), and how far a body found in them is off the depth.

`read_depth` mirrors the images back; the joints of the Kinect SDK are mirrored here too.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.io import loadmat
from scipy.spatial import cKDTree

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.tables import JOINTS
from solvers.recordings import read_depth

TAKES = Path(__file__).resolve().parents[4] / "shared" / "data" / "depth" / "utd_mhad"
SUBJECTS = (1, 3, 5, 7)
ACTIONS = (
    "swipe left", "swipe right", "wave", "clap", "throw", "cross arms", "basketball shot",
    "draw x", "draw circle", "draw circle back", "draw triangle", "bowling", "boxing",
    "baseball swing", "tennis swing", "arm curl", "tennis serve", "push", "knock", "catch",
    "pick up and throw", "jog", "walk", "sit to stand", "stand to sit", "lunge", "squat",
)  # fmt: skip
DEPTH_DELAY_FRAMES = 2
"""depth[t] fits skeleton[t - 2] (data/README.md)."""
SDK = {
    "head": 0, "neck": 1, "spine": 2, "hips": 3,
    "leftUpperArm": 4, "leftLowerArm": 5, "leftHand": 6,
    "rightUpperArm": 8, "rightLowerArm": 9, "rightHand": 10,
    "leftUpperLeg": 12, "leftLowerLeg": 13, "leftFoot": 14,
    "rightUpperLeg": 16, "rightLowerLeg": 17, "rightFoot": 18,
}  # fmt: skip
"""Our joints, and their indices in the SDK's skeleton."""
OURS = [JOINTS.index(joint) for joint in SDK]
STABLE = [
    index for index, joint in enumerate(SDK) if not joint.endswith(("Hand", "LowerArm", "Foot"))
]
"""Of `SDK`: trunk, shoulders, hips and knees."""
HANDS = [list(SDK).index(joint) for joint in ("leftHand", "rightHand")]
MIN_AIR_DISTANCE_M = 0.1
"""Meters between a hand and the nearest point of the depth from which on it is in the air."""


@dataclass(frozen=True, eq=False)
class KinectTake:
    """A depth recording, and the joints that of the Kinect's SDK."""

    action: int
    subject: int
    depth: DepthRecording
    joints: np.ndarray
    """Shape (n_frames, 16, 3), meters, camera frame (y down); NaN before the SDK began."""

    @property
    def name(self) -> str:
        """What the files are called."""
        return f"a{self.action}_s{self.subject}_t1"

    def distances(self, found: np.ndarray) -> np.ndarray:
        """Return how far our joints (n_frames, 21, 3) are from the SDK's, (n_frames, 16).

        Meters, after the median offset of each joint, for joints are defined differently.
        """
        off = found[:, OURS] - self.joints
        return np.linalg.norm(off - np.nanmedian(off, axis=0), axis=-1)

    def hands_in_air(self, hands: np.ndarray) -> float:
        """Return the fraction of hands (n_frames, 2, 3) far from all observed points."""
        sdk_joints = []
        for frame in range(self.depth.n_frames):
            depth = self.depth.frame(frame)
            points = self.depth.camera.back_project(depth)[depth > 0.0]
            here = hands[frame][np.isfinite(hands[frame]).all(axis=-1)]
            if len(points) and len(here):
                sdk_joints += (cKDTree(points).query(here)[0] > MIN_AIR_DISTANCE_M).tolist()
        return float(np.mean(sdk_joints))


def kinect_take(action: int, subject: int) -> KinectTake | None:
    """Read one take, or None where there is none."""
    stem = f"a{action}_s{subject}_t1"
    if not (TAKES / f"{stem}_depth.mat").exists():
        return None
    depth = read_depth(TAKES / f"{stem}_depth.mat")
    sdk_joints = np.moveaxis(loadmat(TAKES / f"{stem}_skeleton.mat")["d_skel"], 2, 0)
    joints = np.full((depth.n_frames, len(SDK), 3), np.nan)
    n_frames = min(depth.n_frames - DEPTH_DELAY_FRAMES, len(sdk_joints))
    joints[DEPTH_DELAY_FRAMES : DEPTH_DELAY_FRAMES + n_frames] = sdk_joints[
        :n_frames, list(SDK.values())
    ] * [
        -1.0,
        -1.0,
        1.0,
    ]
    return KinectTake(action, subject, depth, joints)
