"""Depth sequences with true joints, and the figures measured on them."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import BodyModel, default_body
from solvers.depth_tracking.body.pose_from_joints import body_from_joints, pose_from_joints
from solvers.depth_tracking.body.tables import JOINTS, LENGTHS

TRUTH = Path(__file__).resolve().parents[4] / "shared" / "data" / "depth" / "truth"
SCORED = ("walk_front", "walk_side", "walk_diagonal", "hop", "jump")
CENTRAL = {
    "hips": "Hips", "spine": "LowerBack", "chest": "Spine", "neck": "Neck", "head": "Neck1",
}  # fmt: skip
LIMBS = {
    "Shoulder": "Shoulder", "UpperArm": "Arm", "LowerArm": "ForeArm", "Hand": "Hand",
    "UpperLeg": "UpLeg", "LowerLeg": "Leg", "Foot": "Foot", "Toes": "ToeBase",
}  # fmt: skip
CMU_NAMES = CENTRAL | {
    f"{side.lower()}{role}": f"{side}{name}"
    for side in ("Left", "Right")
    for role, name in LIMBS.items()
}
"""CMU's name of each of `JOINTS`."""
MAX_FOUND_ERROR_M = 0.1
"""Meters within which a joint counts as found [WZC12] 7.2."""


@dataclass(frozen=True, eq=False)
class Sequence:
    """A depth recording of a skinned body, and where its joints were."""

    name: str
    depth: DepthRecording
    joints: np.ndarray
    """Shape (n_frames, 21, 3), meters, camera frame, in the order of `JOINTS`."""

    @property
    def body(self) -> BodyModel:
        """Lengths from the true joints; other proportions and radii of the default body."""
        adult = default_body()
        measured = body_from_joints(adult, self.joints)
        factor = float(np.median(measured.lengths / adult.lengths))
        return body_from_joints(adult.scaled(factor), self.joints)

    @property
    def typical_body(self) -> BodyModel:
        """The default body scaled to about the right stature."""
        adult = default_body()
        return adult.scaled(float(np.median(self.body.lengths / adult.lengths)))

    def first_pose(self, body: BodyModel) -> np.ndarray:
        """Return the pose of the first frame from the true joints."""
        return pose_from_joints(body, self.joints[0])


@cache
def sequence(name: str, folder: Path = TRUTH) -> Sequence:
    """Read one of data/depth/truth."""
    with np.load(folder / f"{name}.npz") as archive:
        depth, rate = archive["depth"], float(archive["frame_rate"])
        fx, fy, cx, cy = (float(archive[key]) for key in ("fx", "fy", "cx", "cy"))
        names = list(archive["joint_names"])
        joints = archive["joints"].astype(np.float64)
    camera = Camera(fx, fy, cx, cy, depth.shape[2], depth.shape[1])
    indices = [names.index(CMU_NAMES[role]) for role in JOINTS]
    recording = DepthRecording(
        camera, len(depth), rate, lambda i: depth[i].astype(np.float32) / np.float32(1000.0)
    )
    return Sequence(name, recording, joints[:, indices])


def noisier(one: Sequence, sigma: float, seed: int = 0) -> Sequence:
    """Return the sequence with Gaussian noise, `sigma` meters at 3 m, growing as z squared."""

    def read(frame: int) -> np.ndarray:
        rng = np.random.default_rng((seed, frame))
        depth = one.depth.frame(frame)
        noise = sigma * (depth / 3.0) ** 2 * rng.standard_normal(depth.shape)
        return np.where(depth > 0.0, depth + noise, 0.0).astype(np.float32)

    depth = DepthRecording(one.depth.camera, one.depth.n_frames, one.depth.frame_rate, read)
    return Sequence(f"{one.name} + {1000 * sigma:g} mm", depth, one.joints)


@dataclass(frozen=True, eq=False)
class Errors:
    """How far joints were off, meters, each (n_frames, 21)."""

    raw: np.ndarray
    offset_taken: np.ndarray
    """After a constant offset per joint and take: joints are defined differently."""

    def figures(self) -> dict[str, float]:
        """Return the figures of a table."""
        return {
            "cm": 100.0 * self.offset_taken.mean(),
            "% < 10 cm": 100.0 * (self.offset_taken < MAX_FOUND_ERROR_M).mean(),
            "cm raw": 100.0 * self.raw.mean(),
            "% raw < 10 cm": 100.0 * (self.raw < MAX_FOUND_ERROR_M).mean(),
        }


def errors(found: np.ndarray, truth: np.ndarray) -> Errors:
    """Compare joints (n_frames, 21, 3)."""
    off = found - truth
    return Errors(np.linalg.norm(off, axis=-1), np.linalg.norm(off - off.mean(axis=0), axis=-1))


def length_error(found: BodyModel, truth: BodyModel) -> float:
    """Return the mean difference of the lengths that joints tell, per cent."""
    measured = [
        LENGTHS.index(f"{side}{name}")
        for side in ("left", "right")
        for name in ("UpperArm", "LowerArm", "UpperLeg", "LowerLeg")
    ]
    return 100.0 * float(np.abs(found.lengths / truth.lengths - 1.0)[measured].mean())
