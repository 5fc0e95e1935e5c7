"""FBX, glTF and USD come in through Blender's importers, standing, in true size."""

import json
import struct

import numpy as np
import pytest

GLB_JSON = 0x4E4F534A
FIGURES = {
    "fbx/mixamo_web/Walking.fbx": (37, 30.0, 1.9),
    "fbx/mixamo_web/Rolling.fbx": (74, 30.0, 0.9),
    "glb/mixamo_blender/walking.glb": (30, 30.0, 1.7),
    "glb/khronos_cesiumman/CesiumMan.glb": (49, 24.0, 1.13),
}


@pytest.mark.parametrize("file", FIGURES)
def test_takes_come_in_standing_in_true_size(bring, recordings, blank, file, load):
    n_frames, rate, height = FIGURES[file]

    armatures, _ = bring(recordings / "corpus" / file)

    read = load("mocap_assist.actions.armature_read").read_take
    motion = read(armatures[-1], blank.context.scene).parts[0].motion
    poses = load("solvers.motion").world_poses(
        motion.skeleton, motion.rotations, motion.root_positions
    )
    assert motion.n_frames == n_frames
    assert motion.frame_rate == pytest.approx(rate)
    tall = np.median(np.ptp(poses.positions[..., 2], axis=1))
    assert tall == pytest.approx(height, rel=0.06)
    roles = load("solvers.motion").find_humanoid_map(motion.skeleton)
    assert roles.has("hips", "head", "leftFoot", "rightHand")


def below_node(path, target, **transform):
    """Write a GLB with its nodes below another one."""
    data = path.read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    content = json.loads(data[20 : 20 + length])
    scene = content["scenes"][0]
    content["nodes"].append({**transform, "children": scene["nodes"]})
    scene["nodes"] = [len(content["nodes"]) - 1]
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    head = struct.pack("<IIIII", 0x46546C67, 2, 20 + len(text) + len(rest), len(text), GLB_JSON)
    target.write_bytes(head + text + rest)


@pytest.mark.parametrize("degrees", [0.0, 90.0, 180.0])
def test_a_body_overrules_the_up_axis_of_its_file(bring, recordings, tmp_path, blank, degrees):
    path, half = tmp_path / "take.glb", np.radians(degrees) / 2.0
    figure = recordings / "corpus/glb/mixamo_blender/walking.glb"
    below_node(figure, path, rotation=[np.sin(half), 0.0, 0.0, np.cos(half)])

    (armature,), _ = bring(path)

    assert head_height(armature) == pytest.approx(1.5, abs=0.1)
    noted = json.loads(armature["mocap_assist_recording"])
    assert noted["stated_up"] == ("Y" if degrees else None)
    blank.ops.mocap_assist.change_axes(up="Y")
    blank.context.view_layer.update()
    assert head_height(armature) == pytest.approx(1.5 * np.cos(2 * half), abs=0.2)


def head_height(armature):
    (head,) = (bone for bone in armature.pose.bones if bone.name.endswith("Head"))
    return (armature.matrix_world @ head.head).z


@pytest.mark.parametrize("size", [0.01, 10.0])
def test_the_body_overrules_a_wrong_unit(load, recordings, tmp_path, size):
    path = tmp_path / "take.glb"
    figure = recordings / "corpus/glb/mixamo_blender/walking.glb"
    below_node(figure, path, scale=[size] * 3)
    module = load("mocap_assist.importing.solve_reading")

    (read,) = module.read_takes(path, module.Conversion())

    stature = load("solvers.recordings.conventions").stature
    assert stature(read.recording) == pytest.approx(1.75, rel=0.02)
    assert any(each.startswith("Lengths are interpreted as") for each in read.warnings)


def test_takes_of_one_skeleton_are_actions_of_one_armature(bring, recordings, blank):
    armatures, _ = bring(recordings / "corpus/glb/mixamo_blender/walking.glb")

    (armature,) = armatures
    assert armature.name == "walking"
    assert armature.animation_data.action.name == "Idle"
    assert [each.name for each in blank.data.actions] == ["Idle", "Walk"]
    assert all(each.use_fake_user for each in blank.data.actions)
    ends = [each.frame_range[1] for each in blank.data.actions]
    assert ends == [30.0, 30.0]
    assert blank.context.scene.render.fps == 30


def test_a_vrm_animation_comes_in_without_a_skin(bring, recordings):
    (armature,), _ = bring(recordings / "corpus/vrm/vrma_pixiv/test.vrma")

    assert len(armature.data.bones) >= 51
    assert "leftUpperArm" in armature.data.bones
    assert armature.animation_data.action.frame_range[1] == 91.0  # 3 s at 30 Hz


@pytest.mark.parametrize(
    ("source", "name", "n_frames"),
    [
        ("fbx/mixamo_web/Walking.fbx", "take.glb", 37),
        ("fbx/mixamo_web/Walking.fbx", "take.bvh", 37),
        ("glb/khronos_cesiumman/CesiumMan.glb", "take.fbx", 49),
        ("glb/mixamo_blender/walking.glb", "take.usdc", 30),
        ("bvh/smpl_momask/momask_out.bvh", "take.fbx", None),
        ("bvh/smpl_momask/momask_out.bvh", "take.glb", None),
    ],
)
def test_the_content_decides_where_the_suffix_is_wrong(
    load, recordings, tmp_path, source, name, n_frames
):
    path = tmp_path / name
    path.write_bytes((recordings / "corpus" / source).read_bytes())
    module = load("mocap_assist.importing.solve_reading")

    (wrong,) = module.read_takes(path, module.Conversion())

    (right,) = module.read_takes(recordings / "corpus" / source, module.Conversion())
    assert wrong.recording.n_frames == right.recording.n_frames
    assert n_frames in {None, wrong.recording.n_frames}
    assert wrong.recording.conventions == right.recording.conventions


def test_the_lowest_foot_is_placed_on_the_floor(blank, recordings, load):
    """Hips of this dancer are at the origin, and the feet 85 cm below."""
    path = recordings / "corpus/bvh/olympe_ballet/ballet.bvh"

    heights = []
    for placed in ("NEVER", "AUTO"):
        blank.ops.mocap_assist.import_recording(filepath=str(path), place_on_floor=placed)
        armature, scene = blank.context.object, blank.context.scene
        lowest = []
        for frame in range(1, 1000, 50):
            scene.frame_set(frame)
            lowest += [min((armature.matrix_world @ b.head).z for b in armature.pose.bones)]
        heights.append(np.percentile(lowest, 5))

    assert heights[0] < -0.7
    assert heights[1] == pytest.approx(0.07, abs=0.03)  # ankles: there are no toes
