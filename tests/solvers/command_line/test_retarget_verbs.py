"""`retarget` and `unbake` on files."""

import json

import numpy as np
import pytest
from rigs import mixamo, unreal

from solvers.motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    Tracks,
    find_humanoid_map,
    forward_kinematics,
    read_humanoid_map,
    write_humanoid_map,
)
from solvers.recordings import read_bvh, write_bvh, write_trc
from solvers.retargeting import load_sparse_motion
from solvers.rotations.representations import IDENTITY
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture
def walk_file(tmp_path):
    write_bvh(walking_gait(GaitSettings(duration=2.0, frame_rate=30.0)), tmp_path / "walk.bvh")
    return tmp_path / "walk.bvh"


@pytest.fixture
def rig_file(tmp_path):
    write_bvh(resting(mixamo()), tmp_path / "rig.bvh")
    return tmp_path / "rig.bvh"


def test_retarget_writes_the_motion_of_the_target(call, walk_file, rig_file, tmp_path):
    status, printed, _ = call("retarget", walk_file, tmp_path / "out.bvh", "--to", rig_file)

    assert status == 0 and "22 shared roles" in printed and "100%" in printed
    given = read_bvh(tmp_path / "out.bvh")
    assert set(given.skeleton.names) == set(mixamo().names) and given.n_frames == 60
    position = forward_kinematics(given).positions
    assert np.ptp(position[:, given.skeleton.index("mixamorig:LeftFoot"), 1]) > 0.5


def test_retarget_reports_roles_with_low_confidence(call, walk_file, rig_file, tmp_path):
    """A map whose neck is a shoulder: names and structure are against it."""
    skeleton = read_bvh(walk_file).skeleton
    right = find_humanoid_map(skeleton)
    wrong = right.with_joint("neck", right.joints["leftShoulder"])
    write_humanoid_map(wrong, tmp_path / "wrong.json")
    words = ("retarget", walk_file, tmp_path / "out.bvh", "--to", rig_file)

    _, plain, _ = call(*words)
    status, printed, _ = call(*words, "--again", "--source-map", tmp_path / "wrong.json")
    _, figures, _ = call(*words, "--again", "--json", "--source-map", tmp_path / "wrong.json")

    assert status == 0
    assert "low confidence" not in plain
    assert f"low confidence: {wrong.joints['neck']} as neck (neither name" in printed
    neck = json.loads(figures)["evidence"]["source"]["neck"]
    assert neck["confidence"] < 0.5 and neck["reason"].startswith("neither name")


def test_retarget_takes_many_files_settings_and_json(call, walk_file, rig_file, tmp_path):
    status, printed, _ = call(
        "retarget", walk_file, "--to", rig_file, "--output-folder", tmp_path / "out",
        "--root-motion", "in place", "--no-keep-hands", "--json",
    )  # fmt: skip

    assert status == 0
    assert json.loads(printed)["n_frames"] == 60
    still = read_bvh(tmp_path / "out" / "walk.bvh")
    assert np.ptp(still.root_positions[15:-15, :2], axis=0).max() < 0.5


def test_retarget_reads_maps_from_files(call, walk_file, tmp_path):
    """A target with unknown names, whose map swaps the sides of the feet."""
    rig = mixamo()
    names = tuple(f"joint{chr(97 + i // 26)}{chr(97 + i % 26)}" for i in range(rig.n_joints))
    nameless = Skeleton(names, rig.parents, rig.offsets)
    indices = find_humanoid_map(rig).indices(rig)
    write_bvh(resting(nameless), tmp_path / "rig.bvh")
    write_humanoid_map(
        HumanoidMap({role: names[joint] for role, joint in indices.items()}),
        tmp_path / "rig.json",
    )

    status, printed, _ = call(
        "retarget", walk_file, tmp_path / "out.bvh", "--to", tmp_path / "rig.bvh",
        "--target-map", tmp_path / "rig.json",
    )  # fmt: skip

    assert status == 0 and "22 shared roles" in printed


def test_detected_map_can_be_saved_edited_and_reused(call, walk_file, rig_file, tmp_path):
    """A first go writes the map; without its arms, a second one leaves the arms at rest."""
    map_file = tmp_path / "rig.json"
    out = tmp_path / "out.bvh"
    call("retarget", walk_file, out, "--to", rig_file, "--write-target-map", map_file)
    found = read_humanoid_map(map_file)
    for role in [role for role in found.joints if "Arm" in role or "Hand" in role]:
        found = found.with_joint(role, None)
    write_humanoid_map(found, map_file)

    status, printed, _ = call(
        "retarget", walk_file, out, "--to", rig_file, "--target-map", map_file
    )

    assert status == 0 and "16 shared roles" in printed
    armless = read_bvh(out)
    arm = armless.rotations[:, armless.skeleton.index("mixamorig:LeftArm")]
    assert np.abs(np.abs(arm[:, 0]) - 1.0).max() < 1e-6


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--to", "{folder}/none.bvh"), "none.bvh"),
        (("--to", "{folder}/points.trc"), "points without a skeleton"),
        (("--to", "{folder}/rig.bvh", "--source-map", "{folder}/wrong.json"), "lacks: Nobody"),
        (("--to", "{folder}/rig.bvh", "--root-motion", "root bone"), "no joint above the hips"),
        ((), "--to"),
    ],
)
def test_retarget_reports_what_is_wrong(call, walk_file, rig_file, tmp_path, words, sentence):
    write_trc(Tracks(("a",), np.zeros((3, 1, 3)), 30.0), tmp_path / "points.trc")
    write_humanoid_map(HumanoidMap({"hips": "Nobody"}), tmp_path / "wrong.json")
    words = [word.format(folder=tmp_path) for word in words]

    status, _, error_output = call("retarget", walk_file, tmp_path / "out.bvh", *words)

    assert status == 2 and sentence in error_output
    assert not (tmp_path / "out.bvh").exists()


def test_travel_moves_to_the_root_bone(call, walk_file, tmp_path):
    write_bvh(resting(unreal()), tmp_path / "rig.bvh")

    status, _, _ = call(
        "retarget", walk_file, tmp_path / "out.bvh", "--to", tmp_path / "rig.bvh",
        "--root-motion", "root bone",
    )  # fmt: skip

    assert status == 0
    assert read_bvh(tmp_path / "out.bvh").skeleton.names[0] == "root"


def test_unbake_reports_and_saves_keys(call, walk_file, tmp_path):
    status, printed, _ = call(
        "unbake", walk_file, tmp_path / "few.bvh", "--tolerance", 0.5, "--keys"
    )

    sparse = load_sparse_motion(tmp_path / "few.npz")
    assert status == 0 and printed.startswith(f"{sparse.n_keys} keys instead of")
    before, after = (
        forward_kinematics(read_bvh(path)).positions
        for path in (walk_file, tmp_path / "few.bvh")
    )
    assert np.linalg.norm(after - before, axis=-1).max() < 0.0053


def test_unbake_refuses_points_and_invalid_tolerances(call, walk_file, tmp_path):
    write_trc(Tracks(("a",), np.zeros((3, 1, 3)), 30.0), tmp_path / "points.trc")

    failures = [
        call("unbake", tmp_path / "points.trc", tmp_path / "few.bvh"),
        call("unbake", walk_file, tmp_path / "few.bvh", "--tolerance", 0),
        call("unbake", walk_file, tmp_path / "few.bvh", "--tolerance", "nan"),
    ]

    assert [status for status, _, _ in failures] == [2, 2, 2]
    assert "Points without a skeleton" in failures[0][2]
    assert "not positive" in failures[1][2]


def resting(skeleton: Skeleton) -> Motion:
    rotations = np.tile(IDENTITY, (2, skeleton.n_joints, 1))
    return Motion(skeleton, rotations, np.tile(skeleton.offsets[0], (2, 1)), 30.0)
