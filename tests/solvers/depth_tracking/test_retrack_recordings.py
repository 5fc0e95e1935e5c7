"""One corrected frame repairs a segment of a recording with true joints."""

import numpy as np
import pytest

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.motion import body_motion, motion_frames
from solvers.depth_tracking.body.pose_from_joints import body_from_joints, pose_from_joints
from solvers.depth_tracking.body.segment_kinematics import joint_positions
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing.retrack import retrack

CMU = {
    "hips": "Hips", "chest": "Spine1", "neck": "Neck1", "head": "Head",
    **{
        f"{side}{ours}": f"{side.capitalize()}{theirs}"
        for side in ("left", "right")
        for ours, theirs in (("UpperArm", "Arm"), ("LowerArm", "ForeArm"), ("Hand", "Hand"),
                             ("UpperLeg", "UpLeg"), ("LowerLeg", "Leg"), ("Foot", "Foot"))
    },
}  # fmt: skip
N_FRAMES, CORRECTED, WRONG = 40, 20, slice(8, 33)


def with_true_joints(recordings, take, first):
    """Return the recording, the body, and its poses from the true joints."""
    with np.load(recordings / "depth" / "truth" / f"{take}.npz") as truth:
        depth = truth["depth"][first : first + N_FRAMES]
        names = truth["joint_names"].tolist()
        joints = np.full((N_FRAMES, len(JOINTS), 3), np.nan)
        for name, recorded_name in CMU.items():
            index = names.index(recorded_name)
            joints[:, JOINTS.index(name)] = truth["joints"][first : first + N_FRAMES, index]
        focal = [float(truth[name]) for name in ("fx", "fy", "cx", "cy")]
    recording = DepthRecording(
        Camera(*focal, 320, 240), N_FRAMES, 30.0, lambda frame: depth[frame] / np.float32(1e3)
    )
    body = body_from_joints(default_body(), joints)
    poses, pose = [], None
    for frame in joints:
        pose = pose_from_joints(body, frame, start=pose)
        poses.append(pose)
    return recording, body, np.array(poses)


@pytest.mark.parametrize(
    ("take", "first", "maximum"), [("walk_diagonal", 20, 0.13), ("hop", 60, 0.04)]
)
def test_retrack_recovers_occluded_arms(recordings, take, first, maximum):
    """Both arms hang stiffly forward for 25 frames, except for the corrected one.

    In the diagonal walk the body occludes one arm in most of them.
    """
    recording, body, poses = with_true_joints(recordings, take, first)
    wrong = poses.copy()
    for side in ("left", "right"):
        for name, value in (("HumerusX", 1.2), ("HumerusZ", 0.1), ("Radius", 0.1)):
            wrong[WRONG, COORDINATES.index(f"{side}{name}")] = value
    wrong[CORRECTED] = poses[CORRECTED]
    motion = body_motion(body, wrong, 30.0)

    found = retrack(recording, body, motion, CORRECTED)

    truth = elbows_and_hands(body, body_motion(body, poses, 30.0))
    before, after = (
        np.linalg.norm(elbows_and_hands(body, one) - truth, axis=-1)[WRONG].mean()
        for one in (motion, found.motion)
    )
    assert before > 0.3
    assert after < maximum


def elbows_and_hands(body, motion):
    indices = [JOINTS.index(f"{side}{name}") for side in ("left", "right")
              for name in ("LowerArm", "Hand")]  # fmt: skip
    return joint_positions(body, motion_frames(body, motion))[:, indices]
