"""Made sequences before two depth cameras, with known places and times.

Bodies, clips and noise are those of `depth_extra_sequences`. The second camera begins later and
takes its images between those of the first, as cameras do that nothing synchronizes.
"""

from functools import cache
from hashlib import sha1
from typing import NamedTuple

import numpy as np

from solvers.depth_tracking.forest_training.render_mesh import render_mesh
from solvers.depth_tracking.forest_training.sensor_noise import add_sensor_noise
from solvers.depth_tracking.forest_training.skinned_body import SkinnedBody
from solvers.depth_tracking.forest_training.training_images import vary_body
from solvers.motion import resample
from solvers.rotations import matrix_from_quaternion, quaternion_from_matrix, slerp

from ..depth_extra_sequences import (
    BUILD,
    KINECT,
    RATE_HZ,
    SHAPES,
    Take,
    before_camera,
    view_center,
)
from ..depth_sequences import Sequence, sequence
from ..forest_sources import all_bodies

STEPS = 4
"""Times between two images at which the motion is known."""
DELAY_STEPS = 26
"""Steps after which the second camera takes its first image: six images and a half."""
OFFSET_S = DELAY_STEPS / STEPS / RATE_HZ


class Pair(NamedTuple):
    """A clip before two cameras."""

    take: Take
    """As the first camera shows it."""
    angle: float = 90.0
    """Degrees from the first camera to the second, about the middle of the path."""
    distance: float = 3.2
    """Meters of the second camera from it."""
    tilt: float = 8.0
    """Degrees that the second camera looks down."""


PAIRS = {
    "walk, arm hidden": Pair(Take("cmu_walk/07_08.bvh", 80.0, 10, 70, 3.4)),
    "walk, rotated by 360": Pair(Take("cmu_walk/07_08.bvh", 40.0, 10, 70, 3.8, spin=155.0)),
    "kick, side": Pair(Take("HDM_bk_kickLFront1Reps_010", 80.0)),
    "crossed arms, side": Pair(Take("HDM_bk_squat1Reps_020", -60.0, crossed=True), -90.0),
    "sneak, from behind": Pair(Take("HDM_dg_sneak2StepsLStart_009", 180.0), 120.0),
    "run in a circle": Pair(Take("HDM_bk_jogLeftCircle4StepsRstart_005", n_frames=56), 100.0),
}
"""Clips of `depth_extra_sequences` in which limbs are hidden from the first camera."""
TUNED_PAIRS = {
    "walk, side": Pair(Take("cmu_walk/26_01.bvh", 90.0, 5, 60)),
    "walk, away": Pair(Take("cmu_walk/06_01.bvh", -135.0, 5, 60), 80.0),
    "sneak, side": Pair(Take("HDM_bd_sneak2StepsLStart_001", 80.0)),
    "elbow to knee": Pair(Take("HDM_bd_elbowToKnee1RepsLelbowStart_001", 20.0, spin=120.0)),
}
"""Other clips, by which the fusion was developed."""


class CameraPair(NamedTuple):
    """Two recordings of one motion."""

    first: Sequence
    second: Sequence
    camera_from_first: np.ndarray
    """True transform from the frame of the first camera to that of the second, (4, 4)."""
    offset: float
    """True time of the first camera at which the second begins, seconds."""


@cache
def camera_pair(name: str) -> CameraPair:
    """Return one of the pairs, from the cache or rendered now."""
    pair = (PAIRS | TUNED_PAIRS)[name]
    key = sha1(repr((pair, SHAPES, KINECT, DELAY_STEPS)).encode()).hexdigest()[:8]
    names = [f"{name} {key} camera {number}" for number in (1, 2)]
    if not all((BUILD / f"{each}.npz").exists() for each in names):
        BUILD.mkdir(parents=True, exist_ok=True)
        for each, arrays in zip(names, _render(name, pair), strict=True):
            np.savez_compressed(BUILD / f"{each}.npz", **arrays)
    first, second = (sequence(each, BUILD) for each in names)
    return CameraPair(first, second, second_camera(pair), OFFSET_S)


def second_camera(pair: Pair) -> np.ndarray:
    """Return the transform (4, 4) from the frame of the first camera to the second."""
    turn, tilt = np.radians(pair.angle), np.radians(pair.tilt)
    about_y = np.array([
        [np.cos(turn), 0.0, -np.sin(turn)],
        [0.0, 1.0, 0.0],
        [np.sin(turn), 0.0, np.cos(turn)],
    ])
    down = np.array([
        [1.0, 0.0, 0.0],
        [0.0, np.cos(tilt), -np.sin(tilt)],
        [0.0, np.sin(tilt), np.cos(tilt)],
    ])
    transform = np.eye(4)
    transform[:3, :3] = down @ about_y
    middle = np.array([0.1, 0.0, pair.distance])
    transform[:3, 3] = middle - transform[:3, :3] @ view_center(pair.take)
    return transform


def _render(name: str, pair: Pair) -> list[dict[str, object]]:
    number = [*PAIRS, *TUNED_PAIRS].index(name)
    body = vary_body(all_bodies(), np.random.default_rng((17, number)), SHAPES)
    rng = np.random.default_rng((18, number))
    scenes = _scenes(body, pair.take)
    transform = second_camera(pair)
    identity = np.eye(4)
    return [
        _recorded(body, scenes[first::STEPS], camera, rng)
        for first, camera in ((0, identity), (DELAY_STEPS, transform))
    ]


def _scenes(body: SkinnedBody, take: Take) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return vertices and joints in the frame of the first camera, in steps."""
    motion, rotations = before_camera(body, take)
    fine = resample(motion, RATE_HZ * STEPS)
    headings = quaternion_from_matrix(rotations)
    scenes = []
    for step in range(fine.n_frames):
        before = min(step // STEPS, len(headings) - 2)
        heading = slerp(headings[before], headings[before + 1], step / STEPS - before)
        vertices, joints = (
            points @ matrix_from_quaternion(heading) + view_center(take)
            for points in body.pose(fine.rotations[step], fine.root_positions[step])
        )
        scenes.append((vertices, joints))
    return scenes


def _recorded(
    body: SkinnedBody,
    scenes: list[tuple[np.ndarray, np.ndarray]],
    camera_from_first: np.ndarray,
    rng: np.random.Generator,
) -> dict[str, object]:
    rotation, shift = camera_from_first[:3, :3], camera_from_first[:3, 3]
    images, joints = [], []
    for vertices, true_joints in scenes:
        moved = vertices @ rotation.T + shift
        exact = render_mesh(moved, body.triangles, body.vertex_parts, KINECT)
        noisy = add_sensor_noise(exact, KINECT, rng)
        images.append((1000.0 * noisy.depth).round().astype(np.uint16))
        joints.append(true_joints @ rotation.T + shift)
    return {
        "depth": np.array(images), "joints": np.array(joints), "frame_rate": RATE_HZ,
        "joint_names": np.array(body.skeleton.names),
        "fx": KINECT.fx, "fy": KINECT.fy, "cx": KINECT.cx, "cy": KINECT.cy,
    }  # fmt: skip
