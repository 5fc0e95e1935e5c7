"""Depth of a skinned body as Blender's Cycles sees it, to hold against our own renderer."""

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.forest_training.render_mesh import render_mesh
from solvers.depth_tracking.forest_training.skinned_body import SkinnedBody
from solvers.motion import Motion

SCRIPT = Path(__file__).with_name("render_in_blender.py")


class Difference(NamedTuple):
    """Differences between two depth images."""

    millimeters: np.ndarray
    """Absolute difference of each pixel that both see."""
    covered: float
    """Fraction of the pixels of either image that only one has."""


def blender_depth(
    body: SkinnedBody,
    motion: Motion,
    rotations: np.ndarray,
    position: np.ndarray,
    camera: Camera,
) -> np.ndarray:
    """Return pictures (n_frames, height, width), meters, 0: nothing.

    Points are seen at points @ rotation + position.
    """
    skeleton = body.skeleton
    scene = {
        "vertices": body.vertices, "triangles": body.triangles, "weights": body.weights,
        "names": np.array(skeleton.names), "parents": np.array(skeleton.parents),
        "heads": skeleton.rest_positions, "rotations": motion.rotations,
        "roots": motion.root_positions, "view_rotations": rotations, "view_position": position,
        "camera": np.array(
            [camera.fx, camera.fy, camera.cx, camera.cy, camera.width, camera.height]
        ),
    }  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "scene.npz", Path(folder) / "depth.npz"
        np.savez(source, **scene)
        command = [sys.executable, SCRIPT, source, target]
        subprocess.run(command, check=True, capture_output=True, timeout=600)
        with np.load(target) as found:
            return found["depth"]


def our_depth(
    body: SkinnedBody,
    motion: Motion,
    rotations: np.ndarray,
    position: np.ndarray,
    camera: Camera,
) -> np.ndarray:
    """Return the same pictures by our skinning and z-buffer."""
    pictures = []
    for pose, root, rotation in zip(
        motion.rotations, motion.root_positions, rotations, strict=True
    ):
        vertices = body.pose(pose, root)[0] @ rotation + position
        rendered = render_mesh(vertices, body.triangles, body.vertex_parts, camera)
        pictures.append(rendered.depth)
    return np.array(pictures)


def difference(ours: np.ndarray, others: np.ndarray) -> Difference:
    """Compare pictures of one size."""
    both, either = (ours > 0.0) & (others > 0.0), (ours > 0.0) | (others > 0.0)
    millimeters = 1000.0 * np.abs(ours - others)[both]
    return Difference(millimeters, 1.0 - both.sum() / either.sum())
