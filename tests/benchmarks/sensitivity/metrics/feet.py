"""Planting feet: slide, knees, what is moved, and the error of the ankles in contact.

Made bodies on all fours show the same of hands and knees, and a walk whose path drifts that of
feet that are held while the actor moves.
"""

import numpy as np

from solvers.arrays import Array, Flags
from solvers.denoising import plant_feet
from solvers.feet import PlantSettings
from solvers.feet.legs import find_legs
from solvers.motion import Motion, detect_contacts, find_humanoid_map, forward_kinematics
from solvers.rotations.representations import IDENTITY, angle_between
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait

from ...contacts.made_supports import made_supports
from ...contacts.made_takes import MadeTake
from ...live.held_feet import drifting, hold_feet
from ..takes import hdm05, variety, walk

EXTRA_TRAVEL_FRACTION = 0.15
"""Fraction by which the body travels farther than its steps."""


def prepare() -> dict[str, object]:
    """Make feet slide: a swaying root, travel too long, noise, and none of these."""
    plain = walk("07_11", 1)
    swaying, skating = walk("10_04", 2), walk("32_01", 2)
    path = skating.root_positions.copy()
    path[:, :2] += EXTRA_TRAVEL_FRACTION * (path[:, :2] - path[0, :2])
    noisy, kick = walk("07_03"), hdm05("kickLFront1Reps", 2)
    punch = variety("02_05").slice(600, 900)
    dance = variety("salsa_01").slice(300, 500)
    sway = CorruptionSettings(jitter=0.0, root_sway=0.03)
    pairs = {
        "walk 120 Hz": (plain, plain),
        "sway 60 Hz": (swaying, corrupt(swaying, sway)),
        "skating 60 Hz": (skating, skating.with_poses(root_positions=path)),
        "noise 30 Hz": (noisy, corrupt(noisy, CorruptionSettings(jitter=1, root_jitter=0.003))),
        "kick 30 Hz": (kick, corrupt(kick, sway)),
        "punch 120 Hz": (punch, corrupt(punch, sway)),
        "dance 60 Hz": (dance, corrupt(dance, sway)),
    }
    supports = made_supports(30.0)
    return {
        "takes": {
            name: (capture, given, detect_contacts(capture), detect_contacts(given))
            for name, (capture, given) in pairs.items()
        },
        "bodies": {
            name: (supports[name], corrupt(supports[name].motion, sway))
            for name in ("walk on hands and feet", "push-ups")
        },
        "streamed": drifting(walking_gait(GaitSettings(duration=8.0, frame_rate=30.0))),
    }


def measure(
    takes: dict[str, tuple[Motion, Motion, Flags, Flags]],
    bodies: dict[str, tuple[MadeTake, Motion]],
    streamed: Motion,
) -> dict[str, float]:
    """Plant the feet; in contact as in the capture, slide and error of the ankles."""
    figures = _held_while_streaming(streamed)
    for name, (made, given) in bodies.items():
        figures |= _supported(name, made, given)
    for name, (capture, given, truly, contacts) in takes.items():
        legs = find_legs(given.skeleton)
        planted = plant_feet(given, contacts).motion
        after, before, wanted = (_feet(each, legs) for each in (planted, given, capture))
        speed = np.linalg.norm(np.diff(after[..., :2], axis=0), axis=-1).min(axis=-1)
        both = truly[1:] & truly[:-1]
        figures[f"{name}: slide cm/s"] = 100.0 * float(speed[both].mean()) * given.frame_rate
        figures[f"{name}: knee 1000 deg/s2"] = _knees(planted, legs)
        if "kick" in name:
            loose = plant_feet(given, contacts, settings=PlantSettings(spare_knees=False))
            figures[f"{name}, loose knees: moved cm"] = _distance(
                _feet(loose.motion, legs), before
            )
            figures[f"{name}, loose knees: knee 1000 deg/s2"] = _knees(loose.motion, legs)
        figures[f"{name}: moved cm"] = _distance(after, before)
        if "skating" not in name:
            figures[f"{name}: error cm"] = _distance(after, wanted, truly)
    return figures


def _held_while_streaming(motion: Motion) -> dict[str, float]:
    """Return slide, jump at release and distance of feet that are held frame by frame."""
    poses = [motion.slice(frame, frame + 1) for frame in range(60, motion.n_frames)]
    found = hold_feet(motion.slice(0, 60), poses)
    legs = find_legs(motion.skeleton)
    return {
        "streamed: slide cm": 100.0 * found.slide_m,
        "streamed: jump cm": 100.0 * found.jumps_m[1],
        "streamed: moved cm": _distance(_feet(found.held, legs), _feet(found.raw, legs)),
    }


def _supported(name: str, made: MadeTake, given: Motion) -> dict[str, float]:
    """Return what holding hands and knees does to a made body whose root sways."""
    planted = plant_feet(given).motion
    roles = find_humanoid_map(given.skeleton).indices(given.skeleton)
    arms = {part: [roles[f"{side}{part}"] for side in ("left", "right")]
            for part in ("UpperArm", "LowerArm", "Hand")}  # fmt: skip
    before, after = (forward_kinematics(each) for each in (given, planted))
    steps = np.linalg.norm(np.diff(after.positions[:, arms["Hand"], :2], axis=0), axis=-1)
    held = made.contacts[1:, :2] & made.contacts[:-1, :2]
    figures = {
        f"{name}: slide of hands cm/s": 100.0 * float(steps[held].mean()) * given.frame_rate,
        f"{name}: hands moved cm": 100.0 * float(np.linalg.norm(
            (after.positions - before.positions)[:, arms["Hand"]], axis=-1).mean()),
    }  # fmt: skip
    for part, joints in arms.items():
        angles = angle_between(planted.rotations[:, joints], given.rotations[:, joints])
        figures[f"{name}: {part} deg"] = float(np.degrees(angles).mean())
    return figures


def _feet(motion: Motion, legs: tuple) -> Array:
    joints = np.array([[leg.ankle, leg.toe or leg.ankle] for leg in legs])
    return forward_kinematics(motion).positions[:, joints]


def _knees(motion: Motion, legs: tuple) -> float:
    bends = [angle_between(motion.rotations[:, leg.knee], IDENTITY) for leg in legs]
    change = np.abs(np.diff(np.degrees(bends), n=2, axis=1))
    return float(change.mean() * motion.frame_rate**2 / 1000.0)


def _distance(a: Array, b: Array, where: Flags | None = None) -> float:
    distance = np.linalg.norm(a[:, :, 0] - b[:, :, 0], axis=-1)
    return float(100.0 * (distance if where is None else distance[where]).mean())
