"""Effect of one frame corrected by hand: on wrong arms, and on a real capture."""

from time import process_time

import numpy as np

from solvers.arrays import Array
from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.motion import body_motion, motion_frames
from solvers.depth_tracking.body.pose_from_joints import pose_from_joints
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing.capture import CaptureSettings, capture
from solvers.depth_tracking.capturing.retrack import retrack

from ..shared.tables import Scores
from .depth_sequences import SCORED, Sequence, sequence

N_WRONG, AROUND = 12, 10
"""Frames before and after the corrected one with wrong arms, or in the score."""
STIFF = {"HumerusX": 1.2, "HumerusZ": 0.1, "Radius": 0.1}
"""Coordinates of arms that point stiffly forward."""
ARMS = [JOINTS.index(f"{side}{name}") for side in ("left", "right")
        for name in ("LowerArm", "Hand")]  # fmt: skip


def retracking() -> list[str]:
    """Correct one frame by the true joints, in five takes with the true body lengths."""
    scores = Scores(
        "One frame corrected", "each sequence counts as one clip; cm of elbows and hands", ""
    )
    for name in SCORED:
        one = sequence(name)
        poses = capture(one.depth, one.body, settings=CaptureSettings()).poses
        worst = int(_off(one, joint_positions(one.body, segment_frames(one.body, poses))
                         )[AROUND:-AROUND].argmax()) + AROUND  # fmt: skip
        _correct(scores, name, one, poses, worst, "where the capture is worst")
        middle = one.depth.n_frames // 2
        corrupted = poses.copy()
        stretch = slice(middle - N_WRONG, middle + N_WRONG + 1)
        for side in ("left", "right"):
            for coordinate, value in STIFF.items():
                corrupted[stretch, COORDINATES.index(f"{side}{coordinate}")] = value
        _correct(scores, name, one, corrupted, middle, "arms missing for 25 frames")
    return [scores.markdown()]


def _correct(
    scores: Scores, name: str, one: Sequence, poses: Array, frame: int, label: str
) -> None:
    """Compare before and after, in the frames around the corrected one but not in it."""
    corrected = poses.copy()
    corrected[frame] = pose_from_joints(one.body, one.joints[frame], start=poses[frame])
    motion = body_motion(one.body, corrected, one.depth.frame_rate)
    started = process_time()
    found = retrack(one.depth, one.body, motion, frame)
    seconds = process_time() - started
    before = _off(one, joint_positions(one.body, segment_frames(one.body, poses)))
    after = _off(one, joint_positions(one.body, motion_frames(one.body, found.motion)))
    around = np.arange(max(0, frame - AROUND), min(len(poses), frame + AROUND + 1))
    around = around[around != frame]
    scores.add(label, "before", name, before[around].mean())
    scores.add(label, "after", name, after[around].mean())
    scores.add(label, "before, complete take", name, before.mean())
    scores.add(label, "after, complete take", name, after.mean())
    scores.add(label, "frames changed", name, found.last - found.first + 1)
    scores.add(label, "s", name, seconds)


def _off(one: Sequence, joints: Array) -> Array:
    """Return how far elbows and hands are off on average, cm, (n_frames,)."""
    distances = np.linalg.norm(joints - one.joints, axis=-1)[:, ARMS]
    return np.asarray(100.0 * distances.mean(axis=1))
