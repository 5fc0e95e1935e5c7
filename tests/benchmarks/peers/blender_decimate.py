"""Blender's own Decimate (Allowed Change), really run in Blender, at a given error of limbs.

`python -m tests.benchmarks.peers.blender_decimate IN.npz OUT.json` is the child process. Every
channel is an F-Curve of its own. Rotations are decimated with one margin and positions with
another, as meters and parts of quaternions have no common one; of the pairs that keep every
joint within the tolerance at every frame, the one with the minimum of keys is taken. The margin
of its rotations is widened by bisection as far as that holds.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from solvers.arrays import Array
from solvers.motion import Motion, forward_kinematics
from solvers.retargeting.error_points import find_error_points
from solvers.rotations.representations import IDENTITY, normalize, unroll

from .blender_graph import _graph_editor, _write

TIMEOUT = 3600.0
ROTATION_MARGINS = np.geomspace(3e-4, 0.1, 14)
"""Margins of quaternions' parts to begin with."""
POSITION_MARGINS = np.geomspace(1e-4, 0.05, 14)
"""Margins of positions, meters."""
HALVINGS = 4


@dataclass(frozen=True, eq=False)
class Decimated:
    """Some channels after Decimate: their values at every frame, keys, and seconds."""

    values: Array
    n_keys: int
    seconds: float


def decimate_in_blender(motion: Motion, tolerances: Sequence[float]) -> list[dict[str, float]]:
    """Return for each tolerance in meters: keys, error in meters, seconds of the last run."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.npz", Path(folder) / "out.json"
        np.savez(
            source,
            names=np.array(motion.skeleton.names),
            parents=np.array(motion.skeleton.parents),
            offsets=motion.skeleton.offsets,
            rotations=motion.rotations,
            positions=motion.root_positions,
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
            skeleton, given["rotations"], given["positions"], float(given["frame_rate"])
        )
        tolerances = given["tolerances"].tolist()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    found = Search(bpy, motion).found(tolerances)
    Path(target).write_text(json.dumps(found), encoding="utf-8")


class Search:
    """The widest margins that keep within a tolerance."""

    def __init__(self, bpy: Any, motion: Motion) -> None:
        self._bpy, self._motion = bpy, motion
        off = np.abs(motion.rotations - IDENTITY).max(axis=(0, 2))
        self._moving = np.flatnonzero(off > 1e-9)
        quaternions = unroll(motion.rotations[:, self._moving])
        self._quaternions = quaternions.reshape(motion.n_frames, -1)
        self._points = find_error_points(motion.skeleton)
        self._positions = self._points.positions(forward_kinematics(motion))

    def found(self, tolerances: Sequence[float]) -> list[dict[str, float]]:
        """Return keys, error and seconds for each tolerance in meters."""
        rotation_fits = {
            margin: self._decimated(self._quaternions, margin) for margin in ROTATION_MARGINS
        }
        motion = self._motion
        positions = [
            self._decimated(motion.root_positions, margin) for margin in POSITION_MARGINS
        ]
        errors = {
            (margin, number): self._error(rotation, position)
            for margin, rotation in rotation_fits.items()
            for number, position in enumerate(positions)
        }
        results = []
        for tolerance in tolerances:
            fitting = [pair for pair, error in errors.items() if error <= tolerance]
            margin, number = min(
                fitting,
                key=lambda pair: rotation_fits[pair[0]].n_keys + positions[pair[1]].n_keys,
            )
            results.append(
                self._widened(tolerance, margin, rotation_fits[margin], positions[number])
            )
        return results

    def _widened(
        self, tolerance: float, low: float, best: Decimated, position: Decimated
    ) -> dict[str, float]:
        """Return the figures of the widest margin of rotations, from one that holds."""
        high = low * ROTATION_MARGINS[1] / ROTATION_MARGINS[0]
        for _ in range(HALVINGS):
            margin = float(np.sqrt(low * high))
            rotation = self._decimated(self._quaternions, margin)
            if self._error(rotation, position) <= tolerance:
                low, best = margin, rotation
            else:
                high = margin
        return {
            "keys": best.n_keys + position.n_keys,
            "error": self._error(best, position),
            "seconds": best.seconds + position.seconds,
        }

    def _decimated(self, take: Array, margin: float) -> Decimated:
        bpy = self._bpy
        ob = bpy.data.objects.new("take", None)
        bpy.context.scene.collection.objects.link(ob)
        curves = _write(bpy, ob, take)
        bpy.context.view_layer.objects.active = ob
        ob.select_set(True)
        start = perf_counter()
        with _graph_editor(bpy, ob):
            bpy.ops.graph.select_all(action="SELECT")
            bpy.ops.graph.decimate(mode="ERROR", remove_error_margin=float(margin))
        seconds = perf_counter() - start
        frames = range(len(take))
        after = np.array([[curve.evaluate(frame) for frame in frames] for curve in curves]).T
        keys = sum(len(curve.keyframe_points) for curve in curves)
        bpy.data.actions.remove(ob.animation_data.action)
        bpy.data.objects.remove(ob)
        return Decimated(after, keys, seconds)

    def _error(self, rotation: Decimated, position: Decimated) -> float:
        """Return the greatest distance of any joint at any frame, meters."""
        rotations = self._motion.rotations.copy()
        rotations[:, self._moving] = normalize(rotation.values.reshape(len(rotations), -1, 4))
        other = self._motion.with_poses(rotations, position.values)
        positions = self._points.positions(forward_kinematics(other))
        return float(np.linalg.norm(positions - self._positions, axis=-1).max())


if __name__ == "__main__":
    _child(*sys.argv[1:])
    # Blender 4.5 may hang at a normal exit.
    sys.stdout.flush()
    os._exit(0)
