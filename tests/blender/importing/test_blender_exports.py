"""Files that Blender itself exports: turned, scaled, keyed on every bone, or without a body."""

import json
import struct

import numpy as np
import pytest
from mathutils import Matrix, Vector

TURN = Matrix.Rotation(np.pi / 2, 4, "X")
COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset><library_visual_scenes><visual_scene id="s">
<node id="box" name="box"/></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""


@pytest.fixture
def walker(make_armature, animate, blank):
    """An armature with Y up in centimeters, turned and scaled; every bone has location keys.

    Bones move little, the hips along a path of 3 m, 1 m above the floor.
    """
    armature = make_armature()
    armature.data.transform(Matrix.Scale(100.0, 4) @ TURN.inverted())
    armature.matrix_world = TURN @ Matrix.Scale(0.01, 4)
    animate(armature, range(1, 61), locations=True)
    for curve in curves(armature):
        for point in curve.keyframe_points:
            point.co.y = curve.data_path.endswith("quaternion") and curve.array_index == 0
    hips = (
        armature.data.bones["Hips"].matrix_local.to_3x3().inverted() @ TURN.to_3x3().inverted()
    )
    for index, along in enumerate(hips @ Vector((300.0, 0.0, 0.0))):
        key(armature, "Hips", index, along * np.linspace(0.0, 1.0, 60))
    blank.context.scene.frame_end = 60
    blank.context.scene.render.fps = 30
    return armature


def curves(armature):
    return armature.animation_data.action.layers[0].strips[0].channelbags[0].fcurves


def key(armature, bone, index, values):
    path = f'pose.bones["{bone}"].location'
    curve = next(c for c in curves(armature) if (c.data_path, c.array_index) == (path, index))
    for point, value in zip(curve.keyframe_points, values, strict=True):
        point.co.y = value
    curve.update()


def export(blank, path):
    operators = blank.ops.export_scene
    if path.suffix == ".fbx":
        operators.fbx(
            filepath=str(path),
            add_leaf_bones=False,
            bake_anim_use_nla_strips=False,
            bake_anim_use_all_actions=False,
        )
    elif path.suffix.startswith(".usd"):
        blank.ops.wm.usd_export(filepath=str(path), export_animation=True)
    else:
        operators.gltf(filepath=str(path))
    for kind in (blank.data.objects, blank.data.armatures, blank.data.actions):
        blank.data.batch_remove(list(kind))


def without_skin(path):
    """Take the skin out of a GLB, as web pages load animations; return its new path."""
    content = path.read_bytes()
    length = struct.unpack("<I", content[12:16])[0]
    described = json.loads(content[20 : 20 + length])
    described.pop("skins", None)
    for node in described["nodes"]:
        node.pop("skin", None)
        node.pop("mesh", None)
    described.pop("meshes", None)
    text = json.dumps(described).encode()
    text += b" " * (-len(text) % 4)
    rest = content[20 + length :]
    head = struct.pack(
        "<IIIII", 0x46546C67, 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A
    )
    path.write_bytes(head + text + rest)


@pytest.fixture
def brought(blank, load):
    """Import a file; return the motion, and the path of each joint."""

    def bring(path):
        blank.ops.mocap_assist.import_recording(filepath=str(path))
        read = load("mocap_assist.actions.armature_read").read_take
        motion = read(blank.context.object, blank.context.scene).parts[0].motion
        joints = load("solvers.motion").world_poses(
            motion.skeleton, motion.rotations, motion.root_positions
        )
        paths = joints.positions.swapaxes(0, 1)
        return motion, dict(zip(motion.skeleton.names, paths, strict=True))

    return bring


@pytest.mark.parametrize("suffix", ["glb", "fbx", "skinless.glb", "usdc"])
def test_a_turned_and_scaled_body_stands_and_walks_its_path(
    walker, blank, tmp_path, brought, suffix
):
    export(blank, tmp_path / f"take.{suffix}")
    if suffix.startswith("skinless"):
        without_skin(tmp_path / f"take.{suffix}")

    motion, where = brought(tmp_path / f"take.{suffix}")

    assert motion.skeleton.names[0] == "Hips"
    assert motion.frame_rate == pytest.approx(30.0)
    assert motion.n_frames == 60
    assert where["Hips"][:, 2] == pytest.approx(1.0, abs=0.01)
    assert where["Head"][:, 2] == pytest.approx(1.5, abs=0.01)
    assert where["LeftFoot"][:, 2] == pytest.approx(0.1, abs=0.01)
    assert (where["LeftUpLeg"] - where["RightUpLeg"])[:, 0] == pytest.approx(0.2, abs=0.01)
    assert np.ptp(where["Hips"], axis=0) == pytest.approx([3.0, 0.0, 0.0], abs=0.02)


@pytest.mark.parametrize("suffix", ["glb", "fbx", "usda"])
def test_a_body_moves_with_what_carries_it(walker, blank, tmp_path, brought, suffix):
    """Programs put the travel of a body on a null above its skeleton."""
    carrier = blank.data.objects.new("Carrier", None)
    blank.context.scene.collection.objects.link(carrier)
    walker.parent = carrier
    for frame, along in ((1, 0.0), (60, 2.0)):
        carrier.location.y = along
        carrier.keyframe_insert("location", frame=frame)
    export(blank, tmp_path / f"take.{suffix}")

    _, where = brought(tmp_path / f"take.{suffix}")

    assert where["Hips"][-1] - where["Hips"][0] == pytest.approx([3.0, 2.0, 0.0], abs=0.02)


def test_a_body_has_not_the_travel_of_another_take(walker, blank, load):
    carrier = blank.data.objects.new("Carrier", None)
    blank.context.scene.collection.objects.link(carrier)
    walker.parent = carrier
    for frame, along in ((1, 0.0), (60, 2.0)):
        carrier.location.y = along
        carrier.keyframe_insert("location", frame=frame)
    track = carrier.animation_data.nla_tracks.new()
    track.strips.new("first", 1, carrier.animation_data.action)
    walker.animation_data.action.copy()
    source = walker.animation_data.action, walker.animation_data.action_slot
    take = load("mocap_assist.actions.armature_read").read_take(walker, blank.context.scene)
    motion = take.parts[0].motion

    carried = load("mocap_assist.library.carriers").with_carriers(
        blank.context.scene, walker, source, take.frames, motion, 1.0
    )

    travel = carried.root_positions - motion.root_positions
    assert travel == pytest.approx(0.0, abs=1e-5)


def test_keys_at_tenths_of_a_frame_make_no_finer_take(make_armature, animate, blank, load):
    """Exporters add keys between frames at fast moments."""
    armature = make_armature()
    animate(armature, [*range(1, 30), *np.arange(30.0, 32.0, 0.1), *range(32, 61)])
    blank.context.scene.render.fps = 30

    take = load("mocap_assist.actions.armature_read").read_take(armature, blank.context.scene)

    assert take.parts[0].motion.frame_rate == pytest.approx(30.0)
    assert take.parts[0].motion.n_frames == 60


@pytest.mark.parametrize("suffix", ["glb", "dae"])
def test_a_file_without_a_skeleton_is_refused(blank, tmp_path, suffix):
    path = tmp_path / f"box.{suffix}"
    if suffix == "dae":
        path.write_text(COLLADA)
    else:
        blank.ops.mesh.primitive_cube_add()
        blank.context.object.keyframe_insert("location", frame=1)
        blank.context.object.keyframe_insert("location", frame=20)
        export(blank, path)

    with pytest.raises(RuntimeError) as error:
        blank.ops.mocap_assist.import_recording(filepath=str(path))

    if suffix == "dae" and blank.app.version >= (5, 0, 0):
        assert "is a Collada file, which Blender" in str(error.value)
        assert "Convert it to FBX or glTF" in str(error.value)
    else:
        assert "has no skeleton, so there is no body to import" in str(error.value)
    assert not [each for each in blank.data.objects if each.type == "ARMATURE"]


def test_what_bones_do_beyond_rotations_is_reported(walker, blank, tmp_path, brought, capfd):
    """A recording has rotations, and bones of constant length and size."""
    for frame, along, size in ((1, 0.0, 1.0), (60, 10.0, 1.5)):
        walker.pose.bones["LeftUpLeg"].location = 0.0, along, 0.0
        walker.pose.bones["LeftUpLeg"].keyframe_insert("location", frame=frame)
        walker.pose.bones["Head"].scale = (size,) * 3
        walker.pose.bones["Head"].keyframe_insert("scale", frame=frame)
    for frame, size in ((26, 1.0), (30, 0.5), (34, 1.0)):
        walker.pose.bones["LeftArm"].scale.y = size
        walker.pose.bones["LeftArm"].keyframe_insert("scale", index=1, frame=frame)
    export(blank, tmp_path / "take.glb")

    brought(tmp_path / "take.glb")

    said = capfd.readouterr().out
    assert "distance to their parents, which is left out: LeftUpLeg, by up to 10 cm." in said
    assert "Bones change their size, which is left out: Head, LeftArm." in said
