"""From a C3D file to a cleaned armature: Import, Clean, Make Skeleton."""

import numpy as np
import pytest

STEP = 4  # of 120 frames a second
N_MARKERS = 41


@pytest.fixture
def tracks(recordings, load):
    """Eight seconds of a dancer with the CMU set, at 30 Hz, one marker lost for a second."""
    take = load("solvers.recordings").read_recording(recordings / "mocap" / "05_13.c3d")
    positions = take.positions[::STEP, :N_MARKERS].copy()
    positions[100:130, 5] = np.nan
    few = load("solvers.motion").Tracks
    return few(take.names[:N_MARKERS], positions, take.frame_rate / STEP)


@pytest.fixture
def holder(tracks, bring, load, tmp_path, blank):
    blank.context.scene.render.fps = 30
    load("solvers.recordings").write_c3d(tracks, tmp_path / "dance.c3d")
    return bring(tmp_path / "dance.c3d")


def head_positions(blank, armature, bone, frames):
    """World positions of a bone's head, as Blender evaluates them."""
    found = []
    for frame in frames:
        blank.context.scene.frame_set(int(frame))
        pose = armature.evaluated_get(blank.context.evaluated_depsgraph_get()).pose.bones[bone]
        found.append(armature.matrix_world @ pose.head)
    return np.array(found)


def test_a_c3d_becomes_a_cleaned_armature(blank, holder, tracks, load, recordings, markers_of):
    markers = {child.name: child.animation_data.action for child in markers_of(holder)}
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    cleaned = {child.name: child.animation_data.action for child in markers_of(holder)}

    assert blank.ops.mocap_assist.solve_skeleton() == {"FINISHED"}

    armature = blank.context.object
    assert armature.type == "ARMATURE"
    is_selected = load("mocap_assist.blender.compat").is_selected
    assert [bone.name for bone in armature.pose.bones if is_selected(bone)] == ["hips"]
    assert {child.name: child.animation_data.action for child in markers_of(holder)} == cleaned
    assert markers.keys() == cleaned.keys()
    skeleton = load("solvers.recordings").read_acclaim(recordings / "mocap" / "05_13.amc")
    joints = load("solvers.motion").forward_kinematics(skeleton)
    frames = np.arange(0, tracks.n_frames, 20)
    for bone, joint in {
        "leftLowerLeg": "ltibia", "rightLowerLeg": "rtibia",
        "leftLowerArm": "lradius", "rightLowerArm": "rradius",
    }.items():  # fmt: skip
        index = skeleton.skeleton.index(joint)
        expected = joints.positions[frames * STEP, index]
        found = head_positions(blank, armature, bone, frames + 1)
        rotated = expected[:, [0, 1, 2]] - expected.mean(axis=0)
        moved = np.linalg.norm(found - found.mean(axis=0), axis=1)
        assert np.abs(moved - np.linalg.norm(rotated, axis=1)).mean() < 0.05, bone
    raw = armature.animation_data.action
    assert not blank.ops.mocap_assist.revert_to_raw.poll()  # it is raw itself
    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}
    assert armature.animation_data.action != raw
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert armature.animation_data.action == raw


def test_markers_of_no_known_set_are_refused_in_a_sentence(blank, bring, load, tmp_path, rng):
    some = load("solvers.motion").Tracks(("a", "b", "c"), rng.normal(size=(60, 3, 3)), 30.0)
    load("solvers.recordings").write_trc(some, tmp_path / "some.trc")
    bring(tmp_path / "some.trc")
    before = set(blank.data.objects)

    with pytest.raises(RuntimeError, match="pelvis"):
        blank.ops.mocap_assist.solve_skeleton()

    assert set(blank.data.objects) == before


def test_button_gives_a_reason_without_markers(blank):
    with pytest.raises(RuntimeError, match="Select a marker set"):
        blank.ops.mocap_assist.solve_skeleton()


@pytest.mark.parametrize("unswap", [True, False])
def test_clean_puts_swapped_labels_right(blank, bring, tracks, load, tmp_path, unswap):
    swapped = tracks.positions.copy()
    pair = [
        tracks.names.index(name) for name in tracks.names if name.endswith(("LKNE", "RKNE"))
    ]
    swapped[40:90, pair] = tracks.positions[40:90, pair[::-1]]
    load("solvers.recordings").write_c3d(tracks.with_positions(swapped), tmp_path / "bad.c3d")
    blank.context.scene.render.fps = 30
    holder = bring(tmp_path / "bad.c3d")

    blank.ops.mocap_assist.denoise(unswap=unswap)

    read = load("mocap_assist.actions.markers.take").read_markers
    take = read(holder, blank.context.scene)
    order = [take.tracks.names.index(name.split(":")[-1]) for name in tracks.names]
    error = np.linalg.norm(
        take.tracks.positions[:, order][:, pair] - tracks.positions[:, pair], axis=-1
    )
    assert (np.median(error[45:85]) < 0.03) == unswap
