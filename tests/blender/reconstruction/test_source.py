"""The imported file of a take contains more than its bones; used if they agree."""

import numpy as np
import pytest


@pytest.fixture
def found(load, blank):
    """What was measured for what an armature plays, or None."""

    def find(armature, path):
        take = load("mocap_assist.actions.armature_read").read_take(
            armature, blank.context.scene
        )
        recording = load("solvers.recordings").read_recording(path)
        measured = load("solvers.workflows.joints_from_source").joints_from_source
        return measured(take.parts[0].motion, recording)

    return find


@pytest.mark.parametrize("fps", [24, 30, 60])
def test_imported_take_is_recognized_after_moving(walk_file, bring, found, blank, fps):
    armature = bring(walk_file)
    blank.context.scene.render.fps = fps
    armature.location, armature.rotation_euler.z, armature.scale = (2, 1, 0.9), 0.5, (1.1,) * 3
    blank.context.view_layer.update()

    assert found(armature, walk_file) is not None


def test_real_take_with_gaps_is_recognized(recordings, bring, found):
    path = recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"

    assert found(bring(path), path) is not None


def test_edited_take_is_used_as_edited(walk, walk_file, found):
    curves = walk.animation_data.action.layers[0].strips[0].channelbags[0].fcurves
    path = 'pose.bones["ElbowRight"].rotation_quaternion'
    key = curves.find(path, index=1).keyframe_points[40]
    key.co.y += 0.3

    assert found(walk, walk_file) is None


def test_reconstruct_works_without_the_source_file(walk, walk_file, reconstruct):
    walk_file.unlink()

    assert reconstruct().name == "walk.reconstructed"


def test_source_file_improves_joints_below_a_missing_one(
    load, truth, bring, tmp_path, reconstruct, blank
):
    """The elbow is missing; only the file has the position of the wrist."""
    from kinect_walks import tracked_walk

    motion, recordings = load("solvers.motion"), load("solvers.recordings")
    recording = tracked_walk(motion, truth)
    names, positions = recording.names, np.array(recording.tracks.positions)
    positions[60:75, names.index("ElbowRight")] = np.nan
    path = tmp_path / "walk.csv"
    recordings.write_joint_csv(
        recording.with_tracks(recording.tracks.with_positions(positions)), path
    )
    wrist = names.index("WristRight")
    errors = []
    for with_file in (True, False):
        armature = bring(path)
        if not with_file:
            path.unlink()
        reconstruct()
        take = load("mocap_assist.actions.armature_read").read_take(
            armature, blank.context.scene
        )
        body = take.parts[0].motion
        found_positions = motion.forward_kinematics(body).positions[
            :, body.skeleton.index("WristRight")
        ]
        errors.append(np.linalg.norm(found_positions - truth[:, wrist], axis=-1)[60:75].mean())

    assert errors[0] < 0.03
    assert errors[0] < 0.8 * errors[1]


@pytest.mark.parametrize(("first", "last"), [(25, 65), (1, 40), (50, 90)])
def test_segment_of_a_take_is_found_in_its_file(
    walk, walk_file, load, blank, reconstruct, first, last
):
    scene = blank.context.scene
    scene.use_preview_range = True
    scene.frame_preview_start, scene.frame_preview_end = first, last
    ranges = load("mocap_assist.actions.frames").FrameRange
    take = load("mocap_assist.actions.armature_read").read_take(walk, scene, ranges.PREVIEW)
    recording = load("solvers.recordings").read_recording(walk_file)

    found = load("solvers.workflows.joints_from_source").joints_from_source(
        take.parts[0].motion, recording
    )
    reconstruct(frame_range="PREVIEW")

    wrists = (each.tracks.positions for each in (found, recording))
    mine, theirs = (
        positions[:, each.names.index("WristLeft")]
        for positions, each in zip(wrists, (found, recording), strict=True)
    )
    offsets = mine - theirs[first - 1 : last]
    assert np.allclose(offsets, [0.0, 0.0, offsets[0, 2]], atol=1e-4)  # on the floor
    terms = load("mocap_assist.overlays.confidence_colors").available_terms(walk)
    assert "KINEMATICS" in {term.name for term in terms}


def test_hips_never_tracked_are_between_the_legs(
    load, truth, bring, tmp_path, reconstruct, capfd
):
    from kinect_walks import tracked_walk

    motion, recordings = load("solvers.motion"), load("solvers.recordings")
    recording = tracked_walk(motion, truth)
    positions = np.array(recording.tracks.positions)
    positions[:, recording.names.index("HipCenter")] = np.nan
    path = tmp_path / "walk.csv"
    recordings.write_joint_csv(
        recording.with_tracks(recording.tracks.with_positions(positions)), path
    )

    armature = bring(path)
    message = capfd.readouterr().out
    result = reconstruct()

    assert "with hips added between the legs" in message
    assert "HipCenter" in armature.pose.bones
    assert result.name == "walk.reconstructed"
    terms = load("mocap_assist.overlays.confidence_colors").available_terms(armature)
    assert "KINEMATICS" in {term.name for term in terms}
