"""More depth sequences with true joints: other bodies, views and movements than depth/truth.

Rendered by us, with our noise, on first use, and cached in build/. Nothing
was learned from these clips, nor tuned on them: the forest knows no clip of HDM05 and none of
the walkers 07 and 35; weights were chosen on other takes (the first of a kind of each actor).
No actor of HDM05 crosses the arms or sits on a chair: there, limbs are moved by IK.
"""

from dataclasses import replace
from functools import cache
from hashlib import sha1
from pathlib import Path
from typing import NamedTuple

import numpy as np

from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.forest_training.render_mesh import render_mesh
from solvers.depth_tracking.forest_training.sensor_noise import add_sensor_noise
from solvers.depth_tracking.forest_training.skinned_body import SkinnedBody
from solvers.depth_tracking.forest_training.training_images import (
    TrainingImagesSettings,
    vary_body,
)
from solvers.motion import Motion, Skeleton, find_humanoid_map, forward_kinematics, resample
from solvers.motion.skeletons.limb_ik import reach
from solvers.recordings import read_acclaim, read_bvh

from .depth_sequences import Sequence, sequence
from .forest_sources import CMU_METERS, DATA, all_bodies

KINECT = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)
SHAPES = TrainingImagesSettings(shape=0.05, clothes=0.02)
RATE_HZ = 30.0
BUILD = Path(__file__).resolve().parents[3] / "build" / "depth_more"
SEAT, BEHIND = 0.5, 0.4
"""Meters of a seated pelvis above the feet, and behind them."""
CROSSING_FRAMES = 20
"""Frames in which arms are crossed."""


class Take(NamedTuple):
    """A piece of a clip before a camera."""

    clip: str
    yaw: float = 0.0
    """Heading of the actor relative to the camera in the middle frame, degrees to the left."""
    first: int = 0
    """Frame at 30 Hz."""
    n_frames: int = 80
    distance: float = 3.0
    """Distance from the camera to the middle of the path, meters."""
    tilt: float = 0.0
    """Degrees that the camera looks down, from as much higher."""
    spin: float = 0.0
    """Added rotation of the actor, degrees per second."""
    crossed: bool = False
    seated: bool = False


TAKES = {
    "run in a circle": Take("HDM_bk_jogLeftCircle4StepsRstart_005", n_frames=56),
    "run past": Take("cmu_walk/35_22.bvh", 80.0, 3, 33, distance=3.5),
    "kick": Take("HDM_dg_kickLFront1Reps_014", 30.0),
    "kick, side": Take("HDM_bk_kickLFront1Reps_010", 80.0),
    "jump": Take("HDM_dg_hopBothLegs1hops_025", -30.0),
    "squat": Take("HDM_dg_squat1Reps_030", 20.0),
    "arm circles": Take("HDM_bk_rotateArmsBothBackward1Reps_006", 30.0),
    "elbow to knee": Take("HDM_bk_elbowToKnee1RepsLelbowStart_009", -20.0),
    "throw": Take("HDM_dg_throwBasketball_008", -45.0),
    "deposit": Take("HDM_dg_depositFloorR_016", 60.0),
    "lie down": Take("HDM_bk_lieDownFloor_008", 40.0),
    "grab, from above": Take("HDM_bk_grabHighR_007", 10.0, tilt=35.0),
    "sneak, from behind": Take("HDM_dg_sneak2StepsLStart_009", 180.0),
    "walk, near": Take("cmu_walk/07_10.bvh", 60.0, 24, 32, distance=2.2),
    "walk, far": Take("cmu_walk/35_30.bvh", 45.0, 10, 60, distance=4.5),
    "arm circles, rotated by 360": Take("HDM_dg_rotateArmsBothBackward1Reps_010", spin=135.0),
    "walk, rotated by 360": Take("cmu_walk/07_08.bvh", 40.0, 10, 70, 3.8, spin=155.0),
    "crossed arms": Take("HDM_dg_squat1Reps_033", 10.0, crossed=True),
    "crossed arms, side": Take("HDM_bk_squat1Reps_020", -60.0, crossed=True),
    "seated": Take("HDM_dg_throwBasketball_009", 0.0, seated=True),
    "seated, side": Take("HDM_bk_rotateArmsBothBackward1Reps_008", 50.0, seated=True),
}


@cache
def more_sequence(name: str) -> Sequence:
    """Return one of `TAKES`, from the cache or rendered now."""
    key = sha1(repr((TAKES[name], SHAPES, KINECT)).encode()).hexdigest()[:8]
    file_name = f"{name} {key}"
    if not (BUILD / f"{file_name}.npz").exists():
        BUILD.mkdir(parents=True, exist_ok=True)
        np.savez_compressed(BUILD / f"{file_name}.npz", **_render(name))
    drawn = sequence(file_name, BUILD)
    return Sequence(name, drawn.depth, drawn.joints)


def posed(body: SkinnedBody, take: Take) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return vertices and joints of each picture in the camera's frame, meters."""
    motion, rotations = before_camera(body, take)
    found = []
    for pose, root, rotation in zip(
        motion.rotations, motion.root_positions, rotations, strict=True
    ):
        vertices, joints = (
            points @ rotation + view_center(take) for points in body.pose(pose, root)
        )
        found.append((vertices, joints))
    return found


def before_camera(body: SkinnedBody, take: Take) -> tuple[Motion, np.ndarray]:
    """Return the motion about its middle, and the rotations (n_frames, 3, 3).

    A point of the world is at point @ rotation + view_center(take) in the camera frame.
    """
    motion = _moved(body, take)
    tilt = np.radians(take.tilt)
    down = np.array([
        [1.0, 0.0, 0.0],
        [0.0, np.sin(tilt), np.cos(tilt)],
        [0.0, -np.cos(tilt), np.sin(tilt)],
    ])  # fmt: skip
    rotations = np.array([_yaw_matrix(heading) @ down for heading in _headings(motion, take)])
    middle = motion.root_positions.mean(axis=0)
    return replace(motion, root_positions=motion.root_positions - middle), rotations


def view_center(take: Take) -> np.ndarray:
    """Return the position of the middle of the path in the camera frame."""
    return np.array([0.0, 0.05, take.distance])


def body_of(name: str) -> SkinnedBody:
    """Return the body of a take: a random blend of the four of data/body."""
    rng = np.random.default_rng((7, list(TAKES).index(name)))
    return vary_body(all_bodies(), rng, SHAPES)


def _render(name: str) -> dict[str, object]:
    body, rng = body_of(name), np.random.default_rng((8, list(TAKES).index(name)))
    pictures, joints = [], []
    for vertices, true_joints in posed(body, TAKES[name]):
        exact = render_mesh(vertices, body.triangles, body.vertex_parts, KINECT)
        noisy = add_sensor_noise(exact, KINECT, rng)
        pictures.append((1000.0 * noisy.depth).round().astype(np.uint16))
        joints.append(true_joints)
    return {
        "depth": np.array(pictures), "joints": np.array(joints), "frame_rate": RATE_HZ,
        "joint_names": np.array(body.skeleton.names),
        "fx": KINECT.fx, "fy": KINECT.fy, "cx": KINECT.cx, "cy": KINECT.cy,
    }  # fmt: skip


def _moved(body: SkinnedBody, take: Take) -> Motion:
    """Return the piece of the clip, moved by the body."""
    clip = resample(_clip(take.clip), RATE_HZ)
    clip = clip.slice(take.first, min(clip.n_frames, take.first + take.n_frames))
    theirs = find_humanoid_map(clip.skeleton).indices(clip.skeleton)
    ours = body.humanoid.indices(body.skeleton)
    scale = _leg(body.skeleton, ours) / _leg(clip.skeleton, theirs)
    roots = clip.root_positions * scale
    motion = Motion(body.skeleton, body.rotations_of(clip), roots, RATE_HZ)
    if take.seated:
        motion = _seated(body, motion)
    return _crossed(body, motion) if take.crossed else motion


def _leg(skeleton: Skeleton, indices: dict[str, int]) -> float:
    bones = [indices["leftLowerLeg"], indices["leftFoot"]]
    return float(np.linalg.norm(skeleton.offsets[bones], axis=1).sum())


def _seated(body: SkinnedBody, motion: Motion) -> Motion:
    """Sit down: the pelvis on a chair all the time, feet on the floor before it."""
    indices = body.humanoid.indices(body.skeleton)
    ahead = _ahead(motion, indices)
    low = motion.root_positions.copy()
    joints = forward_kinematics(motion).positions
    feet = {side: joints[:, indices[f"{side}Foot"]] for side in ("left", "right")}
    floor = min(foot[:, 2].min() for foot in feet.values())
    low[:, 2] += floor + SEAT - joints[:, indices["hips"], 2]
    sitting = replace(motion, root_positions=low)
    hips = forward_kinematics(sitting).positions
    for side in feet:
        limb = tuple(indices[f"{side}{bone}"] for bone in ("UpperLeg", "LowerLeg", "Foot"))
        target = hips[:, limb[0]] + BEHIND * ahead
        target[:, 2] = floor
        sitting = reach(sitting, limb, target)
    return sitting


def _crossed(body: SkinnedBody, motion: Motion) -> Motion:
    """Cross the arms before the chest, the right one outside."""
    indices = body.humanoid.indices(body.skeleton)
    ahead = _ahead(motion, indices)
    weight = np.clip(np.arange(motion.n_frames) / CROSSING_FRAMES, 0.0, 1.0)[:, np.newaxis]
    for side, other, out in (("left", "right", 0.14), ("right", "left", 0.2)):
        joints = forward_kinematics(motion).positions
        limb = tuple(indices[f"{side}{bone}"] for bone in ("UpperArm", "LowerArm", "Hand"))
        across = joints[:, indices[f"{other}UpperArm"]] - joints[:, limb[0]]
        target = joints[:, limb[0]] + 0.75 * across + out * ahead - [0.0, 0.0, 0.22]
        target = (1.0 - weight) * joints[:, limb[2]] + weight * target
        motion = reach(motion, limb, target)
    return motion


def _ahead(motion: Motion, indices: dict[str, int]) -> np.ndarray:
    """Return where the body faces in each frame, level, shape (n_frames, 3)."""
    joints = forward_kinematics(motion).positions
    across = joints[:, indices["leftUpperLeg"]] - joints[:, indices["rightUpperLeg"]]
    ahead = np.stack([across[:, 1], -across[:, 0], 0.0 * across[:, 0]], axis=1)
    return ahead / np.linalg.norm(ahead, axis=1, keepdims=True)


def _headings(motion: Motion, take: Take) -> np.ndarray:
    """Return the rotation of the world about the vertical in each frame, radians."""
    left = motion.skeleton.names.index("LeftUpLeg")
    right = motion.skeleton.names.index("RightUpLeg")
    middle = motion.n_frames // 2
    joints = forward_kinematics(motion).positions[middle]
    across = joints[left] - joints[right]
    still = np.radians(take.yaw) - np.arctan2(across[1], across[0])
    return still + np.radians(take.spin) * (np.arange(motion.n_frames) - middle) / RATE_HZ


def _yaw_matrix(angle: float) -> np.ndarray:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _clip(name: str) -> Motion:
    if name.endswith(".bvh"):
        return read_bvh(DATA / "mocap" / name, scale=CMU_METERS)
    folder = DATA / "mocap" / "hdm05"
    return read_acclaim(folder / f"{name}_120.amc", folder / f"{name[:6]}.asf")
