"""Depth sequences of two actors with true joints, rendered by us with the noise of a Kinect.

Bodies and clips are those of `depth_extra_sequences`: nothing was learned from them. What was
chosen by hand for several people was chosen on `TUNED_ON`, of other clips.
"""

from dataclasses import dataclass
from functools import cache
from hashlib import sha1
from pathlib import Path
from typing import NamedTuple

import numpy as np

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import BodyModel, default_body
from solvers.depth_tracking.body.pose_from_joints import body_from_joints
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.forest_training.render_mesh import RenderedMesh, render_mesh
from solvers.depth_tracking.forest_training.sensor_noise import add_sensor_noise
from solvers.depth_tracking.forest_training.skinned_body import SkinnedBody
from solvers.depth_tracking.forest_training.training_images import vary_body
from solvers.motion import Motion, forward_kinematics
from solvers.motion.skeletons.limb_ik import reach

from ..depth_extra_sequences import KINECT, RATE_HZ, SHAPES, Take, before_camera
from ..depth_sequences import CMU_NAMES
from ..forest_sources import all_bodies

BUILD = Path(__file__).resolve().parents[4] / "build" / "depth_people"
CAMERA_HEIGHT_M = 1.0
"""Height of the camera above the floor on which both stand."""
MIN_PIXELS = 150
"""Pixels from which on a person is visible: a twentieth of a body at 3 m."""
SHAKE_M, SHAKE_HZ = 0.06, 2.0
"""How far joined hands move up and down, and how often."""
FREE_FRAMES, REACHING_FRAMES = 10, 12
"""Frames before and after in which hands are apart, and in which they approach."""


class Placed(NamedTuple):
    """An actor before the camera."""

    take: Take
    right: float
    """Of the middle of the path, meters to the right of the camera's axis."""


class Scene(NamedTuple):
    """Two actors before one camera."""

    actors: tuple[Placed, Placed]
    shaking: bool = False
    """Whether the right hands meet."""


SCENES = {
    "side by side": Scene((
        Placed(Take("HDM_dg_squat1Reps_030", 20.0, distance=3.2), -0.6),
        Placed(Take("HDM_bk_kickLFront1Reps_010", -20.0, distance=3.2), 0.6),
    )),
    "crossing": Scene((
        Placed(Take("cmu_walk/07_10.bvh", 90.0, 5, 70, distance=2.8), 0.0),
        Placed(Take("cmu_walk/35_30.bvh", -90.0, 15, 70, distance=3.7), 0.0),
    )),
    "shaking hands": Scene((
        Placed(Take("HDM_dg_throwBasketball_008", 75.0, 0, 65, 3.0), -0.45),
        Placed(Take("HDM_bk_grabHighR_007", -75.0, 0, 65, 3.0), 0.45),
    ), shaking=True),
    "entering behind": Scene((
        Placed(Take("HDM_dg_depositFloorR_016", 10.0, 0, 90, 2.9), 0.0),
        Placed(Take("cmu_walk/07_08.bvh", 90.0, 0, 90, 3.9), -1.2),
    )),
}  # fmt: skip
"""Sequences of the tables."""
TUNED_ON = {
    "side by side": Scene((
        Placed(Take("HDM_bd_squat1Reps_004", 20.0, distance=3.2), -0.55),
        Placed(Take("HDM_bd_elbowToKnee1RepsLelbowStart_004", -30.0, distance=3.3), 0.55),
    )),
    "crossing": Scene((
        Placed(Take("cmu_walk/05_01.bvh", 90.0, 40, 70, distance=2.8), 0.0),
        Placed(Take("cmu_walk/32_01.bvh", -90.0, 20, 70, distance=3.6), 0.0),
    )),
    "shaking hands": Scene((
        Placed(Take("HDM_bd_throwBasketball_001", 75.0, 0, 65, 3.0), -0.45),
        Placed(Take("HDM_bd_grabHighR_001", -75.0, 0, 65, 3.0), 0.45),
    ), shaking=True),
    "entering behind": Scene((
        Placed(Take("HDM_bd_depositFloorR_003", 10.0, 0, 80, 2.9), 0.0),
        Placed(Take("cmu_walk/06_01.bvh", 90.0, 10, 80, 3.9), -1.0),
    )),
}  # fmt: skip
"""Sequences for the choice of constants."""


@dataclass(frozen=True, eq=False)
class PeopleSequence:
    """A depth recording of two skinned bodies, and where their joints were."""

    name: str
    depth: DepthRecording
    joints: np.ndarray
    """Shape (n_people, n_frames, 21, 3), meters, camera frame, in the order of `JOINTS`."""
    pixels: np.ndarray
    """Visible pixels of each person, shape (n_people, n_frames)."""

    @property
    def visible(self) -> np.ndarray:
        """Frames in which each person is visible, shape (n_people, n_frames)."""
        return self.pixels >= MIN_PIXELS

    def body(self, person: int) -> BodyModel:
        """Lengths from the true joints; other proportions and radii of the default body."""
        adult = default_body()
        measured = body_from_joints(adult, self.joints[person])
        factor = float(np.median(measured.lengths / adult.lengths))
        return body_from_joints(adult.scaled(factor), self.joints[person])


@cache
def people_sequence(name: str, *, tuning: bool = False) -> PeopleSequence:
    """Return one of `SCENES` or `TUNED_ON`, from the cache or rendered now."""
    scenes = TUNED_ON if tuning else SCENES
    key = sha1(repr((scenes[name], SHAPES, KINECT, CAMERA_HEIGHT_M)).encode()).hexdigest()[:8]
    path = BUILD / f"{name} {key}.npz"
    if not path.exists():
        BUILD.mkdir(parents=True, exist_ok=True)
        seed = (13, int(tuning), list(scenes).index(name))
        np.savez_compressed(path, **_render(scenes[name], np.random.default_rng(seed)))
    with np.load(path) as archive:
        depth, joints, pixels = (archive[key] for key in ("depth", "joints", "pixels"))
    recording = DepthRecording(
        KINECT, len(depth), RATE_HZ,
        lambda frame: depth[frame].astype(np.float32) / np.float32(1000.0),
    )  # fmt: skip
    return PeopleSequence(name, recording, joints, pixels)


def _render(scene: Scene, rng: np.random.Generator) -> dict[str, np.ndarray]:
    bodies = [vary_body(all_bodies(), rng, SHAPES) for _ in scene.actors]
    played = _before_camera(scene, bodies)
    n_frames = min(len(vertices) for vertices, _ in played)
    images, pixels = [], np.zeros((len(bodies), n_frames), dtype=int)
    for frame in range(n_frames):
        rendered = [
            render_mesh(vertices[frame], body.triangles, body.vertex_parts, KINECT)
            for body, (vertices, _) in zip(bodies, played, strict=True)
        ]
        depths = np.array([np.where(one.depth > 0.0, one.depth, np.inf) for one in rendered])
        nearest = depths.argmin(axis=0)
        depth = depths.min(axis=0)
        for person in range(len(bodies)):
            pixels[person, frame] = (np.isfinite(depth) & (nearest == person)).sum()
        depth = np.where(np.isfinite(depth), depth, 0.0).astype(np.float32)
        labels = np.where(depth > 0.0, nearest, 255).astype(np.uint8)
        noisy = add_sensor_noise(RenderedMesh(depth, labels), KINECT, rng)
        images.append((1000.0 * noisy.depth).round().astype(np.uint16))
    joints = np.array([found[:n_frames] for _, found in played])
    return {"depth": np.array(images), "joints": joints, "pixels": pixels}


def _before_camera(
    scene: Scene, bodies: list[SkinnedBody]
) -> list[tuple[list[np.ndarray], np.ndarray]]:
    """Return the vertices and joints of each actor in the camera frame, on one floor."""
    motions, rotations, centers = [], [], []
    for body, (take, right) in zip(bodies, scene.actors, strict=True):
        motion, rotation = before_camera(body, take)
        lowest = forward_kinematics(motion).positions[..., 2].min()
        motions.append(motion)
        rotations.append(rotation)
        centers.append(np.array([right, CAMERA_HEIGHT_M + lowest, take.distance]))
    n_frames = min(motion.n_frames for motion in motions)
    motions = [motion.slice(0, n_frames) for motion in motions]
    if scene.shaking:
        motions = _joined_hands(motions, rotations, centers)
    played = []
    for body, motion, rotation, center in zip(bodies, motions, rotations, centers, strict=True):
        indices = [body.skeleton.names.index(CMU_NAMES[role]) for role in JOINTS]
        vertices, joints = [], []
        for pose, root, turned in zip(
            motion.rotations, motion.root_positions, rotation, strict=False
        ):
            points, bones = body.pose(pose, root)
            vertices.append(points @ turned + center)
            joints.append(bones[indices] @ turned + center)
        played.append((vertices, np.array(joints)))
    return played


def _joined_hands(
    motions: list[Motion], rotations: list[np.ndarray], centers: list[np.ndarray]
) -> list[Motion]:
    """Move the right hands to a point between the chests, up and down."""
    n_frames = motions[0].n_frames
    chests, joined = [], []
    for motion, rotation, center in zip(motions, rotations, centers, strict=True):
        chest = motion.skeleton.names.index(CMU_NAMES["chest"])
        positions = forward_kinematics(motion).positions[:, chest]
        chests.append(np.einsum("fi,fij->fj", positions, rotation[:n_frames]) + center)
    target = np.mean(chests, axis=0)
    frames = np.arange(n_frames)
    from_ends = np.minimum(frames, n_frames - 1 - frames) - FREE_FRAMES
    weight = np.clip(from_ends / REACHING_FRAMES, 0.0, 1.0)[:, np.newaxis]
    phase = 2.0 * np.pi * SHAKE_HZ * frames / RATE_HZ
    target[:, 1] += SHAKE_M * np.sin(phase)
    for motion, rotation, center in zip(motions, rotations, centers, strict=True):
        limb = tuple(
            motion.skeleton.names.index(f"Right{bone}") for bone in ("Arm", "ForeArm", "Hand")
        )
        own = np.einsum("fj,fij->fi", target - center, rotation[:n_frames])
        hand = forward_kinematics(motion).positions[:, limb[2]]
        joined.append(reach(motion, limb, (1.0 - weight) * hand + weight * own))
    return joined
