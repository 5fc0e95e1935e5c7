"""Physics: what a simulated body makes of a walk that shakes, and of a squat."""

import numpy as np

from solvers.motion import Motion, detect_contacts, forward_kinematics
from solvers.physics import Ground, SimulateSettings, simulate
from solvers.samples import CorruptionSettings, corrupt

from ..takes import hdm05, variety, walk


def prepare() -> dict[str, object]:
    """Shake four takes a little."""
    punch = variety("02_05").slice(600, 720)
    motions = {
        "walk 30 Hz": walk("07_11"),
        "squat 30 Hz": hdm05("squat1Reps"),
        "kick 30 Hz": hdm05("kickLFront1Reps"),
        "punch 120 Hz": punch,
    }
    wrong = CorruptionSettings(jitter=0.7, root_jitter=0.003, seed=4)
    return {"takes": {name: (each, corrupt(each, wrong)) for name, each in motions.items()}}


def measure(takes: dict[str, tuple[Motion, Motion]]) -> dict[str, float]:
    """Slide, depth, jerk, help from outside, frames lost, and distance from the truth."""
    figures = {}
    for name, (truth, given) in takes.items():
        result = simulate(given, settings=SimulateSettings(ground=Ground.FEET))
        positions, wanted = (
            forward_kinematics(each).positions for each in (result.motion, truth)
        )
        distance = np.linalg.norm(positions - wanted, axis=-1)
        jerk = np.linalg.norm(np.diff(positions, 3, axis=0), axis=-1) * given.frame_rate**3
        agreed = (result.contacts == detect_contacts(truth)).mean()
        figures |= {
            f"{name}: distance mm": 1000.0 * float(distance.mean()),
            f"{name}: jerk m/s3": float(jerk.mean()),
            f"{name}: slide mm": 1.0 + 1000.0 * result.slide_after,
            f"{name}: depth mm": 1.0 + 1000.0 * result.penetration_after,
            f"{name}: help %": 1.0 + 100.0 * float(result.support.mean()),
            f"{name}: lost %": 1.0 + 100.0 * float(1.0 - result.followed.mean()),
            f"{name}: contacts off %": 1.0 + 100.0 * float(1.0 - agreed),
        }
    return figures
