"""Capture with nothing given; and detector and tracker, alone and together."""

from collections.abc import Callable
from time import process_time

import numpy as np

from solvers.depth_tracking.body.model import BodyModel
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing.capture import Capture, CaptureSettings, capture
from solvers.depth_tracking.capturing.capture_method import CaptureMethod
from solvers.depth_tracking.capturing.passes import TrackingContext
from solvers.depth_tracking.capturing.restart_policies import RecoverySettings
from solvers.depth_tracking.detection.detect_pose import detect_pose
from solvers.depth_tracking.forest.pixel_forest import load_pixel_forest
from solvers.depth_tracking.terms.tracker_settings import DEFAULT_TRACKER
from solvers.depth_tracking.tracking.track_pose import track_pose
from solvers.errors import InvalidMotionError

from ..shared.tables import Scores
from .depth_extra_sequences import TAKES, more_sequence
from .depth_sequences import MAX_FOUND_ERROR_M, SCORED, Sequence, errors, length_error, sequence

FPS = "frames/s"
FORWARD = CaptureSettings(backward=False, smoothing=0.0)
PUBLISHED = {
    "wei, body known": CaptureSettings(method=CaptureMethod.REGISTRATION),
    "lou, body known": CaptureSettings(method=CaptureMethod.EDGES),
}
"""The published systems, without color."""
DETECTOR_STEP_FRAMES = 5
"""Frames from one that the detector gets to the next, where it works alone."""
BY_JOINT = {
    "detector alone, each frame by itself": "detector",
    "tracker alone, from the true first pose": "tracker",
    "both, forward and backward, smoothed": "both",
}
"""Joints to report, and their names in the tables."""
Found = tuple[np.ndarray, np.ndarray, int]
"""Joints (n, 21, 3), their frames (n,), and restarts."""


def captures() -> list[str]:
    """Capture without a given body or first pose; and forward only, with the true body."""
    title = "Automatic capture"
    scores = Scores(title, "each sequence counts as one clip; no pose is given", "")
    by_sequence = Scores(f"{title}, by sequence", "one each; nothing is given", "")
    for name in SCORED:
        one = sequence(name)
        for label, given, settings in (
            ("nothing given", None, CaptureSettings()),
            ("forward only, not smoothed, body known", one.body, FORWARD),
            *((label, one.body, each) for label, each in PUBLISHED.items()),
        ):
            rows = _captured(one, given, settings)
            for column, figure in rows.items():
                scores.add(label, column, name, figure)
                if given is None:
                    by_sequence.add(name, column, name, figure)
    return [scores.markdown(), by_sequence.markdown()]


def more() -> list[str]:
    """Capture and track the sequences of `depth_more`."""
    captures_table = Scores("More sequences, capture", "one each; nothing is given", "")
    alone = Scores(
        "More sequences, tracker from the true first pose", "one each; lengths known", ""
    )
    rows = []
    for name in TAKES:
        one = more_sequence(name)
        rows += [
            (captures_table, name, each)
            for each in _captured(one, None, CaptureSettings()).items()
        ]
        rows += [(alone, name, each) for each in _measured(_tracker_alone, one).items()]
    for scores, name, (column, figure) in rows:
        scores.add(name, column, name, figure)
    for scores, name, (column, figure) in rows:
        scores.add("all", column, name, figure)
    return [one.markdown() for one in (captures_table, alone)]


def capture_modes() -> list[str]:
    """Compare the detector alone, the tracker alone, and both, on depth/truth."""
    return _compare_modes("depth/truth", [sequence(name) for name in SCORED])


def more_capture_modes() -> list[str]:
    """Compare them on the sequences of `depth_more`."""
    return _compare_modes("more sequences", [more_sequence(name) for name in TAKES])


def _compare_modes(title: str, sequences: list[Sequence]) -> list[str]:
    methods: dict[str, Callable[[Sequence], Found]] = {
        "detector alone, each frame by itself": _detector_alone,
        "detector, refined by the tracker": _detector_refined,
        "tracker alone, from the true first pose": _tracker_alone,
        "tracker alone, from the detected first pose": _tracker_from_detector,
        "both, forward": lambda one: _both(one, FORWARD),
        "both, forward and backward, smoothed": lambda one: _both(one, CaptureSettings()),
    }
    unit = f"{len(sequences)} sequences as clips; lengths known"
    scores = Scores(f"Detector and tracker, alone and together, {title}", unit, "")
    by_joint = Scores(f"Per cent of each joint within 10 cm, {title}", unit, "")
    for one in sequences:
        for label, method in methods.items():
            for column, figure in _measured(method, one, by_joint, label).items():
                scores.add(label, column, one.name, figure)
    return [scores.markdown(), by_joint.markdown()]


def _captured(
    one: Sequence, body: BodyModel | None, settings: CaptureSettings
) -> dict[str, float]:
    """Return the figures of a captured sequence."""
    started = process_time()
    found = capture(one.depth, body, settings=settings)
    speed = one.depth.n_frames / (process_time() - started)
    off = errors(found.joints.positions, one.joints)
    return off.figures() | {
        "restarts": float(len(found.restarts)),
        "flagged %": 100.0 * found.low_confidence.mean(),
        "cm where not flagged": _confident_only(found, off.offset_taken),
        "% off in length": length_error(found.body, one.body),
        FPS: speed,
    }


def _confident_only(found: Capture, off: np.ndarray) -> float:
    confident = off[~found.low_confidence]
    return 100.0 * float(confident.mean()) if len(confident) else float("nan")


def _measured(
    method: Callable[[Sequence], Found],
    one: Sequence,
    by_joint: Scores | None = None,
    label: str = "",
) -> dict[str, float]:
    """Return the figures of a method; record those of each joint."""
    started = process_time()
    joints, frames, restarts = method(one)
    speed = len(frames) / (process_time() - started)
    off = errors(joints, one.joints[frames])
    if by_joint is not None and label in BY_JOINT:
        for joint, near in zip(
            JOINTS, (off.offset_taken < MAX_FOUND_ERROR_M).mean(axis=0), strict=True
        ):
            by_joint.add(joint, BY_JOINT[label], one.name, 100.0 * near)
    return off.figures() | {"restarts": float(restarts), FPS: speed}


def _detector_alone(one: Sequence) -> Found:
    forest, frames = load_pixel_forest(), np.arange(0, one.depth.n_frames, DETECTOR_STEP_FRAMES)
    joints = []
    for frame in frames.tolist():
        depth = one.depth.frame(frame)
        joints.append(detect_pose(depth, one.depth.camera, one.body, forest).joints)
    return np.array(joints), frames, 0


def _detector_refined(one: Sequence) -> Found:
    actor = TrackingContext(
        one.depth, one.body, load_pixel_forest(), DEFAULT_TRACKER, RecoverySettings()
    )
    frames = np.arange(0, one.depth.n_frames, DETECTOR_STEP_FRAMES)
    poses = np.array([_refined(actor, frame) for frame in frames.tolist()])
    return joint_positions(one.body, segment_frames(one.body, poses)), frames, 0


def _refined(actor: TrackingContext, frame: int) -> np.ndarray:
    found = actor.detected(frame)
    if found is None:
        raise InvalidMotionError(f"No person was detected in frame {frame}.")
    return found[0]


def _tracker_alone(one: Sequence) -> Found:
    tracked = track_pose(one.depth, one.body, one.first_pose(one.body))
    return tracked.joints.positions, np.arange(one.depth.n_frames), 0


def _tracker_from_detector(one: Sequence) -> Found:
    actor = TrackingContext(
        one.depth, one.body, load_pixel_forest(), DEFAULT_TRACKER, RecoverySettings()
    )
    tracked = track_pose(one.depth, one.body, _refined(actor, 0))
    return tracked.joints.positions, np.arange(one.depth.n_frames), 0


def _both(one: Sequence, settings: CaptureSettings) -> Found:
    found = capture(one.depth, one.body, settings=settings)
    return found.joints.positions, np.arange(one.depth.n_frames), len(found.restarts)
