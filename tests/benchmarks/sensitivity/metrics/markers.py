"""Optical markers: joints of a body that is known."""

from typing import Any

import numpy as np

from solvers.markers import solve_skeleton
from solvers.motion import find_humanoid_map, forward_kinematics
from tests.fixtures.marked_bodies import markers_on

from ...shared import clips
from ..takes import point_error, variety

JOINTS = ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")
N_GAPS, GAP_FRAMES = 10, 15
SPARSE_FRAMES = 20
"""Last frames, of which a third of all markers is missing at random."""


def prepare() -> dict[str, Any]:
    """Put markers with noise and gaps on a body that punches."""
    motion = clips.every(variety("02_05").slice(600, 900), clips.STEP)
    joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    positions = forward_kinematics(motion).positions
    truth = {part: positions[:, joints[f"left{part}"]] for part in JOINTS}
    marked = markers_on(motion, noise=0.001, skin=0.006)
    given = marked.positions.copy()
    rng = np.random.default_rng(2)
    for marker in rng.choice(marked.n_points, N_GAPS, replace=False):
        first = int(rng.integers(0, len(given) - GAP_FRAMES))
        given[first : first + GAP_FRAMES, marker] = np.nan
    given[-SPARSE_FRAMES:][rng.random((SPARSE_FRAMES, marked.n_points)) < 0.3] = np.nan
    return {"given": marked.with_positions(given), "truth": truth}


def measure(given: Any, truth: dict[str, Any]) -> dict[str, float]:
    """Distance to the joints of the left limbs."""
    centers = solve_skeleton(given).joint_centers
    return {
        f"{part}: mm": point_error(
            centers.positions[:, centers.names.index(f"left{part}")], where
        )
        for part, where in truth.items()
    }
