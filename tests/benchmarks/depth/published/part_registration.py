"""[WZC12]: its table 1, its figure 11, and the accuracy of its calibration."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import BodyModel, default_body
from solvers.depth_tracking.capturing.calibrate_body import CalibrationSettings, calibrate_body
from solvers.depth_tracking.capturing.capture import Capture, CaptureSettings, capture
from solvers.depth_tracking.capturing.capture_method import CaptureMethod
from solvers.depth_tracking.capturing.find_body import find_body
from solvers.depth_tracking.forest.pixel_forest import load_pixel_forest
from solvers.depth_tracking.forest_training.render_mesh import render_mesh
from solvers.depth_tracking.forest_training.sensor_noise import add_sensor_noise
from solvers.depth_tracking.forest_training.training_images import vary_body
from solvers.depth_tracking.published.registration_tracker import REGISTRATION_TRACKER
from solvers.depth_tracking.terms.tracker_settings import TrackerSettings
from solvers.depth_tracking.tracking.track_pose import track_pose
from solvers.errors import InvalidMotionError

from ...shared.tables import Scores, number, table
from ..depth_extra_sequences import KINECT, SHAPES, TAKES, more_sequence
from ..depth_sequences import (
    CMU_NAMES,
    JOINTS,
    MAX_FOUND_ERROR_M,
    SCORED,
    Sequence,
    errors,
    length_error,
    sequence,
)
from ..depth_takes import ACTIONS, kinect_take
from ..forest_sources import all_bodies

UNIT = "each sequence counts as one clip"
N_BODIES = 12
"""Bodies in the reference pose."""
DISTANCE_M, HIPS_BELOW_M = 2.6, -0.15
"""Meters from the camera to the hips in the reference pose, and how far they are below it."""
METHODS = {
    "wei": CaptureSettings(method=CaptureMethod.REGISTRATION),
    "ours (default)": CaptureSettings(),
}
WITHOUT: dict[str, dict[str, float]] = {
    "all terms": {},
    "no depth image": {"depth_weight": 0.0},
    "no extra depth": {"extra_weight": 0.0},
    "no silhouette (figure 11 b)": {"silhouette_weight": 0.0},
    "no occlusion handling (figure 11 a)": {"limit": 1.0},
    "no prior": {"shift_weight": 0.0, "rotation_weight": 0.0},
    "prior in radians": {"rotation_weight": REGISTRATION_TRACKER.shift_weight},
}


def robustness(subject: int = 1) -> list[str]:
    """Return table 1 of [WZC12]: frames that the detector reset, and frames that are wrong."""
    rows: dict[str, list[str]] = {}
    for label, settings in METHODS.items():
        groups = {
            "depth/truth": _with_truth([sequence(name) for name in SCORED], settings),
            "more sequences": _with_truth([more_sequence(name) for name in TAKES], settings),
        }
        if settings.method is CaptureMethod.REGISTRATION:
            groups["UTD-MHAD"] = _kinect(subject, settings)
        for group, (n_frames, n_restarts, n_wrong) in groups.items():
            wrong = "-" if n_wrong is None else number(100.0 * n_wrong / n_frames)
            restarts = number(100.0 * n_restarts / n_frames)
            rows[f"{label}: {group}"] = [str(n_frames), restarts, wrong]
    header = ["method", "frames", "tracking failure, %", "system failure, %"]
    title = "**Robustness in the unit of [WZC12], table 1** (the paper: 0.46 and 0.11 %)\n\n"
    return [title + table(header, rows) + "\n"]


Counts = tuple[int, int, int | None]


def _with_truth(sequences: list[Sequence], settings: CaptureSettings) -> Counts:
    """Count frames, restarts, and frames with a mean joint error above 10 cm."""
    counts = np.zeros(3, dtype=int)
    for one in sequences:
        found = capture(one.depth, one.body, settings=settings)
        off = errors(found.joints.positions, one.joints).offset_taken.mean(axis=1)
        counts += [len(off), len(found.restarts), int((off > MAX_FOUND_ERROR_M).sum())]
    return int(counts[0]), int(counts[1]), int(counts[2])


def _kinect(subject: int, settings: CaptureSettings) -> Counts:
    """Count frames and restarts of all actions; the body is calibrated once, in the first."""
    results: list[Capture] = []
    for action in range(1, len(ACTIONS) + 1):
        take = kinect_take(action, subject)
        if take is not None:
            results.append(capture(take.depth, kinect_body(subject), settings=settings))
    frames = sum(found.motion.n_frames for found in results)
    return frames, sum(len(found.restarts) for found in results), None


@cache
def kinect_body(subject: int) -> BodyModel:
    """Return the body of a subject of UTD-MHAD, fitted to the first action."""
    take = kinect_take(1, subject)
    assert take is not None
    return find_body(take.depth, load_pixel_forest())


def ablation(sequences: list[Sequence]) -> list[str]:
    """Leave out each term of [WZC12] as published, from the true first pose."""
    unit = f"{len(sequences)} sequences as clips"
    scores = Scores("[WZC12] without each part, figure 11", unit, "")
    for label, changes in WITHOUT.items():
        settings = replace(REGISTRATION_TRACKER, **changes)
        for one in sequences:
            for column, figure in _tracked(one, settings).items():
                scores.add(label, column, one.name, figure)
    return [scores.markdown()]


def _tracked(one: Sequence, settings: TrackerSettings) -> dict[str, float]:
    with np.errstate(all="ignore"):
        tracked = track_pose(one.depth, one.body, one.first_pose(one.body), settings=settings)
    return errors(tracked.joints.positions, one.joints).figures()


def calibration() -> list[str]:
    """Compare the bodies that are measured in a reference pose with the true ones."""
    forest = load_pixel_forest()
    scores = Scores("Calibration in a reference pose", f"{N_BODIES} bodies as clips", "")
    failed: dict[str, int] = {}
    for number_, (one, depth) in enumerate(reference_poses()):
        for label, settings in (
            ("cylinders, as published", CalibrationSettings(refine=False)),
            ("cylinders, lengths by a fit of the body", CalibrationSettings()),
        ):
            try:
                body = calibrate_body(depth, 0, forest, settings=settings)
            except InvalidMotionError:
                failed[label] = failed.get(label, 0) + 1
                continue
            _note(scores, label, number_, body, one.body)
        _note(scores, "default body of the true stature", number_, one.typical_body, one.body)
        _note(scores, "default body of 1.75 m", number_, default_body(1.75), one.body)
    refused = [f"{label} refused {count} of them." for label, count in failed.items()]
    return [scores.markdown(), *(f"{sentence}\n" for sentence in refused)]


def _note(scores: Scores, label: str, clip: int, found: BodyModel, truth: BodyModel) -> None:
    scores.add(label, "% off in length", str(clip), length_error(found, truth))
    stature = 100.0 * abs(found.lengths.sum() / truth.lengths.sum() - 1.0)
    scores.add(label, "% off in all lengths together", str(clip), stature)


def reference_poses() -> Iterator[tuple[Sequence, DepthRecording]]:
    """Yield blends of the four bodies in their rest pose, arms and legs away from the trunk."""
    for index in range(N_BODIES):
        rng = np.random.default_rng((13, index))
        body = vary_body(all_bodies(), rng, SHAPES)
        rotations = np.tile([1.0, 0.0, 0.0, 0.0], (body.skeleton.n_joints, 1))
        vertices, positions = body.pose(rotations, np.zeros(3))
        to_camera = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
        shift = np.array([0.0, HIPS_BELOW_M, DISTANCE_M])
        exact = render_mesh(
            vertices @ to_camera + shift, body.triangles, body.vertex_parts, KINECT
        )
        depth = add_sensor_noise(exact, KINECT, rng).depth.astype(np.float32)
        recording = DepthRecording(KINECT, 1, 30.0, lambda _, depth=depth: depth)
        order = [body.skeleton.names.index(CMU_NAMES[role]) for role in JOINTS]
        truth = (positions @ to_camera + shift)[None, order]
        yield Sequence(f"body {index}", recording, truth), recording
