"""Blender's own Decimate (Allowed Change), really run in Blender, at a given error of limbs.

`python -m tests.benchmarks.peers.blender_decimate IN.npz OUT.json` is the child process. Every
channel, quaternions and places, is an F-Curve of its own; all are selected and decimated with
one margin, which is found by bisection so that no joint is off by more than asked.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from solvers.motion import Motion, forward_kinematics
from solvers.motion.rotations import IDENTITY, normalize, unroll
from solvers.retargeting.judged_points import find_judged_points

from .blender_graph import _graph_editor, _write

Array = NDArray[np.float64]
TIMEOUT = 3600.0
HALVINGS = 9
WIDEST = 0.3
"""Margin of a channel, beyond which no one would decimate."""


def decimate_in_blender(motion: Motion, tolerances: Sequence[float]) -> list[dict[str, float]]:
    """Return for each tolerance in metres: keys, error in metres, seconds of the last run."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.npz", Path(folder) / "out.json"
        np.savez(
            source,
            names=np.array(motion.skeleton.names),
            parents=np.array(motion.skeleton.parents),
            offsets=motion.skeleton.offsets,
            rotations=motion.rotations,
            places=motion.root_positions,
            frame_rate=motion.frame_rate,
            tolerances=np.array(tolerances),
        )
        done = subprocess.run(
            [sys.executable, "-m", "tests.benchmarks.peers.blender_decimate", source, target],
            env={**os.environ, "BLENDER_USER_RESOURCES": folder},
            timeout=TIMEOUT,
            capture_output=True,
            text=True,
        )
        if done.returncode or not target.exists():
            raise RuntimeError(f"Blender failed: {done.stdout[-2000:]} {done.stderr[-2000:]}")
        return list(json.loads(target.read_text(encoding="utf-8")))


def _child(source: str, target: str) -> None:
    import bpy

    from solvers.motion import Skeleton

    with np.load(source) as given:
        skeleton = Skeleton(
            tuple(given["names"].tolist()), tuple(given["parents"]), given["offsets"]
        )
        motion = Motion(
            skeleton, given["rotations"], given["places"], float(given["frame_rate"])
        )
        tolerances = given["tolerances"].tolist()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    found = [_bisected(bpy, motion, tolerance) for tolerance in tolerances]
    Path(target).write_text(json.dumps(found), encoding="utf-8")


def _bisected(bpy: Any, motion: Motion, tolerance: float) -> dict[str, float]:
    """Return the figures of the widest margin found that keeps within the tolerance."""
    low, high = 0.0, WIDEST
    best = {"keys": float("nan"), "error": 0.0, "seconds": 0.0, "margin": 0.0}
    for _ in range(HALVINGS):
        margin = 0.5 * (low + high) if low else high / 8.0
        figures = _decimated(bpy, motion, margin)
        if figures["error"] <= tolerance:
            low, best = margin, figures
        else:
            high = margin
    return best


def _decimated(bpy: Any, motion: Motion, margin: float) -> dict[str, float]:
    moving = [
        joint
        for joint in range(motion.n_joints)
        if np.abs(motion.rotations[:, joint] - IDENTITY).max() > 1e-9
    ]
    quaternions = unroll(motion.rotations[:, moving])
    take = np.concatenate(
        [quaternions.reshape(motion.n_frames, -1), motion.root_positions], axis=1
    )
    ob = bpy.data.objects.new("take", None)
    bpy.context.scene.collection.objects.link(ob)
    curves = _write(bpy, ob, take)
    bpy.context.view_layer.objects.active = ob
    ob.select_set(True)
    start = perf_counter()
    with _graph_editor(bpy, ob):
        bpy.ops.graph.select_all(action="SELECT")
        bpy.ops.graph.decimate(mode="ERROR", remove_error_margin=margin)
    seconds = perf_counter() - start
    frames = range(motion.n_frames)
    after = np.array([[curve.evaluate(frame) for frame in frames] for curve in curves]).T
    keys = sum(len(curve.keyframe_points) for curve in curves)
    bpy.data.actions.remove(ob.animation_data.action)
    bpy.data.objects.remove(ob)
    rotations = motion.rotations.copy()
    rotations[:, moving] = normalize(after[:, :-3].reshape(motion.n_frames, -1, 4))
    error = _error(motion, motion.with_poses(rotations, after[:, -3:]))
    return {"keys": keys, "error": error, "seconds": seconds, "margin": margin}


def _error(motion: Motion, other: Motion) -> float:
    points = find_judged_points(motion.skeleton)
    places = [points.positions(forward_kinematics(each)) for each in (motion, other)]
    return float(np.linalg.norm(places[1] - places[0], axis=-1).max())


if __name__ == "__main__":
    _child(*sys.argv[1:])
    # Blender 4.5 may hang at a normal exit.
    sys.stdout.flush()
    os._exit(0)
