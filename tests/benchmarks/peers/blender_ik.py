"""Blender's own inverse kinematics with pinned feet, really run in Blender.

`python -m tests.benchmarks.peers.blender_ik IN.npz OUT.npz` is the child process. Each take is
an armature with a key on every frame, as an importer makes it. The shin has an IK constraint of
chain length 2 on an empty, the foot copies the empty's rotation; the empties are keyed where
the ankles shall be, and rotated as the feet were. `bpy.ops.nla.bake` with visual keying of
thighs, shins and feet is what an animator does next; its time is that of the method.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from solvers.arrays import Array
from solvers.feet.legs import find_legs
from solvers.motion import Motion, forward_kinematics
from solvers.rotations import inverse, multiply, quaternion_from_matrix, rotate
from solvers.rotations.representations import unroll

TIMEOUT = 600.0
SHORT_BONE_M = 0.05
"""Length of bones whose direction does not matter, meters."""


@dataclass(frozen=True, eq=False)
class PinnedTake:
    """A motion, and the joints of its legs with the targets of its ankles."""

    motion: Motion
    legs: Array
    """Hip, knee and ankle of each leg, (n_legs, 3)."""
    targets: Array
    """Shape (n_frames, n_legs, 3), meters."""


def has_blender() -> bool:
    """Return whether Blender can be imported as a module."""
    return find_spec("bpy") is not None


def pin_in_blender(takes: Sequence[tuple[Motion, Array]]) -> list[tuple[Motion, float]]:
    """Return each motion with its ankles at the targets, and the seconds of baking it."""
    pinned = [_pinned_take(motion, targets) for motion, targets in takes]
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.npz", Path(folder) / "out.npz"
        np.savez(source, **_packed(pinned))
        done = subprocess.run(
            [sys.executable, "-m", "tests.benchmarks.peers.blender_ik", source, target],
            env={**os.environ, "BLENDER_USER_RESOURCES": folder},
            timeout=TIMEOUT,
            capture_output=True,
            text=True,
        )
        if done.returncode or not target.exists():
            raise RuntimeError(f"Blender failed: {done.stdout[-2000:]} {done.stderr[-2000:]}")
        with np.load(target) as found:
            return [
                (_with_legs(take, found[f"{number}_legs"]), float(found[f"{number}_seconds"]))
                for number, take in enumerate(pinned)
            ]


def _pinned_take(motion: Motion, targets: Array) -> PinnedTake:
    legs = np.array([leg.chain for leg in find_legs(motion.skeleton)])
    return PinnedTake(motion, legs, targets)


def _packed(takes: Sequence[PinnedTake]) -> dict[str, Array]:
    """Return the arrays of all takes, each under its number."""
    packed: dict[str, Array] = {"n": np.array(len(takes))}
    for number, take in enumerate(takes):
        skeleton, poses = take.motion.skeleton, forward_kinematics(take.motion)
        packed |= {
            f"{number}_{name}": value
            for name, value in (
                ("parents", np.array(skeleton.parents)),
                ("rest", skeleton.rest_positions),
                ("rotations", take.motion.rotations),
                ("positions", take.motion.root_positions),
                ("frame_rate", np.array(take.motion.frame_rate)),
                ("legs", take.legs),
                ("targets", take.targets),
                ("feet", poses.rotations[:, take.legs[:, 2]]),
            )
        }
    return packed


def _with_legs(take: PinnedTake, legs: Array) -> Motion:
    rotations = take.motion.rotations.copy()
    rotations[:, take.legs.ravel()] = legs
    return take.motion.with_poses(rotations)


def _child(source: str, target: str) -> None:
    import bpy

    results = {}
    with np.load(source) as given:
        for number in range(int(given["n"])):
            bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
            prefix = f"{number}_"
            arrays = {
                name.removeprefix(prefix): given[name]
                for name in given.files
                if name.startswith(prefix)
            }
            rig = _Rig(bpy, arrays)
            results[f"{number}_seconds"] = np.array(rig.bake())
            results[f"{number}_legs"] = rig.leg_rotations()
    np.savez(target, **results)


class _Rig:
    """An armature that plays a take, with pinned feet."""

    def __init__(self, bpy: Any, take: dict[str, Array]) -> None:
        self._bpy, self._take = bpy, take
        self._n_frames = len(take["rotations"])
        bpy.context.scene.render.fps = round(float(take["frame_rate"]))
        self._armature = self._make_bones()
        # Blender orders bones by the tree, which need not be the order of the joints.
        bones = [self._armature.data.bones[_name(joint)] for joint in range(len(take["rest"]))]
        matrices = np.array([np.array(bone.matrix_local.to_3x3()) for bone in bones])
        self._rest = quaternion_from_matrix(matrices)
        self._key_take()
        for number in range(len(take["legs"])):
            self._pin(number)

    def bake(self) -> float:
        """Bake the legs; return the seconds."""
        bpy, armature = self._bpy, self._armature
        bpy.ops.object.mode_set(mode="POSE")
        legs = {_name(joint) for joint in self._take["legs"].ravel()}
        for bone in armature.pose.bones:
            # Blender 5 has moved the selection from bones to their poses.
            owner = bone if hasattr(bone, "select") else bone.bone
            owner.select = bone.name in legs
        start = perf_counter()
        bpy.ops.nla.bake(
            frame_start=0, frame_end=self._n_frames - 1, only_selected=True,
            visual_keying=True, clear_constraints=True, use_current_action=True,
            bake_types={"POSE"},
        )  # fmt: skip
        return perf_counter() - start

    def leg_rotations(self) -> Array:
        """Return the local rotations of hips, knees and ankles, (n_frames, n_legs * 3, 4)."""
        bag = self._armature.animation_data.action.layers[0].strips[0].channelbags[0]
        result = []
        for joint in self._take["legs"].ravel():
            path = f'pose.bones["{_name(joint)}"].rotation_quaternion'
            curves = [bag.fcurves.find(path, index=index) for index in range(4)]
            values = np.array([
                [curve.evaluate(frame) for curve in curves] for frame in range(self._n_frames)
            ])
            values /= np.linalg.norm(values, axis=-1, keepdims=True)
            rest = self._rest[joint]
            result.append(multiply(multiply(rest, values), inverse(rest)))
        return np.stack(result, axis=1)

    def _make_bones(self) -> Any:
        bpy, rest = self._bpy, self._take["rest"]
        armature = bpy.data.objects.new("take", bpy.data.armatures.new("take"))
        bpy.context.scene.collection.objects.link(armature)
        bpy.context.view_layer.objects.active = armature
        armature.select_set(True)
        bpy.ops.object.mode_set(mode="EDIT")
        tails = rest + np.array([0.0, 0.0, SHORT_BONE_M])
        for hip, knee, ankle in self._take["legs"]:
            tails[hip], tails[knee] = rest[knee], rest[ankle]
        for joint, parent in enumerate(self._take["parents"]):
            bone = armature.data.edit_bones.new(_name(joint))
            bone.head, bone.tail = rest[joint], tails[joint]
            if parent >= 0:
                bone.parent = armature.data.edit_bones[_name(parent)]
        bpy.ops.object.mode_set(mode="OBJECT")
        return armature

    def _key_take(self) -> None:
        curves = _new_curves(self._bpy, self._armature)
        for joint, rest in enumerate(self._rest):
            local = self._take["rotations"][:, joint]
            values = unroll(multiply(multiply(inverse(rest), local), rest)[:, None])[:, 0]
            _key(curves, f'pose.bones["{_name(joint)}"].rotation_quaternion', values)
        moved = rotate(inverse(self._rest[0]), self._take["positions"] - self._take["rest"][0])
        _key(curves, f'pose.bones["{_name(0)}"].location', moved)

    def _pin(self, number: int) -> None:
        bpy, (_, knee, ankle) = self._bpy, self._take["legs"][number]
        empty = bpy.data.objects.new(f"foot {number}", None)
        bpy.context.scene.collection.objects.link(empty)
        empty.rotation_mode = "QUATERNION"
        curves = _new_curves(bpy, empty)
        _key(curves, "location", self._take["targets"][:, number])
        rotated = multiply(self._take["feet"][:, number], self._rest[ankle])
        _key(curves, "rotation_quaternion", unroll(rotated[:, None])[:, 0])
        bones = self._armature.pose.bones
        constraint = bones[_name(knee)].constraints.new("IK")
        constraint.target, constraint.chain_count = empty, 2
        bones[_name(ankle)].constraints.new("COPY_ROTATION").target = empty


def _name(joint: int) -> str:
    return f"joint {joint}"


def _new_curves(bpy: Any, owner: Any) -> Any:
    action = bpy.data.actions.new("take")
    slot = action.slots.new(id_type="OBJECT", name="take")
    strip = action.layers.new("take").strips.new(type="KEYFRAME")
    owner.animation_data_create().action = action
    owner.animation_data.action_slot = slot
    return strip.channelbag(slot, ensure=True).fcurves


def _key(curves: Any, path: str, values: Array) -> None:
    keys = np.empty((len(values), 2), np.float32)
    keys[:, 0] = np.arange(len(values))
    for index, channel in enumerate(values.T):
        curve = curves.new(data_path=path, index=index)
        curve.keyframe_points.add(len(values))
        keys[:, 1] = channel
        curve.keyframe_points.foreach_set("co", keys.ravel())
        curve.update()


if __name__ == "__main__":
    _child(*sys.argv[1:])
    # Blender 4.5 may hang at a normal exit.
    sys.stdout.flush()
    os._exit(0)
