"""Armatures of several people of one recording."""

import numpy as np
import pytest


def test_each_person_has_an_armature_and_the_first_is_active(write_tracked, load, blank):
    made = write_tracked(n_people=3)

    read = load("mocap_assist.track.tracked_armature.body").TrackedBody.read
    armatures = [each for each in blank.data.objects if each.type == "ARMATURE"]
    assert sorted(read(each).person for each in armatures) == [0, 1, 2]
    assert read(made.armature).person == 0
    assert all(f"{each.name}:" in made.message for each in armatures)
    ends = {read(each).person: each.name.rpartition(" tracked ")[2] for each in armatures}
    assert ends == {0: "person 1", 1: "person 2", 2: "person 3"}
    actions = {each.animation_data.action for each in armatures}
    assert len(actions) == 3


def test_one_tracked_person_has_no_index(write_tracked, load):
    made = write_tracked()

    assert (
        load("mocap_assist.track.tracked_armature.body").TrackedBody.read(made.armature).person
        is None
    )


def test_track_from_here_reads_the_images_of_its_person(load):
    """Two upright boards stand next to each other; the second one moves a little."""
    scene, retracking = load("solvers.depth_scene"), load("mocap_assist.track.solve_retracking")
    camera = scene.Camera(142.8, 142.8, 79.5, 59.5, 160, 120)

    def read(frame):
        depth = np.zeros((120, 160), np.float32)
        depth[25:95, 30:52] = 3.0
        depth[30:95, 100 + frame : 120 + frame] = 2.5
        return depth

    recording = scene.DepthRecording(camera, 6, 30.0, read)
    played = retracking.TrackedActor(
        recording, scene.ForegroundSettings(), None, None, 0, None, person=1
    )
    found = retracking._actor_only(played, lambda fraction, message="": None)
    second = found.frame(0) > 0.0
    other = found.occluders(0) > 0.0
    assert second.any() and other.any() and not (second & other).any()
    assert (second | other).sum() == (read(0) > 0.0).sum()

    with pytest.raises(load("solvers.errors").InvalidMotionError, match="Only 2 people"):
        retracking._actor_only(played._replace(person=2), lambda fraction, message="": None)


def test_all_people_are_tracked_and_written(load, blank, tmp_path):
    """Two bodies stand next to each other for four frames; previews show the first one only."""
    body, scene = load("solvers.depth_tracking.body"), load("solvers.depth_scene")
    camera = scene.Camera(142.8, 142.8, 79.75, 59.75, 160, 120)
    depth = np.zeros((120, 160), np.float32)
    for right in (-0.7, 0.7):
        pose = np.zeros(36)
        pose[[0, 2]] = right, 2.8
        model = body.default_body()
        depth += body.cast_rays(model, body.segment_frames(model, pose), camera).depth_image()
    recording = scene.DepthRecording(camera, 4, 30.0, lambda frame: depth)
    solving = load("mocap_assist.track.solve_tracking")
    settings = load("solvers.depth_tracking.capturing").CaptureSettings(
        backward=False, refine=False, check_every=1000
    )
    previews = []

    tracked = solving.track_recording(
        recording, settings, scene.ForegroundSettings(), None, True, show=previews.append
    )

    assert (tracked.person, [other.person for other in tracked.others]) == (0, [1])
    hips = [one.motion.root_positions[0] for one in (tracked, *tracked.others)]
    assert np.linalg.norm(hips[0] - hips[1]) == pytest.approx(1.4, abs=0.05)
    partial = solving.partial_result(previews, recording, settings)
    np.testing.assert_allclose(partial.motion.root_positions[0], hips[0], atol=0.05)
