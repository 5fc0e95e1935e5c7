"""Check: how well it lists the known faults of a take, and of a take of points."""

import numpy as np

from solvers.arrays import Array
from solvers.denoising import find_worst_issues, learn_joint_limits, measure_quality
from solvers.motion import JointLimits, Motion, Tracks
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector
from solvers.samples import CorruptionSettings, corrupt

from ..takes import hdm05, joint_tracks, missed_or_false, variety, walk

Fault = tuple[str, int, int]


def prepare() -> dict[str, object]:
    """Make a dance faulty, and a kick; learn limits of clean walks."""
    walks = [walk(name) for name in ("10_04", "27_01", "32_01", "07_11")]
    return {
        "takes": {
            "dance, 60 Hz": _faulty(variety("salsa_01").slice(300, 600), 6, "rForeArm"),
            "kick, 30 Hz": _faulty(hdm05("kickLFront1Reps", 2), 7, "rhumerus"),
        },
        "limits": learn_joint_limits(walks),
        "beyond": corrupt(walks[2], CorruptionSettings(jitter=12.0, seed=9)),
        "points": _stretched(),
    }


def measure(
    takes: dict[str, tuple[Motion, list[Fault]]],
    limits: JointLimits,
    beyond: Motion,
    points: Tracks,
) -> dict[str, float]:
    """Frames of joints that are listed, against those made faulty; and what is reported."""
    figures = {}
    for name, (motion, faults) in takes.items():
        issues = [
            (issue.joint, issue.start_frame, issue.stop_frame)
            for issue in find_worst_issues(motion, measure_quality(motion))
            if issue.kind != "foot slide"
        ]
        figures[f"{name}: missed or false %"] = missed_or_false(
            _mask(motion, issues), _mask(motion, faults)
        )
        figures[f"{name}: foot slide m/s"] = measure_quality(motion).foot_slide
        spread = [float(np.nanmean(each.noise)) for each in measure_quality(motion).signals]
        figures[f"{name}: noise"] = float(np.nanmean(spread))
    quality = measure_quality(beyond, limits=limits)
    listed = find_worst_issues(beyond, quality)
    figures["beyond limits: severity"] = sum(issue.severity for issue in listed)
    drifts = measure_quality(points).bones
    figures["points: bones"] = float(len(drifts))
    figures["points: drift m"] = float(np.mean([abs(each.drift) for each in drifts]))
    return figures


def _faulty(clean: Motion, seed: int, shaking: str) -> tuple[Motion, list[Fault]]:
    """Add single-frame spikes, a joint that shakes for a fifth of the take, and a gap."""
    rng = np.random.default_rng(seed)
    names = clean.skeleton.names
    joints = [name for name in names if not name.lower().endswith("end")][2:14]
    stop = 10 + clean.n_frames // 4
    missing = names[names.index(shaking) + 1]
    given = corrupt(clean, CorruptionSettings(jitter=0.3), missing={missing: range(10, stop)})
    rotations = given.rotations.copy()
    gone = [name for name in names if np.isnan(rotations[12, names.index(name)]).any()]
    faults = [(name, 10, stop) for name in gone]
    for joint, degrees in zip(joints, np.geomspace(4.0, 60.0, 12), strict=True):
        column, frame = names.index(joint), int(rng.integers(5, clean.n_frames - 5))
        rotated = multiply(rotations[frame, column], _random_rotation(rng, degrees))
        rotations[frame, column] = rotated
        faults.append((joint, frame, frame + 1))
    column, start = names.index(shaking), clean.n_frames // 2
    shaken = range(start, start + clean.n_frames // 5)
    for frame in shaken:
        rotations[frame, column] = multiply(
            rotations[frame, column], _random_rotation(rng, 3.0)
        )
    faults.append((shaking, shaken.start, shaken.stop))
    return given.with_poses(rotations), faults


def _stretched() -> Tracks:
    """Points of a walk whose left forearm grows by 3 cm, without the names of a body."""
    tracks = joint_tracks(walk("10_04"))
    positions = tracks.positions.copy()
    hand = tracks.names.index("LeftHand")
    arm = positions[:, hand] - positions[:, tracks.names.index("LeftForeArm")]
    length = np.linalg.norm(arm, axis=1, keepdims=True)
    positions[:, hand:] += (np.linspace(0, 0.03, len(arm))[:, None] * arm / length)[:, None]
    positions += np.random.default_rng(8).normal(scale=0.002, size=positions.shape)
    names = tuple(f"point {number}" for number in range(len(tracks.names)))
    return Tracks(names, positions, tracks.frame_rate)


def _mask(motion: Motion, faults: list[Fault]) -> np.ndarray:
    names = motion.skeleton.names
    mask = np.zeros((motion.n_frames, len(names)), dtype=np.bool_)
    for joint, start, stop in faults:
        mask[start:stop, names.index(joint)] = True
    return mask


def _random_rotation(rng: np.random.Generator, degrees: float) -> Array:
    axis = rng.normal(size=3)
    return quaternion_from_rotation_vector(np.radians(degrees) * axis / np.linalg.norm(axis))
