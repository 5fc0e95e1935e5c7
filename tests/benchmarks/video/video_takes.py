"""Takes as video models write them, made from captures whose truth is known.

Optical captures that no setting was tuned on (CMU subjects 05, 06, 29, 35 and 49, HDM05 actors
dg and bk) are put on the SMPL skeleton, resampled to 30 Hz and damaged as a model that sees one
camera damages them. They are then written as an SMPL-X archive and read by the reader of
Import. The sizes of the faults are chosen, not measured: no take of a video model with its
truth is free to use.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.interpolate import CubicSpline

from solvers.arrays import Array
from solvers.motion import Motion, Skeleton, find_humanoid_map
from solvers.motion.humanoid import SIDES
from solvers.recordings import read_acclaim, read_recording
from solvers.recordings.conventions import put_on_floor, z_up_from_y_up
from solvers.recordings.conventions.axes import rotations_y_up_from_z_up, y_up_from_z_up
from solvers.recordings.skeleton_files.smpl_bodies.joints import smpl_joints
from solvers.retargeting import retarget
from solvers.rotations import (
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)

from ..shared import clips
from ..shared.noise import seeded

CMU = ("05_01", "06_01", "29_01", "35_01", "35_17", "35_30")
"""Walks, and a run (35_17)."""
HOPS = ("49_02",)
HOP_FRAMES = range(240, 480)
HDM05 = (
    "dg_jogLeftCircle4StepsRstart", "bk_sneak2StepsLStart", "dg_squat1Reps",
    "bk_kickLFront1Reps", "dg_depositFloorR", "bk_throwBasketball", "dg_hopBothLegs1hops",
)  # fmt: skip
"""The first clip of an actor and class."""
LEG = ("hip", "knee", "ankle", "foot")
ENDS = ("wrist", "ankle", "foot", "head")
END_FACTOR = 1.5
"""How much farther off the ends of limbs are than other joints."""


@dataclass(frozen=True, kw_only=True)
class Faults:
    """Kinds and sizes of what a video model does wrong."""

    jitter_deg: float = 0.0
    """Noise of each joint that is new in each frame."""
    wobble_deg: float = 0.0
    """Slow error of each joint."""
    depth_jitter_m: float = 0.0
    """Noise of the distance from the camera; a third of it up and sideways."""
    depth_drift_m: float = 0.0
    """Slow error of the distance from the camera."""
    travel: float = 1.0
    """Traveled distance over the true one: the size of the actor is a guess."""
    tilt_deg: float = 0.0
    """Angle of the vertical: the camera's own is a guess. Feet sink on one side."""
    rise_m: float = 0.0
    """How much higher the body is at the end of the take."""
    swaps_per_s: float = 0.0
    """How often the legs are swapped, for 2 to 6 frames."""


PER_FRAME = Faults(
    jitter_deg=2.0, wobble_deg=3.0, depth_jitter_m=0.015, depth_drift_m=0.06, travel=0.95,
    tilt_deg=1.5, rise_m=0.05, swaps_per_s=0.3,
)  # fmt: skip
"""A model that sees one frame at a time, its results put into the world."""
TEMPORAL = Faults(
    jitter_deg=0.3, wobble_deg=3.0, depth_jitter_m=0.002, depth_drift_m=0.03, travel=0.95,
    tilt_deg=1.0, rise_m=0.05,
)  # fmt: skip
"""A model that sees all frames and predicts the path in the world."""
ALONE = {
    "jitter": Faults(jitter_deg=2.0, depth_jitter_m=0.015),
    "sliding": Faults(travel=0.9, depth_drift_m=0.06),
    "floating": Faults(rise_m=0.1),
    "tilted ground": Faults(tilt_deg=3.0),
    "swapped legs": Faults(swaps_per_s=0.5),
}
"""Each fault without the others."""


def truths() -> dict[str, Motion]:
    """Return the captures on the SMPL skeleton at 30 Hz, on the floor."""
    found = {name: clips.read_cmu(clips.WALKS / f"{name}.bvh") for name in CMU}
    for name in HOPS:
        found[name] = clips.read_cmu(clips.HOPS / f"{name}.bvh").slice(
            HOP_FRAMES.start, HOP_FRAMES.stop
        )
    for name in HDM05:
        path = min(clips.HDM05.glob(f"HDM_{name}_*_120.amc"))
        found[name] = clips.every(read_acclaim(path), clips.STEP)
    return {name: on_smpl(motion) for name, motion in found.items()}


def on_smpl(motion: Motion) -> Motion:
    """Return the motion of an SMPL body that does the same."""
    names, parents, offsets = smpl_joints(hands=False)
    body = Skeleton(names, parents, z_up_from_y_up(offsets))
    source = find_humanoid_map(motion.skeleton)
    return put_on_floor(retarget(motion, source, body, find_humanoid_map(body)))


def recorded(name: str, truth: Motion, faults: Faults) -> Motion:
    """Return what Import makes of the take that a video model would write."""
    damaged = damage(truth, faults, seeded(name, faults))
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.npz"
        write_smpl_x(damaged, path)
        motion = read_recording(path)
    assert isinstance(motion, Motion)
    return motion


def write_smpl_x(motion: Motion, path: Path) -> None:
    """Write the parameters of a body of 22 joints under the names of video models, Y up."""
    vectors = rotation_vector_from_quaternion(rotations_y_up_from_z_up(motion.rotations))
    np.savez(
        path,
        global_orient=vectors[:, 0],
        body_pose=vectors[:, 1:].reshape(motion.n_frames, -1),
        transl=y_up_from_z_up(motion.root_positions),
        betas=np.zeros(10),
        fps=motion.frame_rate,
    )


def damage(motion: Motion, faults: Faults, rng: np.random.Generator) -> Motion:
    """Return the motion with these faults. The camera looks along Y."""
    names = motion.skeleton.names
    factor = np.array([END_FACTOR if name.endswith(ENDS) else 1.0 for name in names])
    shape = (motion.n_frames, motion.n_joints, 3)
    errors = faults.jitter_deg * rng.normal(size=shape)
    errors += faults.wobble_deg * slow_noise(motion, rng, shape[1:])
    errors = np.radians(factor[:, None] * errors)
    rotations = multiply(motion.rotations, quaternion_from_rotation_vector(errors))
    for start, stop in swapped(motion, faults.swaps_per_s, rng):
        left, right = ([names.index(f"{side}_{part}") for part in LEG] for side in SIDES)
        rotations[start:stop, left + right] = rotations[start:stop, right + left]

    start = motion.root_positions[0]
    path = start + (faults.travel, faults.travel, 1.0) * (motion.root_positions - start)
    spread = faults.depth_jitter_m * np.array([1 / 3, 1.0, 1 / 3])
    path = path + spread * rng.normal(size=path.shape)
    path[:, 1] += faults.depth_drift_m * slow_noise(motion, rng, (1,))[:, 0]
    path[:, 2] += faults.rise_m * np.linspace(0.0, 1.0, motion.n_frames)
    tilt = quaternion_from_rotation_vector(np.radians([faults.tilt_deg, 0.0, 0.0]))
    rotations[:, 0] = multiply(tilt, rotations[:, 0])
    return motion.with_poses(rotations, start + rotate(tilt, path - start))


SLOW_S = 0.7
"""Seconds between independent values of slow errors."""


def slow_noise(motion: Motion, rng: np.random.Generator, shape: Sequence[int]) -> Array:
    """Return curves of unit variance that change slowly, shape (n_frames, *shape)."""
    times = np.arange(motion.n_frames) * motion.dt
    knots = np.arange(-1, int(times[-1] / SLOW_S) + 4) * SLOW_S
    return np.asarray(CubicSpline(knots, rng.normal(size=(len(knots), *shape)))(times))


def swapped(
    motion: Motion, per_second: float, rng: np.random.Generator
) -> list[tuple[int, int]]:
    """Return first and last frame, exclusive, of swapped legs."""
    count = rng.poisson(per_second * motion.n_frames * motion.dt)
    starts = rng.integers(0, motion.n_frames, size=count)
    return [(int(start), int(start + rng.integers(2, 7))) for start in starts]
