"""What a second depth camera gains, and how exactly the actor calibrates it."""

from collections.abc import Iterator

import numpy as np

from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing.capture import Capture
from solvers.depth_tracking.several_cameras.align_tracks import CameraAlignment, align_tracks
from solvers.depth_tracking.several_cameras.capture_cameras import (
    CapturedByCameras,
    capture_cameras,
)
from solvers.depth_tracking.several_cameras.capture_views import capture_views, own_poses
from solvers.depth_tracking.several_cameras.track_views import ViewedActor
from solvers.depth_tracking.several_cameras.views import CameraTake
from solvers.depth_tracking.terms.tracker_settings import DEFAULT_TRACKER
from solvers.errors import InvalidMotionError

from ...shared.tables import Scores
from ..depth_sequences import errors
from .camera_pairs import OFFSET_S, PAIRS, CameraPair, camera_pair

LIMBS = [
    JOINTS.index(f"{side}{joint}")
    for side in ("left", "right")
    for joint in ("LowerArm", "Hand", "LowerLeg", "Foot")
]
"""Elbows, hands, knees and feet: the joints that hide behind the body."""
FAR_M = 0.1
"""Error of a joint that the first camera does not show, meters [WZC12] 7.2."""
FIRST_SHARED = int(np.ceil(OFFSET_S * 30.0))
"""Frame of the first camera from which both record."""


def cameras() -> list[str]:
    """Compare one camera, the mean of two skeletons, and one body in both images."""
    unit = f"{len(PAIRS)} sequences as clips; nothing is given"
    scores = Scores("Two cameras", unit, "")
    positions = Scores("The second camera, calibrated by the actor", unit, "")
    by_clip = Scores("Limbs that camera 1 loses, by sequence, cm", "one each", "")
    refused: list[str] = []
    for name in PAIRS:
        pair = camera_pair(name)
        try:
            found = capture_cameras([pair.first.depth, pair.second.depth])
        except InvalidMotionError as error:
            refused.append(f"{name}: {error}")
            continue
        by_skeletons = align_tracks(found.alone[0].joints, found.alone[1].joints)
        hidden = _hidden(found.alone[0], pair)
        for method, joints in _methods(found, by_skeletons, pair):
            figures = _figures(joints, pair, hidden)
            for column, figure in figures.items():
                scores.add(method, column, name, figure)
            by_clip.add(name, method, name, figures["cm, limbs camera 1 loses"])
        for method, alignment in (
            ("from the skeletons", by_skeletons), ("refined by the images", found.alignments[1])
        ):  # fmt: skip
            for column, figure in _placement(alignment, pair).items():
                positions.add(method, column, name, figure)
    return [scores.markdown(), positions.markdown(), by_clip.markdown(), *refused]


def _methods(
    found: CapturedByCameras, by_skeletons: CameraAlignment, pair: CameraPair
) -> Iterator[tuple[str, np.ndarray]]:
    """Yield methods and their joints in the frames that both cameras show."""
    takes = _takes(pair, found.alignments[1])
    actor = ViewedActor(takes, found.captured.body, DEFAULT_TRACKER)
    own = [
        joint_positions(actor.body, segment_frames(actor.body, poses[FIRST_SHARED:]))
        for poses in own_poses(actor, found.alone)
    ]
    yield "camera 1 alone", own[0]
    yield "camera 2 alone", own[1]
    yield "mean of both skeletons, by confidence", _mean(own, found, pair)
    aligned = _takes(pair, by_skeletons)
    unrefined = capture_views(ViewedActor(aligned, actor.body, DEFAULT_TRACKER), found.alone)
    yield "both images, cameras not refined", unrefined.joints.positions[FIRST_SHARED:]
    yield "both images (default)", found.captured.joints.positions[FIRST_SHARED:]


def _takes(pair: CameraPair, alignment: CameraAlignment) -> tuple[CameraTake, CameraTake]:
    first = CameraAlignment(np.eye(4), 0.0, 0.0)
    return CameraTake(pair.first.depth, first), CameraTake(pair.second.depth, alignment)


def _mean(own: list[np.ndarray], found: CapturedByCameras, pair: CameraPair) -> np.ndarray:
    """Return the joints of both cameras, weighted by their confidence: the peer."""
    weights = [np.asarray(each.joints.confidence) for each in found.alone]
    times = np.arange(FIRST_SHARED, pair.first.depth.n_frames) / pair.first.depth.frame_rate
    nearest = np.round((times - found.alignments[1].offset) * pair.second.depth.frame_rate)
    frames = np.clip(nearest.astype(int), 0, pair.second.depth.n_frames - 1)
    both = np.stack([weights[0][FIRST_SHARED:], weights[1][frames]])[..., np.newaxis] + 1e-6
    return (both * np.stack(own)).sum(axis=0) / both.sum(axis=0)


def _hidden(alone: Capture, pair: CameraPair) -> np.ndarray:
    """Return whether the first camera loses a limb's joint by more than 10 cm."""
    off = errors(alone.joints.positions[FIRST_SHARED:], pair.first.joints[FIRST_SHARED:])
    return off.offset_taken[:, LIMBS] > FAR_M


def _figures(joints: np.ndarray, pair: CameraPair, hidden: np.ndarray) -> dict[str, float]:
    truth = pair.first.joints[FIRST_SHARED:]
    valid = np.isfinite(joints).all(axis=(1, 2))
    off = errors(joints[valid], truth[valid])
    limbs = off.offset_taken[:, LIMBS]
    lost = limbs[hidden[valid]]
    return off.figures() | {
        "cm, limbs": 100.0 * float(limbs.mean()),
        "cm, limbs camera 1 loses": 100.0 * float(lost.mean()) if len(lost) else float("nan"),
    }


def _placement(alignment: CameraAlignment, pair: CameraPair) -> dict[str, float]:
    found, true = (
        np.linalg.inv(each)[:3, 3]
        for each in (alignment.camera_from_first, pair.camera_from_first)
    )
    return {
        "cm off": 100.0 * float(np.linalg.norm(found - true)),
        "degrees off": alignment.angle_to(pair.camera_from_first),
        "ms off": 1000.0 * abs(alignment.offset - pair.offset),
        "mismatch, cm": 100.0 * alignment.mismatch,
    }
