"""Depth sequences on which the tracker is tuned: other clips than those of depth/truth.

Skinned bodies, random blends of the four of data/body, drawn by our own renderer with our own
noise. No clip of depth/truth is among them, nor any of its walkers.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.forest_training.render_mesh import RenderedMesh
from solvers.depth_tracking.forest_training.sensor_noise import add_sensor_noise
from solvers.depth_tracking.forest_training.skinned_body import SkinnedBody
from solvers.depth_tracking.forest_training.training_images import (
    TrainingImagesSettings,
    vary_body,
)
from solvers.motion import Motion
from solvers.recordings import read_acclaim, read_bvh

from .depth_sequences import CMU_NAMES, Sequence
from .forest_sources import CMU_METERS, DATA, all_bodies
from .painted_bodies import ColoredPicture, colored_picture, vertex_materials

KINECT = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)
SHAPES = TrainingImagesSettings(shape=0.05, clothes=0.02)


class Take(NamedTuple):
    """A piece of a clip before a level camera."""

    clip: str
    first: int
    """First frame of the clip."""
    yaw: float
    """Heading of the actor relative to the camera in the middle frame, degrees to its left."""
    step: int = 4
    """Frames of the clip per picture: 4 of 120 make 30 per second."""
    n_frames: int = 60
    distance: float = 3.0
    """Distance to the middle of the path, meters."""


TAKES = {
    "walk, front": Take("cmu_walk/10_04.bvh", 20, 0.0),
    "walk, side": Take("cmu_walk/26_01.bvh", 20, 90.0),
    "walk, diagonal": Take("cmu_walk/27_01.bvh", 20, 45.0),
    "walk, other side": Take("cmu_walk/29_01.bvh", 20, -90.0),
    "walk, from behind": Take("cmu_walk/32_01.bvh", 20, 180.0),
    "walk, away": Take("cmu_walk/06_01.bvh", 20, -135.0),
    "walk, hurried": Take("cmu_walk/32_02.bvh", 20, 60.0, 8, 30),
    "hop": Take("cmu_hop/49_04.bvh", 2, 30.0),
    "jumping jack": Take("cmu_jumping_jack/13_29.amc", 400, 15.0),
    "dance": Take("05_13.amc", 200, 0.0),
    "kick": Take("hdm05/HDM_bd_kickLFront1Reps_001_120.amc", 0, 40.0),
    "jog in a circle": Take(
        "hdm05/HDM_bd_jogLeftCircle4StepsRstart_001_120.amc", 0, 0.0, distance=4.2
    ),
    "squat": Take("hdm05/HDM_bd_squat1Reps_001_120.amc", 0, 20.0),
    "elbow to knee": Take("hdm05/HDM_bd_elbowToKnee1RepsLelbowStart_001_120.amc", 0, 0.0),
    "sneak, side": Take("hdm05/HDM_bd_sneak2StepsLStart_001_120.amc", 0, 80.0),
    "arms backward": Take("hdm05/HDM_bd_rotateArmsBothBackward1Reps_001_120.amc", 0, 50.0),
    "deposit": Take("hdm05/HDM_bd_depositFloorR_001_120.amc", 0, -40.0),
}  # fmt: skip
"""Walks of six actors from all around, fast legs and arms, rotations, crossed shanks, bows."""


@cache
def tuning_sequence(name: str, columns: int = 160) -> Sequence:
    """Draw one of `TAKES`, with the noise of a Kinect, and with colors."""
    take = TAKES[name]
    rng = np.random.default_rng((11, list(TAKES).index(name)))
    body = vary_body(all_bodies(), rng, SHAPES)
    camera = KINECT.every(KINECT.width // columns)
    materials = vertex_materials(body)
    pictures: list[ColoredPicture] = []
    joints = []
    indices = [body.skeleton.names.index(CMU_NAMES[role]) for role in JOINTS]
    for vertices, bones in posed(body, take):
        rendered = colored_picture(body, materials, vertices, camera, rng)
        labels = np.zeros(rendered.depth.shape, dtype=np.uint8)
        noisy = add_sensor_noise(RenderedMesh(rendered.depth, labels), camera, rng)
        pictures.append(ColoredPicture(noisy.depth, rendered.color))
        joints.append(bones[indices])
    recording = DepthRecording(
        camera, len(pictures), 120.0 / take.step,
        lambda frame: pictures[frame].depth, lambda frame: pictures[frame].color,
    )  # fmt: skip
    return Sequence(name, recording, np.array(joints))


def posed(body: SkinnedBody, take: Take) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return vertices and joints of each picture in the camera's frame."""
    motion = clip(take.clip)
    last = min(motion.n_frames, take.first + take.step * take.n_frames)
    frames = np.arange(take.first, last, take.step)
    rotations = body.rotations_of(motion.slice(take.first, last))[:: take.step]
    roots = motion.root_positions[frames]
    rotation, middle = (
        _before_camera(body, rotations[len(frames) // 2], take.yaw),
        roots.mean(0),
    )
    shift = np.array([0.0, 0.1, take.distance])
    poses = []
    for pose, root in zip(rotations, roots, strict=True):
        vertices, joints = body.pose(pose, root - middle)
        poses.append((vertices @ rotation + shift, joints @ rotation + shift))
    return poses


def clip(name: str) -> Motion:
    """Read a clip of data/mocap."""
    path = DATA / "mocap" / name
    if path.suffix == ".bvh":
        return read_bvh(path, scale=CMU_METERS)
    skeleton = DATA / "mocap" / "05.asf"
    if "HDM" in name:
        skeleton = path.with_name(f"{path.name[:6]}.asf")
    return read_acclaim(path, skeleton)


def _before_camera(body: SkinnedBody, pose: np.ndarray, yaw: float) -> np.ndarray:
    """Return the rotation (3, 3), points @ rotation, that gives the body this heading."""
    _, joints = body.pose(pose, np.zeros(3))
    names = body.skeleton.names
    across = joints[names.index("LeftUpLeg")] - joints[names.index("RightUpLeg")]
    angle = np.radians(yaw) - np.arctan2(across[1], across[0])
    cosine, sine = np.cos(angle), np.sin(angle)
    level = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return level @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
