"""Armatures to test on, made and animated with nothing but Blender's own API."""

from collections.abc import Callable, Iterable

import numpy as np
import pytest

BONES = {  # name: (parent, head, tail, connected)
    "Hips": (None, (0, 0, 1.0), (0, 0, 1.1), False),
    "Spine": ("Hips", (0, 0, 1.1), (0, 0, 1.4), True),
    "Head": ("Spine", (0, 0, 1.5), (0, 0, 1.7), False),
    "LeftArm": ("Spine", (0.2, 0, 1.4), (0.5, 0, 1.4), False),
    "LeftForeArm": ("LeftArm", (0.5, 0, 1.4), (0.8, 0.05, 1.4), True),
    "RightArm": ("Spine", (-0.2, 0, 1.4), (-0.5, 0, 1.4), False),
    "RightForeArm": ("RightArm", (-0.5, 0, 1.4), (-0.8, 0.05, 1.4), True),
    "LeftUpLeg": ("Hips", (0.1, 0, 0.95), (0.1, -0.02, 0.5), False),
    "LeftLeg": ("LeftUpLeg", (0.1, -0.02, 0.5), (0.1, 0, 0.1), True),
    "LeftFoot": ("LeftLeg", (0.1, 0, 0.1), (0.1, -0.15, 0.02), True),
    "RightUpLeg": ("Hips", (-0.1, 0, 0.95), (-0.1, -0.02, 0.5), False),
    "RightLeg": ("RightUpLeg", (-0.1, -0.02, 0.5), (-0.1, 0, 0.1), True),
    "RightFoot": ("RightLeg", (-0.1, 0, 0.1), (-0.1, -0.15, 0.02), True),
}
PROPERTIES = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}


@pytest.fixture
def make_armature(blank) -> Callable[..., object]:
    """Make an armature object: `make_armature(bones, mode="XYZ")`; it becomes active."""

    def make(bones=BONES, mode="QUATERNION", name="Actor"):
        armature = blank.data.objects.new(name, blank.data.armatures.new(name))
        blank.context.scene.collection.objects.link(armature)
        blank.context.view_layer.objects.active = armature
        blank.ops.object.mode_set(mode="EDIT")
        for bone, (parent, head, tail, connected) in bones.items():
            made = armature.data.edit_bones.new(bone)
            made.head, made.tail, made.roll = head, tail, 0.3
            made.parent = armature.data.edit_bones.get(parent or "")
            made.use_connect = connected
        blank.ops.object.mode_set(mode="OBJECT")
        for bone in armature.pose.bones:
            bone.rotation_mode = mode
        return armature

    return make


@pytest.fixture
def animate(blank, rng) -> Callable[..., object]:
    """Give an armature an action of smooth random turns, keyed at `frames`; return the action.

    The root also moves, and with `locations` every other bone too.
    """

    def walk(n_frames: int, width: int) -> np.ndarray:
        phases = rng.uniform(0, 2 * np.pi, size=(3, width))
        time = np.arange(n_frames)[:, None, None]
        waves = np.sin(time * np.array([0.05, 0.11, 0.23])[:, None] + phases)
        return (waves * np.array([0.5, 0.2, 0.1])[:, None]).sum(axis=1)

    def make(armature, frames: Iterable[float] = range(1, 61), locations=False):
        frames = np.array(list(frames), dtype=np.float32)
        action = blank.data.actions.new("walk")
        slot = action.slots.new("OBJECT", armature.name)
        bag = (
            action.layers.new("Layer").strips.new(type="KEYFRAME").channelbag(slot, ensure=True)
        )
        for bone in armature.pose.bones:
            name = PROPERTIES.get(bone.rotation_mode, "rotation_euler")
            width = 3 if name == "rotation_euler" else 4
            values = {name: walk(len(frames), width)}
            if name != "rotation_euler":
                values[name] += (1.0, 0.0, 0.0, 0.0)
            if locations or not bone.parent:
                values["location"] = walk(len(frames), 3)
            for path, columns in values.items():
                for index, column in enumerate(columns.T):
                    curve = bag.fcurves.new(f'pose.bones["{bone.name}"].{path}', index=index)
                    curve.keyframe_points.add(len(frames))
                    keys = np.column_stack([frames, column]).astype(np.float32)
                    curve.keyframe_points.foreach_set("co", keys.ravel())
                    curve.update()
        armature.animation_data_create().action = action
        armature.animation_data.action_slot = slot
        return action

    return make


@pytest.fixture
def poses(blank) -> Callable[..., np.ndarray]:
    """World matrices of all pose bones as Blender itself evaluates them, bone by name."""

    def evaluate(armature, frames) -> dict[str, np.ndarray]:
        found = {bone.name: [] for bone in armature.pose.bones}
        for frame in frames:
            whole = int(np.floor(frame))
            blank.context.scene.frame_set(whole, subframe=float(frame - whole))
            for bone in armature.pose.bones:
                found[bone.name].append(np.array(armature.matrix_world @ bone.matrix))
        return {name: np.array(matrices) for name, matrices in found.items()}

    return evaluate


@pytest.fixture
def keys_of() -> Callable[..., dict]:
    """Every key of an action, slot by slot, as plain tuples that can be compared."""

    def listed(action) -> dict:
        found = {}
        for slot in action.slots:
            bag = action.layers[0].strips[0].channelbag(slot)
            for curve in bag.fcurves if bag else ():
                found[slot.identifier, curve.data_path, curve.array_index] = [
                    (*key.co, *key.handle_left, *key.handle_right, key.interpolation, key.type)
                    for key in curve.keyframe_points
                ]
        return found

    return listed


@pytest.fixture
def scene_io(load) -> object:
    """The modules under test, by name."""

    class Modules:
        reading = load("mocap_assist.scene.armature_read")
        writing = load("mocap_assist.scene.armature_write")
        frames = load("mocap_assist.scene.frames")
        kinematics = load("solvers.motion.kinematics")
        rotations = load("solvers.motion.rotations")
        errors = load("solvers.errors")

    return Modules
