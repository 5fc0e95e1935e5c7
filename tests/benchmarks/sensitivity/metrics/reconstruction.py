"""Reconstruct: joints of known bodies, damaged as the tracker of a depth camera does."""

import numpy as np

from solvers.arrays import Array
from solvers.motion import (
    SENSOR_JOINTS,
    JointRecording,
    Motion,
    Sensor,
    Tracks,
    forward_kinematics,
)
from solvers.motion.humanoid import (
    POSTURE_JOINTS,
    posture_joint_indices,
    postures_from_motion,
)
from solvers.reconstruction import PostureLibrary, build_posture_library, reconstruct
from solvers.rotations.representations import angle_between

from ...shared import clips
from ..takes import hdm05, missed_or_false, point_error, variety, walk

LIBRARY = (("squat1Reps", 2), ("grabHighR", 1), ("kickLFront1Reps", 4), ("throwBasketball", 1))
SENSORS = {
    "kick": Sensor.KINECT_V1,
    "deposit": Sensor.KINECT_V2,
    "walk": Sensor.KINECT_V1,
    "punch": Sensor.KINECT_V2,
}
"""The second has a shipped residual prior."""
WRONG_M = 0.12
"""Meters off the truth from which a joint counts as wrong."""


def prepare() -> dict[str, object]:
    """Move the joints of four takes; build a library of other takes."""
    examples = [hdm05(*each) for each in LIBRARY] + [walk("27_01"), walk("32_01")]
    motions = {
        "kick": hdm05("kickLFront1Reps", 2),
        "deposit": hdm05("depositFloorR", 1),
        "walk": walk("10_04").slice(20, 100),
        "punch": clips.every(variety("02_05").slice(600, 960), clips.STEP),
    }
    cases = {}
    for seed, (name, motion) in enumerate(motions.items()):
        truth = _sensor_joints(motion, SENSORS[name])
        cases[name] = truth, _damaged(truth, SENSORS[name], np.random.default_rng(seed))
    return {"cases": cases, "examples": examples}


def measure(
    cases: dict[str, tuple[Array, JointRecording]], examples: list[Motion]
) -> dict[str, float]:
    """Distance of wrong and of right joints, reliability, shaking, and length of bones."""
    library: PostureLibrary = build_posture_library(examples)
    figures = {}
    for name, (truth, recording) in cases.items():
        result = reconstruct(recording, library)
        joints = list(posture_joint_indices(recording.names).values())
        given, truth = recording.tracks.positions[:, joints], truth[:, joints]
        wrong = ~(np.linalg.norm(given - truth, axis=-1) < WRONG_M)
        found = result.tracks.positions[:, joints]
        figures[f"{name}: wrong joints mm"] = point_error(found, truth, wrong)
        figures[f"{name}: others mm"] = point_error(found, truth, ~wrong)
        flagged = result.reliability.combined[:, joints] < 0.5
        figures[f"{name}: wrong joints found %"] = missed_or_false(flagged, wrong)
        jerk = np.diff(found, n=3, axis=0) * recording.frame_rate**3
        figures[f"{name}: jerk m/s3"] = float(np.linalg.norm(jerk, axis=-1).mean())
        fitted = forward_kinematics(result.motion).positions
        moving = result.motion.rotations
        angles = angle_between(moving[1:], moving[:-1])
        figures[f"{name}: turning deg"] = float(np.degrees(angles).mean())
        figures[f"{name}: skeleton mm"] = _distance(
            result.motion, fitted, truth, [recording.names[joint] for joint in joints]
        )
    return figures


def _sensor_joints(motion: Motion, sensor: Sensor) -> Array:
    """Return the joints that postures have; what a sensor has besides is where its hand is."""
    names = SENSOR_JOINTS[sensor]
    roles = {column: role for role, column in posture_joint_indices(names).items()}
    hands = {
        column: f"{'left' if 'Left' in name else 'right'}Hand"
        for column, name in enumerate(names)
    }
    order = [
        POSTURE_JOINTS.index(roles.get(column, hands[column])) for column in range(len(names))
    ]
    return postures_from_motion(motion)[:, order]


def _damaged(truth: Array, sensor: Sensor, rng: np.random.Generator) -> JointRecording:
    """Shake by 8 mm; lose a hand, invent a leg, swap the arms, and let an elbow jump."""
    index = posture_joint_indices(SENSOR_JOINTS[sensor])
    n_frames = len(truth)
    given = truth + rng.normal(scale=0.008, size=truth.shape)
    part = max(n_frames // 8, 4)
    given[part : 2 * part, index["leftHand"]] = np.nan
    leg = [index["rightLowerLeg"], index["rightFoot"]]
    drift = np.cumsum(rng.normal(scale=0.03, size=(part, 1, 3)), axis=0)
    drift[..., 2] += 0.25
    given[3 * part : 4 * part, leg] += drift
    left, right = (
        [index[f"{side}{joint}"] for joint in ("LowerArm", "Hand")]
        for side in ("left", "right")
    )
    frames = slice(5 * part, 5 * part + 4)
    given[frames, left + right] = given[frames, right + left]
    for frame in rng.integers(6 * part, n_frames - 1, size=3):
        given[frame, index["rightLowerArm"]] += rng.normal(scale=0.15, size=3)
    return JointRecording(Tracks(SENSOR_JOINTS[sensor], given, 30.0), None, sensor)


def _distance(motion: Motion, positions: Array, truth: Array, names: tuple[str, ...]) -> float:
    """Distance of the joints that the fitted skeleton shares with the sensor."""
    shared = [name for name in names if name in motion.skeleton.names]
    ours = [motion.skeleton.names.index(name) for name in shared]
    theirs = [names.index(name) for name in shared]
    return point_error(positions[:, ours], truth[:, theirs])
