"""Joints of glTF that no skin names come in as bones, like those that one names."""

import base64
import json

import numpy as np
import pytest

JOINTS = {
    "hips": ("", (0.0, 0.95, 0.0)),
    "spine": ("hips", (0.0, 0.1, 0.0)),
    "neck": ("spine", (0.0, 0.4, 0.0)),
    "head": ("neck", (0.0, 0.1, 0.0)),
    "armL": ("spine", (0.17, 0.35, 0.0)),
    "forearmL": ("armL", (0.28, 0.0, 0.0)),
    "handL": ("forearmL", (0.25, 0.0, 0.0)),
    "armR": ("spine", (-0.17, 0.35, 0.0)),
    "forearmR": ("armR", (-0.28, 0.0, 0.0)),
    "handR": ("forearmR", (-0.25, 0.0, 0.0)),
    "thighL": ("hips", (0.1, -0.05, 0.0)),
    "shinL": ("thighL", (0.0, -0.42, 0.0)),
    "footL": ("shinL", (0.0, -0.42, -0.02)),
    "thighR": ("hips", (-0.1, -0.05, 0.0)),
    "shinR": ("thighR", (0.0, -0.42, 0.0)),
    "footR": ("shinR", (0.0, -0.42, -0.02)),
}
"""Parent, and position relative to it, in meters."""
N_FRAMES = 31


@pytest.fixture
def write(tmp_path):
    """Write a body in which all joints rotate, with a skin for some, and an animated prop."""

    def write(skinned, picture=None):
        names = [*JOINTS, "avatar", "prop"]
        nodes = [
            {"name": name, "translation": JOINTS.get(name, ("", (0.0, 0.0, 0.0)))[1]}
            for name in names
        ]
        for name in names:
            above, _ = JOINTS.get(name, ("", None))
            if name != "avatar":
                parent = nodes[names.index(above or "avatar")]
                parent.setdefault("children", []).append(names.index(name))
        times = np.arange(N_FRAMES, dtype=np.float32) / 30.0
        turns = np.zeros((N_FRAMES, 4), np.float32)
        turns[:, 0], turns[:, 3] = np.sin(0.1 * np.sin(times)), np.cos(0.1 * np.sin(times))
        data = times.tobytes() + turns.tobytes()
        content = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [names.index("avatar")]}],
            "nodes": nodes,
            "skins": [{"joints": [names.index(name) for name in skinned]}],
            "animations": [{
                "samplers": [{"input": 0, "output": 1}],
                "channels": [
                    {"sampler": 0, "target": {"node": index, "path": "rotation"}}
                    for index in range(len(names))
                ],
            }],
            "accessors": [
                accessor(0, "SCALAR", min=[0.0], max=[float(times[-1])]),
                accessor(1, "VEC4"),
            ],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": times.nbytes},
                {"buffer": 0, "byteOffset": times.nbytes, "byteLength": turns.nbytes},
            ],
            "buffers": [{
                "byteLength": len(data),
                "uri": "data:application/octet-stream;base64,"
                + base64.b64encode(data).decode(),
            }],
        }  # fmt: skip
        if picture is not None:
            texture = {"baseColorTexture": {"index": 0}}
            content |= {
                "images": [{"uri": picture}],
                "textures": [{"source": 0}],
                "materials": [{"pbrMetallicRoughness": texture}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 2}, "material": 0}]}],
            }
            content["accessors"].append({**accessor(1, "VEC3"), "count": 3})
            nodes[names.index("prop")]["mesh"] = 0
        path = tmp_path / "take.gltf"
        path.write_text(json.dumps(content))
        return path

    return write


def accessor(view, kind, **more):
    return {
        "bufferView": view, "componentType": 5126, "count": N_FRAMES, "type": kind, **more
    }  # fmt: skip


@pytest.mark.parametrize(
    "skinned",
    [["neck", "head"], ["hips", "spine", "neck", "head"], ["shinL"], [*JOINTS][:-1]],
    ids=["head", "trunk", "one shin", "all but a foot"],
)
def test_joints_without_weights_are_bones_too(bring, write, skinned):
    armatures, _ = bring(write(skinned))

    (armature,) = armatures
    assert JOINTS.keys() <= set(armature.data.bones.keys())
    assert "prop" not in armature.data.bones


def test_a_complete_skin_is_kept(bring, write):
    (armature,), _ = bring(write([*JOINTS]))

    assert set(armature.data.bones.keys()) == JOINTS.keys()


@pytest.mark.parametrize("picture", ["gone.png", "/dev/zero", "../secret.png"])
def test_pictures_in_other_files_are_not_needed_for_a_motion(bring, write, picture):
    (armature,), _ = bring(write([*JOINTS], picture))

    assert len(armature.data.bones) == len(JOINTS)
    assert armature.animation_data.action.frame_range[1] == N_FRAMES


def test_a_long_name_is_not_cut_within_a_letter(bring, write):
    """Blender's importer failed at it; 63 bytes of a name are kept."""
    path = write([*JOINTS])
    content = json.loads(path.read_text())
    content["nodes"][9]["name"] = "é" * 40
    path.write_text(json.dumps(content))

    (armature,), _ = bring(path)

    assert "é" * 31 in armature.data.bones


@pytest.mark.parametrize("end", [{}, {"children": [0]}], ids=["chain", "circle"])
def test_chains_without_end_are_no_bodies(load, end):
    """A chain of 2,000 nodes took 13 s, one of 20,000 hours."""
    nodes = [*({"children": [above + 1]} for above in range(999)), end]
    channels = [{"target": {"path": "rotation", "node": node}} for node in range(1000)]

    trees = load("mocap_assist.blender.gltf_skins").find_joint_trees({
        "nodes": nodes, "skins": [{"joints": [0]}], "animations": [{"channels": channels}]
    })  # fmt: skip

    assert trees == []
