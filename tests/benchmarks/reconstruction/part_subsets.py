"""Table III of [SHJT13] on UI-PRMD: complete postures from a few joints, subject left out."""

import numpy as np

from solvers.arrays import Array
from solvers.motion.humanoid.posture_joints import N_JOINTS, POSTURE_JOINTS
from solvers.reconstruction import ReconstructMethod

from ..shared.tables import table
from .kinect_damage import without
from .kinect_errors import bone_direction_errors, compared
from .kinect_folds import SUBJECTS, takes_of, truth_of
from .kinect_methods import Method, by_postures, by_published_postures, by_reconstruct, joints
from .part_losses import REPETITIONS

HANDS, FEET = ("leftHand", "rightHand"), ("leftFoot", "rightFoot")
PARTS = {
    "left hand, left foot": ("leftHand", "leftFoot"),
    "hands": HANDS,
    "hands, feet": HANDS + FEET,
    "hands, feet, elbows, knees": (
        *HANDS, *FEET, "leftLowerArm", "rightLowerArm", "leftLowerLeg", "rightLowerLeg",
    ),
    "all": POSTURE_JOINTS,
}  # fmt: skip
"""Hips are always used. The first frame shows all joints, and so the lengths of bones."""
EXERCISE_STEP = 5
"""Exercises from one that is measured to the next."""
METHODS: dict[str, Method] = {
    "[SHJT13] postures, as published": joints(by_published_postures),
    "postures": joints(by_postures),
    "postures, of CMU alone": joints(by_postures, others_too=False),
    "ours (both)": joints(by_reconstruct, method=ReconstructMethod.BOTH),
}


def subsets(n_repetitions: int) -> list[str]:
    """Return errors of the vector from the parent joint, as they are and without their mean."""
    del n_repetitions
    errors: dict[str, dict[str, list[tuple[Array, Array]]]] = {}
    takes = [pair for one in SUBJECTS for pair in takes_of(one, *REPETITIONS)[::EXERCISE_STEP]]
    for pair in takes:
        for part, used in PARTS.items():
            used_joints = [POSTURE_JOINTS.index(role) for role in ("hips", *used)]
            missing = np.ones((pair.kinect.n_frames, N_JOINTS), dtype=np.bool_)
            missing[:, used_joints] = False
            missing[0] = False
            blind = without(pair, missing)
            for name, method in METHODS.items():
                made = method(blind, pair.subject)[1:]
                truth = truth_of(pair)[1:]
                found = compared(made, truth)[1], bone_direction_errors(made, truth)
                errors.setdefault(name, {}).setdefault(part, []).append(found)
    rows = {
        name: [
            " / ".join(
                f"{100.0 * np.nanmean(np.concatenate([one.ravel() for one in kind])):.2f}"
                for kind in zip(*each[part], strict=True)
            )
            for part in PARTS
        ]
        for name, each in errors.items()
    }
    head = (
        f"**Parts used** (table III of [SHJT13]), {len(takes)} takes, subject left out: cm to"
        " the joint above (eq. 18), and without each joint's mean offset\n\n"
    )
    return [head + table(["method", *PARTS], rows) + "\n"]
