"""Frames of depth/truth with the part that each pixel sees, and images of held-out clips.

The takes were rendered by other code from bodies and clips that we have, so that the same
bodies in the same poses, laid over the true joints, tell the parts.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.forest.depth_differences import BACKGROUND_MM, MM_PER_M
from solvers.depth_tracking.forest_training.render_mesh import NO_PART, render_mesh
from solvers.depth_tracking.forest_training.skinned_body import SkinnedBody, load_skinned_body
from solvers.depth_tracking.forest_training.train_forest import draw_images
from solvers.depth_tracking.forest_training.training_images import (
    CAMERA,
    TrainingImagesSettings,
    image_source,
)
from solvers.recordings import read_bvh

from .forest_sources import CMU_METERS, DATA, TRUTH, all_bodies, held_out_motions

SAME_DEPTH = 0.08
"""Difference of both renderings in meters above which a pixel has no label."""
CMU_JOINTS = {
    "hips": "Hips", "spine": "LowerBack", "chest": "Spine", "neck": "Neck", "head": "Head",
    "UpperArm": "Arm", "LowerArm": "ForeArm", "Hand": "Hand",
    "UpperLeg": "UpLeg", "LowerLeg": "Leg", "Foot": "Foot", "Toes": "ToeBase",
}  # fmt: skip
"""Joints of the body model and those of the truth; clavicles differ and are left out."""


class LabeledFrame(NamedTuple):
    """One picture and what is true in it."""

    take: str
    frame: int
    camera: Camera
    depth: NDArray[np.float32]
    labels: NDArray[np.uint8]
    """Index in `PARTS`, or `NOTHING` where the part is unknown."""
    joints: Array
    """The `JOINTS` of the body model; NaN where the truth has no such joint."""


def truth_frames(take: str, every: int = 1, step: int = 2) -> Iterator[LabeledFrame]:
    """Yield frames of a take at a constant step, every `step`-th column and row of it."""
    body, laid = truth_bodies(take, every)
    with np.load(DATA / "depth" / "truth" / f"{take}.npz") as archive:
        truth = {name: np.array(archive[name]) for name in archive.files}
    n_rows, n_columns = truth["depth"].shape[1:]
    fx, fy, cx, cy = (float(truth[name]) for name in ("fx", "fy", "cx", "cy"))
    camera = Camera(fx, fy, cx, cy, n_columns, n_rows).every(step)
    for frame, vertices in laid:
        depth = (truth["depth"][frame, ::step, ::step] / MM_PER_M).astype(np.float32)
        joints = truth["joints"][frame].astype(float)
        rendered = render_mesh(vertices, body.triangles, body.vertex_parts, camera)
        same = (rendered.depth > 0.0) & (np.abs(rendered.depth - depth) < SAME_DEPTH)
        labels = np.where(same, rendered.labels, np.uint8(NO_PART))
        yield LabeledFrame(
            take, frame, camera, depth, labels, _ours(truth["joint_names"].tolist(), joints)
        )


def truth_bodies(take: str, every: int = 1) -> tuple[SkinnedBody, Iterator[tuple[int, Array]]]:
    """Return the body of a take, and frames with its vertices there, camera frame, meters."""
    clip, first, body_name = TRUTH[take]
    body = load_skinned_body(DATA / "body" / f"{body_name}.npz")
    poses = body.rotations_of(read_bvh(DATA / "mocap" / clip, scale=CMU_METERS))
    with np.load(DATA / "depth" / "truth" / f"{take}.npz") as archive:
        truth = archive["joints"].astype(float)

    def laid() -> Iterator[tuple[int, Array]]:
        for frame in range(0, len(truth), every):
            vertices, joints = body.pose(poses[first + 4 * frame], np.zeros(3))
            rotation, shift = _laid_over(joints, truth[frame])
            yield frame, vertices @ rotation + shift

    return body, laid()


def held_out_frames(n_blocks: int = 30, loose: float = 0.0) -> Iterator[LabeledFrame]:
    """Yield pictures of HDM05's actors, whom no forest here has learned from."""
    settings = TrainingImagesSettings(loose=loose, min_distance=2.0, max_distance=4.0)
    source = image_source(held_out_motions(), all_bodies(), settings, 5)
    rendered = draw_images(source, range(n_blocks))
    for number, (picture, labels) in enumerate(zip(*rendered, strict=True)):
        inner = picture[1:-1, 1:-1]
        depth = (np.where(inner == BACKGROUND_MM, 0, inner) / MM_PER_M).astype(np.float32)
        unknown = np.full((len(JOINTS), 3), np.nan)
        yield LabeledFrame("HDM05", number, CAMERA, depth, labels, unknown)


def _ours(names: list[str], joints: Array) -> Array:
    found = np.full((len(JOINTS), 3), np.nan)
    for index, joint in enumerate(JOINTS):
        side = next((side for side in ("left", "right") if joint.startswith(side)), "")
        name = side.capitalize() + CMU_JOINTS.get(joint.removeprefix(side), "-")
        if name in names:
            found[index] = joints[names.index(name)]
    return found


def _laid_over(points: Array, onto: Array) -> tuple[Array, Array]:
    """Return rotation and shift of the rigid fit to other points: points @ rotation + shift."""
    start, stop = points.mean(axis=0), onto.mean(axis=0)
    left, _, right = np.linalg.svd((points - start).T @ (onto - stop))
    rotation = left @ np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))]) @ right
    return rotation, stop - start @ rotation
