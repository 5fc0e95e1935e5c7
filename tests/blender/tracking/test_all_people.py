"""Armatures of several people of one recording."""

import numpy as np
import pytest


def test_each_person_has_an_armature_and_the_first_is_active(write_tracked, load, blank):
    made = write_tracked(n_people=3)

    read = load("mocap_assist.track.tracked_armature.body").TrackedBody.read
    armatures = [each for each in blank.data.objects if each.type == "ARMATURE"]
    assert sorted(read(each).person for each in armatures) == [0, 1, 2]
    assert read(made.armature).person == 0
    assert all(each.name in made.message for each in armatures)
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
